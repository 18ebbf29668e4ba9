/* A summary as text: the table on the terminal, CSV, and the formats of other tools. */
#ifndef MOTE_HARNESS_TABLE_H
#define MOTE_HARNESS_TABLE_H

#include "harness/base/file.h"
#include "harness/summary/summary.h"

#include <stdio.h>

/* A block a scenario and caches, a line a configuration. */
void mote_table_print(const mote_summary *summary, FILE *out);

/* A line of names, then one line a configuration, times in nanoseconds, an empty field for what
   there is not. */
void mote_table_csv(const mote_summary *summary, mote_text *text);

/* What benchmark trackers read. NULL when memory ran out; the caller decrefs. */
json_t *mote_gha_json(const mote_summary *summary);     /* github-action-benchmark */
json_t *mote_bencher_json(const mote_summary *summary); /* Bencher */

/* Google Benchmark: an entry a replicate. manifest (borrowed, may be NULL): the run's, for when
   and where it was measured. */
json_t *mote_gbench_json(const mote_summary *summary, const json_t *manifest);

#endif
