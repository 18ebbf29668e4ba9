/* Merges runs that were measured separately, as shards or on other machines, into one
   directory. */
#ifndef MOTE_HARNESS_MERGE_H
#define MOTE_HARNESS_MERGE_H

#include "core/base/status.h"

#include <stddef.h>

typedef struct mote_merged {
    size_t copied;      /* cells */
    size_t simulations; /* copied */
    size_t present;     /* cells and simulations that the directory already had */
} mote_merged;

/* Copies every complete cell and every simulation of a run into directory, which is created if
   missing, and the manifest if there is none. What is there already stays, unless it failed and
   the run's did not. MOTE_EIO for a run that cannot be read or a directory that cannot be
   written; MOTE_EINVAL for an incomplete cell, or for a run measured by another build than the
   existing cells, as the two cannot be in one table. */
mote_status mote_merge(const char *directory, const char *run, mote_merged *merged);

#endif
