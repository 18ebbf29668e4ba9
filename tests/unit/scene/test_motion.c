#include "harness/base/curve.h"
#include "harness/scene/motion.h"
#include "core/base/turn.h"
#include "tests/support/test.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

TEST(mote_turn_many_angles_matches_the_c_library)
{
    for (int i = -4000; i <= 4000; ++i) {
        const double turns = i * 0.0137 + 1e-9 * i * i;
        double sine, cosine;
        mote_turn(turns, &sine, &cosine);
        const double angle = (turns - floor(turns)) * 6.283185307179586476925;
        assert_true(fabs(sine - sin(angle)) < 1e-15);
        assert_true(fabs(cosine - cos(angle)) < 1e-15);
        assert_true(fabs(sine * sine + cosine * cosine - 1) < 5e-16);
    }
}

TEST(mote_turn_quarter_turns_is_exact)
{
    static const double expected[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (int i = -9; i < 9; ++i) {
        double sine, cosine;
        mote_turn(i / 4.0, &sine, &cosine);
        assert_true(sine == expected[i & 3][0]);
        assert_true(cosine == expected[i & 3][1]);
    }
}

TEST(mote_curve_evaluate_keys_are_met_exactly)
{
    static const uint32_t frames[] = {1, 4, 50, 51};
    static const double values[] = {1, -2, 3, 5, -7, 11, 13, 17};
    mote_curve *curve;
    assert_int_equal(mote_curve_create(frames, values, 4, 2, &curve), MOTE_OK);
    for (int k = 0; k < 4; ++k) {
        double value[2];
        mote_curve_evaluate(curve, frames[k], value);
        assert_true(value[0] == values[2 * k]);
        assert_true(value[1] == values[2 * k + 1]);
    }
    double value[2];
    mote_curve_evaluate(curve, 0, value);
    assert_true(value[0] == 1);
    mote_curve_evaluate(curve, 99, value);
    assert_true(value[1] == 17);
    mote_curve_destroy(curve);
}

/* Tangents taken from parabolas reproduce a parabola's inner pieces. */
TEST(mote_curve_evaluate_parabola_is_reproduced)
{
    static const uint32_t frames[] = {1, 3, 8, 10, 20};
    double values[5];
    for (int k = 0; k < 5; ++k)
        values[k] = 2.0 + 3.0 * frames[k] - 0.5 * frames[k] * frames[k];
    mote_curve *curve;
    assert_int_equal(mote_curve_create(frames, values, 5, 1, &curve), MOTE_OK);
    for (double t = 3; t <= 10; t += 0.125) {
        double value;
        mote_curve_evaluate(curve, t, &value);
        assert_true(fabs(value - (2 + 3 * t - 0.5 * t * t)) < 1e-12);
    }
    mote_curve_destroy(curve);
}

TEST(mote_curve_evaluate_across_keys_slope_is_continuous)
{
    static const uint32_t frames[] = {1, 10, 14, 40};
    static const double values[] = {0, 1, -1, 2};
    mote_curve *curve;
    assert_int_equal(mote_curve_create(frames, values, 4, 1, &curve), MOTE_OK);
    for (int k = 1; k < 3; ++k) {
        const double h = 1e-6;
        double before, at, after;
        mote_curve_evaluate(curve, frames[k] - h, &before);
        mote_curve_evaluate(curve, frames[k], &at);
        mote_curve_evaluate(curve, frames[k] + h, &after);
        assert_true(fabs((at - before) / h - (after - at) / h) < 1e-5);
    }
    mote_curve_destroy(curve);
}

TEST(mote_curve_create_frames_not_rising_is_refused)
{
    static const uint32_t frames[] = {1, 5, 5};
    static const double values[] = {0, 0, 0};
    mote_curve *curve = NULL;
    assert_int_equal(mote_curve_create(frames, values, 3, 1, &curve), MOTE_EINVAL);
    assert_null(curve);
}

TEST(mote_quaternion_matrix_is_a_rotation)
{
    for (int i = 1; i < 200; ++i) {
        const mote_vec3 axis = {i - 100.5, (i * 7) % 13 - 6.0, (i * 5) % 11 - 5.0};
        const double degrees = i * 7.3;
        const mote_mat3 r = mote_quaternion_matrix(mote_quaternion_about(axis, degrees));
        /* Rodrigues' formula on a vector. */
        const mote_vec3 v = {0.3, -0.8, 0.5};
        const mote_vec3 u = mote_scale(axis, 1 / mote_length(axis));
        const double t = degrees * 3.14159265358979323846 / 180;
        mote_vec3 expected = mote_scale(v, cos(t));
        expected = mote_add_scaled(expected, sin(t), mote_cross(u, v));
        expected = mote_add_scaled(expected, mote_dot(u, v) * (1 - cos(t)), u);
        assert_true(mote_length(mote_sub(mote_rotate(&r, v), expected)) < 1e-13);
        assert_true(mote_length(mote_sub(mote_rotate_back(&r, mote_rotate(&r, v)), v)) < 4e-15);
    }
}

TEST(mote_motion_pose_places_the_centre)
{
    static const uint32_t frames[] = {1, 101};
    static const double positions[] = {1, 2, 3, 2, 4, 6};
    mote_quaternion turns[2] = {mote_quaternion_about(mote_vec3_make(0, 0, 1), 0),
                                mote_quaternion_about(mote_vec3_make(0, 0, 1), 90)};
    mote_body_motion motion = {.centre = {5, -1, 2}};
    assert_int_equal(mote_curve_create(frames, positions, 2, 3, &motion.position), MOTE_OK);
    assert_int_equal(mote_curve_create(frames, &turns->w, 2, 4, &motion.rotation), MOTE_OK);
    const mote_pose last = mote_motion_pose(&motion, 101);
    const mote_vec3 centre = mote_pose_apply(&last, motion.centre);
    assert_true(mote_length(mote_sub(centre, mote_vec3_make(2, 4, 6))) < 1e-14);
    const mote_vec3 x = mote_rotate(&last.rotation, mote_vec3_make(1, 0, 0));
    assert_true(mote_length(mote_sub(x, mote_vec3_make(0, 1, 0))) < 1e-15);
    /* Half way between two keys both curves are half way. */
    const mote_pose middle = mote_motion_pose(&motion, 51);
    const mote_vec3 half = mote_rotate(&middle.rotation, mote_vec3_make(1, 0, 0));
    assert_true(mote_length(mote_sub(half, mote_vec3_make(sqrt(0.5), sqrt(0.5), 0))) < 1e-15);
    mote_body_motion_free(&motion);
}

TEST(mote_waves_draw_stays_within_amplitude_and_periods)
{
    mote_wave waves[14 * 3];
    mote_waves_draw(7, 14, 3, 0.05, 200, 500, waves);
    for (uint32_t i = 0; i < 42; ++i) {
        assert_int_equal(waves[i].control, i / 3);
        assert_true(fabs(mote_length(waves[i].amplitude) - 0.05 / 3) < 1e-15);
        assert_true(waves[i].period >= 200 && waves[i].period <= 500);
        assert_true(waves[i].phase >= 0 && waves[i].phase < 1);
    }
    mote_wave again[14 * 3];
    mote_waves_draw(7, 14, 3, 0.05, 200, 500, again);
    for (uint32_t i = 0; i < 42; ++i)
        assert_true(waves[i].phase == again[i].phase && waves[i].period == again[i].period);
    mote_waves_draw(8, 14, 3, 0.05, 200, 500, again);
    for (uint32_t i = 0; i < 42; ++i)
        assert_true(waves[i].phase != again[i].phase);
}

TEST(mote_motion_displacements_sums_the_sines)
{
    mote_wave *waves = calloc(2, sizeof *waves);
    assert_non_null(waves);
    waves[0] = (mote_wave){1, {1, 0, 2}, 100, 0.25};
    waves[1] = (mote_wave){1, {0, 3, 0}, 40, 0};
    mote_body_motion motion = {.waves = waves, .wave_count = 2, .control_count = 2};
    mote_vec3 d[2];
    mote_motion_displacements(&motion, 30, d);
    assert_true(mote_length(d[0]) == 0);
    const double a = sin(2 * 3.14159265358979323846 * (0.3 + 0.25));
    const double b = sin(2 * 3.14159265358979323846 * 0.75);
    assert_true(mote_length(mote_sub(d[1], mote_vec3_make(a, 3 * b, 2 * a))) < 1e-14);
    mote_body_motion_free(&motion);
}
