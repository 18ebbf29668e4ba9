/* Distances of triangles against closed forms and against a slow reference in 113 bits. */
#include "core/body/triangle.h"

#include "tests/support/test.h"
#include "tests/support/triangle_pairs.h"
#include "baselines/wide_triangle.h"

#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* Relative to the pair's extent: a few units in the last place. */
#define TOLERANCE 1e-15

static const mote_vec3 floor_triangle[3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

/* A pair whose distance is known from geometry. */
typedef struct closed_form {
    const char *name;
    mote_vec3 t[3]; /* against floor_triangle */
    double squared;
} closed_form;

static const closed_form closed_forms[] = {
    {"parallel faces", {{1, 1, 2}, {2, 1, 2}, {1, 2, 2}}, 4},
    {"parallel faces, larger above", {{-9, -9, 3}, {20, -9, 3}, {-9, 20, 3}}, 9},
    {"vertex over face", {{1, 1, 1}, {1, 1, 5}, {2, 2, 5}}, 1},
    {"vertex beyond edge", {{2, -3, 0}, {2, -8, 1}, {3, -8, -1}}, 9},
    {"vertex to vertex", {{7, 0, 4}, {9, 1, 5}, {9, -1, 6}}, 25},
    {"edge over edge", {{2, -1, 3}, {2, -1, 9}, {2, -5, 3}}, 10},
    {"edges crossing at a gap", {{2, -1, 1}, {2, 1, -3}, {2, -9, -3}}, 1.0 / 5},
    {"coplanar apart", {{-1, 0, 0}, {-3, 0, 0}, {-3, 3, 0}}, 1},
    {"coplanar overlapping", {{1, 1, 0}, {9, 1, 0}, {1, 9, 0}}, 0},
    {"coplanar inside", {{0.5, 0.5, 0}, {1, 0.5, 0}, {0.5, 1, 0}}, 0},
    {"coplanar around", {{-9, -9, 0}, {20, -9, 0}, {-9, 20, 0}}, 0},
    {"the same", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 0},
    {"piercing by an edge", {{1, 1, -1}, {1, 1, 1}, {9, 9, 3}}, 0},
    {"piercing through its edge", {{-1, 1, -1}, {-1, 1, 1}, {3, 1, 0}}, 0},
    {"both planes crossed, apart", {{3, 3, -1}, {3, 3, 1}, {9, 9, 0}}, 2},
    {"touching at a vertex", {{4, 0, 0}, {5, 0, 1}, {5, 0, -1}}, 0},
    {"vertex touching an edge", {{2, 0, 0}, {2, -3, 1}, {2, -3, -1}}, 0},
    {"vertex touching the face", {{1, 1, 0}, {1, 1, 3}, {2, 1, 3}}, 0},
    {"edges touching", {{2, 0, -1}, {2, 0, 1}, {2, -5, 0}}, 0},
    {"shared edge", {{0, 0, 0}, {4, 0, 0}, {0, -4, 1}}, 0},
    {"segment over face", {{1, 1, 2}, {2, 1, 2}, {1.5, 1, 2}}, 4},
    {"segment through face", {{1, 1, 2}, {1, 1, -2}, {1, 1, 0.5}}, 0},
    {"segment beside", {{-2, 1, 5}, {-2, 1, -5}, {-2, 1, 5}}, 4},
    {"point over face", {{1, 1, 3}, {1, 1, 3}, {1, 1, 3}}, 9},
    {"point on face", {{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}, 0},
    {"point beyond vertex", {{7, 0, 4}, {7, 0, 4}, {7, 0, 4}}, 25},
};

static void check_points(const mote_vec3 s[3], const mote_vec3 t[3], double squared,
                         mote_vec3 p, mote_vec3 q)
{
    double extent = pair_extent(s, t, sqrt(squared));
    wide3 a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = wide_from(s[k]);
        b[k] = wide_from(t[k]);
        extent = fmax(extent, fmax(mote_length(s[k]), mote_length(t[k])));
    }
    assert_true(wide_sqrt(reference_point_triangle(wide_from(p), a)) <= TOLERANCE * extent);
    assert_true(wide_sqrt(reference_point_triangle(wide_from(q), b)) <= TOLERANCE * extent);
    assert_true(fabs(mote_length(mote_sub(p, q)) - sqrt(squared)) <= TOLERANCE * extent);
    if (squared == 0)
        assert_memory_equal(&p, &q, sizeof(p));
}

TEST(triangle_triangle_closed_forms_exact)
{
    for (size_t i = 0; i < COUNT(closed_forms); i++) {
        const closed_form *c = &closed_forms[i];
        for (int turn = 0; turn < 9; turn++) {
            mote_vec3 s[3], t[3], p, q;
            for (int k = 0; k < 3; k++) {
                s[k] = floor_triangle[(k + turn) % 3];
                t[k] = c->t[(k + turn / 3) % 3];
            }
            double squared = mote_triangle_triangle(s, t, &p, &q);
            if (fabs(squared - c->squared) > 1e-15 * c->squared)
                fail_msg("%s: %.17g instead of %.17g", c->name, squared, c->squared);
            check_points(s, t, squared, p, q);
            squared = mote_triangle_triangle(t, s, &p, &q);
            if (fabs(squared - c->squared) > 1e-15 * c->squared)
                fail_msg("%s, swapped: %.17g instead of %.17g", c->name, squared, c->squared);
        }
    }
}

/* Compares one pair with the reference, both ways round. */
static void check_pair(pair_sort sort, const mote_vec3 s[3], const mote_vec3 t[3])
{
    mote_vec3 p, q;
    double squared = mote_triangle_triangle(s, t, &p, &q);
    double swapped = mote_triangle_triangle(t, s, NULL, NULL);
    double truth = wide_sqrt(reference_triangle_triangle(s, t));
    double extent = pair_extent(s, t, truth), error = fabs(sqrt(squared) - truth);
    if (!(error <= TOLERANCE * extent) || (truth == 0 && squared != 0))
        fail_msg("sort %d: distance %.17g instead of %.17g", (int)sort, sqrt(squared), truth);
    assert_true(fabs(sqrt(squared) - sqrt(swapped)) <= TOLERANCE * extent);
    check_points(s, t, squared, p, q);
}

TEST(triangle_triangle_random_pairs_match_reference)
{
    uint64_t seed = 1;
    for (int i = 0; i < 108000; i++) {
        mote_vec3 s[3], t[3];
        pair_sort sort = (pair_sort)(i % PAIR_SORTS);
        pair_make(sort, s, t, &seed);
        check_pair(sort, s, t);
    }
}

static mote_mat3 random_rotation(uint64_t *seed)
{
    mote_vec3 a = pair_point(seed), b = pair_point(seed);
    a = mote_scale(a, 1 / mote_length(a));
    b = mote_add_scaled(b, -mote_dot(a, b), a);
    b = mote_scale(b, 1 / mote_length(b));
    mote_vec3 c = mote_cross(a, b);
    mote_mat3 r = {{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}};
    return r;
}

TEST(triangle_triangle_rigid_motion_same_distance)
{
    uint64_t seed = 2;
    for (int i = 0; i < 20000; i++) {
        mote_vec3 s[3], t[3];
        pair_make((pair_sort)(i % PAIR_SORTS), s, t, &seed);
        mote_pose pose = {random_rotation(&seed), mote_scale(pair_point(&seed), 3)};
        double before = sqrt(mote_triangle_triangle(s, t, NULL, NULL));
        for (int k = 0; k < 3; k++) {
            s[k] = mote_pose_apply(&pose, s[k]);
            t[k] = mote_pose_apply(&pose, t[k]);
        }
        double after = sqrt(mote_triangle_triangle(s, t, NULL, NULL));
        assert_true(fabs(before - after) <= 1e-14 * (3 + pair_extent(s, t, before)));
    }
}

static void scale_triangle(const mote_vec3 t[3], double scale, mote_vec3 scaled[3])
{
    for (int k = 0; k < 3; k++)
        scaled[k] = mote_scale(t[k], scale);
}

static void check_scaled(mote_vec3 p, double scale, mote_vec3 scaled)
{
    p = mote_scale(p, scale);
    assert_memory_equal(&p, &scaled, sizeof(p));
}

static const int exponents[] = {-480, -333, -200, -120, -40, -7, 1, 13, 40, 120, 200, 333, 480};

TEST(triangle_triangle_power_of_two_scale_same_bits)
{
    uint64_t seed = 3;
    for (int i = 0; i < 20000; i++) {
        mote_vec3 s[3], t[3], a[3], b[3], p, q, x, y;
        pair_make((pair_sort)(i % PAIR_SORTS), s, t, &seed);
        double squared = mote_triangle_triangle(s, t, &p, &q);
        double scale = ldexp(1, exponents[(size_t)i % COUNT(exponents)]);
        scale_triangle(s, scale, a);
        scale_triangle(t, scale, b);
        assert_true(mote_triangle_triangle(a, b, &x, &y) == squared * scale * scale);
        check_scaled(p, scale, x);
        check_scaled(q, scale, y);
        double point = mote_point_triangle(s[0], t, &q);
        assert_true(mote_point_triangle(a[0], b, &y) == point * scale * scale);
        check_scaled(q, scale, y);
        double segment = mote_segment_segment(s, t, &p, &q);
        assert_true(mote_segment_segment(a, b, &x, &y) == segment * scale * scale);
        check_scaled(p, scale, x);
        check_scaled(q, scale, y);
    }
}

/* One is as good as a point beside the other, and either may be the large one. */
TEST(tiny_and_huge_corners_are_scaled_by_the_largest)
{
    const double huge = 0x1p400, tiny = 0x1p-400;
    const mote_vec3 dot[3] = {{tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}};
    for (int corner = 0; corner < 3; corner++) {
        mote_vec3 far[3] = {{1, 2, 2}, {1, 2, 2}, {1, 2, 2}}, p, q, face[3];
        far[corner] = mote_vec3_make(2, 4, 4);
        scale_triangle(far, huge, face);
        const double truth = 9 * huge * huge;
        assert_true(mote_triangle_triangle(face, dot, &p, &q) == truth && p.z == 2 * huge);
        assert_true(mote_triangle_triangle(dot, face, &p, &q) == truth && q.z == 2 * huge);
        assert_true(mote_point_triangle(dot[0], face, &q) == truth && q.z == 2 * huge);
        assert_true(mote_segment_segment(face, &dot[1], &p, &q) == truth && p.z == 2 * huge);
        assert_true(mote_segment_segment(&dot[1], face, &p, &q) == truth && q.z == 2 * huge);
        assert_true(mote_point_triangle(face[0], dot, NULL) == mote_length_squared(face[0]));
        assert_true(mote_point_triangle(far[0], dot, &q) == mote_length_squared(far[0]));
        assert_true(mote_length(q) <= tiny);
    }
}

TEST(points_at_the_origin_touch)
{
    const mote_vec3 origin[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    mote_vec3 p, q;
    assert_true(mote_triangle_triangle(origin, origin, &p, &q) == 0);
    assert_true(mote_segment_segment(origin, origin, &p, &q) == 0);
    assert_true(mote_point_triangle(origin[0], origin, &q) == 0);
    assert_memory_equal(&q, origin, sizeof(q));
}

/* The distance is a double, its square is none. */
TEST(nearest_corner_of_the_largest_doubles_is_found)
{
    const double most = DBL_MAX, half = DBL_MAX / 2;
    const mote_vec3 corners[3] = {{half, 0, 0}, {0, half, 0}, {0, 0, half}};
    for (int turn = 0; turn < 3; turn++) {
        mote_vec3 t[3], q;
        for (int k = 0; k < 3; k++)
            t[k] = corners[(k + turn) % 3];
        assert_true(isinf(mote_point_triangle(mote_vec3_make(most, 0, 0), t, &q)));
        assert_memory_equal(&q, &corners[0], sizeof(q));
    }
}

/* Squares of the distance leave the range of doubles; whether there is contact does not. */
TEST(closed_forms_at_the_ends_of_doubles_touch_or_do_not)
{
    for (size_t i = 0; i < COUNT(closed_forms); i++) {
        for (int power = -1000; power <= 1000; power += 40) {
            const double scale = ldexp(1, power);
            mote_vec3 s[3], t[3];
            scale_triangle(floor_triangle, scale, s);
            scale_triangle(closed_forms[i].t, scale, t);
            const double squared = mote_triangle_triangle(s, t, NULL, NULL);
            test_row("%s, times 2^%d", closed_forms[i].name, power);
            assert_true((squared > 0) == (closed_forms[i].squared > 0));
            if (4 * squared < HUGE_VAL)
                assert_true(mote_triangle_triangle_below(s, t, 4 * squared, NULL, NULL) ==
                            squared);
        }
    }
}

/* A face so small that its normal hardly is a number is not told apart by it. */
TEST(triangle_triangle_below_of_a_tiny_and_a_large_face_finds_what_is_below)
{
    uint64_t seed = 7;
    for (int i = 0; i < 20000; i++) {
        mote_vec3 s[3], t[3];
        pair_make(PAIR_GENERAL, s, t, &seed);
        const mote_vec3 to_origin = mote_scale(t[0], -1);
        pair_move(s, to_origin);
        pair_move(t, to_origin);
        scale_triangle(t, ldexp(1, -230 - i % 50), t);
        const double truth = mote_triangle_triangle(s, t, NULL, NULL);
        for (int swap = 0; swap < 2; swap++) {
            const double bound = truth * 1.01 + 0x1p-1000;
            const double below = swap ? mote_triangle_triangle_below(t, s, bound, NULL, NULL)
                                      : mote_triangle_triangle_below(s, t, bound, NULL, NULL);
            assert_true(fabs(sqrt(below) - sqrt(truth)) <= 1e-14 * pair_extent(s, t, 1));
        }
    }
}

TEST(triangle_triangle_common_offset_costs_nothing)
{
    uint64_t seed = 4;
    for (int i = 0; i < 20000; i++) {
        mote_vec3 s[3], t[3];
        pair_make(PAIR_BESIDE, s, t, &seed);
        for (int k = 0; k < 3; k++) { /* coordinates that are exact at the offset */
            s[k] = mote_scale(
                mote_vec3_make(rint(s[k].x * 999), rint(s[k].y * 999), s[k].z > 0), 1);
            t[k] = mote_scale(mote_vec3_make(rint(t[k].x * 999), rint(t[k].y * 999), 5), 1);
        }
        double near = mote_triangle_triangle(s, t, NULL, NULL);
        pair_move(s, mote_vec3_make(0x1p40, -0x1p41, 0x1p39));
        pair_move(t, mote_vec3_make(0x1p40, -0x1p41, 0x1p39));
        assert_true(mote_triangle_triangle(s, t, NULL, NULL) == near);
    }
}

/* Where an edge goes through a face, the point is rounded at the offset, the distance is not.
 */
TEST(triangle_triangle_offset_of_intersecting_pairs_is_a_contact)
{
    uint64_t seed = 5;
    int contacts = 0;
    for (int i = 0; i < 20000; i++) {
        mote_vec3 s[3], t[3];
        pair_make(PAIR_GENERAL, s, t, &seed);
        for (int k = 0; k < 3; k++) {
            s[k] = mote_vec3_make(rint(s[k].x * 999), rint(s[k].y * 999), rint(s[k].z * 999));
            t[k] = mote_vec3_make(rint(t[k].x * 999), rint(t[k].y * 999), rint(t[k].z * 999));
        }
        const double near = mote_triangle_triangle(s, t, NULL, NULL);
        pair_move(s, mote_vec3_make(0x1p50, -0x1p51, 0x1p49));
        pair_move(t, mote_vec3_make(0x1p50, -0x1p51, 0x1p49));
        const double far = mote_triangle_triangle(s, t, NULL, NULL);
        assert_true(far == near);
        contacts += near == 0;
    }
    assert_in_range(contacts, 2000, 10000);
}

/* A bound from 0 to twice the squared distance: any such, itself, or a little more. */
static double bound_about(double squared, int i, uint64_t *seed)
{
    const double any = 2 * pair_uniform(seed), more = 1 + ldexp(1, -8 - i % 44);
    return squared * (i % 3 == 0 ? any : i % 3 == 1 ? 1 : more);
}

TEST(triangle_triangle_below_agrees_with_the_bound)
{
    uint64_t seed = 5;
    int cut = 0;
    for (int i = 0; i < 80000; i++) {
        mote_vec3 s[3], t[3], p = {7, 7, 7}, q = {8, 8, 8}, x, y;
        pair_make((pair_sort)(i % PAIR_SORTS), s, t, &seed);
        const double scale = ldexp(1, exponents[(size_t)i % COUNT(exponents)]);
        scale_triangle(s, scale, s);
        scale_triangle(t, scale, t);
        double exact = mote_triangle_triangle(s, t, &x, &y);
        double bound = bound_about(exact, i, &seed);
        double squared = mote_triangle_triangle_below(s, t, bound, &p, &q);
        if (exact < bound) {
            assert_true(squared == exact);
            assert_memory_equal(&p, &x, sizeof(p));
            assert_memory_equal(&q, &y, sizeof(q));
        } else if (exact > 0) {
            assert_true(squared >= bound && squared <= exact);
            assert_true(p.x == 7 && q.x == 8);
            cut += squared < exact;
        }
    }
    assert_true(cut > 1000);
}

TEST(point_triangle_random_points_match_reference)
{
    uint64_t seed = 6;
    for (int i = 0; i < 50000; i++) {
        mote_vec3 s[3], t[3], closest;
        pair_make((pair_sort)(i % PAIR_SORTS), s, t, &seed);
        wide3 wide_s[3] = {wide_from(s[0]), wide_from(s[1]), wide_from(s[2])};
        double truth = wide_sqrt(reference_point_triangle(wide_from(t[0]), wide_s));
        double extent = pair_extent(s, s, truth);
        double squared = mote_point_triangle(t[0], s, &closest);
        assert_true(fabs(sqrt(squared) - truth) <= TOLERANCE * extent);
        extent = fmax(extent, mote_length(s[0]));
        assert_true(fabs(mote_length(mote_sub(t[0], closest)) - truth) <= TOLERANCE * extent);
        assert_true(wide_sqrt(reference_point_triangle(wide_from(closest), wide_s)) <=
                    TOLERANCE * extent);
    }
}

TEST(segment_segment_random_pairs_match_reference)
{
    uint64_t seed = 7;
    for (int i = 0; i < 50000; i++) {
        mote_vec3 s[3], t[3], p, q;
        pair_make((pair_sort)(i % PAIR_SORTS), s, t, &seed);
        double truth = wide_sqrt(reference_segment_segment(wide_from(s[0]), wide_from(s[1]),
                                                           wide_from(t[0]), wide_from(t[1])));
        s[2] = s[0];
        t[2] = t[0];
        double squared = mote_segment_segment(s, t, &p, &q);
        assert_true(fabs(sqrt(squared) - truth) <= TOLERANCE * pair_extent(s, t, truth));
        check_points(s, t, squared, p, q);
    }
}

TEST(segment_segment_one_point_distance_of_points)
{
    mote_vec3 a[2] = {{1, 2, 3}, {1, 2, 3}}, b[2] = {{1, 2, 5}, {1, 2, 5}}, p, q;
    assert_true(mote_segment_segment(a, b, &p, &q) == 4);
    assert_memory_equal(&p, a, sizeof(p));
    assert_memory_equal(&q, b, sizeof(q));
    assert_true(mote_segment_segment(a, a, &p, &q) == 0);
}
