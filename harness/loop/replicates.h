/* Repeated simulations of several methods, each in its own process, stored in
   DIRECTORY/simulations/ID.json as soon as it ends, and not repeated if that file exists.
   Replicates differ by the method's seed and in time. */
#ifndef MOTE_HARNESS_REPLICATES_H
#define MOTE_HARNESS_REPLICATES_H

#include "harness/loop/simulations.h"
#include "harness/run/plan.h"

typedef struct mote_replicates {
    const mote_subject *subject; /* with its hashes */
    const mote_choices *choices;
    mote_simulation_options options;
    uint32_t steps;      /* 0: all frames of the scenario */
    uint64_t seed;       /* replicate k, from 1, has seed + k - 1 */
    uint32_t replicates; /* 1 .. MOTE_REPLICATES_MAX */
    uint32_t jobs;       /* at a time, 1 .. MOTE_CHILDREN_MAX */
    uint64_t program;    /* mote_program_hash */
    const char *directory;
    double share;  /* further replicates are added until the interval of each method's time lies
                      within this share of its median; 0: none are added */
    double budget; /* seconds for them */
} mote_replicates;

/* MOTE_EINVAL if a method rejects its parameters or the scenario cannot be simulated, with the
   reason. Nothing is written. */
mote_status mote_replicates_check(const mote_replicates *plan);

/* Runs the missing simulations; simulations.h reads them. Invalid input, such as bodies that
   start in contact, ends everything with MOTE_EINVAL, and memory that runs out with
   MOTE_ENOMEM, where what is finished is kept; a crash, or a method that cannot answer, is
   stored as that replicate's result. MOTE_EIO also if a signal asked to stop. With a share, the
   precision reached is told on stderr. */
mote_status mote_replicates_run(const mote_replicates *plan);

/* Adds to *all the simulations in a list that the plan asks for, of which a directory may keep
   more, and to *failed those of them that failed; unsupported ones do not count. */
void mote_replicates_count(const mote_replicates *plan, const mote_simulations *list,
                           size_t *all, size_t *failed);

#endif
