/* Speed at equal error: the fronts of time against error of a run's scenarios. A family is the
   configurations of one method that differ in n only, on the same frames of one machine. Its
   front at an error e is the time that it needs to be at most so wrong: of its fastest
   configuration that is, or, towards the next faster one that is not, interpolated between the
   two on logarithmic scales. Nothing is interpolated from an exact configuration: none lies
   between. Error is the 99th percentile, in L, time the median total, both over all frames of
   all replicates, as in the summary's rows. */
#ifndef MOTE_HARNESS_FRONT_H
#define MOTE_HARNESS_FRONT_H

#include "harness/base/file.h"
#include "harness/summary/summary.h"

#include <stdio.h>

#define MOTE_FRONT_LEVELS 5
extern const double mote_front_levels[MOTE_FRONT_LEVELS]; /* rising; the first: exact */

/* A family at one level, against the best of all FCL's configurations at that level. */
typedef struct mote_front_speed {
    double time_ns;           /* MOTE_NONE: no configuration is so exact */
    double faster;            /* FCL's time / this; MOTE_NONE without FCL in the run */
    mote_confidence interval; /* of faster in processes: drawn again from ten on, else t; wide
                                 enough to hold it */
} mote_front_speed;

typedef struct mote_front {
    size_t first;    /* a row of the family, for its scenario and caches */
    char title[256]; /* "particle-paper:refine=no" */
    mote_front_speed speed[MOTE_FRONT_LEVELS];
} mote_front;

typedef struct mote_fronts {
    const mote_summary *summary; /* borrowed */
    mote_front *items;           /* in the order of the summary's rows */
    size_t count;
    size_t *dominator; /* [summary->count]: the fastest row that is surely faster (by intervals,
                          so with two replicates or more) and no less exact than this one;
                          SIZE_MAX: none */
} mote_fronts;

/* Of rows with a distance and comparable times; others are in no family. The caller frees
 *fronts. */
mote_status mote_fronts_make(const mote_summary *summary, mote_fronts *fronts);
void mote_fronts_free(mote_fronts *fronts);

/* The time at which points reach an error of at most `error`; MOTE_NONE when none does. */
double mote_front_time(const double *times, const double *errors, size_t count, double error);

/* The label of a row without its n. */
void mote_front_title(const mote_summary_row *row, char *title, size_t size);

void mote_fronts_print(const mote_fronts *fronts, FILE *out);

/* [{"scenario", "cache", "family", "speed": [{"error", "total_ns", "faster", "ci_low",
   "ci_high"}]}]; NULL when memory ran out. */
json_t *mote_fronts_json(const mote_fronts *fronts);

/* Writes directory/fronts.csv, a line a row of the summary with its dominator, and
   directory/speed.csv, a line a family and level. */
mote_status mote_fronts_write(const mote_fronts *fronts, const char *directory);

#endif
