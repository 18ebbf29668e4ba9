#include "core/base/random.h"
#include "harness/mesh/orientation.h"
#include "harness/mesh/polygon.h"
#include "tests/support/polygons.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define CORNERS_MAX 64

__extension__ typedef __int128 wide_integer;

/* The same sign, by integers whose products do not overflow. */
static int integer_orientation(const int64_t a[2], const int64_t b[2], const int64_t c[2])
{
    const wide_integer area = (wide_integer)(b[0] - a[0]) * (c[1] - a[1]) -
                              (wide_integer)(b[1] - a[1]) * (c[0] - a[0]);
    return (area > 0) - (area < 0);
}

/* Points a few units of 2^-53 from a diagonal, where differences and products are rounded. */
TEST(orientation_near_a_line_is_that_of_integers)
{
    const int64_t one = (int64_t)1 << 53;
    int on_line = 0;
    for (int i = 0; i < 64 * 64; ++i) {
        const int64_t a[2] = {one / 2 + i % 64, one / 2 + i / 64};
        const int64_t b[2] = {12 * one, 12 * one};
        const int64_t c[2] = {24 * one, 24 * one};
        double p[3][2];
        for (int k = 0; k < 2; ++k) {
            p[0][k] = ldexp((double)a[k], -53);
            p[1][k] = ldexp((double)b[k], -53);
            p[2][k] = ldexp((double)c[k], -53);
        }
        const int right = integer_orientation(a, b, c);
        on_line += right == 0;
        assert_int_equal(mote_orientation(p[0], p[1], p[2]), right);
        assert_int_equal(mote_orientation(p[1], p[2], p[0]), right);
        assert_int_equal(mote_orientation(p[1], p[0], p[2]), -right);
    }
    assert_int_equal(on_line, 64);
}

/* How a flat outline is placed in space; each way is exact for small integers. */
static void lay(int plane, const double at[2], double xyz[3])
{
    const double u = at[0], v = at[1];
    const double places[6][3] = {
        {u, v, 0}, {0, u, v}, {v, 7, u}, {u, v, u + 2 * v}, {u - v, u + v, 3 * u}, {u, -v, 5}};
    memcpy(xyz, places[plane], sizeof places[plane]);
}

typedef struct flat_polygon {
    size_t count;
    double at[CORNERS_MAX][2];
} flat_polygon;

static double signed_area(const flat_polygon *p)
{
    double twice = 0;
    for (size_t i = 0; i < p->count; ++i) {
        const double *a = p->at[i], *b = p->at[(i + 1) % p->count];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return twice / 2;
}

/* By the crossings of a ray along the first coordinate. */
static bool is_inside(const flat_polygon *p, double x, double y)
{
    bool inside = false;
    for (size_t i = 0; i < p->count; ++i) {
        const double *a = p->at[i], *b = p->at[(i + 1) % p->count];
        if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]))
            inside = !inside;
    }
    return inside;
}

static double triangle_area(const flat_polygon *p, const uint32_t t[3])
{
    const double *a = p->at[t[0]], *b = p->at[t[1]], *c = p->at[t[2]];
    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

/* The number of triangles that contain a point, which must not be on an edge. */
static int cover(const flat_polygon *p, uint32_t (*triangles)[3], double x, double y)
{
    int count = 0;
    for (size_t i = 0; i + 2 < p->count; ++i) {
        flat_polygon triangle = {.count = 3};
        for (int k = 0; k < 3; ++k)
            memcpy(triangle.at[k], p->at[triangles[i][k]], sizeof triangle.at[k]);
        count += is_inside(&triangle, x, y);
    }
    return count;
}

/* Checks that every triangle is wound as the polygon and has area; together they cover it
   once. */
static void check_triangles(const flat_polygon *p, uint32_t (*triangles)[3])
{
    const double area = signed_area(p);
    double sum = 0;
    for (size_t i = 0; i + 2 < p->count; ++i) {
        const double part = triangle_area(p, triangles[i]);
        assert_true(part * area > 0);
        sum += part;
    }
    assert_true(fabs(sum - area) <= 1e-12 * fabs(area));
    for (int i = 0; i < 400; ++i) {
        const double x = -4.013 + 0.6 * (i % 20), y = -4.017 + 0.6 * (i / 20.0);
        assert_int_equal(cover(p, triangles, x, y), is_inside(p, x, y));
    }
}

static mote_status triangulate(const flat_polygon *p, int plane, uint32_t (*triangles)[3])
{
    double xyz[3 * CORNERS_MAX];
    for (size_t i = 0; i < p->count; ++i)
        lay(plane, p->at[i], xyz + 3 * i);
    return mote_polygon_triangulate(xyz, p->count, triangles);
}

static void check_in_all_planes(const flat_polygon *p)
{
    for (int plane = 0; plane < 6; ++plane) {
        uint32_t triangles[CORNERS_MAX][3];
        if (triangulate(p, plane, triangles) != MOTE_OK)
            fail_msg("plane %d: %s", plane, mote_error_text());
        check_triangles(p, triangles);
    }
}

TEST(polygon_is_covered_once_from_every_corner_and_in_both_windings)
{
    for (size_t s = 0; s < polygon_shape_count; ++s) {
        const polygon_shape *shape = &polygon_shapes[s];
        for (size_t start = 0; start < 2 * shape->count; ++start) {
            flat_polygon p = {.count = shape->count};
            for (size_t i = 0; i < p.count; ++i)
                memcpy(p.at[i], polygon_corner(shape, start, i), sizeof p.at[i]);
            assert_true(fabs(signed_area(&p)) == shape->area);
            check_in_all_planes(&p);
        }
    }
}

static int turn(const flat_polygon *p, size_t a, size_t b, size_t c)
{
    return mote_orientation(p->at[a], p->at[b], p->at[c]);
}

/* Reverses parts of the outline between crossing edges until none cross. */
static void untangle(flat_polygon *p)
{
    for (bool crossed = true; crossed;) {
        crossed = false;
        for (size_t i = 0; i + 1 < p->count; ++i) {
            for (size_t j = i + 2; j < p->count; ++j) {
                const size_t after = (j + 1) % p->count;
                if (after == i || turn(p, i, i + 1, j) == turn(p, i, i + 1, after) ||
                    turn(p, j, after, i) == turn(p, j, after, i + 1))
                    continue;
                for (size_t low = i + 1, high = j; low < high; ++low, --high) {
                    double kept[2];
                    memcpy(kept, p->at[low], sizeof kept);
                    memcpy(p->at[low], p->at[high], sizeof kept);
                    memcpy(p->at[high], kept, sizeof kept);
                }
                crossed = true;
            }
        }
    }
}

TEST(polygon_of_random_corners_is_covered_once)
{
    mote_random random = {7};
    for (int round = 0; round < 3000; ++round) {
        flat_polygon p = {.count =
                              4 + (size_t)(mote_random_unit(&random) * (round % 50 ? 12 : 50))};
        for (size_t i = 0; i < p.count; ++i) {
            p.at[i][0] = 6 * mote_random_unit(&random) - 2;
            p.at[i][1] = 6 * mote_random_unit(&random) - 2;
        }
        untangle(&p);
        uint32_t triangles[CORNERS_MAX][3];
        if (triangulate(&p, 0, triangles) != MOTE_OK)
            fail_msg("round %d: %s", round, mote_error_text());
        check_triangles(&p, triangles);
    }
}

/* On a small grid many corners lie on lines through others. The outline may touch itself, and
   is then refused. */
TEST(polygon_on_a_grid_is_covered_once_or_refused)
{
    mote_random random = {11};
    int covered = 0, refused = 0;
    for (int round = 0; round < 5000; ++round) {
        flat_polygon p = {.count = 5 + (size_t)(mote_random_unit(&random) * 5)};
        for (size_t i = 0; i < p.count; ++i) {
            p.at[i][0] = floor(5 * mote_random_unit(&random));
            p.at[i][1] = floor(5 * mote_random_unit(&random));
        }
        uint32_t triangles[CORNERS_MAX][3];
        const mote_status status = triangulate(&p, 3, triangles);
        double sum = 0, positive = 0;
        refused += status != MOTE_OK;
        if (status != MOTE_OK)
            continue;
        for (size_t i = 0; i + 2 < p.count; ++i) {
            sum += triangle_area(&p, triangles[i]);
            positive += fabs(triangle_area(&p, triangles[i]));
        }
        assert_true(sum == signed_area(&p) && positive == fabs(sum));
        covered += sum != 0;
    }
    assert_true(covered > 100 && refused > 1000);
}

TEST(polygon_convex_is_a_fan_from_its_first_corner)
{
    flat_polygon p = {.count = 40};
    for (size_t i = 0; i < p.count; ++i) {
        p.at[i][0] = cos(0.157 * (double)i);
        p.at[i][1] = sin(0.157 * (double)i);
    }
    uint32_t triangles[CORNERS_MAX][3];
    assert_int_equal(triangulate(&p, 1, triangles), MOTE_OK);
    for (uint32_t i = 0; i + 2 < p.count; ++i) {
        assert_int_equal(triangles[i][0], 0);
        assert_int_equal(triangles[i][1], i + 1);
        assert_int_equal(triangles[i][2], i + 2);
    }
}

/* Edges one unit in the last place off a line, far from the origin. */
TEST(polygon_nearly_flat_ears_are_cut_exactly)
{
    const double bit = ldexp(1, -43); /* unit in the last place of numbers from 512 to 1024 */
    const flat_polygon p = {8,
                            {{600, 600},
                             {610, 600 - bit},
                             {620, 600},
                             {630, 600 + bit},
                             {640, 600},
                             {640, 620},
                             {620, 600 + 2 * bit},
                             {600, 620}}};
    for (int plane = 0; plane < 3; ++plane) {
        uint32_t triangles[CORNERS_MAX][3];
        if (triangulate(&p, plane, triangles) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        for (size_t i = 0; i + 2 < p.count; ++i) {
            const uint32_t *t = triangles[i];
            assert_int_equal(mote_orientation(p.at[t[0]], p.at[t[1]], p.at[t[2]]), 1);
        }
    }
}

TEST(polygon_that_is_not_simple_is_refused)
{
    static const struct {
        const char *edges;
        flat_polygon p;
    } wrong[] = {
        {"edges 1 and 3", {4, {{0, 0}, {2, 2}, {2, 0}, {0, 2}}}},         /* a bow tie */
        {"edges", {5, {{0, 3}, {2, -3}, {-3, 1}, {3, 1}, {-2, -3}}}},     /* a pentagram */
        {"edges", {6, {{0, 0}, {2, 1}, {4, 0}, {4, 2}, {2, 1}, {0, 2}}}}, /* a waist */
        {"edges", {5, {{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}}}, /* a corner on an edge */
        {"edges", /* a frame whose hole is joined by a bridge */
         {10,
          {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}}}},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        for (int plane = 0; plane < 6; ++plane) {
            uint32_t triangles[CORNERS_MAX][3];
            assert_int_equal(triangulate(&wrong[i].p, plane, triangles), MOTE_EINVAL);
            if (!strstr(mote_error_text(), wrong[i].edges) ||
                !strstr(mote_error_text(), "; give triangles"))
                fail_msg("case %zu, plane %d: %s", i, plane, mote_error_text());
        }
    }
}

/* Parts without area add none, and the rest stays right. */
TEST(polygon_with_parts_of_no_area_keeps_its_area)
{
    static const struct {
        double area;
        flat_polygon p;
    } odd[] = {
        {4, {5, {{0, 0}, {2, 0}, {2, 2}, {2, 2}, {0, 2}}}},                 /* a corner twice */
        {4, {6, {{0, 0}, {2, 0}, {5, 0}, {2, 0}, {2, 2}, {0, 2}}}},         /* a spike */
        {4, {7, {{0, 0}, {2, 0}, {2, 2}, {3, 3}, {2, 2}, {0, 2}, {0, 2}}}}, /* both */
        {0, {6, {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {2, 0}, {1, 0}}}},         /* a hook */
        {0, {4, {{0, 0}, {3, 0}, {1, 0}, {2, 0}}}},                         /* a line */
        {0, {4, {{1, 1}, {1, 1}, {1, 1}, {1, 1}}}},                         /* a point */
        {0.5, {5, {{0, 0}, {0, 0}, {0, 0}, {1, 0}, {0, 1}}}},
    };
    for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
        for (int plane = 0; plane < 6; ++plane) {
            uint32_t triangles[CORNERS_MAX][3];
            double sum = 0;
            if (triangulate(&odd[i].p, plane, triangles) != MOTE_OK)
                fail_msg("case %zu: %s", i, mote_error_text());
            for (size_t k = 0; k + 2 < odd[i].p.count; ++k)
                sum += fabs(triangle_area(&odd[i].p, triangles[k]));
            assert_true(sum == odd[i].area);
        }
    }
}

/* A strip of a tooth at each corner, 1 long, turned by some angle, far out along all axes; its
   coordinates are floats. `crossed`: its first and last corner are exchanged. */
static mote_status strip_at(double offset, double width, int corners, double angle,
                            bool crossed)
{
    double xyz[3 * CORNERS_MAX];
    uint32_t triangles[CORNERS_MAX][3];
    const int half = corners / 2;
    for (int i = 0; i < corners; ++i) {
        const int at = crossed && (i == 0 || i == corners - 1) ? corners - 1 - i : i;
        const double x =
            at < half ? (double)at / (half - 1) : (corners - 0.5 - at) / (half - 1);
        const double y = at < half ? 0 : width;
        const double place[3] = {cos(angle) * x - sin(angle) * y,
                                 sin(angle) * x + cos(angle) * y, 0.3 * x};
        for (int k = 0; k < 3; ++k)
            xyz[3 * i + k] = (double)(float)(offset + place[k]);
    }
    return mote_polygon_triangulate(xyz, (size_t)corners, triangles);
}

/* Rounding makes its edges cross. */
TEST(polygon_thinner_than_rounded_coordinates_is_accepted)
{
    static const double offsets[] = {0, 10, 100, 1000, 1e5};
    for (size_t o = 0; o < sizeof offsets / sizeof offsets[0]; ++o) {
        const double rounding = fmax(offsets[o], 1) * 0x1p-24;
        for (int i = 0; i < 400; ++i) {
            const int corners = 8 + 2 * (i % 5), step = i / 5;
            const double width = rounding * (0.05 + 0.05 * step);
            if (strip_at(offsets[o], width, corners, 0.1 * i, false) != MOTE_OK)
                fail_msg("%g, %d corners, %g wide: %s", offsets[o], corners, width,
                         mote_error_text());
        }
    }
}

TEST(polygon_that_crosses_wider_than_its_rounding_is_refused)
{
    static const double offsets[] = {0, 10, 100, 1000, 1e5};
    for (size_t o = 0; o < sizeof offsets / sizeof offsets[0]; ++o) {
        const double width = fmax(offsets[o], 1) * 20 * 0x1p-24;
        assert_int_equal(strip_at(offsets[o], width, 8, 0.7, true), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "cross or touch; give triangles"));
        assert_int_equal(strip_at(offsets[o], width, 8, 0.7, false), MOTE_OK);
    }
}

/* A polygon that is not flat is accepted if some view of it is simple; a quadrilateral always
   has one. */
TEST(polygon_that_is_not_flat_is_seen_along_some_line)
{
    uint32_t triangles[4][3];
    const double skew[] = {0, 0, 0, 2, 2, 1, 2, 0, 0, 0, 2, 2};
    assert_int_equal(mote_polygon_triangulate(skew, 4, triangles), MOTE_OK);
    /* A helix of two turns has no such view. */
    double helix[3 * CORNERS_MAX];
    for (size_t i = 0; i < 32; ++i) {
        helix[3 * i] = cos(0.4 * (double)i);
        helix[3 * i + 1] = sin(0.4 * (double)i);
        helix[3 * i + 2] = 0.1 * sin(0.2 * (double)i);
    }
    uint32_t many[CORNERS_MAX][3];
    assert_int_equal(mote_polygon_triangulate(helix, 32, many), MOTE_EINVAL);
}

/* A comb whose columns, one unit wide, are alternately 0.5 and 5 high, seen along either
   axis. */
TEST(polygon_of_ten_thousand_corners_takes_seconds_at_most)
{
    enum { TEETH = 2500, CORNERS = 4 * TEETH + 2 };
    static double xyz[3 * CORNERS];
    static uint32_t triangles[CORNERS][3];
    for (int turned = 0; turned < 2; ++turned) {
        for (size_t i = 0; i < CORNERS; ++i) {
            const size_t tooth = i / 4, k = i % 4;
            double at[2] = {2.0 * (double)tooth + (k >= 2), k == 0 || k == 3 ? 5 : 0.5};
            if (tooth == TEETH) {
                at[0] = k == 0 ? 2 * TEETH : -1;
                at[1] = 0;
            }
            xyz[3 * i + (size_t)turned] = at[0];
            xyz[3 * i + (size_t)!turned] = at[1];
            xyz[3 * i + 2] = 0;
        }
        const clock_t start = clock();
        assert_int_equal(mote_polygon_triangulate(xyz, CORNERS, triangles), MOTE_OK);
        assert_true(clock() - start < 10 * CLOCKS_PER_SEC);
        double area = 0;
        for (size_t t = 0; t + 2 < CORNERS; ++t) {
            const double *a = xyz + 3 * triangles[t][0], *b = xyz + 3 * triangles[t][1],
                         *c = xyz + 3 * triangles[t][2];
            area += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
        }
        assert_true(fabs(fabs(area) - 5.5 * TEETH) < 1e-9 * fabs(area));
    }
}
