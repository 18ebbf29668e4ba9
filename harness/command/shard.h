/* --shard I/N: a part of the scenarios of a command line. Shards are whole scenarios, so that
   the methods compared are measured on one machine. */
#ifndef MOTE_HARNESS_SHARD_H
#define MOTE_HARNESS_SHARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Part `shard` of `shards`, from 1; 0 of 0: everything. Zero-initialise. */
typedef struct mote_shard {
    uint32_t shard, shards;
} mote_shard;

/* "I/N" with 1 <= I <= N; false otherwise. */
bool mote_shard_read(const char *text, mote_shard *shard);

/* If no shard was given, a task of a Slurm job array is one. False, after a line on stderr, if
   Slurm's variables do not describe a task. */
bool mote_shard_of_task(const char *command, mote_shard *shard);

/* Keeps every shards-th of the scenarios; returns how many remain. */
size_t mote_shard_keep(mote_shard shard, const char **scenarios, size_t count);

#endif
