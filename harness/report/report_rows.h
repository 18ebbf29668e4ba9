/* The rows of a report as both of its forms show them: their order, their blocks, and what to
   say first. Columns are those of MOTE_VIEW_REPORT (harness/summary/column.h). */
#ifndef MOTE_HARNESS_REPORT_ROWS_H
#define MOTE_HARNESS_REPORT_ROWS_H

#include "harness/report/report.h"
#include "harness/summary/table.h"

/* The rows in the order in which they are shown: block by block, within a block by median total
   time, rows without a time that can be compared last. Part of mote_report_gather. */
void mote_report_sort(mote_report *report);

/* Row i as shown, i < mote_report_row_count; 0 rows where there is no summary. */
size_t mote_report_row_count(const mote_report *report);
const json_t *mote_report_row(const mote_report *report, size_t i);

/* The cells of row i; NULL where the report has none. */
const mote_summary_row *mote_report_cells(const mote_report *report, size_t i);

/* row[object][key], or row[key] with object NULL; MOTE_NONE where it is no number. */
double mote_report_number(const json_t *row, const char *object, const char *key);

/* Reads the two ends of value[interval]; false where they are not two numbers: an end that
   is not finite is stored as null. */
bool mote_report_interval(const json_t *value, double interval[2]);

/* row[key] as text, "" where it is none. */
const char *mote_report_text(const json_t *row, const char *key);

/* The name of a row's scene, as in its heading; older summaries have only its scenario. */
const char *mote_report_scene(const json_t *row);

/* What a reader of a row's figures must know: the stride, that others ran beside it, replicates
   that failed. i from 0, below MOTE_REPORT_NOTES; false: nothing. */
#define MOTE_REPORT_NOTES MOTE_ROW_NOTES
#define MOTE_REPORT_NOTE MOTE_ROW_NOTE
bool mote_report_note(const json_t *row, size_t i, char text[MOTE_REPORT_NOTE]);

/* Whether a row was given all vertices at no charge; it is not compared with rows that are
   charged. */
bool mote_report_is_given(const json_t *row);

/* Whether two rows are in one table: same scenario, state of caches, machine, question and
   range of frames. */
bool mote_report_same_block(const json_t *a, const json_t *b);

/* One after the last row of the block that starts at row first. */
size_t mote_report_block_end(const mote_report *report, size_t first);

/* The rows that a block mentions first; SIZE_MAX where there is no such row. Rows with given
   positions (no method is charged for deformation) are not compared with the others. */
typedef struct mote_report_glance {
    size_t right;   /* the fastest row without a wrong answer in any frame */
    size_t fastest; /* the fastest row; SIZE_MAX where it is `right` */
} mote_report_glance;

mote_report_glance mote_report_block_glance(const mote_report *report, size_t first,
                                            size_t end);

/* Whether a row represents its method where one row a method is shown
   (mote_find_method_rows); true of all rows of an older summary, which does not say. */
bool mote_report_stands_for_method(const json_t *row);

#endif
