/* A summary as text: the table on the terminal, CSV, and the formats of other tools. */
#ifndef MOTE_HARNESS_TABLE_H
#define MOTE_HARNESS_TABLE_H

#include "harness/base/file.h"
#include "harness/summary/column.h"

#include <stdio.h>

/* A block a scenario and caches, a line a configuration. */
void mote_table_print(const mote_summary *summary, FILE *out);

/* "11,920 and 11,920 triangles, 1,984 frames, 3 replicates, caches hot": what was measured of
   the scene of the block that begins at row start. The caller frees it. */
char *mote_table_heading(const mote_summary *summary, size_t start);

/* One after the last row of that block. */
size_t mote_table_block_end(const mote_summary *summary, size_t start);

/* The columns of a view: two lines of heads behind `width` characters, of which the second
   begins with "method"; and the values of a row, below them, without a line end. */
void mote_table_heads(mote_view view, int width, FILE *out);
void mote_table_values(mote_view view, const mote_summary_row *row, FILE *out);

#define MOTE_ROW_NOTES 4
#define MOTE_ROW_NOTE 96

/* What must be known of a row beside its figures, i < MOTE_ROW_NOTES: "every 16th frame";
   false, and no text, where it does not apply. */
bool mote_table_note(const mote_summary_row *row, int i, char text[MOTE_ROW_NOTE]);

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
