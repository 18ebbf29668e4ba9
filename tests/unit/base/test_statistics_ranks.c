/* Tests by ranks and order statistics against every arrangement counted one by one, closed
   forms and the table of the sign test. */
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

/* Two-sided p of a normal variable. */
static double p_normal(double distance, double variance)
{
    return erfc(fmax(0, fabs(distance) - 0.5) / sqrt(2 * variance));
}

enum { SIGNED = 9 };

/* The share of all signs whose sum of positive ranks is as far from its mean; sizes differ. */
static double wilcoxon_counted(const double *differences, size_t n)
{
    double ranks[SIGNED], sum = 0, mean = (double)(n * (n + 1)) / 4;
    for (size_t i = 0; i < n; ++i) {
        ranks[i] = 1;
        for (size_t k = 0; k < n; ++k)
            ranks[i] += fabs(differences[k]) < fabs(differences[i]);
        sum += differences[i] > 0 ? ranks[i] : 0;
    }
    size_t as_far = 0;
    for (size_t signs = 0; signs < (size_t)1 << n; ++signs) {
        double other = 0;
        for (size_t i = 0; i < n; ++i)
            other += signs >> i & 1 ? ranks[i] : 0;
        as_far += fabs(other - mean) >= fabs(sum - mean);
    }
    return (double)as_far / (double)((size_t)1 << n);
}

TEST(wilcoxon_of_few_is_the_share_of_all_signs)
{
    double differences[SIGNED], work[2 * SIGNED];
    for (size_t n = 1; n <= SIGNED; ++n) {
        for (size_t signs = 0; signs < (size_t)1 << n; signs += 1 + n / 4) {
            for (size_t i = 0; i < n; ++i)
                differences[i] = (double)(i * 5 % 11 + 1) * (signs >> i & 1 ? 1 : -1);
            assert_near(mote_statistics_wilcoxon(differences, n, work),
                        wilcoxon_counted(differences, n), 1e-12);
        }
    }
}

TEST(wilcoxon_of_fifty_is_exact_and_of_more_is_normal)
{
    double differences[51], work[102];
    for (size_t i = 0; i < 51; ++i)
        differences[i] = (double)i + 1;
    assert_near(mote_statistics_wilcoxon(differences, 50, work), ldexp(2, -50), 1e-9);
    assert_near(mote_statistics_wilcoxon(differences, 51, work),
                p_normal(51 * 52 / 4.0, 51 * 52 * 103 / 24.0), 1e-9);
    for (size_t i = 0; i < 51; i += 3)
        differences[i] = -differences[i]; /* -1, -4, ..., -49: 17 of them, a sum of 425 */
    assert_near(mote_statistics_wilcoxon(differences, 51, work),
                p_normal(51 * 52 / 4.0 - 425, 51 * 52 * 103 / 24.0), 1e-9);
}

TEST(wilcoxon_of_ties_takes_them_off_the_variance)
{
    /* Sizes 1 1 2 3 3 3, ranks 1.5 1.5 3 5 5 5: ties take (6 + 24) / 48 off 91 / 4. */
    const double differences[] = {-1, 3, 0, 1, 2, -3, 3};
    double work[2 * COUNT(differences)];
    assert_near(mote_statistics_wilcoxon(differences, COUNT(differences), work),
                p_normal(1.5 + 3 + 5 + 5 - 10.5, 91 / 4.0 - 30 / 48.0), 1e-12);
}

enum { LEFT = 4, RIGHT = 5 };

/* The number of pairs in which a's value is the larger, ties counting half. */
static double count_pairs(const double *a, size_t m, const double *b, size_t n)
{
    double u = 0;
    for (size_t i = 0; i < m; ++i) {
        for (size_t k = 0; k < n; ++k)
            u += a[i] > b[k] ? 1 : a[i] < b[k] ? 0 : 0.5;
    }
    return u;
}

/* Splits 1 .. LEFT + RIGHT by the bits of `chosen`; false: not LEFT of them. */
static bool split(size_t chosen, double *a, double *b)
{
    size_t m = 0, n = 0;
    for (size_t i = 0; i < LEFT + RIGHT; ++i) {
        if (chosen >> i & 1 ? m == LEFT : n == RIGHT)
            return false;
        if (chosen >> i & 1)
            a[m++] = (double)i + 1;
        else
            b[n++] = (double)i + 1;
    }
    return true;
}

TEST(mann_whitney_of_few_is_the_share_of_all_splits)
{
    const double mean = LEFT * RIGHT / 2.0;
    double a[LEFT], b[RIGHT], c[LEFT], d[RIGHT], work[2 * (LEFT + RIGHT)];
    for (size_t chosen = 0; chosen < 1 << (LEFT + RIGHT); ++chosen) {
        if (!split(chosen, a, b))
            continue;
        const double u = count_pairs(a, LEFT, b, RIGHT);
        size_t as_far = 0, all = 0;
        for (size_t other = 0; other < 1 << (LEFT + RIGHT); ++other) {
            if (!split(other, c, d))
                continue;
            as_far += fabs(count_pairs(c, LEFT, d, RIGHT) - mean) >= fabs(u - mean);
            ++all;
        }
        assert_int_equal(all, 126);
        const double p = (double)as_far / (double)all;
        assert_near(mote_statistics_mann_whitney(a, LEFT, b, RIGHT, work), p, 1e-12);
        assert_near(mote_statistics_mann_whitney(b, RIGHT, a, LEFT, work), p, 1e-12);
    }
}

TEST(mann_whitney_of_fifty_is_exact_and_of_more_is_normal)
{
    double values[51], work[102];
    for (size_t i = 0; i < 51; ++i)
        values[i] = (double)i;
    /* 25 of 50 below the others: two of C(50, 25) splits are as far. */
    const double ways = exp(lgamma(51) - 2 * lgamma(26));
    assert_near(mote_statistics_mann_whitney(values, 25, values + 25, 25, work), 2 / ways,
                1e-9);
    assert_near(mote_statistics_mann_whitney(values + 26, 25, values, 26, work),
                p_normal(25 * 26 / 2.0, 25 * 26 * 52 / 12.0), 1e-9);
    /* One value against 49: each place is equally likely. */
    assert_near(mote_statistics_mann_whitney(values, 1, values + 1, 49, work), 2 / 50.0, 1e-12);
    assert_near(mote_statistics_mann_whitney(values + 49, 1, values, 49, work), 2 / 50.0,
                1e-12);
}

TEST(mann_whitney_of_ties_takes_them_off_the_variance)
{
    /* 1 2 2 2 3 3 4 5: three alike and two alike take (24 + 6) / (8 x 7) off 9. */
    const double a[] = {2, 5, 3, 2}, b[] = {1, 2, 3, 4};
    double work[16];
    const double u = count_pairs(a, 4, b, 4);
    assert_near(mote_statistics_mann_whitney(a, 4, b, 4, work),
                p_normal(u - 8, 16 / 12.0 * (9 - 30 / 56.0)), 1e-12);
}

TEST(mann_whitney_without_values_or_spread_tells_nothing)
{
    const double same[] = {7, 7, 7};
    double work[12];
    assert_near(mote_statistics_mann_whitney(same, 3, same, 3, work), 1, 0);
    assert_true(isnan(mote_statistics_mann_whitney(same, 0, same, 3, work)));
    assert_true(isnan(mote_statistics_mann_whitney(same, 3, same, 0, work)));
}

TEST(mad_of_values_around_ten_is_their_middle_distance)
{
    double values[] = {10, 7, 11, 30, 10.5}; /* median 10.5: 0.5 3.5 0.5 19.5 0 */
    assert_near(mote_statistics_mad(values, COUNT(values)), 1.4826 * 0.5, 1e-12);
}

TEST(sign_interval_is_that_of_the_table)
{
    /* The rank from either end, of a 95 % interval of the median, for 6 .. 25 values. */
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

TEST(outliers_on_the_fences_are_none)
{
    /* Quartiles 3 and 7: fences -3 and 13. */
    const double inside[] = {-3, 2, 3, 4, 5, 6, 7, 8, 13};
    const double below[] = {-3.1, 2, 3, 4, 5, 6, 7, 8, 13};
    const double above[] = {-3, 2, 3, 4, 5, 6, 7, 8, 13.1};
    assert_int_equal(mote_statistics_outliers(inside, COUNT(inside)), 0);
    assert_int_equal(mote_statistics_outliers(below, COUNT(below)), 1);
    assert_int_equal(mote_statistics_outliers(above, COUNT(above)), 1);
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
