/* What the triangle distance skips when a bound is given, and where two triangles count as
   touching: pairs constructed with known answers. */
#include "core/body/triangle.h"

#include "tests/support/test.h"
#include "tests/support/triangle_pairs.h"

#include <stddef.h>
#include <stdint.h>

/* A random rotation about the origin: its columns. */
static void random_axes(uint64_t *seed, mote_vec3 axes[3])
{
    mote_vec3 a = pair_point(seed), b = pair_point(seed);
    axes[0] = mote_scale(a, 1 / mote_length(a));
    b = mote_add_scaled(b, -mote_dot(axes[0], b), axes[0]);
    axes[1] = mote_scale(b, 1 / mote_length(b));
    axes[2] = mote_cross(axes[0], axes[1]);
}

static void turn(const mote_vec3 axes[3], const mote_vec3 from[3], mote_vec3 to[3])
{
    for (int k = 0; k < 3; ++k)
        to[k] =
            mote_add_scaled(mote_add_scaled(mote_scale(axes[0], from[k].x), from[k].y, axes[1]),
                            from[k].z, axes[2]);
}

/* Checks that the result is the bound itself where a plane or the line of centres proves the
   pair to be far, and that the points stay unchanged. */
static void check_cut(const mote_vec3 s[3], const mote_vec3 t[3], double bound_squared)
{
    mote_vec3 p = {7, 7, 7}, q = {8, 8, 8};
    assert_true(mote_triangle_triangle_below(s, t, bound_squared, &p, &q) == bound_squared);
    assert_true(mote_triangle_triangle_below(t, s, bound_squared, &q, &p) == bound_squared);
    assert_true(p.x == 7 && q.x == 8);
}

/* Apart by 2 to 4 along z: the plane of the lower one proves it, to a tenth of a percent. */
TEST(below_of_pairs_beyond_a_plane_is_the_bound)
{
    uint64_t seed = 31;
    for (int i = 0; i < 2000; ++i) {
        mote_vec3 s[3], t[3], axes[3];
        double gap = HUGE_VAL;
        random_axes(&seed, axes);
        for (int k = 0; k < 3; ++k) {
            const mote_vec3 a = pair_point(&seed), b = pair_point(&seed);
            s[k] = mote_vec3_make(9 * a.x, 9 * a.y, 0);
            t[k] = mote_vec3_make(9 * b.x, 9 * b.y, 3 + b.z);
            gap = fmin(gap, t[k].z);
        }
        turn(axes, s, s);
        turn(axes, t, t);
        if (mote_length(mote_cross(mote_sub(s[1], s[0]), mote_sub(s[2], s[0]))) > 0.1)
            check_cut(s, t, 0.997 * gap * gap);
    }
}

/* Two perpendicular triangles, both in planes through the line of their centres, one around
   x = 0, the other around x = 10; each is cut by the other's plane. */
TEST(below_of_pairs_far_along_their_centres_is_the_bound)
{
    uint64_t seed = 32;
    for (int i = 0; i < 2000; ++i) {
        const mote_vec3 flat[3] = {{-1, -1, 0}, {-1, 1, 0}, {1, 0, 0}};
        const mote_vec3 upright[3] = {{11, 0, -1}, {11, 0, 1}, {9, 0, 0}};
        mote_vec3 s[3], t[3], axes[3];
        random_axes(&seed, axes);
        turn(axes, flat, s);
        turn(axes, upright, t);
        check_cut(s, t, 63); /* 8 apart, and 8 along the centres */
        assert_true(fabs(mote_triangle_triangle_below(s, t, 65, NULL, NULL) - 64) <= 1e-12);
    }
}

/* The squared width of the gap that the line of centres has between s and t; 0: none. */
static double squared_gap_of_centres(const mote_vec3 s[3], const mote_vec3 t[3])
{
    const mote_vec3 along =
        mote_sub(mote_add(t[0], mote_add(t[1], t[2])), mote_add(s[0], mote_add(s[1], s[2])));
    double from = -HUGE_VAL, to = HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
        from = fmax(from, mote_dot(along, s[k]));
        to = fmin(to, mote_dot(along, t[k]));
    }
    return to > from ? (to - from) * (to - from) / mote_length_squared(along) : 0;
}

/* Only gaps of more than a thousandth of the distance of two corners, which rounding cannot
   hide. */
TEST(below_of_pairs_that_the_line_of_centres_separates_is_the_bound)
{
    uint64_t seed = 34;
    int separate = 0;
    for (int i = 0; i < 20000; ++i) {
        mote_vec3 s[3], t[3];
        pair_make(i % 2 ? PAIR_APART : PAIR_BESIDE, s, t, &seed);
        for (int k = 0; k < 3; ++k) {
            const double scale = ldexp(1, i % 81 - 40);
            s[k] = mote_scale(s[k], scale);
            t[k] = mote_scale(t[k], scale);
        }
        const double squared = squared_gap_of_centres(s, t);
        if (squared > 1e-6 * mote_distance_squared(s[0], t[0])) {
            check_cut(s, t, 0.99 * squared);
            ++separate;
        }
    }
    assert_true(separate > 10000);
}

/* Corners of two triangles face each other across a gap of a few roundings. No proof that is
   itself only rounding may return the bound instead of the distance. */
TEST(below_of_pairs_apart_by_rounding_is_the_distance)
{
    uint64_t seed = 33;
    int apart = 0;
    for (int i = 0; i < 40000; ++i) {
        const double gap = ldexp(1 + pair_uniform(&seed), -51 + i % 5);
        const mote_vec3 left[3] = {{0, 0, 0}, {-1, 0.3, 0.1}, {-1, -0.3, 0.2}};
        const mote_vec3 right[3] = {{gap, 0, 0}, {1, 0.1, 0.3}, {1, 0.2, -0.3}};
        mote_vec3 s[3], t[3], axes[3];
        random_axes(&seed, axes);
        turn(axes, left, s);
        turn(axes, right, t);
        const double exact = mote_triangle_triangle(s, t, NULL, NULL);
        const double bound = exact * (1 + 0.2 * pair_uniform(&seed));
        if (exact > 0 && bound > exact) {
            assert_true(mote_triangle_triangle_below(s, t, bound, NULL, NULL) == exact);
            ++apart;
        }
    }
    assert_true(apart > 10000);
}

/* The longest edge is 5: touching is at most 2^-51 x 5 = 2.2e-15. */
TEST(pairs_apart_by_more_than_rounding_do_not_touch)
{
    const mote_vec3 s[3] = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
    for (int k = 1; k <= 40; ++k) {
        const double gap = 1e-16 * k;
        const mote_vec3 t[3] = {{1, 1, gap}, {1, 1, 3}, {2, 1, 3}};
        mote_vec3 p, q;
        const double squared = mote_triangle_triangle(s, t, &p, &q);
        if (gap < 2.2e-15)
            assert_true(squared == 0 && p.z == q.z && p.z >= 0 && p.z <= gap);
        if (gap > 2.6e-15) { /* coordinates round by up to 2.2e-16 */
            assert_true(squared > 0 && fabs(sqrt(squared) - gap) <= 1e-15);
            assert_true(fabs(q.z - p.z - gap) <= 1e-15);
        }
    }
}

/* A degenerate triangle, a segment, passes through a face at every slope. */
TEST(segment_through_a_face_touches_at_any_slope)
{
    const mote_vec3 s[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (int k = 1; k <= 16; ++k) {
        const double half = 0.125 * k; /* at 0.5 the dot product of normal and edge is 1 */
        const mote_vec3 t[3] = {
            {0.25, 0.25, -half}, {0.25, 0.25, half}, {0.25, 0.25, half / 2}};
        mote_vec3 p, q;
        assert_true(mote_triangle_triangle(s, t, &p, &q) == 0);
        assert_true(p.x == 0.25 && p.y == 0.25 && p.z == 0);
        assert_true(mote_triangle_triangle(t, s, NULL, NULL) == 0);
    }
}

/* An edge so much shorter than the others that the square of the normal has lost bits, or is 0:
   as a segment, of which one end is nearest, or the middle. */
TEST(point_triangle_with_one_edge_next_to_nothing_is_that_of_a_segment)
{
    for (int k = 300; k <= 600; ++k) {
        test_row("short edge 2^-%d", k);
        const double e = ldexp(1, -k);
        const mote_vec3 t[3] = {{0, 0, 0}, {-e, -3 * e, 0}, {-1, 0, 0}};
        for (int turn = 0; turn < 3; ++turn) {
            const mote_vec3 u[3] = {t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]};
            mote_vec3 p;
            const double end = mote_point_triangle(mote_vec3_make(0, -0.01, 0), u, &p);
            assert_true(fabs(sqrt(end) - 0.01) < 1e-15 && fabs(p.x) < 1e-15);
            const double side = mote_point_triangle(mote_vec3_make(-0.5, 3, 4), u, &p);
            assert_true(fabs(sqrt(side) - 5) < 1e-14 && fabs(p.x + 0.5) < 1e-15);
        }
    }
}
