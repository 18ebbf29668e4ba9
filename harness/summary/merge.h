/* Runs that were measured apart, as shards or on other machines, put into one directory. */
#ifndef MOTE_HARNESS_MERGE_H
#define MOTE_HARNESS_MERGE_H

#include "core/base/status.h"

#include <stddef.h>

typedef struct mote_merged {
    size_t copied, present; /* cells that were copied; that the directory had already */
} mote_merged;

/* Copies every whole cell of a run into directory, made if missing, and, where it has none, the
   manifest. A cell that is there already stays. MOTE_EIO for a run that cannot be read or a
   directory that cannot be written, MOTE_EINVAL for a cell that is not whole or for a run that
   was measured by another build than the one that is there: its cells could not stand in one
   table. */
mote_status mote_merge(const char *directory, const char *run, mote_merged *merged);

#endif
