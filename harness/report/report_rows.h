/* The rows of a report as both of its forms show them: their order, their blocks, and which to
   mention first. Columns are those of MOTE_VIEW_REPORT (harness/summary/column.h). */
#ifndef MOTE_HARNESS_REPORT_ROWS_H
#define MOTE_HARNESS_REPORT_ROWS_H

#include "harness/report/report.h"

/* The rows in display order: block by block, within a block by median total time, rows without
   a comparable time last. Part of mote_report_gather. */
void mote_report_sort(mote_report *report);

/* Row i as shown, i < summary.count. */
const mote_summary_row *mote_report_row(const mote_report *report, size_t i);

/* Reads the two ends of value[interval]; false unless they are two numbers: an end that is not
   finite is stored as null. */
bool mote_report_interval(const json_t *value, double interval[2]);

/* One after the last row of the block that starts at row first. */
size_t mote_report_block_end(const mote_report *report, size_t first);

/* The rows mentioned first for a block; SIZE_MAX if there is no such row. Rows with given
   positions (no method is charged for deformation) are not compared with the others. */
typedef struct mote_report_glance {
    size_t right;   /* the fastest row without a wrong answer in any frame */
    size_t fastest; /* the fastest row; SIZE_MAX if it is `right` */
} mote_report_glance;

mote_report_glance mote_report_block_glance(const mote_report *report, size_t first,
                                            size_t end);

#endif
