/* A page of any number of runs: their rows in one place, a table for each scene, question and
   machine, with what they were asked and where they come from; the same rows as CSV. */
#ifndef MOTE_HARNESS_SITE_H
#define MOTE_HARNESS_SITE_H

#include "harness/report/report.h"

/* A run: its folder with summary.json and, where it has them, manifest.json and report.html. */
typedef struct mote_results_site_run {
    char *directory;  /* as it was named */
    char *path;       /* without links */
    char *name;       /* the last parts of the path that tell it from the other runs */
    json_t *manifest; /* NULL: it has none */
    uint64_t digest;  /* of summary.json */
    bool has_report;
    mote_summary summary;
} mote_results_site_run;

typedef struct mote_results_site {
    mote_results_site_run *runs;
    size_t count, capacity;
    json_t *left_out; /* texts: what was named twice */
    mote_report all;  /* the rows of all runs, in the order of scenes; borrows from runs */
    size_t *run_of;   /* [rows of all.summary]: the index of a row's run */
} mote_results_site;

/* Adds a run. One that was added already, or whose summary.json is the same file or a copy, is
   noted in left_out. MOTE_EIO: there is no such folder or no summary.json in it; MOTE_EINVAL:
   it cannot be read, has another schema, or a row without scenario or method. */
mote_status mote_results_site_add(mote_results_site *site, const char *directory);

/* Writes directory/index.html and directory/results.csv from what was added, and makes the
   directory. Links from there to the runs are relative. */
mote_status mote_results_site_write(mote_results_site *site, const char *directory);
void mote_results_site_free(mote_results_site *site);

#endif
