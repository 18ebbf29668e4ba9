/* A run as read for comparisons: its summary, manifest and instructions; and which rows of two
   runs are compared. */
#ifndef MOTE_HARNESS_COMPARED_RUN_H
#define MOTE_HARNESS_COMPARED_RUN_H

#include "harness/loop/simulations.h"
#include "harness/summary/summary.h"

typedef struct mote_compared_run {
    char *directory;
    mote_summary summary; /* without rows if there are only simulations */
    mote_simulations simulations;
    json_t *manifest;     /* manifest.json, or NULL */
    json_t *instructions; /* instructions.json, or NULL */
} mote_compared_run;

/* Reads a run's directory, its summary.json, or another file in that format. If there are
   cells, the summary is made from them, since summary.json may be older. MOTE_EIO or
   MOTE_EINVAL, with the file, if one cannot be read or a row of it lacks its scenario,
   fingerprint or method. The caller frees *run. */
mote_status mote_compared_run_read(const char *path, mote_compared_run *run);
void mote_compared_run_free(mote_compared_run *run);

/* The row of another run with the same configuration: the same scene, question, frames, stride,
   caches, seeds, method and parameters. What an older run does not say is taken for what the
   other one says. Preferably one whose times are comparable if the row's are (a run may have
   been measured with --jobs and without), and then on the same machine. NULL: none. */
const mote_summary_row *mote_compared_partner(const mote_summary *summary,
                                              const mote_summary_row *row);

/* Whether two rows are of one method with the same parameters; one that only one of them knows
   has its default there. */
bool mote_compared_same_method(const mote_summary_row *a, const mote_summary_row *b);

/* Whether two texts are equal, as far as both are known (not ""). */
bool mote_compared_agree(const char *a, const char *b);

/* Whether two ranges of frames are equal, as far as both are known. */
bool mote_compared_same_range(const uint32_t a[2], const uint32_t b[2]);

#endif
