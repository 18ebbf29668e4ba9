/* Two triangles whose vertices go straight: how long they are shown to stay apart, against
   closed forms. */
#include "core/impact/impact_leaf.h"

#include "tests/support/test.h"

#include <math.h>

/* A flat triangle at a height, that moves by `up` in the step. */
static mote_moving_triangle level(double height, double up)
{
    mote_moving_triangle t = {.p = {{0, 0, height}, {1, 0, height}, {0, 1, height}},
                              .d = {{0, 0, up}, {0, 0, up}, {0, 0, up}}};
    return t;
}

/* b is above a by g, and comes nearer by `closing` in the step: the gap, less the tolerance and
   the bend, is g - tolerance - closing s - bend s^2, of which `until` is the root. */
TEST(mote_moving_triangles_that_face_each_other_are_shown_apart_to_the_root)
{
    static const struct {
        double g, tolerance, closing, bend, until;
    } rows[] = {
        {1, 0, 2, 0, 0.5},                 /* a line */
        {1, 0.25, 2, 0, 0.375},            /* to the tolerance */
        {1, 0, 0, 4, 0.5},                 /* the bend alone */
        {1, 0, 2, 3, 1.0 / 3},             /* 3 s^2 + 2 s - 1 */
        {1, 0, -1, 4, 0.6403882032022076}, /* 4 s^2 - s - 1: away, and bent back */
        {1, 0.5, 0.25, 0.2, 1},            /* apart all the way */
        {0.1, 0.2, -0.1, 1, 0},            /* nearer than the tolerance all the time */
        {0, 0, 1, 0.1, 0},                 /* they touch */
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        const mote_moving_triangle a = level(0, 0), b = level(rows[i].g, -rows[i].closing);
        /* by the direction that showed it last, and by one that shows nothing */
        for (int k = 0; k < 2; ++k) {
            mote_leaf_question q = {.tolerance = rows[i].tolerance,
                                    .bend = rows[i].bend,
                                    .apart = {k ? 1 : 0, 0, k ? 0 : 1}};
            uint64_t tests = 0;
            test_row("row %zu, direction %d", i, k);
            const double until = mote_moving_triangles(&a, &b, &q, 1, &tests);
            assert_true(until <= rows[i].until);
            assert_true(until >= rows[i].until * (1 - 2e-3));
            assert_int_equal(tests == 0, k == 0 && rows[i].until >= 1);
        }
    }
}

/* Triangles that cross from the start are shown nothing. */
TEST(mote_moving_triangles_that_cross_are_never_apart)
{
    const mote_moving_triangle a = level(0, 0);
    const mote_moving_triangle b = {.p = {{0.2, 0.2, -1}, {0.3, 0.2, 1}, {0.2, 0.3, 1}},
                                    .d = {{0, 0, 3}, {0, 0, 3}, {0, 0, 3}}};
    mote_leaf_question q = {.bend = 0.1, .apart = {0, 0, 1}};
    uint64_t tests = 0;
    assert_true(!(mote_moving_triangles(&a, &b, &q, 1, &tests) > 0));
    assert_int_equal(tests, 1);
}

/* A triangle that goes by at a distance of 1/2, too fast for any one direction: shown by
   several, each of which holds for a part of the way. */
TEST(mote_moving_triangles_that_pass_are_shown_apart_by_several_directions)
{
    const mote_moving_triangle a = {.p = {{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}},
                                    .d = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    const mote_moving_triangle b = {.p = {{-5, 0.5, 0}, {-5, 0.501, 0}, {-5, 0.5, 1e-3}},
                                    .d = {{10, 0, 0}, {10, 0, 0}, {10, 0, 0}}};
    for (int k = 0; k < 2; ++k) { /* with a tolerance that it keeps, and one that it does not */
        mote_leaf_question q = {.tolerance = k ? 0.6 : 0.4, .bend = 1e-9, .apart = {0, 0, 1}};
        uint64_t tests = 0;
        const double until = mote_moving_triangles(&a, &b, &q, 1, &tests);
        const double entry = 0.5 - sqrt(0.6 * 0.6 - 0.499 * 0.499) / 10;
        if (k == 0)
            assert_true(until >= 1);
        else
            assert_true(until <= entry + 1e-3 && until > 0.9 * entry);
        assert_true(tests > 1);
    }
}
