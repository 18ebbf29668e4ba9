/* The statistics of races. Two programs' times of the same frames, measured in turn, are
   compared; the sampling unit is a pair of processes, since all frames of a process share its
   layout. */
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

/* The median of the means of all pairs of values (Hodges and Lehmann), for values distributed
   symmetrically about the parameter. MOTE_NONE without values. count <= MOTE_PAIRED_MAX. */
#define MOTE_PAIRED_MAX 100
double mote_paired_centre(const double *values, size_t count);

/* Wilcoxon's signed rank interval of the same parameter: it misses with a probability of at
   most alpha, exactly, for any distribution, if the values are independent and symmetric. This
   holds for the logarithms of ratios of two equally fast builds measured in random order, since
   they are exchangeable. MOTE_NONE if there are too few values for alpha. */
mote_confidence mote_paired_interval(const double *values, size_t count, double alpha);

/* The smallest number of values for which there is an interval; alpha in (0, 1). */
size_t mote_paired_least(double alpha);

#endif
