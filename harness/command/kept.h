/* What a directory keeps: the cells of `mote run`, the simulations of `mote simulate`, or
   both. */
#ifndef MOTE_HARNESS_KEPT_H
#define MOTE_HARNESS_KEPT_H

#include "harness/loop/simulations.h"
#include "harness/summary/summary.h"

typedef struct mote_kept {
    bool has_summary; /* there are cells, or no simulations */
    mote_summary summary;
    mote_simulations simulations;
} mote_kept;

/* Makes the rows of a directory's cells and simulations. Errors of mote_summary_make, unless
   there are simulations only. The caller frees *kept. */
mote_status mote_kept_read(const char *directory, mote_kept *kept);
void mote_kept_free(mote_kept *kept);

/* Prints the table of the cells and the lines of the simulations. */
void mote_kept_print(const mote_kept *kept, FILE *out);

#endif
