/* Statistics of the experiments; the one file that uses GSL's. All arrays are borrowed and left
   as they were unless said otherwise; all values are finite. A result that cannot be had (no
   values, one replicate) is MOTE_NONE. */
#ifndef MOTE_HARNESS_STATISTICS_H
#define MOTE_HARNESS_STATISTICS_H

#include "core/status.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A figure that cannot be had: a NaN. */
#define MOTE_NONE ((double)NAN)

/* A two-sided 95 % interval; both MOTE_NONE when there are too few values. */
typedef struct mote_confidence {
    double low, high;
} mote_confidence;

/* Sorts in place, ascending. */
void mote_statistics_sort(double *values, size_t count);

/* Quantile of sorted values, linear between order statistics: at index (count - 1) * fraction.
   fraction in [0, 1]. */
double mote_statistics_quantile(const double *sorted, size_t count, double fraction);

/* Median of values, which are reordered. Cost O(count). */
double mote_statistics_median(double *values, size_t count);

double mote_statistics_mean(const double *values, size_t count);

/* Student's t interval of the mean; MOTE_NONE below two values. */
mote_confidence mote_statistics_t_interval(const double *values, size_t count);

/* One process's frames. */
typedef struct mote_replicate {
    const double *values;
    size_t count;
} mote_replicate;

/* From this many replicates on, the bootstrap is used, below it the t interval: the bootstrap
   over few replicates is too narrow. */
#define MOTE_BOOTSTRAP_REPLICATES 10

/* Interval of the median over all frames of processes that ran the same frames. values are
   positive when logarithmic. Below MOTE_BOOTSTRAP_REPLICATES: t interval of the process medians
   (of their logarithms when logarithmic). From there on: percentiles of 1,000 hierarchical
   resamples, replicates first, then blocks of frames, drawn from seed. */
mote_status mote_statistics_median_interval(const mote_replicate *replicates, size_t count,
                                            bool logarithmic, uint64_t seed,
                                            mote_confidence *interval);

#endif
