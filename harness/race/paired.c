#include "harness/race/paired.h"

#include "harness/base/memory.h"

#include <assert.h>
#include <stdlib.h>

double mote_bout_log_ratio(const mote_bout_times *times, double total_ns[2])
{
    const size_t frames = times->frames;
    double *level = mote_allocate(times->passes, sizeof *level);
    double *change = mote_allocate(times->passes, sizeof *change);
    double sums[2] = {0, 0};
    for (size_t f = 0; f < frames; ++f) {
        for (size_t p = 0; p < times->passes; ++p) {
            const double a = log(times->a[p * frames + f]), b = log(times->b[p * frames + f]);
            level[p] = 0.5 * (a + b);
            change[p] = b - a;
        }
        const double middle = mote_statistics_median(level, times->passes);
        const double half = 0.5 * mote_statistics_median(change, times->passes);
        sums[0] += exp(middle - half);
        sums[1] += exp(middle + half);
    }
    free(level);
    free(change);
    for (int side = 0; total_ns && side < 2; ++side)
        total_ns[side] = sums[side] / (double)frames;
    return log(sums[1]) - log(sums[0]);
}

void mote_paired_add(mote_paired_sample *sample, size_t unit, double log_ratio)
{
    assert(unit < MOTE_PAIRED_MAX);
    sample->sum[unit] += log_ratio;
    ++sample->times[unit];
}

size_t mote_paired_values(const mote_paired_sample *sample, double values[MOTE_PAIRED_MAX])
{
    size_t count = 0;
    for (size_t unit = 0; unit < MOTE_PAIRED_MAX; ++unit) {
        if (sample->times[unit] > 0)
            values[count++] = sample->sum[unit] / (double)sample->times[unit];
    }
    return count;
}

/* The means of all pairs of values (Walsh averages), including each value with itself, sorted.
   The caller frees them. */
static double *pair_means(const double *values, size_t count, size_t *means)
{
    double *sorted = mote_allocate(count * (count + 1) / 2, sizeof *sorted);
    *means = 0;
    for (size_t i = 0; i < count; ++i) {
        for (size_t j = i; j < count; ++j)
            sorted[(*means)++] = 0.5 * (values[i] + values[j]);
    }
    mote_statistics_sort(sorted, *means);
    return sorted;
}

double mote_paired_centre(const double *values, size_t count)
{
    size_t means;
    if (count == 0)
        return MOTE_NONE;
    double *sorted = pair_means(values, count, &means);
    const double centre = mote_statistics_quantile(sorted, means, 0.5);
    free(sorted);
    return centre;
}

/* How many of the smallest and of the largest means lie outside an interval that misses with
   probability alpha at most: the largest k with P(signed rank sum < k) <= alpha / 2. */
static size_t outside(size_t count, double alpha)
{
    const size_t sums = count * (count + 1) / 2;
    double *share = mote_allocate(sums + 1, sizeof *share);
    size_t largest_sum = 0;
    share[0] = 1;
    for (size_t rank = 1; rank <= count; ++rank) { /* each rank has either sign */
        largest_sum += rank;
        for (size_t s = largest_sum + 1; s-- > 0;)
            share[s] = 0.5 * (share[s] + (s >= rank ? share[s - rank] : 0));
    }
    size_t k = 0;
    for (double below = share[0]; below <= 0.5 * alpha && k < sums; below += share[k])
        ++k;
    free(share);
    return k;
}

mote_confidence mote_paired_interval(const double *values, size_t count, double alpha)
{
    const mote_confidence none = {MOTE_NONE, MOTE_NONE};
    size_t means;
    const size_t k = count > 0 ? outside(count, alpha) : 0;
    if (k == 0)
        return none;
    double *sorted = pair_means(values, count, &means);
    const mote_confidence interval = {sorted[k - 1], sorted[means - k]};
    free(sorted);
    return interval;
}

size_t mote_paired_least(double alpha)
{
    size_t count = 1;
    while (ldexp(1, -(int)count) > 0.5 * alpha) /* the extreme case: all values of one sign */
        ++count;
    return count;
}
