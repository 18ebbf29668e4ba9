/* The statistics of races. Two programs' times of the same frames, measured in turn, are
   compared. What is measured together shares a layout in memory: all frames of a process that
   of the process, and all processes of a program its link order. So the sampling unit is a pair
   of builds where both sides have several, and else a pair of processes; what is measured of a
   unit again lessens its noise, and adds no value. */
#ifndef MOTE_HARNESS_PAIRED_H
#define MOTE_HARNESS_PAIRED_H

#include "harness/base/statistics.h"

/* Times of one pair of processes: [passes][frames], in ns, all > 0. */
typedef struct mote_bout_times {
    const double *a, *b;
    size_t passes, frames;
} mote_bout_times;

/* How much more time b takes than a: the logarithm of the ratio of their totals over all
   frames. A frame's ratio is the median over passes of its paired logarithms, so interruptions
   of a pass do not count; every frame is weighted by its share of the total. Exchanging a and b
   negates the result exactly. *total_ns (unless NULL): a frame's mean time in a and b. At least
   one pass and one frame. */
double mote_bout_log_ratio(const mote_bout_times *times, double total_ns[2]);

#define MOTE_PAIRED_MAX 100

/* What is measured of each unit. Zero-initialise. */
typedef struct mote_paired_sample {
    double sum[MOTE_PAIRED_MAX]; /* of its logarithms */
    size_t times[MOTE_PAIRED_MAX];
} mote_paired_sample;

/* Adds a logarithm of a unit; unit < MOTE_PAIRED_MAX. */
void mote_paired_add(mote_paired_sample *sample, size_t unit, double log_ratio);

/* The values of the units measured so far: the means of their logarithms. Returns their
   number. */
size_t mote_paired_values(const mote_paired_sample *sample, double values[MOTE_PAIRED_MAX]);

/* The median of the means of all pairs of values (Hodges and Lehmann), for values distributed
   symmetrically about the parameter. MOTE_NONE without values. count <= MOTE_PAIRED_MAX. */
double mote_paired_centre(const double *values, size_t count);

/* Wilcoxon's signed rank interval of the same parameter: it misses with a probability of at
   most alpha, exactly, for any distributions (of each value its own), if the values are
   independent and symmetric. This holds for the values of units of two equally fast sides
   measured in random order, since the sides of a unit are exchangeable. MOTE_NONE if there are
   too few values for alpha. */
mote_confidence mote_paired_interval(const double *values, size_t count, double alpha);

/* The smallest number of values for which there is an interval; alpha in (0, 1). */
size_t mote_paired_least(double alpha);

#endif
