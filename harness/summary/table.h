/* A summary as text: the table on the terminal, CSV, and the formats of other tools. */
#ifndef MOTE_HARNESS_TABLE_H
#define MOTE_HARNESS_TABLE_H

#include "harness/base/file.h"
#include "harness/summary/column.h"

#include <stdio.h>

/* Prints a block per scenario and caches, a line per configuration. */
void mote_table_print(const mote_summary *summary, FILE *out);

/* "11,920 and 11,920 triangles, 1,984 frames, 3 replicates, caches hot": what was measured in
   the scene of the block that begins at row start. The caller frees it. */
char *mote_table_heading(const mote_summary *summary, size_t start);

/* One after the last row of that block. */
size_t mote_table_block_end(const mote_summary *summary, size_t start);

/* The columns of a view: two header lines after `width` characters, the second beginning with
   "method"; and a row's values below them, without a line end. */
void mote_table_heads(mote_view view, int width, FILE *out);
void mote_table_values(mote_view view, const mote_summary_row *row, FILE *out);

#define MOTE_ROW_NOTES 4
#define MOTE_ROW_NOTE 96

/* Note i < MOTE_ROW_NOTES that accompanies a row's values, such as "every 16th frame"; false,
   and no text, if it does not apply. */
bool mote_table_note(const mote_summary_row *row, int i, char text[MOTE_ROW_NOTE]);

/* A line of names, then one line per configuration, times in nanoseconds; missing values are
   empty fields. */
void mote_table_csv(const mote_summary *summary, mote_text *text);

/* The same with further columns at the end: their names, and their fields in each row [count],
   both as they stand in the file. */
void mote_table_csv_with(const mote_summary *summary, const char *names, char *const *fields,
                         mote_text *text);

/* The formats of benchmark trackers. NULL if memory ran out; the caller decrefs. */
json_t *mote_gha_json(const mote_summary *summary);     /* github-action-benchmark */
json_t *mote_bencher_json(const mote_summary *summary); /* Bencher */

/* Google Benchmark: an entry per replicate. manifest (borrowed, may be NULL): the run's, for
   when and where it was measured. */
json_t *mote_gbench_json(const mote_summary *summary, const json_t *manifest);

#endif
