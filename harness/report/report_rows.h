/* The rows of a report as both of its forms show them: the columns, and what to say first. */
#ifndef MOTE_HARNESS_REPORT_ROWS_H
#define MOTE_HARNESS_REPORT_ROWS_H

#include "harness/base/number_text.h"
#include "harness/report/report.h"

/* One column of the table of results. */
typedef struct mote_report_column {
    const char *group, *head; /* the two lines above it: "total", "median" */
    const char *object, *key; /* where its value is in a row: "total_ns", "median"; object NULL:
                                 at the top */
    mote_number_show show;    /* how it is written */
    bool interval;            /* the object has ci_low and ci_high for it */
    const char *brief;        /* its head in the plain text; NULL: not there */
    const char *meaning;      /* one sentence */
} mote_report_column;

extern const mote_report_column mote_report_columns[];
extern const size_t mote_report_column_count;

/* Row i, i < mote_report_row_count; 0 rows where there is no summary. */
size_t mote_report_row_count(const mote_report *report);
const json_t *mote_report_row(const mote_report *report, size_t i);

/* row[object][key], or row[key] with object NULL; MOTE_NONE where it is no number. */
double mote_report_number(const json_t *row, const char *object, const char *key);

/* Takes the two ends of value[interval]; false where they are no two numbers: an end that is
   not finite is stored as null. */
bool mote_report_interval(const json_t *value, double interval[2]);

/* row[key] as text, "" where it is none. */
const char *mote_report_text(const json_t *row, const char *key);

/* What a reader of a row's figures must know: the stride, that others ran beside it, replicates
   that failed. i from 0, below MOTE_REPORT_NOTES; false: nothing. */
#define MOTE_REPORT_NOTES 3
#define MOTE_REPORT_NOTE 80
bool mote_report_note(const json_t *row, size_t i, char text[MOTE_REPORT_NOTE]);

/* Whether two rows stand in one table: one scenario, state of caches, machine,
   question and range of frames. */
bool mote_report_same_block(const json_t *a, const json_t *b);

/* One after the last row of the block that starts at row first. */
size_t mote_report_block_end(const mote_report *report, size_t first);

/* What a block says first; SIZE_MAX where there is no such row. */
typedef struct mote_report_glance {
    size_t right;   /* the fastest row without a wrong answer in any frame */
    size_t fastest; /* the fastest row; SIZE_MAX where it is `right` */
} mote_report_glance;

mote_report_glance mote_report_block_glance(const mote_report *report, size_t first,
                                            size_t end);

#endif
