/* Intervals and tests of means, shares and figures of processes, against closed forms:
   Student's t with one and two degrees of freedom, and sums of binomial terms. */
#include "harness/base/statistics.h"
#include "tests/support/test.h"

#include <gsl/gsl_rng.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <stddef.h>
#include <stdint.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))
#define PI 3.14159265358979323846

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance * fmax(1, fabs(expected))))
        fail_msg("%.17g is not within %g of %.17g", value, tolerance, expected);
}

/* The value that Student's t exceeds with this probability, for one and two degrees of
   freedom. */
static double t_one(double above)
{
    return tan(PI * (0.5 - above));
}

static double t_two(double above)
{
    return (1 - 2 * above) / sqrt(2 * above * (1 - above));
}

/* Two-sided p of a t with one degree of freedom, and with two. */
static double p_one(double t)
{
    return 1 - 2 / PI * atan(t);
}

static double p_two(double t)
{
    return 1 - t / sqrt(2 + t * t);
}

/* P(at least k of n), each with probability p. */
static double at_least(size_t k, size_t n, double p)
{
    double sum = 0;
    for (size_t i = k; i <= n; ++i)
        sum += exp(lgamma((double)n + 1) - lgamma((double)i + 1) - lgamma((double)(n - i) + 1) +
                   (double)i * log(p) + (double)(n - i) * log1p(-p));
    return sum;
}

TEST(mean_of_three_values_is_a_third_of_their_sum)
{
    const double values[] = {1, 2, 6};
    assert_near(mote_statistics_mean(values, 3), 3, 1e-15);
    assert_true(isnan(mote_statistics_mean(values, 0)));
}

TEST(t_interval_of_two_and_three_values_is_the_closed_form)
{
    const double values[] = {1, 2, 6};
    mote_confidence two = mote_statistics_t_interval(values, 2);
    assert_near(two.low, 1.5 - t_one(0.025) * 0.5, 1e-9);
    assert_near(two.high, 1.5 + t_one(0.025) * 0.5, 1e-9);
    mote_confidence three = mote_statistics_t_interval(values, 3);
    assert_near(three.low, 3 - t_two(0.025) * sqrt(7.0 / 3), 1e-9);
    assert_near(three.high, 3 + t_two(0.025) * sqrt(7.0 / 3), 1e-9);
}

TEST(share_interval_leaves_a_fortieth_on_each_side)
{
    static const size_t of[][2] = {{1, 2},   {5, 10},  {1, 40},   {39, 40},
                                   {2, 260}, {4, 358}, {30, 1000}};
    for (size_t i = 0; i < COUNT(of); ++i) {
        const size_t k = of[i][0], n = of[i][1];
        mote_confidence interval = mote_statistics_share_interval((double)k, (double)n);
        assert_near(at_least(k, n, interval.low), 0.025, 1e-9);
        assert_near(1 - at_least(k + 1, n, interval.high), 0.025, 1e-9);
    }
}

TEST(share_interval_of_none_and_all_ends_at_0_and_1)
{
    mote_confidence none = mote_statistics_share_interval(0, 10);
    assert_near(none.low, 0, 0);
    assert_near(none.high, 1 - pow(0.025, 0.1), 1e-9);
    mote_confidence all = mote_statistics_share_interval(10, 10);
    assert_near(all.low, pow(0.025, 0.1), 1e-9);
    assert_near(all.high, 1, 0);
    mote_confidence untried = mote_statistics_share_interval(0, 0);
    assert_true(isnan(untried.low) && isnan(untried.high));
}

/* Half a success has an interval between those of none and of one. */
TEST(share_interval_of_parts_lies_between_those_of_wholes)
{
    const mote_confidence none = mote_statistics_share_interval(0, 32);
    const mote_confidence half = mote_statistics_share_interval(0.5, 32);
    const mote_confidence one = mote_statistics_share_interval(1, 32);
    assert_true(none.low < half.low && half.low < one.low);
    assert_true(none.high < half.high && half.high < one.high);
}

TEST(t_test_of_two_and_three_values_is_the_closed_form)
{
    const double values[] = {1, 2, 6}, below[] = {-1, -2, -6};
    assert_near(mote_statistics_t_test(values, 2), p_one(3), 1e-9);
    assert_near(mote_statistics_t_test(values, 3), p_two(3 / sqrt(7.0 / 3)), 1e-9);
    assert_near(mote_statistics_t_test(below, 3), p_two(3 / sqrt(7.0 / 3)), 1e-9);
    assert_true(isnan(mote_statistics_t_test(values, 1)));
}

TEST(t_test_of_equal_values_is_certain)
{
    const double zero[] = {0, 0}, above[] = {0.5, 0.5}, below[] = {-0.5, -0.5};
    assert_near(mote_statistics_t_test(zero, 2), 1, 0);
    assert_near(mote_statistics_t_test(above, 2), 0, 0);
    assert_near(mote_statistics_t_test(below, 2), 0, 0);
}

TEST(welch_of_equal_variances_is_students_test)
{
    /* Two values on each side, variances 2: two degrees of freedom, a standard error of
       sqrt 2. */
    const double a[] = {1, 3}, b[] = {6, 8};
    mote_difference d = mote_statistics_welch(a, 2, b, 2);
    assert_near(d.value, 5, 1e-15);
    assert_near(d.p, p_two(5 / sqrt(2)), 1e-9);
    assert_near(d.interval.low, 5 - t_two(0.025) * sqrt(2), 1e-9);
    assert_near(d.interval.high, 5 + t_two(0.025) * sqrt(2), 1e-9);
    mote_difference back = mote_statistics_welch(b, 2, a, 2);
    assert_near(back.value, -5, 1e-15);
    assert_near(back.p, d.p, 1e-15);
    const double small_a[] = {0.1, 0.3}, small_b[] = {0.6, 0.8};
    assert_near(mote_statistics_welch(small_a, 2, small_b, 2).p, d.p, 1e-9);
}

TEST(welch_of_one_constant_side_has_the_freedom_of_the_other)
{
    /* Equal values add no variance: three values leave two degrees of freedom; standard error
       sqrt 7/3. */
    const double constant[] = {1, 1, 1, 1, 1}, values[] = {1, 2, 6};
    mote_difference d = mote_statistics_welch(constant, 5, values, 3);
    assert_near(d.value, 2, 1e-15);
    assert_near(d.p, p_two(2 / sqrt(7.0 / 3)), 1e-9);
    mote_difference back = mote_statistics_welch(values, 3, constant, 5);
    assert_near(back.p, d.p, 1e-12);
}

TEST(welch_without_spread_is_certain)
{
    const double one[] = {1, 1}, two[] = {2, 2};
    mote_difference same = mote_statistics_welch(one, 2, one, 2);
    mote_difference up = mote_statistics_welch(one, 2, two, 2);
    mote_difference down = mote_statistics_welch(two, 2, one, 2);
    assert_near(same.p, 1, 0);
    assert_near(up.p, 0, 0);
    assert_near(down.p, 0, 0);
    assert_near(up.interval.low, 1, 0);
    assert_near(up.interval.high, 1, 0);
    assert_near(down.interval.low, -1, 0);
}

TEST(welch_of_too_few_values_says_what_it_can)
{
    const double a[] = {1, 2}, b[] = {5, 7};
    assert_true(isnan(mote_statistics_welch(a, 0, b, 2).value));
    assert_true(isnan(mote_statistics_welch(a, 2, b, 0).value));
    mote_difference left = mote_statistics_welch(a, 1, b, 2);
    mote_difference right = mote_statistics_welch(a, 2, b, 1);
    assert_near(left.value, 5, 1e-15);
    assert_near(right.value, 3.5, 1e-15);
    assert_true(isnan(left.p) && isnan(left.interval.low) && isnan(left.interval.high));
    assert_true(isnan(right.p) && isnan(right.interval.low) && isnan(right.interval.high));
}

enum { PROCESSES = 12, FRAMES = 9, MANY = 20 };

/* values[r][k] = process[r], times odd in odd frames. */
static void fill(const double *process, size_t count, double odd, double values[][FRAMES],
                 mote_replicate *replicates)
{
    for (size_t r = 0; r < count; ++r) {
        for (size_t k = 0; k < FRAMES; ++k)
            values[r][k] = process[r] * (k % 2 ? odd : 1);
        replicates[r] = (mote_replicate){values[r], FRAMES};
    }
}

TEST(median_interval_of_two_processes_is_t_with_one_degree)
{
    const double a[] = {3, 1, 2}, b[] = {7, 6, 9};
    const mote_replicate replicates[] = {{a, 3}, {b, 3}};
    mote_confidence interval = mote_statistics_median_interval(replicates, 2, false, 1);
    assert_near(interval.low, 4.5 - t_one(0.025) * 2.5, 1e-9);
    assert_near(interval.high, 4.5 + t_one(0.025) * 2.5, 1e-9);
    interval = mote_statistics_median_interval(replicates, 2, true, 1);
    const double half = t_one(0.025) * log(3.5) / 2;
    assert_near(log(interval.low), log(14) / 2 - half, 1e-9);
    assert_near(log(interval.high), log(14) / 2 + half, 1e-9);
    interval = mote_statistics_median_interval(replicates, 1, true, 1);
    assert_true(isnan(interval.low) && isnan(interval.high));
}

TEST(median_interval_where_frames_are_missing_is_t_of_medians)
{
    double process[PROCESSES], values[PROCESSES][FRAMES];
    mote_replicate replicates[PROCESSES];
    for (size_t r = 0; r < PROCESSES; ++r)
        process[r] = (double)(r * r + 5);
    fill(process, PROCESSES, 2, values, replicates);
    /* Frames 1, 2, 1, ..., 1 times the process: the median is the process's own value. */
    const mote_confidence expected = mote_statistics_t_interval(process, PROCESSES);
    for (size_t missing = 0; missing < PROCESSES; ++missing) {
        mote_confidence interval;
        replicates[missing].count = FRAMES - 2;
        interval = mote_statistics_median_interval(replicates, PROCESSES, false, 1);
        assert_near(interval.low, expected.low, 1e-12);
        assert_near(interval.high, expected.high, 1e-12);
        replicates[missing].count = FRAMES;
    }
}

TEST(median_interval_where_a_process_has_no_frame_is_none)
{
    const double values[] = {1, 2, 3};
    for (size_t empty = 0; empty < 3; ++empty) {
        mote_replicate replicates[] = {{values, 3}, {values, 3}, {values, 3}};
        mote_confidence interval;
        replicates[empty].count = 0;
        interval = mote_statistics_median_interval(replicates, 3, false, 1);
        assert_true(isnan(interval.low) && isnan(interval.high));
    }
}

/* A third of the processes takes four times as long. Of twelve drawn, more than half are slow
   with a probability of 6.6 %, fewer than half with 82 %. So the interval's ends are the two
   levels. */
TEST(median_interval_of_two_sorts_of_processes_spans_both)
{
    for (int logarithmic = 0; logarithmic < 2; ++logarithmic) {
        double process[PROCESSES], values[PROCESSES][FRAMES];
        mote_replicate replicates[PROCESSES];
        mote_confidence interval;
        for (size_t r = 0; r < PROCESSES; ++r)
            process[r] = r % 3 ? 100 : 400;
        fill(process, PROCESSES, 1, values, replicates);
        interval = mote_statistics_median_interval(replicates, PROCESSES, logarithmic == 1, 3);
        assert_near(interval.low, 100, 1e-12);
        assert_near(interval.high, 400, 1e-12);
    }
}

/* Of twenty drawn from 1 .. 20, eleven are at most 6 with a probability of 1.7 %, ten with
   4.8 %. */
TEST(median_interval_of_twenty_processes_cuts_a_fortieth)
{
    for (int logarithmic = 0; logarithmic < 2; ++logarithmic) {
        double process[MANY], values[MANY][FRAMES];
        mote_replicate replicates[MANY];
        mote_confidence interval, other;
        for (size_t r = 0; r < MANY; ++r)
            process[r] = (double)r + 1;
        fill(process, MANY, 1, values, replicates);
        interval = mote_statistics_median_interval(replicates, MANY, logarithmic == 1, 5);
        assert_true(interval.low > 5.4 && interval.low < 7.1);
        assert_true(interval.high > 13.9 && interval.high < 15.6);
        other = mote_statistics_median_interval(replicates, MANY, logarithmic == 1, 6);
        assert_true(other.low > 5.4 && other.low < 7.1);
    }
}

/* Frames differ by a known profile only and processes not at all, so the interval has no
   width. */
TEST(median_interval_of_processes_alike_is_a_point)
{
    for (int logarithmic = 0; logarithmic < 2; ++logarithmic) {
        double process[PROCESSES], values[PROCESSES][FRAMES];
        mote_replicate replicates[PROCESSES];
        mote_confidence interval;
        for (size_t r = 0; r < PROCESSES; ++r)
            process[r] = 3;
        fill(process, PROCESSES, 2, values, replicates);
        interval = mote_statistics_median_interval(replicates, PROCESSES, logarithmic == 1, 3);
        assert_near(interval.low, 3, 1e-12); /* 3 and 6: five of nine frames are 3 */
        assert_near(interval.high, 3, 1e-12);
    }
}

/* The same resampling without any haste: every block frame by frame, every median of all
   values. */
static mote_confidence slow_interval(const mote_replicate *replicates, size_t count,
                                     bool logarithmic, unsigned long seed)
{
    enum { RESAMPLES = 1000, MOST = 4000 };
    static double profile[MOST], drawn[MOST], medians[RESAMPLES];
    const size_t frames = replicates[0].count, block = (size_t)ceil(sqrt((double)frames));
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(random, seed);
    for (size_t k = 0; k < frames; ++k) {
        for (size_t r = 0; r < count; ++r)
            drawn[r] = replicates[r].values[k];
        profile[k] = gsl_stats_median(drawn, 1, count);
    }
    for (size_t i = 0; i < RESAMPLES; ++i) {
        for (size_t r = 0; r < count; ++r) {
            const double *from = replicates[gsl_rng_uniform_int(random, count)].values;
            size_t start = 0;
            for (size_t k = 0; k < frames; ++k) {
                if (k % block == 0)
                    start = gsl_rng_uniform_int(random, frames);
                const size_t at = (start + k % block) % frames;
                drawn[r * frames + k] = logarithmic ? profile[k] * (from[at] / profile[at])
                                                    : profile[k] + (from[at] - profile[at]);
            }
        }
        medians[i] = gsl_stats_median(drawn, 1, count * frames);
    }
    gsl_rng_free(random);
    gsl_sort(medians, 1, RESAMPLES);
    const mote_confidence interval = {
        gsl_stats_quantile_from_sorted_data(medians, 1, RESAMPLES, 0.025),
        gsl_stats_quantile_from_sorted_data(medians, 1, RESAMPLES, 0.975)};
    return interval;
}

/* Values without ties, with many, of two far levels, and of one level only; odd and even
   numbers of them. */
TEST(median_interval_is_that_of_all_values_to_the_last_bit)
{
    enum { LONGEST = 301 };
    static double values[PROCESSES][LONGEST];
    static const size_t lengths[] = {1, 2, 3, 9, 16, 100, LONGEST};
    unsigned state = 1;
    for (size_t test = 0; test < 2 * 2 * 4 * COUNT(lengths); ++test) {
        const size_t frames = lengths[test / 16], count = PROCESSES - test % 3;
        const bool logarithmic = test / 2 % 2;
        mote_replicate replicates[PROCESSES];
        for (size_t r = 0; r < count; ++r) {
            for (size_t k = 0; k < frames; ++k) {
                state = state * 1664525u + 1013904223u;
                const double free = 1 + state / 4294967296.0;
                const double kinds[] = {free, floor(4 * free), free + (state >> 31) * 1000.0,
                                        5};
                values[r][k] = kinds[test / 4 % 4];
            }
            replicates[r] = (mote_replicate){values[r], frames};
        }
        const mote_confidence quick =
            mote_statistics_median_interval(replicates, count, logarithmic, test);
        const mote_confidence slow = slow_interval(replicates, count, logarithmic, test);
        assert_memory_equal(&quick, &slow, sizeof quick);
    }
}

/* A figure for process_interval: the mean of the drawn numbers. */
typedef struct figures {
    const double *of;
    size_t count;
    size_t calls, largest; /* largest: of one call */
} figures;

static double mean_figure(void *context, const size_t *drawn, size_t count)
{
    figures *f = context;
    double sum = 0;
    for (size_t k = 0; k < count; ++k) {
        assert_true(drawn[k] < f->count);
        sum += f->of[drawn[k]];
    }
    ++f->calls;
    f->largest = count > f->largest ? count : f->largest;
    return sum / (double)count;
}

TEST(process_interval_of_few_is_t_on_logarithms)
{
    const double of[] = {10, 100, 1000, -5, MOTE_NONE};
    mote_confidence interval;
    /* 10, 100, 1000: a standard deviation of one decade. Negative ones have no figure. */
    for (size_t processes = 3; processes <= COUNT(of); ++processes) {
        figures f = {.of = of, .count = processes};
        interval = mote_statistics_process_interval(mean_figure, &f, processes, 1);
        assert_near(log10(interval.low), 2 - t_two(0.025) / sqrt(3), 1e-9);
        assert_near(log10(interval.high), 2 + t_two(0.025) / sqrt(3), 1e-9);
        assert_int_equal(f.calls, processes);
        assert_int_equal(f.largest, 1);
    }
    figures one = {.of = &of[2], .count = 3};
    interval = mote_statistics_process_interval(mean_figure, &one, 3, 1);
    assert_true(isnan(interval.low) && isnan(interval.high));
}

TEST(process_interval_takes_figures_below_one_and_leaves_out_zero)
{
    const double of[] = {0.001, 0.01, 0.1, 0};
    figures few = {.of = of, .count = COUNT(of)};
    mote_confidence interval;
    interval = mote_statistics_process_interval(mean_figure, &few, COUNT(of), 1);
    assert_near(log10(interval.low), -2 - t_two(0.025) / sqrt(3), 1e-9);
    assert_near(log10(interval.high), -2 + t_two(0.025) / sqrt(3), 1e-9);
    double shares[MANY], zeros[MANY] = {0};
    for (size_t k = 0; k < MANY; ++k)
        shares[k] = (double)(k + 1) / MANY;
    figures many = {.of = shares, .count = MANY}, none = {.of = zeros, .count = MANY};
    interval = mote_statistics_process_interval(mean_figure, &many, MANY, 4);
    const double half = 1.959964 * sqrt(399.0 / 12 / 20) / MANY;
    assert_near(interval.low, 0.525 - half, 0.02);
    assert_near(interval.high, 0.525 + half, 0.02);
    interval = mote_statistics_process_interval(mean_figure, &none, MANY, 4);
    assert_true(isnan(interval.low) && isnan(interval.high));
}

TEST(half_width_is_the_wider_side_as_a_share_of_the_median)
{
    const mote_confidence above = {8, 13}, below = {5, 11}, none = {MOTE_NONE, MOTE_NONE};
    assert_near(mote_statistics_half_width(10, above), 0.3, 1e-15);
    assert_near(mote_statistics_half_width(10, below), 0.5, 1e-15);
    assert_true(isinf(mote_statistics_half_width(10, none)));
}

TEST(process_interval_of_many_is_that_of_the_mean)
{
    double of[MANY];
    for (size_t k = 0; k < MANY; ++k)
        of[k] = (double)(k + 1);
    figures f = {.of = of, .count = MANY};
    mote_confidence interval, again, other;
    interval = mote_statistics_process_interval(mean_figure, &f, MANY, 4);
    assert_int_equal(f.calls, 1000);
    assert_int_equal(f.largest, MANY);
    /* The mean of 20 drawn from 1 .. 20: a standard deviation of sqrt(399 / 12 / 20). */
    const double half = 1.959964 * sqrt(399.0 / 12 / 20);
    assert_near(interval.low, 10.5 - half, 0.04);
    assert_near(interval.high, 10.5 + half, 0.04);
    again = mote_statistics_process_interval(mean_figure, &f, MANY, 4);
    other = mote_statistics_process_interval(mean_figure, &f, MANY, 5);
    assert_memory_equal(&interval, &again, sizeof interval);
    assert_true(other.low != interval.low || other.high != interval.high);
}

/* From ten processes on: the bootstrap. If no draw has a figure, there is no interval. */
TEST(process_interval_from_ten_on_is_a_bootstrap)
{
    double of[MOTE_BOOTSTRAP_REPLICATES];
    mote_confidence interval;
    for (size_t k = 0; k < COUNT(of); ++k)
        of[k] = (double)(k + 1);
    figures nine = {.of = of, .count = COUNT(of) - 1}, ten = {.of = of, .count = COUNT(of)};
    interval = mote_statistics_process_interval(mean_figure, &nine, 9, 1);
    assert_int_equal(nine.calls, 9);
    interval = mote_statistics_process_interval(mean_figure, &ten, 10, 1);
    assert_int_equal(ten.calls, 1000);
    /* The variance of the mean of ten drawn from 1 .. 10 is 8.25 / 10. */
    assert_near(interval.low, 5.5 - 1.96 * sqrt(0.825), 0.05);
    assert_near(interval.high, 5.5 + 1.96 * sqrt(0.825), 0.05);
    for (size_t k = 0; k < COUNT(of); ++k)
        of[k] = -1;
    interval = mote_statistics_process_interval(mean_figure, &ten, 10, 1);
    assert_true(isnan(interval.low) && isnan(interval.high));
}

/* A figure that the first `count` draws have. */
static double rare_figure(void *context, const size_t *drawn, size_t count)
{
    figures *f = context;
    (void)drawn;
    (void)count;
    return ++f->calls <= f->count ? (double)f->calls : MOTE_NONE;
}

TEST(process_interval_needs_a_figure_from_half_of_the_draws)
{
    static const size_t known[] = {1, 2, 499, 500, 1000};
    for (size_t i = 0; i < COUNT(known); ++i) {
        figures f = {.count = known[i]};
        const mote_confidence interval =
            mote_statistics_process_interval(rare_figure, &f, MOTE_BOOTSTRAP_REPLICATES, 1);
        assert_true(isnan(interval.low) == (known[i] < 500));
        assert_true(isnan(interval.high) == (known[i] < 500));
    }
}

TEST(detectable_of_two_and_three_values_is_the_closed_form)
{
    const double logs[] = {0.1, 0.2, 0.6};
    const double sd = 0.1 / sqrt(2), sd_three = sqrt(0.07);
    assert_near(mote_statistics_detectable(logs, 2, 1), exp((t_one(0.0125) + t_one(0.2)) * sd),
                1e-9);
    assert_near(mote_statistics_detectable(logs, 3, 1),
                exp((t_two(0.0125) + t_two(0.2)) * sd_three * sqrt(2.0 / 3)), 1e-9);
    assert_near(mote_statistics_detectable(logs, 3, 5),
                exp((t_two(0.0025) + t_two(0.2)) * sd_three * sqrt(2.0 / 3)), 1e-9);
    assert_true(isnan(mote_statistics_detectable(logs, 1, 1)));
    assert_true(isnan(mote_statistics_detectable(logs, 3, 0)));
}

/* The exponent of x^e, and its interval for data without noise. */
static void check_power(const double *x, size_t count, double e)
{
    double y[16], exponent;
    mote_confidence interval;
    for (size_t i = 0; i < count; ++i)
        y[i] = 7 * pow(x[i], e) * (1 + 1e-6 * (double)(i % 3));
    assert_int_equal(mote_statistics_exponent(x, y, count, &exponent, &interval), MOTE_OK);
    assert_near(exponent, e, 1e-4);
    assert_near(interval.low, e, 1e-4);
    assert_near(interval.high, e, 1e-4);
    assert_true(interval.low < exponent && exponent < interval.high);
}

TEST(exponent_of_exact_powers_is_the_power)
{
    const double up[] = {1, 2, 4, 8, 16, 32}, down[] = {9, 8, 7, 5, 3}, one[] = {3, 3, 3, 3, 4};
    const double second[] = {3, 4, 3, 3, 3}, first[] = {4, 3, 3, 3, 3};
    check_power(up, 6, 0.25);
    check_power(up, 5, -1);
    check_power(down, 5, 2);
    check_power(one, 5, 1);
    check_power(second, 5, 1);
    check_power(first, 5, 1);
    const double same[] = {3, 3, 3, 3}, y[] = {1, 2, 3, 4};
    double exponent;
    mote_confidence interval;
    assert_int_equal(mote_statistics_exponent(same, y, 4, &exponent, &interval), MOTE_OK);
    assert_true(isnan(exponent) && isnan(interval.low) && isnan(interval.high));
}

/* Half of the values lie above, half below, all equally far: there are no outliers, and robust
   weights change the interval of least squares by a few percent only. */
TEST(exponent_interval_without_outliers_is_that_of_least_squares)
{
    enum { POINTS = 5 };
    static const double off[POINTS] = {1, -2, 2, -2, 1}; /* sum 0, and orthogonal to x */
    double x[POINTS], y[POINTS], exponent;
    for (size_t i = 0; i < POINTS; ++i) {
        x[i] = exp((double)i);
        y[i] = exp(2 * (double)i + 0.01 * off[i]);
    }
    mote_confidence interval;
    assert_int_equal(mote_statistics_exponent(x, y, POINTS, &exponent, &interval), MOTE_OK);
    assert_near(exponent, 2, 2e-3);
    /* t(0.975, 3) = 3.182446, residuals 14e-4 over 3 degrees, sum of (x - mean)^2 = 10. */
    const double half = 3.182446 * sqrt(14e-4 / 3 / 10);
    assert_near((interval.high - interval.low) / 2 / half, 1, 0.25);
}

/* Weights alternate between two fits for ever: least squares decides. */
TEST(exponent_of_weights_that_do_not_settle_is_that_of_least_squares)
{
    static const double x[] = {1e3, 1e4, 1e5, 1e6}, y[] = {16, 9, 9, 16};
    double exponent = 1;
    mote_confidence interval = {1, 1};
    assert_int_equal(mote_statistics_exponent(x, y, 4, &exponent, &interval), MOTE_OK);
    assert_near(exponent, 0, 1e-12);
    /* t(0.975, 2) = 4.302653; each residual is half of log(16 / 9); over 2 degrees, and the sum
       of (log x - mean)^2 is 5 log(10)^2. */
    const double half = 4.302653 * sqrt(4 * pow(log(16. / 9) / 2, 2) / 2 / 5) / log(10);
    assert_near(interval.high, half, 1e-6);
    assert_near(interval.low, -half, 1e-6);
}

static mote_verdict verdict(double ratio, double low, double high, double p)
{
    mote_confidence interval = {low, high};
    return mote_statistics_verdict(ratio, interval, p, 0.25); /* 0.8 .. 1.25 */
}

TEST(verdict_on_a_border_is_no_change)
{
    assert_int_equal(verdict(1.25, 1.1, 1.4, 0.001), MOTE_VERDICT_UNDECIDED);
    assert_int_equal(verdict(1.26, 1.1, 1.4, 0.001), MOTE_VERDICT_SLOWER);
    assert_int_equal(verdict(1.26, 1.0, 1.4, 0.001), MOTE_VERDICT_UNDECIDED);
    assert_int_equal(verdict(0.80, 0.7, 0.9, 0.001), MOTE_VERDICT_UNDECIDED);
    assert_int_equal(verdict(0.79, 0.7, 0.9, 0.001), MOTE_VERDICT_FASTER);
    assert_int_equal(verdict(0.79, 0.7, 1.0, 0.001), MOTE_VERDICT_UNDECIDED);
    assert_int_equal(verdict(0.79, 0.7, 0.9, MOTE_SIGNIFICANT), MOTE_VERDICT_UNDECIDED);
    assert_int_equal(verdict(1.26, 1.1, 1.4, MOTE_SIGNIFICANT), MOTE_VERDICT_UNDECIDED);
    assert_int_equal(verdict(1, 0.8, 1.25, 0.5), MOTE_VERDICT_SAME);
    assert_int_equal(verdict(1, 0.79, 1.25, 0.5), MOTE_VERDICT_UNDECIDED);
    assert_int_equal(verdict(1, 0.8, 1.26, 0.5), MOTE_VERDICT_UNDECIDED);
}
