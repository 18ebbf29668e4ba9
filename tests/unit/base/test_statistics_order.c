/* Order statistics against the table of the sign test, and Holm's correction. */
#include "harness/base/statistics.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdint.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance * fabs(expected)))
        fail_msg("%.17g is not within %g of %.17g", value, tolerance, expected);
}

TEST(sign_interval_is_that_of_the_table)
{
    /* The ranks, from either end, of the 95 % interval of the median, for 6 .. 25 values. */
    static const int ranks[] = {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 5, 5, 5, 6, 6, 6, 7, 7, 8};
    double sorted[25];
    for (size_t i = 0; i < COUNT(sorted); ++i)
        sorted[i] = (double)i + 1;
    for (size_t n = 6; n <= 25; ++n) {
        mote_confidence interval = mote_statistics_sign_interval(sorted, n);
        assert_near(interval.low, ranks[n - 6], 0);
        assert_near(interval.high, (double)n + 1 - ranks[n - 6], 0);
    }
    for (size_t n = 0; n < 6; ++n) {
        mote_confidence interval = mote_statistics_sign_interval(sorted, n);
        assert_true(isnan(interval.low) && isnan(interval.high));
    }
}

TEST(holm_never_falls_below_a_smaller_one_nor_exceeds_one)
{
    double p[] = {0.9, 0.02, 0.6, 0.02, 0.021}, work[5];
    mote_statistics_holm(p, 5, work);
    assert_near(p[1], 0.1, 1e-12);
    assert_near(p[3], 0.1, 1e-12);
    assert_near(p[4], 0.1, 1e-12); /* 3 x 0.021 is less than 5 x 0.02 */
    assert_near(p[2], 1, 0);
    assert_near(p[0], 1, 0);
}

TEST(holm_reads_and_writes_the_values_of_its_table_alone)
{
    double p[] = {MOTE_NONE, 0.02, 0.03, 0.9}, work[] = {0.5, 0.5, 0.5, 0.5};
    mote_statistics_holm(p, 3, work);
    assert_true(isnan(p[0]));
    assert_near(p[1], 0.04, 1e-12);
    assert_near(p[2], 0.04, 1e-12);
    assert_near(p[3], 0.9, 0);
    assert_near(work[3], 0.5, 0);
}
