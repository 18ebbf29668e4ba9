/* The columns of a summary's rows, each declared once: its name, unit and meaning, its place in
   a row, its display, and how two runs are compared by it. Writing and reading of summary.json,
   its schema, the CSV, the tables of the terminal, the report with its page and the documents
   follow this list, in its order. A new column is a member of mote_summary_row and one entry in
   column.c. */
#ifndef MOTE_HARNESS_COLUMN_H
#define MOTE_HARNESS_COLUMN_H

#include "harness/base/number_text.h"
#include "harness/summary/summary.h"

#include <jansson.h>

/* The type of a member of mote_summary_row. */
typedef enum mote_column_type {
    MOTE_COLUMN_TEXT,     /* const char *; "": no text */
    MOTE_COLUMN_REAL,     /* double */
    MOTE_COLUMN_WHOLE,    /* double: a whole number */
    MOTE_COLUMN_COUNT,    /* uint32_t, uint64_t or size_t */
    MOTE_COLUMN_FLAG,     /* bool; as a number: 1 or 0 */
    MOTE_COLUMN_ROW,      /* const mote_summary_row *, another row, written as its label */
    MOTE_COLUMN_COUNTS,   /* uint32_t[] */
    MOTE_COLUMN_NUMBERS,  /* double[] */
    MOTE_COLUMN_COUNTERS, /* the row's counts and processes */
    MOTE_COLUMN_PROCESSES,
    MOTE_COLUMN_OBJECT /* json_t *, borrowed */
} mote_column_type;

/* The tables, each with a selection of columns. */
typedef enum mote_view {
    MOTE_VIEW_TABLE,   /* `mote summarize` */
    MOTE_VIEW_REPORT,  /* report.html; report.md has those with `brief` */
    MOTE_VIEW_SCREEN,  /* the screen at the end of `make bench` */
    MOTE_VIEW_ENGINES, /* the same of `make engines` */
    MOTE_VIEW_IMPACTS, /* `mote summarize`, of scenes that are asked for impacts */
    MOTE_VIEWS
} mote_view;

/* How two runs are compared by a column. Values are equal if they differ by at most `share` of
   the larger one, or if both are at most `negligible`. */
typedef struct mote_column_rule {
    const char *name; /* its name in a comparison; NULL: not compared in this way */
    double share, negligible;
    bool complement; /* more is better: 1 minus the value is compared */
    bool answers; /* it depends on the random numbers of a replicate, and is compared over the
                     replicates that both runs have */
} mote_column_rule;

typedef struct mote_column {
    const char *object, *key; /* its place in a row of summary.json: row[object][key], or
                                 row[key] if object is NULL */
    const char *csv;          /* its name in the CSV; NULL: not in the CSV */
    mote_column_type type;
    size_t offset, size; /* of the member */
    bool quoted;         /* TEXT: always quoted in the CSV */
    bool optional;       /* omitted from JSON without a value; otherwise null */
    bool of_scenes;      /* omitted from JSON in rows of two bodies */
    const char *unit;    /* "ns", "L", "bytes", "frames", "share"; "" for none */
    const char *meaning; /* NULL: as in the previous column, which has the same object */
    const char *schema;  /* JSON of its schema, if the type is not enough */

    /* Its display, for columns in a view. */
    const char *group, *head; /* the two lines above it: "total", "median" */
    const char *brief;        /* one line instead; NULL: not in report.md */
    mote_number_show show;
    bool interval;         /* ci_low and ci_high of the same object are its interval */
    int place[MOTE_VIEWS]; /* position, ascending from left to right; 0: not shown */

    mote_column_rule rule;
} mote_column;

extern const mote_column mote_columns[];
extern const size_t mote_column_count;

/* Finds row[object][key], or row[key] if object is NULL; NULL if there is no such column. */
const mote_column *mote_column_find(const char *object, const char *key);

/* The value of a number or flag in a row, or MOTE_NONE; the text of a text, or "". */
double mote_column_number(const mote_column *column, const mote_summary_row *row);
const char *mote_column_text(const mote_column *column, const mote_summary_row *row);

/* The value as JSON (a new reference, NULL if there is none), and back from JSON (NULL:
   missing), except type ROW, which the reader of a summary resolves. A value of another type
   counts as missing: texts become "", numbers MOTE_NONE or 0, flags true. */
json_t *mote_column_write(const mote_column *column, const mote_summary_row *row);
void mote_column_read(const mote_column *column, const json_t *value, mote_summary_row *row);

/* The columns of a view from left to right; returns their number. columns holds
   MOTE_VIEW_MAX. */
#define MOTE_VIEW_MAX 40
size_t mote_column_view(mote_view view, const mote_column *columns[MOTE_VIEW_MAX]);

#endif
