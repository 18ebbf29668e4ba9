/* The history of accepted references: results/history.csv, a line for each row of each
   reference. */
#ifndef MOTE_HARNESS_HISTORY_H
#define MOTE_HARNESS_HISTORY_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a row was asked: its frames, the question, the step of impacts and the tolerance, as
   "950-1149 distance" or "1-60 impact step 10 tolerance 0.01"; "" where the frames are not
   known (0). The caller frees it. */
char *mote_history_asked(const uint32_t frames[2], const char *ask, uint32_t step,
                         double tolerance);

/* A line of the file with a time. Texts are borrowed from the history. */
typedef struct mote_history_point {
    const char *date, *commit, *why, *row;
    const char *asked;  /* see mote_history_asked. A line of an older version does not say: that
                           of the next line of its row which does; "": none does */
    double time;        /* relative to fcl-aabb if the run had it (1 / ratio), so that
                           references from different machines can be in one series */
    bool relative;      /* otherwise in ns: a separate series, since the scales differ */
    unsigned reference; /* numbered from 0 by date */
    double relative_time; /* to the first point of its series */
    bool changed;         /* a change point: more than 5 %, and more than three times the usual
                             change of the series from one reference to the next */
} mote_history_point;

typedef struct mote_history {
    char *text;
    mote_history_point *points;
    size_t count;
    unsigned references;
} mote_history;

/* MOTE_EINVAL with the line if mote did not write the file. Free with mote_history_free, even
   after a failure. */
mote_status mote_history_read(const char *file, mote_history *history);
void mote_history_free(mote_history *history);

/* Whether two points are of one row that was asked the same, and on the same scale. */
bool mote_history_same_series(const mote_history_point *a, const mote_history_point *b);

/* Whether this is the first point of its series. */
bool mote_history_begins_series(const mote_history *history, size_t index);

/* The row of a point, with what it was asked where a row of that name was asked something else.
   The caller frees it. */
char *mote_history_title(const mote_history *history, const mote_history_point *point);

/* Adds the rows of the run in directory to the file, which is created if missing: date, commit,
   why, row, time, ratio, counts, bytes, error, what was asked. why must not be empty. A file of
   an older version gets the columns that it lacks, empty in its lines. */
mote_status mote_history_add(const char *file, const char *directory, const char *why);

/* Draws the file's series, one per row, as times relative to the first, with change points
   marked, to results/history.svg and .png beside it. Errors as mote_history_read; MOTE_EINVAL
   if there is nothing to draw. */
mote_status mote_history_draw(const char *file);

#endif
