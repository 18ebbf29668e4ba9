/* Vectors, rotations and poses against identities and long double sums. */
#include "tests/support/solids.h"
#include "tests/support/test.h"

static void assert_near(mote_vec3 a, mote_vec3 b, double tolerance)
{
    assert_close(a.x, b.x, tolerance);
    assert_close(a.y, b.y, tolerance);
    assert_close(a.z, b.z, tolerance);
}

TEST(arithmetic_of_known_vectors_is_exact)
{
    const mote_vec3 a = mote_vec3_make(1, 2, 3);
    const mote_vec3 b = mote_vec3_make(-4, 5, 0.5);
    assert_near(mote_add(a, b), mote_vec3_make(-3, 7, 3.5), 0);
    assert_near(mote_sub(a, b), mote_vec3_make(5, -3, 2.5), 0);
    assert_near(mote_scale(a, -2), mote_vec3_make(-2, -4, -6), 0);
    assert_near(mote_add_scaled(a, 2, b), mote_vec3_make(-7, 12, 4), 0);
    assert_near(mote_cross(a, b), mote_vec3_make(-14, -12.5, 13), 0);
    assert_true(mote_dot(a, b) == 7.5);
    assert_true(mote_length_squared(a) == 14);
    assert_true(mote_length(mote_vec3_make(2, -3, 6)) == 7);
    assert_true(mote_distance_squared(a, b) == 25 + 9 + 6.25);
}

TEST(cross_of_random_vectors_obeys_lagrange)
{
    uint64_t seed = 1;
    for (int k = 0; k < 1000; ++k) {
        const mote_vec3 a = random_vec3(&seed, 1);
        const mote_vec3 b = random_vec3(&seed, 1);
        const mote_vec3 c = mote_cross(a, b);
        const double dot = mote_dot(a, b);
        assert_close(mote_dot(a, c), 0, 1e-15);
        assert_close(mote_dot(b, c), 0, 1e-15);
        assert_close(mote_length_squared(c),
                     mote_length_squared(a) * mote_length_squared(b) - dot * dot, 1e-14);
    }
}

TEST(rotate_quarter_turn_about_z_takes_x_to_y)
{
    const mote_mat3 quarter = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
    assert_near(mote_rotate(&quarter, mote_vec3_make(1, 0, 0)), mote_vec3_make(0, 1, 0), 0);
    assert_near(mote_rotate_back(&quarter, mote_vec3_make(0, 1, 0)), mote_vec3_make(1, 0, 0),
                0);
    const mote_pose pose = {quarter, {10, 20, 30}};
    assert_near(mote_pose_apply(&pose, mote_vec3_make(1, 2, 3)), mote_vec3_make(8, 21, 33), 0);
}

TEST(rotate_back_undoes_random_rotations)
{
    uint64_t seed = 2;
    for (int k = 0; k < 1000; ++k) {
        const mote_mat3 r = random_rotation_matrix(&seed);
        const mote_vec3 v = random_vec3(&seed, 1);
        const mote_vec3 turned = mote_rotate(&r, v);
        assert_near(mote_rotate_back(&r, turned), v, 4e-15);
        assert_close(mote_length(turned), mote_length(v), 4e-15);
    }
}

TEST(pose_apply_agrees_with_long_double)
{
    uint64_t seed = 3;
    for (int k = 0; k < 1000; ++k) {
        const mote_pose pose = {random_rotation_matrix(&seed), random_vec3(&seed, 10)};
        const mote_vec3 v = random_vec3(&seed, 1);
        const mote_vec3 at = mote_pose_apply(&pose, v);
        const double got[3] = {at.x, at.y, at.z};
        const double move[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
        for (int row = 0; row < 3; ++row) {
            const double *m = pose.rotation.m[row];
            const long double sum = (long double)m[0] * v.x + (long double)m[1] * v.y +
                                    (long double)m[2] * v.z + move[row];
            assert_close(got[row], sum, 4e-15);
        }
    }
}

/* A float has 24 bits, so the last 29 of a double's 53 are 0. */
TEST(as_floats_of_random_vectors_keeps_24_bits)
{
    uint64_t seed = 4;
    for (int k = 0; k < 1000; ++k) {
        const mote_vec3 v = random_vec3(&seed, 1);
        const mote_vec3 w = mote_as_floats(mote_scale(v, 1.1));
        const double from[3] = {v.x * 1.1, v.y * 1.1, v.z * 1.1};
        const double to[3] = {w.x, w.y, w.z};
        for (int c = 0; c < 3; ++c) {
            uint64_t bits;
            memcpy(&bits, &to[c], sizeof bits);
            assert_int_equal(bits & 0x1fffffff, 0);
            assert_true(fabs(to[c] - from[c]) <= 0x1p-24 * fabs(from[c]));
        }
    }
}
