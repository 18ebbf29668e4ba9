/* Holm's correction at its limits. */
#include "harness/base/statistics.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdint.h>

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance * fabs(expected)))
        fail_msg("%.17g is not within %g of %.17g", value, tolerance, expected);
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
