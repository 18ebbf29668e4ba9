/* A run as read for comparisons: its summary, manifest and instructions. */
#ifndef MOTE_HARNESS_COMPARED_RUN_H
#define MOTE_HARNESS_COMPARED_RUN_H

#include "harness/loop/simulations.h"
#include "harness/summary/summary.h"

typedef struct mote_compared_run {
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

#endif
