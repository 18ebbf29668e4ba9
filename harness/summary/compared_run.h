/* A run as comparisons read it: its summary, and what lies beside. */
#ifndef MOTE_HARNESS_COMPARED_RUN_H
#define MOTE_HARNESS_COMPARED_RUN_H

#include "harness/summary/summary.h"

typedef struct mote_compared_run {
    mote_summary summary;
    json_t *manifest;     /* manifest.json, or NULL */
    json_t *instructions; /* instructions.json, or NULL */
} mote_compared_run;

/* Reads a run's directory, or its summary.json, or another file like that. Where there are
   cells, the summary is made from them: a summary.json may be older than they are. MOTE_EIO or
   MOTE_EINVAL, with the file, when one cannot be read. The caller frees *run. */
mote_status mote_compared_run_read(const char *path, mote_compared_run *run);
void mote_compared_run_free(mote_compared_run *run);

#endif
