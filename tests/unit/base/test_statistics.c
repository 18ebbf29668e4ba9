#include "harness/base/statistics.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdint.h>

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", value, tolerance, expected);
}

TEST(quantile_of_four_values_is_linear_between_them)
{
    const double sorted[] = {1, 2, 3, 4};
    assert_near(mote_statistics_quantile(sorted, 4, 0), 1, 0);
    assert_near(mote_statistics_quantile(sorted, 4, 0.25), 1.75, 1e-15);
    assert_near(mote_statistics_quantile(sorted, 4, 0.95), 3.85, 1e-15);
    assert_near(mote_statistics_quantile(sorted, 4, 1), 4, 0);
    assert_true(isnan(mote_statistics_quantile(sorted, 0, 0.5)));
}

TEST(median_of_even_count_is_the_middle_of_two)
{
    double values[] = {9, 1, 5, 3};
    assert_near(mote_statistics_median(values, 4), 4, 0);
    double three[] = {7, 1, 2};
    assert_near(mote_statistics_median(three, 3), 2, 0);
    assert_true(isnan(mote_statistics_median(values, 0)));
}

TEST(t_interval_of_one_to_five_is_the_textbook_one)
{
    /* t(0.975, 4) = 2.776445 (any table), standard deviation sqrt(2.5). */
    const double values[] = {1, 2, 3, 4, 5};
    mote_confidence interval = mote_statistics_t_interval(values, 5);
    double half = 2.7764451051977987 * sqrt(2.5) / sqrt(5);
    assert_near(interval.low, 3 - half, 1e-12);
    assert_near(interval.high, 3 + half, 1e-12);
}

TEST(t_interval_of_one_value_is_none)
{
    const double value = 3;
    mote_confidence interval = mote_statistics_t_interval(&value, 1);
    assert_true(isnan(interval.low) && isnan(interval.high));
}

TEST(median_interval_of_three_processes_is_t_on_logarithms)
{
    const double a[] = {10, 1, 100}, b[] = {100, 5, 5000}, c[] = {1000, 2, 1e6};
    const mote_replicate replicates[] = {{a, 3}, {b, 3}, {c, 3}};
    mote_confidence interval = mote_statistics_median_interval(replicates, 3, true, 1);
    /* Medians 10, 100, 1000: a standard deviation of one decade; t(0.975, 2) = 4.302653. */
    double half = 4.3026527297494637 / sqrt(3);
    assert_near(log10(interval.low), 2 - half, 1e-12);
    assert_near(log10(interval.high), 2 + half, 1e-12);
}

TEST(median_interval_without_frames_is_none)
{
    const double a[] = {1};
    const mote_replicate replicates[] = {{a, 1}, {a, 0}};
    mote_confidence interval = mote_statistics_median_interval(replicates, 2, true, 1);
    assert_true(isnan(interval.low) && isnan(interval.high));
}

enum { REPLICATES = 12, FRAMES = 101 };

static void fill(double values[REPLICATES][FRAMES], mote_replicate replicates[REPLICATES])
{
    for (int r = 0; r < REPLICATES; ++r) {
        for (int k = 0; k < FRAMES; ++k)
            values[r][k] = 100 + r + (k * 37 % FRAMES) * 0.01;
        replicates[r].values = values[r];
        replicates[r].count = FRAMES;
    }
}

TEST(median_interval_of_many_processes_encloses_the_median)
{
    double values[REPLICATES][FRAMES];
    mote_replicate replicates[REPLICATES];
    fill(values, replicates);
    mote_confidence interval = mote_statistics_median_interval(replicates, REPLICATES, true, 7);
    /* Process medians are 100.5 .. 111.5: standard error about 1.04. */
    assert_true(interval.low > 100.5 && interval.low < 105.5);
    assert_true(interval.high > 106.5 && interval.high < 111.5);
}

TEST(median_interval_with_one_seed_is_the_same_twice)
{
    double values[REPLICATES][FRAMES];
    mote_replicate replicates[REPLICATES];
    fill(values, replicates);
    mote_confidence first, second;
    first = mote_statistics_median_interval(replicates, REPLICATES, true, 7);
    second = mote_statistics_median_interval(replicates, REPLICATES, true, 7);
    assert_memory_equal(&first, &second, sizeof first);
}
