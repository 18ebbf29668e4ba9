/* Tests of hypotheses, against published examples and closed forms. */
#include "harness/base/statistics.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdint.h>

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", value, tolerance, expected);
}

TEST(holm_of_four_values_is_the_textbook_one)
{
    double p[] = {0.01, 0.04, 0.03, MOTE_NONE, 0.005}, work[5];
    mote_statistics_holm(p, 5, work);
    assert_near(p[0], 0.03, 1e-12);
    assert_near(p[1], 0.06, 1e-12);
    assert_near(p[2], 0.06, 1e-12);
    assert_true(isnan(p[3]));
    assert_near(p[4], 0.02, 1e-12);
}

TEST(welch_of_two_samples_is_the_closed_form)
{
    /* Variances 1 and 4, three values each: standard error sqrt(5 / 3), degrees of freedom
       (5/3)^2 / (1/18 + 8/9). */
    const double a[] = {1, 2, 3}, b[] = {8, 10, 12};
    mote_difference d = mote_statistics_welch(a, 3, b, 3);
    assert_near(d.value, 8, 1e-12);
    assert_near((d.interval.low + d.interval.high) / 2, 8, 1e-12);
    double half = (d.interval.high - d.interval.low) / 2;
    /* t(0.975) at 2.941 degrees of freedom lies between those at 2 and 3. */
    assert_true(half > 3.182446 * sqrt(5.0 / 3) && half < 4.302653 * sqrt(5.0 / 3));
    assert_true(d.p > 0.001 && d.p < 0.02);
    assert_true(isnan(mote_statistics_welch(a, 1, b, 3).p));
}

TEST(exponent_of_a_power_with_an_outlier_is_the_power)
{
    double x[12], y[12], exponent;
    mote_confidence interval;
    for (size_t i = 0; i < 12; ++i) {
        x[i] = (double)(i + 1);
        y[i] = 3 * pow(x[i], 1.7) * (i % 2 ? 1.001 : 0.999);
    }
    y[5] *= 100;
    assert_int_equal(mote_statistics_exponent(x, y, 12, &exponent, &interval), MOTE_OK);
    assert_near(exponent, 1.7, 0.01);
    assert_true(interval.low < 1.7 && 1.7 < interval.high);
    assert_int_equal(mote_statistics_exponent(x, y, 3, &exponent, &interval), MOTE_OK);
    assert_true(isnan(exponent));
}

static mote_verdict verdict(double ratio, double low, double high)
{
    mote_confidence interval = {low, high};
    return mote_statistics_verdict(ratio, interval, 0.01, 0.02);
}

TEST(verdict_needs_interval_and_effect)
{
    assert_int_equal(verdict(1.10, 1.05, 1.15), MOTE_VERDICT_SLOWER);
    assert_int_equal(verdict(0.90, 0.85, 0.95), MOTE_VERDICT_FASTER);
    assert_int_equal(verdict(1.01, 1.005, 1.015), MOTE_VERDICT_SAME);
    assert_int_equal(verdict(1.10, 0.95, 1.25), MOTE_VERDICT_UNDECIDED);
    assert_int_equal(verdict(1.01, 1.00, 1.03), MOTE_VERDICT_UNDECIDED);
    assert_int_equal(verdict(1.10, MOTE_NONE, MOTE_NONE), MOTE_VERDICT_UNDECIDED);
    mote_confidence interval = {1.05, 1.15};
    assert_int_equal(mote_statistics_verdict(1.1, interval, 0.04, 0.02),
                     MOTE_VERDICT_UNDECIDED);
}
