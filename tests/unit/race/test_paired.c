/* The statistics of races, on synthetic series. */
#include "tests/support/test.h"

#include "core/base/random.h"
#include "harness/race/protocol.h"
#include "harness/race/race.h"

#include <math.h>
#include <stdlib.h>

/* The share of all sign patterns of 1 .. count for which the interval excludes 0, by
   enumeration: alpha is a bound on it. */
static double misses_by_enumeration(size_t count, double alpha)
{
    size_t misses = 0;
    const size_t patterns = (size_t)1 << count;
    for (size_t p = 0; p < patterns; ++p) {
        double values[16];
        for (size_t i = 0; i < count; ++i) /* no mean of two is 0, except of opposite signs */
            values[i] = (p >> i & 1 ? 1 : -1) * (double)(i + 1) * (1 + 1e-6 * (double)(i * i));
        const mote_confidence interval = mote_paired_interval(values, count, alpha);
        misses += interval.low > 0 || interval.high < 0;
    }
    return (double)misses / (double)patterns;
}

TEST(an_interval_misses_no_more_often_than_it_says)
{
    static const double alphas[] = {0.3, 0.1, 0.05, 0.02, 0.005};
    for (size_t count = 3; count <= 12; ++count) {
        for (size_t k = 0; k < ROWS_OF(alphas); ++k) {
            test_row("%zu values, alpha %g", count, alphas[k]);
            const double share = misses_by_enumeration(count, alphas[k]);
            assert_true(share <= alphas[k]);
            /* The interval is not needlessly wide: one step narrower would miss too often. */
            if (count == 12)
                assert_true(share > 0.5 * alphas[k]);
        }
    }
}

TEST(the_fewest_values_that_give_an_interval)
{
    static const double alphas[] = {0.5, 0.1, 0.05, 0.01, 0.0025, 0.0002};
    double values[MOTE_PAIRED_MAX];
    for (size_t i = 0; i < MOTE_PAIRED_MAX; ++i)
        values[i] = (double)i;
    for (size_t k = 0; k < ROWS_OF(alphas); ++k) {
        const size_t least = mote_paired_least(alphas[k]);
        test_row("alpha %g: %zu", alphas[k], least);
        assert_true(isfinite(mote_paired_interval(values, least, alphas[k]).low));
        assert_true(isnan(mote_paired_interval(values, least - 1, alphas[k]).low));
    }
    assert_true(isnan(mote_paired_centre(values, 0)));
}

/* Symmetric and heavy-tailed: nearly Student's t with two degrees of freedom. */
static double heavy(mote_random *random)
{
    const double u = 2 * mote_random_unit(random) - 1;
    return u / sqrt(1e-9 + (1 - u * u));
}

TEST(an_outlier_moves_centre_and_interval_little)
{
    mote_random random = {7};
    double values[20];
    for (size_t i = 0; i < 20; ++i)
        values[i] = 0.02 + 0.004 * heavy(&random);
    values[3] = 0.7;
    assert_true(fabs(mote_paired_centre(values, 20) - 0.02) < 0.006);
    const mote_confidence interval = mote_paired_interval(values, 20, 0.01);
    assert_true(interval.low < 0.02 && interval.high > 0.02 && interval.high < 0.06);
}

/* Times of one frame set over passes, with drift common to both sides, bursts of other
   processes that last several passes, and interruptions of single frames. */
#define PASSES 40
#define FRAMES 50
typedef struct series {
    double a[PASSES * FRAMES], b[PASSES * FRAMES];
} series;

static void make_series(mote_random *random, double factor, series *s)
{
    double drift = 0, burst = 0;
    for (size_t p = 0; p < PASSES; ++p) {
        drift = 0.95 * drift + 0.02 * heavy(random);
        burst = mote_random_unit(random) < 0.1 ? 0.3 : 0.7 * burst;
        for (size_t f = 0; f < FRAMES; ++f) {
            const double level = (1000 + 100 * (double)f) * exp(drift + burst);
            s->a[p * FRAMES + f] = level * exp(0.005 * heavy(random));
            s->b[p * FRAMES + f] = factor * level * exp(0.005 * heavy(random));
            if (mote_random_unit(random) < 0.03)
                s->a[p * FRAMES + f] += 20000;
            if (mote_random_unit(random) < 0.03)
                s->b[p * FRAMES + f] += 20000;
        }
    }
}

TEST(a_known_factor_is_found_through_drift_and_interruptions)
{
    static const double factors[] = {1, 1.02, 1.1, 0.97, 2};
    series s;
    mote_random random = {3};
    for (size_t k = 0; k < ROWS_OF(factors); ++k) {
        test_row("factor %g", factors[k]);
        make_series(&random, factors[k], &s);
        const mote_bout_times times = {s.a, s.b, PASSES, FRAMES};
        double total[2];
        const double ratio = mote_bout_log_ratio(&times, total);
        assert_true(fabs(ratio - log(factors[k])) < 0.003);
        assert_true(fabs(log(total[1] / total[0]) - ratio) < 1e-12);
        const mote_bout_times exchanged = {s.b, s.a, PASSES, FRAMES};
        assert_true(fabs(ratio + mote_bout_log_ratio(&exchanged, NULL)) < 1e-12);
    }
}

TEST(a_frame_counts_with_its_share_of_the_total)
{
    /* Three frames of 1, 2 and 7; the last one takes half as long again. */
    static const double a[] = {1, 2, 7, 1, 2, 7, 1, 2, 7};
    static const double b[] = {1, 2, 10.5, 1, 2, 10.5, 1, 2, 10.5};
    const mote_bout_times times = {a, b, 3, 3};
    assert_true(fabs(mote_bout_log_ratio(&times, NULL) - log(13.5 / 10)) < 1e-12);
}

/* Plays a race of one row as harness/race/race.c does. Returns the verdict of the last look.
   spread: of pairs of processes. */
static mote_verdict simulate(mote_random *random, double change, double spread)
{
    const double alpha = MOTE_RACE_ALPHA / MOTE_RACE_LOOKS;
    size_t count = 0, next = mote_paired_least(alpha);
    double values[MOTE_PAIRED_MAX];
    mote_verdict verdict = MOTE_VERDICT_UNDECIDED;
    for (size_t look = 0; look < MOTE_RACE_LOOKS; ++look) {
        while (count < next)
            values[count++] = log1p(change) + spread * heavy(random);
        next = mote_race_next_look(count);
        const mote_confidence logs = mote_paired_interval(values, count, alpha);
        const double ratio = exp(mote_paired_centre(values, count));
        const mote_confidence interval = {exp(logs.low), exp(logs.high)};
        verdict = mote_race_verdict(ratio, interval, 0.01, 0.01);
        if (interval.high / ratio - 1 <= 0.01 && ratio / interval.low - 1 <= 0.01)
            break;
    }
    return verdict;
}

/* With 4,000 races the share near 1 % is known to within 0.3 %. */
TEST(looking_again_does_not_inflate_false_alarms)
{
    static const double spreads[] = {0.002, 0.005, 0.01, 0.05};
    mote_random random = {11};
    for (size_t k = 0; k < ROWS_OF(spreads); ++k) {
        size_t alarms = 0;
        for (int i = 0; i < 4000; ++i) {
            const mote_verdict verdict = simulate(&random, 0, spreads[k]);
            alarms += verdict == MOTE_VERDICT_SLOWER || verdict == MOTE_VERDICT_FASTER;
        }
        test_row("spread %g: %zu alarms of 4000", spreads[k], alarms);
        assert_true(alarms <= 4000 * MOTE_RACE_ALPHA * 1.5);
    }
}

TEST(two_per_cent_are_found_where_processes_differ_by_half_a_per_cent)
{
    mote_random random = {13};
    size_t found = 0;
    for (int i = 0; i < 400; ++i)
        found += simulate(&random, 0.02, 0.003) == MOTE_VERDICT_SLOWER;
    assert_true(found >= 360);
}

/* The later looks are far enough apart to decide a row whose processes differ widely. */
TEST(equal_programs_are_the_same_where_processes_differ_by_two_per_cent)
{
    mote_random random = {17};
    size_t same = 0;
    for (int i = 0; i < 400; ++i)
        same += simulate(&random, 0, 0.02) == MOTE_VERDICT_SAME;
    test_row("%zu of 400", same);
    assert_true(same >= 390);
}

/* Standard normal (Box and Muller). */
static double normal(mote_random *random)
{
    const double u = 1 - mote_random_unit(random), v = mote_random_unit(random);
    return sqrt(-2 * log(u)) * cos(6.283185307179586 * v);
}

/* Whether any look of a race of equal sides sees an interval without 0. Each of so many builds
   a side has a layout of its own. */
static bool misses_at_some_look(mote_random *random, size_t builds, double layout, double noise)
{
    const double alpha = MOTE_RACE_ALPHA / MOTE_RACE_LOOKS;
    mote_paired_sample sample = {{0}, {0}};
    double level[MOTE_PAIRED_MAX], values[MOTE_PAIRED_MAX];
    size_t pairs = 0, next = mote_paired_least(alpha);
    bool misses = false;
    for (size_t k = 0; k < builds; ++k)
        level[k] = layout * (normal(random) - normal(random));
    for (size_t look = 0; look < MOTE_RACE_LOOKS; ++look) {
        for (; pairs < next; ++pairs)
            mote_paired_add(&sample, pairs % builds,
                            level[pairs % builds] + noise * normal(random));
        next = mote_race_next_look(pairs);
        const size_t count = mote_paired_values(&sample, values);
        assert_int_equal(count, pairs < builds ? pairs : builds);
        const mote_confidence interval = mote_paired_interval(values, count, alpha);
        misses = misses || interval.low > 0 || interval.high < 0;
    }
    return misses;
}

/* With each pair of processes as a value of its own, 12 builds would miss in 13 % of races. */
TEST(repeats_of_a_unit_add_no_value)
{
    static const size_t builds[] = {11, 12, 24, 64};
    mote_random random = {19};
    for (size_t k = 0; k < ROWS_OF(builds); ++k) {
        size_t misses = 0;
        for (int i = 0; i < 4000; ++i)
            misses += misses_at_some_look(&random, builds[k], 0.005, 0.006);
        test_row("%zu builds: %zu misses of 4000", builds[k], misses);
        assert_true(misses <= 4000 * MOTE_RACE_ALPHA * 1.5);
    }
}

TEST(the_value_of_a_unit_is_the_mean_of_what_was_measured)
{
    mote_paired_sample sample = {{0}, {0}};
    double values[MOTE_PAIRED_MAX];
    assert_int_equal(mote_paired_values(&sample, values), 0);
    mote_paired_add(&sample, MOTE_PAIRED_MAX - 1, 0.5);
    mote_paired_add(&sample, 2, 0.25);
    mote_paired_add(&sample, 2, -0.75);
    assert_int_equal(mote_paired_values(&sample, values), 2);
    assert_true(values[0] == -0.25 && values[1] == 0.5);
}

/* A race keeps MOTE_PAIRED_MAX values a cell, so the last look must not need more, however many
   cells share alpha. */
TEST(the_last_look_of_any_race_is_at_100_pairs_at_most)
{
    for (size_t cells = 1; cells <= MOTE_RACE_CELLS; ++cells) {
        size_t pairs = mote_paired_least(MOTE_RACE_ALPHA / MOTE_RACE_LOOKS / (double)cells);
        for (int k = 1; k < MOTE_RACE_LOOKS; ++k) {
            const size_t next = mote_race_next_look(pairs);
            test_row("%zu cells, look %d", cells, k + 1);
            assert_true(next > pairs && next <= MOTE_PAIRED_MAX);
            pairs = next;
        }
    }
}

TEST(verdicts)
{
    static const struct {
        double ratio, low, high;
        mote_verdict verdict;
    } rows[] = {
        {1.02, 1.012, 1.028, MOTE_VERDICT_SLOWER}, {1.02, 0.999, 1.041, MOTE_VERDICT_UNDECIDED},
        {1.008, 1.001, 1.015, MOTE_VERDICT_SAME}, /* significant, but below the threshold */
        {1.0, 0.985, 1.015, MOTE_VERDICT_SAME},    {1.0, 0.97, 1.03, MOTE_VERDICT_UNDECIDED},
        {0.95, 0.93, 0.97, MOTE_VERDICT_FASTER},   {1.5, 1.2, 1.9, MOTE_VERDICT_SLOWER},
        {1.0, NAN, NAN, MOTE_VERDICT_UNDECIDED},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%zu", i);
        const mote_confidence interval = {rows[i].low, rows[i].high};
        assert_int_equal(mote_race_verdict(rows[i].ratio, interval, 0.01, 0.01),
                         rows[i].verdict);
    }
}
