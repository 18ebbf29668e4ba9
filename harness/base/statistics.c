#include "harness/base/statistics.h"

#include "harness/base/memory.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>
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

/* The quantile of a beta distribution, by bisection: gsl_cdf_beta_Pinv does not converge for
   some parameters, such as 0.975 of 3 and 258. */
static double beta_quantile(double p, double a, double b)
{
    double low = 0, high = 1, middle = 0.5;
    while (middle > low && middle < high) {
        if (gsl_cdf_beta_P(middle, a, b) < p)
            low = middle;
        else
            high = middle;
        middle = (low + high) / 2;
    }
    return high;
}

mote_confidence mote_statistics_share_interval(double successes, double trials)
{
    mote_confidence interval = {MOTE_NONE, MOTE_NONE};
    const double failures = trials - successes;
    if (!(trials > 0))
        return interval;
    interval.low = successes > 0 ? beta_quantile(0.025, successes, failures + 1) : 0;
    interval.high = failures > 0 ? beta_quantile(0.975, successes + 1, failures) : 1;
    return interval;
}

double mote_statistics_t_test(const double *values, size_t count)
{
    if (count < 2)
        return MOTE_NONE;
    double mean = gsl_stats_mean(values, 1, count);
    double error = gsl_stats_sd_m(values, 1, count, mean) / sqrt((double)count);
    if (!(error > 0))
        return mean < 0 || mean > 0 ? 0 : 1;
    return 2 * gsl_cdf_tdist_Q(fabs(mean) / error, (double)(count - 1));
}

static size_t longest(const mote_replicate *replicates, size_t count)
{
    size_t most = 0;
    for (size_t r = 0; r < count; ++r)
        most = replicates[r].count > most ? replicates[r].count : most;
    return most;
}

/* Medians of the processes; work holds as many values as the longest process. */
static void process_medians(const mote_replicate *replicates, size_t count, bool logarithmic,
                            double *work, double *medians)
{
    for (size_t r = 0; r < count; ++r) {
        memcpy(work, replicates[r].values, replicates[r].count * sizeof *work);
        double median = mote_statistics_median(work, replicates[r].count);
        medians[r] = logarithmic ? log(median) : median;
    }
}

static mote_confidence exponentials(mote_confidence interval)
{
    const mote_confidence grown = {exp(interval.low), exp(interval.high)};
    return grown;
}

static mote_confidence t_of_medians(const mote_replicate *replicates, size_t count,
                                    bool logarithmic)
{
    double *work = mote_allocate(longest(replicates, count) + count, sizeof *work);
    double *medians = work + longest(replicates, count);
    process_medians(replicates, count, logarithmic, work, medians);
    const mote_confidence interval = mote_statistics_t_interval(medians, count);
    free(work);
    return logarithmic ? exponentials(interval) : interval;
}

/* The input of the resampling. All processes ran the same frames, so the frames are not a
   sample; only the residuals of the processes are resampled. */
typedef struct resample {
    size_t count, frames;
    bool logarithmic;
    double *profile;   /* [frames], the median over the processes */
    double *residuals; /* a value divided by (or minus) its frame's profile */
    double *drawn;     /* [count * frames] */
    double *near;      /* [count * frames], those of drawn within the bracket */
    double *medians;   /* [RESAMPLES] */
    double low, high;  /* the bracket, in which medians are to be expected */
} resample;

static void make_resample(const mote_replicate *replicates, size_t count, bool logarithmic,
                          resample *s)
{
    size_t frames = replicates[0].count, all = count * frames;
    s->count = count;
    s->frames = frames;
    s->logarithmic = logarithmic;
    s->profile = mote_allocate(frames + 3 * all + RESAMPLES, sizeof *s->profile);
    s->residuals = s->profile + frames;
    s->drawn = s->residuals + all;
    s->near = s->drawn + all;
    s->medians = s->near + all;
    for (size_t k = 0; k < frames; ++k) {
        for (size_t r = 0; r < count; ++r)
            s->drawn[r] = replicates[r].values[k];
        s->profile[k] = mote_statistics_median(s->drawn, count);
        for (size_t r = 0; r < count; ++r) {
            double value = replicates[r].values[k];
            s->residuals[r * frames + k] =
                logarithmic ? value / s->profile[k] : value - s->profile[k];
        }
    }
}

/* Draws the frames first .. first + count - 1 of a process, from residuals in a row. */
static void draw_frames(const resample *s, size_t first, size_t count,
                        const double *restrict residuals, double *restrict to)
{
    const double *restrict profile = s->profile + first;
    to += first;
    if (s->logarithmic) {
        for (size_t i = 0; i < count; ++i)
            to[i] = profile[i] * residuals[i];
    } else {
        for (size_t i = 0; i < count; ++i)
            to[i] = profile[i] + residuals[i];
    }
}

/* Draws one process: the profile of the frames plus blocks of consecutive residuals (wrapping
   around the end), which preserve the dependence of neighbouring frames. */
static void draw_process(gsl_rng *random, const resample *s, double *to)
{
    const double *from = s->residuals + gsl_rng_uniform_int(random, s->count) * s->frames;
    const size_t block = (size_t)ceil(sqrt((double)s->frames));
    for (size_t k = 0; k < s->frames; k += block) {
        const size_t start = gsl_rng_uniform_int(random, s->frames);
        const size_t wanted = k + block < s->frames ? block : s->frames - k;
        const size_t before_end = wanted < s->frames - start ? wanted : s->frames - start;
        draw_frames(s, k, before_end, from + start, to);
        draw_frames(s, k + before_end, wanted - before_end, from, to);
    }
}

/* Gathers the drawn values within the bracket; returns how many, and how many lie below. */
static size_t gather_near(const resample *s, size_t *below)
{
    const double *restrict drawn = s->drawn;
    double *restrict near = s->near;
    const double low = s->low, high = s->high;
    size_t under = 0, count = 0;
    for (size_t i = 0; i < s->count * s->frames; ++i) {
        const double value = drawn[i];
        near[count] = value;
        under += value < low;
        count += (value >= low) & (value <= high);
    }
    *below = under;
    return count;
}

/* The median of the drawn values. While it lies in the bracket, the values outside are only
   counted; otherwise the bracket grows. */
static double drawn_median(resample *s)
{
    const size_t all = s->count * s->frames;
    size_t below;
    const size_t near = gather_near(s, &below);
    const size_t left = (all - 1) / 2, right = all / 2;
    if (below <= left && right < below + near) {
        const double first = gsl_stats_select(s->near, 1, near, left - below);
        const double last = gsl_stats_select(s->near, 1, near, right - below);
        return (first + last) / 2;
    }
    const double median = mote_statistics_median(s->drawn, all);
    s->low = median < s->low ? median : s->low;
    s->high = median > s->high ? median : s->high;
    return median;
}

/* GSL's errors are returned, except that running out of memory ends the program. */
static void handle_error(const char *reason, const char *file, int line, int code)
{
    (void)reason, (void)file, (void)line;
    if (code == GSL_ENOMEM)
        mote_out_of_memory(0);
}

static gsl_rng *make_generator(uint64_t seed)
{
    (void)gsl_set_error_handler(handle_error);
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(random, seed);
    return random;
}

/* The 2.5 % and 97.5 % quantiles of sorted values. */
static mote_confidence percentiles(const double *sorted, size_t count)
{
    const mote_confidence interval = {mote_statistics_quantile(sorted, count, 0.025),
                                      mote_statistics_quantile(sorted, count, 0.975)};
    return interval;
}

static mote_confidence bootstrap(const mote_replicate *replicates, size_t count,
                                 bool logarithmic, uint64_t seed)
{
    gsl_rng *random = make_generator(seed);
    resample s = {.low = HUGE_VAL, .high = -HUGE_VAL};
    make_resample(replicates, count, logarithmic, &s);
    for (size_t k = 0; k < RESAMPLES; ++k) {
        for (size_t r = 0; r < count; ++r)
            draw_process(random, &s, s.drawn + r * s.frames);
        s.medians[k] = drawn_median(&s);
    }
    mote_statistics_sort(s.medians, RESAMPLES);
    const mote_confidence interval = percentiles(s.medians, RESAMPLES);
    free(s.profile);
    gsl_rng_free(random);
    return interval;
}

mote_confidence mote_statistics_median_interval(const mote_replicate *replicates, size_t count,
                                                bool logarithmic, uint64_t seed)
{
    const mote_confidence none = {MOTE_NONE, MOTE_NONE};
    bool same_frames = true;
    for (size_t r = 0; r < count; ++r) {
        if (replicates[r].count == 0)
            return none;
        same_frames = same_frames && replicates[r].count == replicates[0].count;
    }
    if (count < 2)
        return none;
    if (count < MOTE_BOOTSTRAP_REPLICATES || !same_frames)
        return t_of_medians(replicates, count, logarithmic);
    return bootstrap(replicates, count, logarithmic, seed);
}

/* Computes the figure for each process alone, as logarithms; returns how many there are. */
static size_t single_figures(mote_process_figure figure, void *context, size_t processes,
                             double *logs)
{
    size_t known = 0;
    for (size_t k = 0; k < processes; ++k) {
        double value = figure(context, &k, 1);
        if (value > 0)
            logs[known++] = log(value);
    }
    return known;
}

/* Computes the figure for resampled processes, sorted; returns how many there are. */
static size_t drawn_figures(mote_process_figure figure, void *context, size_t processes,
                            gsl_rng *random, size_t *drawn, double *values)
{
    size_t known = 0;
    for (size_t i = 0; i < RESAMPLES; ++i) {
        for (size_t k = 0; k < processes; ++k)
            drawn[k] = gsl_rng_uniform_int(random, processes);
        double value = figure(context, drawn, processes);
        if (value > 0)
            values[known++] = value;
    }
    mote_statistics_sort(values, known);
    return known;
}

/* The interval from resampled processes; values has room for RESAMPLES. */
static mote_confidence resampled(mote_process_figure figure, void *context, size_t processes,
                                 uint64_t seed, double *values)
{
    gsl_rng *random = make_generator(seed);
    size_t *drawn = mote_allocate(processes, sizeof *drawn);
    const size_t known = drawn_figures(figure, context, processes, random, drawn, values);
    free(drawn);
    gsl_rng_free(random);
    if (known < RESAMPLES / 2)
        return (mote_confidence){MOTE_NONE, MOTE_NONE};
    return percentiles(values, known);
}

mote_confidence mote_statistics_process_interval(mote_process_figure figure, void *context,
                                                 size_t processes, uint64_t seed)
{
    double *values = mote_allocate(RESAMPLES + processes, sizeof *values);
    mote_confidence interval;
    if (processes < MOTE_BOOTSTRAP_REPLICATES)
        interval = exponentials(mote_statistics_t_interval(
            values, single_figures(figure, context, processes, values)));
    else
        interval = resampled(figure, context, processes, seed, values);
    free(values);
    return interval;
}

double mote_statistics_half_width(double median, mote_confidence interval)
{
    const double width = fmax(interval.high - median, median - interval.low) / median;
    return isnan(width) ? HUGE_VAL : width;
}

void mote_statistics_holm(double *p, size_t count, double *work)
{
    size_t known = 0;
    for (size_t i = 0; i < count; ++i) {
        if (p[i] == p[i])
            work[known++] = p[i];
    }
    mote_statistics_sort(work, known);
    for (size_t i = 0; i < count; ++i) {
        double corrected = 0;
        for (size_t k = 0; k < known && work[k] <= p[i]; ++k)
            corrected = fmax(corrected, fmin(1, (double)(known - k) * work[k]));
        p[i] = p[i] == p[i] ? corrected : p[i];
    }
}

mote_difference mote_statistics_welch(const double *a, size_t a_count, const double *b,
                                      size_t b_count)
{
    mote_difference none = {MOTE_NONE, {MOTE_NONE, MOTE_NONE}, MOTE_NONE};
    if (a_count == 0 || b_count == 0)
        return none;
    mote_difference found = none;
    found.value = mote_statistics_mean(b, b_count) - mote_statistics_mean(a, a_count);
    if (a_count < 2 || b_count < 2)
        return found;
    double va = gsl_stats_variance(a, 1, a_count) / (double)a_count;
    double vb = gsl_stats_variance(b, 1, b_count) / (double)b_count;
    double error = sqrt(va + vb);
    if (!(error > 0)) {
        found.interval.low = found.interval.high = found.value;
        found.p = found.value < 0 || found.value > 0 ? 0 : 1;
        return found;
    }
    double freedom = (va + vb) * (va + vb) /
                     (va * va / (double)(a_count - 1) + vb * vb / (double)(b_count - 1));
    double half = gsl_cdf_tdist_Pinv(0.975, freedom) * error;
    found.interval.low = found.value - half;
    found.interval.high = found.value + half;
    found.p = 2 * gsl_cdf_tdist_Q(fabs(found.value) / error, freedom);
    return found;
}

static int fit_least_squares(const gsl_matrix *design, const gsl_vector *values,
                             gsl_vector *fitted, gsl_matrix *covariance)
{
    gsl_multifit_linear_workspace *work =
        gsl_multifit_linear_alloc(design->size1, design->size2);
    double squares;
    const int status = gsl_multifit_linear(design, values, fitted, covariance, &squares, work);
    gsl_multifit_linear_free(work);
    return status;
}

/* Regression of log y on log x with an intercept: bisquare, or least squares where the weights
   of bisquare alternate between fits for ever. */
static int fit_logarithms(const double *x, const double *y, size_t count, double *slope,
                          double *error)
{
    gsl_matrix *design = gsl_matrix_alloc(count, 2);
    gsl_vector *values = gsl_vector_alloc(count), *fitted = gsl_vector_alloc(2);
    gsl_matrix *covariance = gsl_matrix_alloc(2, 2);
    gsl_multifit_robust_workspace *work =
        gsl_multifit_robust_alloc(gsl_multifit_robust_bisquare, count, 2);
    for (size_t i = 0; i < count; ++i) {
        gsl_matrix_set(design, i, 0, 1);
        gsl_matrix_set(design, i, 1, log(x[i]));
        gsl_vector_set(values, i, log(y[i]));
    }
    int status = gsl_multifit_robust(design, values, fitted, covariance, work);
    if (status == GSL_EMAXITER)
        status = fit_least_squares(design, values, fitted, covariance);
    *slope = gsl_vector_get(fitted, 1);
    *error = sqrt(gsl_matrix_get(covariance, 1, 1));
    gsl_multifit_robust_free(work);
    gsl_matrix_free(covariance);
    gsl_vector_free(fitted);
    gsl_vector_free(values);
    gsl_matrix_free(design);
    return status;
}

mote_status mote_statistics_exponent(const double *x, const double *y, size_t count,
                                     double *exponent, mote_confidence *interval)
{
    mote_confidence none = {MOTE_NONE, MOTE_NONE};
    bool spread = false;
    for (size_t i = 1; i < count; ++i)
        spread = spread || x[i] < x[0] || x[i] > x[0];
    *exponent = MOTE_NONE;
    *interval = none;
    if (count < 4 || !spread)
        return MOTE_OK;
    (void)gsl_set_error_handler(handle_error);
    double slope = 0, error = 0;
    int status = fit_logarithms(x, y, count, &slope, &error);
    if (status != GSL_SUCCESS)
        return mote_fail(MOTE_ENUMERIC, "no exponent: %s", gsl_strerror(status));
    double half = gsl_cdf_tdist_Pinv(0.975, (double)(count - 2)) * error;
    *exponent = slope;
    interval->low = slope - half;
    interval->high = slope + half;
    return MOTE_OK;
}

double mote_statistics_detectable(const double *logs, size_t count, size_t comparisons)
{
    if (count < 2 || comparisons == 0)
        return MOTE_NONE;
    double freedom = (double)count - 1;
    double error = gsl_stats_sd(logs, 1, count) * sqrt(2 / (double)count);
    double needed = gsl_cdf_tdist_Qinv(MOTE_SIGNIFICANT / 2 / (double)comparisons, freedom) +
                    gsl_cdf_tdist_Qinv(0.2, freedom);
    return exp(needed * error);
}

const char *const mote_verdict_names[] = {"same", "faster", "slower", "undecided"};

mote_verdict mote_statistics_verdict(double ratio, mote_confidence interval, double p,
                                     double floor)
{
    double most = 1 + floor, least = 1 / most;
    bool significant = p < MOTE_SIGNIFICANT;
    if (significant && interval.low > 1 && ratio > most)
        return MOTE_VERDICT_SLOWER;
    if (significant && interval.high < 1 && ratio < least)
        return MOTE_VERDICT_FASTER;
    if (interval.low >= least && interval.high <= most)
        return MOTE_VERDICT_SAME;
    return MOTE_VERDICT_UNDECIDED;
}
