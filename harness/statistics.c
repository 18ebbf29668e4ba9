#include "harness/statistics.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RESAMPLES 1000

void mote_statistics_sort(double *values, size_t count)
{
    gsl_sort(values, 1, count);
}

double mote_statistics_quantile(const double *sorted, size_t count, double fraction)
{
    if (count == 0)
        return MOTE_NONE;
    return gsl_stats_quantile_from_sorted_data(sorted, 1, count, fraction);
}

double mote_statistics_median(double *values, size_t count)
{
    if (count == 0)
        return MOTE_NONE;
    return gsl_stats_median(values, 1, count);
}

double mote_statistics_mean(const double *values, size_t count)
{
    if (count == 0)
        return MOTE_NONE;
    return gsl_stats_mean(values, 1, count);
}

mote_confidence mote_statistics_t_interval(const double *values, size_t count)
{
    mote_confidence interval = {MOTE_NONE, MOTE_NONE};
    if (count < 2)
        return interval;
    double mean = gsl_stats_mean(values, 1, count);
    double error = gsl_stats_sd_m(values, 1, count, mean) / sqrt((double)count);
    double half = gsl_cdf_tdist_Pinv(0.975, (double)(count - 1)) * error;
    interval.low = mean - half;
    interval.high = mean + half;
    return interval;
}

static size_t longest(const mote_replicate *replicates, size_t count)
{
    size_t most = 0;
    for (size_t r = 0; r < count; ++r)
        most = replicates[r].count > most ? replicates[r].count : most;
    return most;
}

/* Medians of the processes; work holds as many values as the longest. */
static void process_medians(const mote_replicate *replicates, size_t count, bool logarithmic,
                            double *work, double *medians)
{
    for (size_t r = 0; r < count; ++r) {
        memcpy(work, replicates[r].values, replicates[r].count * sizeof *work);
        double median = mote_statistics_median(work, replicates[r].count);
        medians[r] = logarithmic ? log(median) : median;
    }
}

static mote_status t_of_medians(const mote_replicate *replicates, size_t count,
                                bool logarithmic, mote_confidence *interval)
{
    double *work = malloc((longest(replicates, count) + count + 1) * sizeof *work);
    if (!work)
        return mote_fail(MOTE_ENOMEM, "no memory for an interval");
    double *medians = work + longest(replicates, count);
    process_medians(replicates, count, logarithmic, work, medians);
    *interval = mote_statistics_t_interval(medians, count);
    if (logarithmic) {
        interval->low = exp(interval->low);
        interval->high = exp(interval->high);
    }
    free(work);
    return MOTE_OK;
}

/* Draws as many frames of one process as it has, in blocks of consecutive frames (around the
   end), so that the dependence of neighbouring frames stays in the resample. */
static size_t draw_blocks(gsl_rng *random, const mote_replicate *from, double *to)
{
    size_t block = (size_t)ceil(sqrt((double)from->count));
    for (size_t drawn = 0; drawn < from->count;) {
        size_t start = gsl_rng_uniform_int(random, from->count);
        for (size_t k = 0; k < block && drawn < from->count; ++k)
            to[drawn++] = from->values[(start + k) % from->count];
    }
    return from->count;
}

static mote_status bootstrap(const mote_replicate *replicates, size_t count, uint64_t seed,
                             mote_confidence *interval)
{
    size_t most = longest(replicates, count) * count;
    double *work = malloc((most + RESAMPLES) * sizeof *work);
    (void)gsl_set_error_handler_off(); /* NULL, not the end of the program */
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    if (!work || !random) {
        free(work);
        gsl_rng_free(random);
        return mote_fail(MOTE_ENOMEM, "no memory for a bootstrap of %zu values", most);
    }
    gsl_rng_set(random, seed);
    double *medians = work + most;
    for (size_t k = 0; k < RESAMPLES; ++k) {
        size_t drawn = 0;
        for (size_t r = 0; r < count; ++r)
            drawn += draw_blocks(random, &replicates[gsl_rng_uniform_int(random, count)],
                                 work + drawn);
        medians[k] = mote_statistics_median(work, drawn);
    }
    mote_statistics_sort(medians, RESAMPLES);
    interval->low = mote_statistics_quantile(medians, RESAMPLES, 0.025);
    interval->high = mote_statistics_quantile(medians, RESAMPLES, 0.975);
    free(work);
    gsl_rng_free(random);
    return MOTE_OK;
}

mote_status mote_statistics_median_interval(const mote_replicate *replicates, size_t count,
                                            bool logarithmic, uint64_t seed,
                                            mote_confidence *interval)
{
    mote_confidence none = {MOTE_NONE, MOTE_NONE};
    *interval = none;
    for (size_t r = 0; r < count; ++r) {
        if (replicates[r].count == 0)
            return MOTE_OK;
    }
    if (count < 2)
        return MOTE_OK;
    if (count < MOTE_BOOTSTRAP_REPLICATES)
        return t_of_medians(replicates, count, logarithmic, interval);
    return bootstrap(replicates, count, seed, interval);
}
