#include "core/base/random.h"
#include "harness/mesh/affine.h"
#include "harness/mesh/track.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

TEST(mote_track_is_linear_between_keys_and_stays_beyond_them)
{
    const double times[] = {1, 2, 2, 4}, values[] = {10, 0, 20, 1, 5, 1, 7, 3};
    const mote_track track = {MOTE_TRACK_LINEAR, 4, times, values};
    static const struct {
        double at, x, y;
    } rows[] = {{-5, 10, 0}, {1, 10, 0}, {1.5, 15, 0.5}, {2, 5, 1},
                {3, 6, 2},   {4, 7, 3},  {1e9, 7, 3},    {1.999999999, 20, 1}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        double value[2];
        test_row("at %g", rows[i].at);
        mote_track_evaluate(&track, 2, rows[i].at, value);
        assert_true(fabs(value[0] - rows[i].x) < 1e-7);
        assert_true(fabs(value[1] - rows[i].y) < 1e-7);
    }
}

TEST(mote_track_of_steps_keeps_the_last_key)
{
    const double times[] = {0, 1, 3}, values[] = {4, 5, 6};
    const mote_track track = {MOTE_TRACK_STEP, 3, times, values};
    double value;
    mote_track_evaluate(&track, 1, 0.999, &value);
    assert_true(value == 4);
    mote_track_evaluate(&track, 1, 2.999, &value);
    assert_true(value == 5);
    mote_track_evaluate(&track, 1, 3, &value);
    assert_true(value == 6);
}

/* Hermite interpolation reproduces a cubic: x(t) = t^3 - 2 t^2 + 3 with its own derivatives. */
TEST(mote_track_of_cubics_is_the_polynomial_of_its_tangents)
{
    const double times[] = {-1, 0.5, 3};
    double values[9];
    for (int k = 0; k < 3; ++k) {
        const double t = times[k], slope = 3 * t * t - 4 * t;
        values[3 * k] = slope;
        values[3 * k + 1] = t * t * t - 2 * t * t + 3;
        values[3 * k + 2] = slope;
    }
    const mote_track track = {MOTE_TRACK_CUBIC, 3, times, values};
    for (double t = -1; t <= 3; t += 0.0625) {
        double value;
        mote_track_evaluate(&track, 1, t, &value);
        assert_true(fabs(value - (t * t * t - 2 * t * t + 3)) < 1e-13);
    }
}

static void random_rotation(mote_random *random, double q[4])
{
    double squares;
    do {
        squares = 0;
        for (int c = 0; c < 4; ++c) {
            q[c] = 2 * mote_random_unit(random) - 1;
            squares += q[c] * q[c];
        }
    } while (squares > 1 || squares < 0.1);
    for (int c = 0; c < 4; ++c)
        q[c] /= sqrt(squares);
}

/* Against the formula with sines, for angles from 1e-9 to half a turn. */
TEST(mote_track_rotation_turns_at_constant_speed_the_shorter_way)
{
    mote_random random = {5};
    for (int i = 0; i < 2000; ++i) {
        double keys[8], times[] = {0, 1};
        random_rotation(&random, keys);
        random_rotation(&random, keys + 4);
        for (int c = 0; c < 4 && i % 2; ++c) /* near ones, too */
            keys[4 + c] = keys[c] + keys[4 + c] * pow(10, -(i % 9));
        const mote_track track = {MOTE_TRACK_LINEAR, 2, times, keys};
        const double part = mote_random_unit(&random);
        double got[4], a[4], b[4], dot = 0, la = 0, lb = 0;
        mote_track_rotation(&track, part, got);
        for (int c = 0; c < 4; ++c) {
            la += keys[c] * keys[c];
            lb += keys[4 + c] * keys[4 + c];
        }
        for (int c = 0; c < 4; ++c) {
            a[c] = keys[c] / sqrt(la);
            b[c] = keys[4 + c] / sqrt(lb);
            dot += a[c] * b[c];
        }
        double squares = 0; /* of b - a or of b + a: gives the sine of half the angle */
        for (int c = 0; c < 4; ++c)
            squares += pow(b[c] * (dot < 0 ? -1 : 1) - a[c], 2);
        const double angle = 2 * asin(fmin(sqrt(squares) / 2, 1));
        for (int c = 0; c < 4; ++c) {
            const double other = b[c] * (dot < 0 ? -1 : 1);
            const double wanted =
                angle > 1e-12
                    ? (sin((1 - part) * angle) * a[c] + sin(part * angle) * other) / sin(angle)
                    : a[c];
            assert_true(fabs(got[c] - wanted) < 4e-15);
        }
    }
}

TEST(mote_affine_inverts_what_is_not_singular)
{
    const mote_affine a = {{{2, 1, 0, 3}, {0, -1, 4, 5}, {1, 0, 1, -7}}};
    const mote_affine flat = {{{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 1, 0, 0}}};
    const mote_affine zero = {{{0}}};
    mote_affine inverse = a;
    assert_true(mote_affine_invert(&a, &inverse));
    const mote_affine one = mote_affine_multiply(&a, &inverse);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            assert_true(fabs(one.m[r][c] - (r == c)) < 1e-14);
    }
    assert_false(mote_affine_invert(&flat, &inverse));
    assert_false(mote_affine_invert(&zero, &inverse));
}

/* Half way from a rotation to its negative, without tangents, a cubic is 0; far tangents make
   it infinite. Both have no direction, and the key before them counts. */
TEST(mote_track_of_a_cubic_rotation_without_a_direction_is_its_last_key)
{
    static const double tangents[] = {0, 1e308};
    for (size_t i = 0; i < ROWS_OF(tangents); ++i) {
        const double times[] = {0, 2}, far = tangents[i];
        const double values[] = {0,   0, 0, 0, 0.6,  0, 0.8,  0, far, far, far, far,
                                 far, 0, 0, 0, -0.6, 0, -0.8, 0, 0,   0,   0,   0};
        const mote_track track = {MOTE_TRACK_CUBIC, 2, times, values};
        double value[4];
        mote_track_rotation(&track, 1, value);
        assert_true(value[0] == 0.6 && value[1] == 0 && value[2] == 0.8 && value[3] == 0);
        mote_track_rotation(&track, 2, value);
        assert_true(value[0] == -0.6 && value[2] == -0.8);
    }
}
