/* Speed at equal error: the fronts of time against error of a run's scenarios. A family is the
   configurations of one method that differ only in n, on the same frames and machine. Its front
   at an error e is the time needed to keep the error at or below e: that of its fastest
   configuration with an error of at most e, or a log-log interpolation between it and the next
   faster one, whose error is larger. There is no interpolation from an exact configuration,
   because nothing lies in between. The error is the 99th percentile over the frames, in L, but
   a configuration counts as exact only if its largest error does. The time is the median total
   over all frames of all replicates, as in the rows of the summary. Families with
   positions=given are compared with FCL's time without deformation, others with all of FCL's
   time, and so it is with the other engines'. */
#ifndef MOTE_HARNESS_FRONT_H
#define MOTE_HARNESS_FRONT_H

#include "harness/base/file.h"
#include "harness/summary/summary.h"

#include <stdio.h>

#define MOTE_FRONT_LEVELS 5
#define MOTE_FRONT_TITLE 256
extern const double mote_front_levels[MOTE_FRONT_LEVELS]; /* ascending; the first: exact */

/* Whom families are compared with: the best of all configurations of FCL, and that of all
   engines of others without a wrong answer, FCL's among them. */
typedef enum mote_rival { MOTE_RIVAL_FCL, MOTE_RIVAL_ENGINE, MOTE_RIVALS } mote_rival;

/* A family against the best of one kind of rivals at one level. */
typedef struct mote_front_ratio {
    double faster;            /* the rival's time divided by this; MOTE_NONE without one */
    mote_confidence interval; /* of faster: spread of the processes that both have (resampled
                                 from ten on, otherwise Student's t), centred on it, given the
                                 configurations that reach the error over all processes
                                 together; MOTE_NONE for the rival itself, and where they share
                                 fewer than two processes */
    size_t rival;             /* its row, the most accurate one where it lies between two;
                                 SIZE_MAX without one */
} mote_front_ratio;

/* A family at one level. */
typedef struct mote_front_speed {
    double time_ns; /* MOTE_NONE: no configuration is as accurate */
    mote_front_ratio to[MOTE_RIVALS];
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

/* Made from rows with a distance and comparable times; others are in no family. The caller
   frees the result. */
mote_fronts mote_fronts_make(const mote_summary *summary);
void mote_fronts_free(mote_fronts *fronts);

/* The time at which points reach an error of at most `error`; MOTE_NONE if none does. */
double mote_front_time(const double *times, const double *errors, size_t count, double error);

/* Whether a row is a point of a front: has a time and an error. */
bool mote_front_has(const mote_summary_row *row);

/* The label of a row without its n. */
void mote_front_title(const mote_summary_row *row, char *title, size_t size);

/* Prints a table per block, and the rows on its front (dominance.h). */
void mote_fronts_print(const mote_fronts *fronts, FILE *out);

/* [{"scenario", "fingerprint", "faces", "cache", "accounting", "family", "speed": [{"error",
   "total_ns", "faster", "ci_low", "ci_high", "engine", "engine_faster", "engine_ci_low",
   "engine_ci_high"}]}]; the first three against the best FCL. */
json_t *mote_fronts_json(const mote_fronts *fronts);

/* Writes directory/fronts.csv, a line per row of the summary with whether it is on the front or
   which row dominates it, and directory/speed.csv, a line per family and level. */
mote_status mote_fronts_write(const mote_fronts *fronts, const char *directory);

#endif
