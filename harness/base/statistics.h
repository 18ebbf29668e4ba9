/* Statistics of the experiments; statistics.c is the only file that uses GSL's. All arrays are
   borrowed and left unchanged unless said otherwise; all values are finite. A result that does
   not exist (no values, one replicate) is MOTE_NONE. */
#ifndef MOTE_HARNESS_STATISTICS_H
#define MOTE_HARNESS_STATISTICS_H

#include "core/base/status.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A value that does not exist: NaN. */
#define MOTE_NONE ((double)NAN)

/* A two-sided 95 % interval; both MOTE_NONE if there are too few values. */
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

/* Clopper and Pearson's exact interval of a proportion: successes in independent trials.
   MOTE_NONE without a trial. A trial may succeed in part, as a group of events does whose
   outcomes depend on each other: successes is then the sum of the parts, and the interval is
   wider than needed by the less the events depend on each other (simulated in
   tests/studies/interval_coverage.c). */
mote_confidence mote_statistics_share_interval(double successes, double trials);

/* Two-sided p of Student's t test that the mean is 0; MOTE_NONE below two values. */
double mote_statistics_t_test(const double *values, size_t count);

/* One process's frames. */
typedef struct mote_replicate {
    const double *values;
    size_t count;
} mote_replicate;

/* The bootstrap is used from this many replicates on, the t interval below it: the bootstrap
   over few replicates is too narrow. */
#define MOTE_BOOTSTRAP_REPLICATES 10

/* Interval of the median over all frames, for processes that ran the same frames. values are
   positive if logarithmic. Below MOTE_BOOTSTRAP_REPLICATES, or where frames are missing: t
   interval of the process medians (of their logarithms if logarithmic). Otherwise: percentiles
   of 1,000 hierarchical resamples, replicates first, then blocks of frames, drawn from seed.
   The frames are not a sample, so what is resampled is each process's deviation from the median
   over processes at each frame. */
mote_confidence mote_statistics_median_interval(const mote_replicate *replicates, size_t count,
                                                bool logarithmic, uint64_t seed);

/* The half width of a median's interval on its wider side, as a share of the median; infinite
   if there is no interval. */
double mote_statistics_half_width(double median, mote_confidence interval);

/* A positive figure computed from some processes: drawn[count], numbered from 0; a process may
   be drawn more than once. MOTE_NONE if they do not give one. */
typedef double (*mote_process_figure)(void *context, const size_t *drawn, size_t count);

/* Interval of a figure of processes. Below MOTE_BOOTSTRAP_REPLICATES processes: the t interval
   of the logarithms of each process's own figure; otherwise: percentiles of 1,000 resamples of
   the processes, drawn from seed. MOTE_NONE if fewer than two processes, or than half of the
   resamples, give a figure. */
mote_confidence mote_statistics_process_interval(mote_process_figure figure, void *context,
                                                 size_t processes, uint64_t seed);

/* Corrects the p-values of one table by Holm's method, in place; MOTE_NONE stays and does not
   count. work holds count doubles. */
void mote_statistics_holm(double *p, size_t count, double *work);

/* The difference of two means by Welch's unequal-variances t-test. With fewer than two values
   on a side, interval and p are MOTE_NONE. */
typedef struct mote_difference {
    double value; /* mean of b minus mean of a */
    mote_confidence interval;
    double p; /* two-sided, for no difference */
} mote_difference;
mote_difference mote_statistics_welch(const double *a, size_t a_count, const double *b,
                                      size_t b_count);

/* The exponent e of y ~ x^e, by robust (bisquare) regression of the logarithms, with its 95 %
   interval; by least squares if the weights do not converge. x, y > 0. MOTE_NONE for fewer than
   four points or for a single x. MOTE_ENUMERIC. */
mote_status mote_statistics_exponent(const double *x, const double *y, size_t count,
                                     double *exponent, mote_confidence *interval);

/* A difference counts as a change if its p is below this: half of the usual 0.05, so comparing
   a method with itself reports faster or slower in clearly fewer than 5 % of comparisons. */
#define MOTE_SIGNIFICANT 0.025

/* The smallest ratio of times that a comparison detects with a power of 80 %, if both sides
   vary like logs (one side's processes, or groups of them) and it is one of `comparisons`
   comparisons: from Student's t at MOTE_SIGNIFICANT / comparisons. MOTE_NONE below two
   values. */
double mote_statistics_detectable(const double *logs, size_t count, size_t comparisons);

/* The verdict on a ratio of times new / old, given its interval, its p (corrected if it is one
   of many) and the smallest effect that counts (floor: 0.02 for 2 %). */
typedef enum mote_verdict {
    MOTE_VERDICT_SAME,     /* the interval lies within 1 / (1 + floor) .. 1 + floor */
    MOTE_VERDICT_FASTER,   /* significant, the interval below 1, the ratio below 1 / (1 + floor)
                            */
    MOTE_VERDICT_SLOWER,   /* the same above 1 */
    MOTE_VERDICT_UNDECIDED /* anything else, or no interval */
} mote_verdict;
extern const char *const mote_verdict_names[]; /* "same", "faster", "slower", "undecided" */
mote_verdict mote_statistics_verdict(double ratio, mote_confidence interval, double p,
                                     double floor);

#endif
