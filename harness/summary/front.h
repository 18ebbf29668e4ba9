/* Speed at equal error: the fronts of time against error of a run's scenarios. A family is the
   configurations of one method that differ in n only, on the same frames of one machine. Its
   front at an error e is the time that it takes to keep the error at or below e: that of its
   fastest configuration whose error is at most e, or an interpolation, on logarithmic scales,
   between it and the next faster one whose error is larger. Nothing is interpolated from an
   exact configuration: there is none in between. The error is the 99th percentile over the
   frames, in L, but a configuration counts as exact only where its largest error does. The time
   is the median total over all frames of all replicates, as in the rows of the summary.
   Families with positions=given are compared with the time of FCL without deformation, others
   with all of FCL's time. */
#ifndef MOTE_HARNESS_FRONT_H
#define MOTE_HARNESS_FRONT_H

#include "harness/base/file.h"
#include "harness/summary/summary.h"

#include <stdio.h>

#define MOTE_FRONT_LEVELS 5
#define MOTE_FRONT_TITLE 256
extern const double mote_front_levels[MOTE_FRONT_LEVELS]; /* rising; the first: exact */

/* A family at one level, against the best of all FCL's configurations at that level. */
typedef struct mote_front_speed {
    double time_ns;           /* MOTE_NONE: no configuration is as accurate */
    double faster;            /* FCL's time / this; MOTE_NONE without FCL in the run */
    mote_confidence interval; /* of faster: how far processes spread (resampled from ten on,
                                 else Student's t), around it, given the configurations that
                                 all processes together say reach the error; MOTE_NONE for the
                                 best FCL itself */
} mote_front_speed;

typedef struct mote_front {
    size_t first;                 /* a row of the family, for its scenario and caches */
    char title[MOTE_FRONT_TITLE]; /* "particle-paper:refine=no" */
    mote_front_speed speed[MOTE_FRONT_LEVELS];
} mote_front;

typedef struct mote_fronts {
    const mote_summary *summary; /* borrowed */
    mote_front *items;           /* in the order of the summary's rows */
    size_t count;
} mote_fronts;

/* Of rows with a distance and comparable times; others are in no family. The caller frees
   them. */
mote_fronts mote_fronts_make(const mote_summary *summary);
void mote_fronts_free(mote_fronts *fronts);

/* The time at which points reach an error of at most `error`; MOTE_NONE when none does. */
double mote_front_time(const double *times, const double *errors, size_t count, double error);

/* Whether a row is a point of a front: it has a time and an error. */
bool mote_front_has(const mote_summary_row *row);

/* The label of a row without its n. */
void mote_front_title(const mote_summary_row *row, char *title, size_t size);

/* A table a block, and the rows on its front (dominance.h). */
void mote_fronts_print(const mote_fronts *fronts, FILE *out);

/* [{"scenario", "fingerprint", "cache", "accounting", "family", "speed": [{"error", "total_ns",
   "faster", "ci_low", "ci_high"}]}] */
json_t *mote_fronts_json(const mote_fronts *fronts);

/* Writes directory/fronts.csv, a line a row of the summary, with whether it is on the front and
   else the row that dominates it, and directory/speed.csv, a line a family and level. */
mote_status mote_fronts_write(const mote_fronts *fronts, const char *directory);

#endif
