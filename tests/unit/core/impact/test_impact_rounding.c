/* Impacts where rounding hides the end of the approach: the bodies come nearer so slowly, or
   are so far from the origin, or the bracket is to be so narrow, that no proof reaches that
   far. A touch that follows is found all the same; a grazing is one without a touch. */
#include "core/impact/impact_state.h"
#include "tests/unit/core/impact/impact_ask.h"

/* Two unit cubes; body 1 goes from x = `from` to x = `to`, both beside the point `offset`. */
static void two_cubes(impact_scene *s, mote_vec3 from, mote_vec3 to, mote_vec3 offset)
{
    impact_scene_init(s, impact_box(1, 1, 1), impact_box(1, 1, 1), IMPACT_RIGID, 1);
    mote_path_line(offset, offset, s->of[0].piece[0].centre);
    mote_path_line(mote_add(offset, from), mote_add(offset, to), s->of[1].piece[0].centre);
}

/* The first moment of the contact, and how far the proof may end before it: the noise of
   impact_rate.c, for two bodies of these sizes, twice. */
typedef struct expected {
    double time, margin;
} expected;

static void check_head_on(impact_scene *s, double resolution, const expected *e)
{
    s->search->options.resolution = resolution;
    const mote_impact_found found = impact_ask(s, impact_question(s, 0));
    assert_int_equal(found.outcome, MOTE_IMPACT_FOUND);
    if (!(found.from <= e->time + e->margin && e->time - e->margin <= found.to))
        fail_msg("%.17g is not within %.17g .. %.17g", e->time, found.from, found.to);
    const double widest = fmax(1.0001 * resolution, e->margin);
    if (!(found.to - found.from <= widest))
        fail_msg("a bracket of %g, at most %g", found.to - found.from, widest);
    assert_true(found.distance <= 0);
    assert_true(fabs(found.normal.x - 1) < 1e-9);
    assert_in_range(found.iterations, 1, 200);
}

TEST(mote_impact_query_head_on_is_found_however_slow_far_and_fine)
{
    static const double resolutions[] = {1e-12, 1e-9, 1e-6, 1e-3};
    static const double speeds[] = {1e-7, 1e-5, 1e-3, 1, 8, 1e3, 1e5};
    static const double offsets[] = {0, 100, 1e4, 1e6};
    for (size_t i = 0; i < ROWS_OF(offsets); ++i) {
        for (size_t j = 0; j < ROWS_OF(speeds); ++j) {
            test_row("offset %g, speed %g", offsets[i], speeds[j]);
            const double far = offsets[i], v = speeds[j];
            impact_scene s;
            two_cubes(&s, mote_vec3_make(1 + 0.375 * v, 0, 0),
                      mote_vec3_make(1 - 0.625 * v, 0, 0), mote_vec3_make(far, far, far));
            const double size = 2 * (1.7321 * far + 2 + v);
            const expected e = {0.375, 1e-15 + 2.5 * 0x1p-41 * size / v};
            for (size_t k = 0; k < ROWS_OF(resolutions); ++k)
                check_head_on(&s, resolutions[k], &e);
            impact_scene_free(&s);
        }
    }
}

/* Turned about an oblique axis, the gap is along no axis: far from the origin the witnesses are
   rounded by more than the bodies are apart just before they touch. */
TEST(mote_impact_query_normal_of_an_oblique_impact_far_away_is_a_direction)
{
    static const double offsets[] = {0, 1e2, 1e4, 1e6, 1e8};
    const mote_quaternion turned =
        mote_quaternion_normalise((mote_quaternion){0.8, 0.3, -0.2, 0.5});
    const mote_mat3 turn = mote_quaternion_matrix(turned);
    const mote_vec3 across = mote_rotate(&turn, mote_vec3_make(1, 0, 0));
    for (size_t i = 0; i < 4 * ROWS_OF(offsets); ++i) {
        const double far = offsets[i / 4], speed = pow(10, -2.0 * (double)(i % 4));
        test_row("offset %g, speed %g", far, speed);
        impact_scene s;
        two_cubes(&s, mote_scale(across, 1 + 0.375 * speed),
                  mote_scale(across, 1 - 0.625 * speed), mote_vec3_make(far, far, far));
        for (int b = 0; b < 2; ++b) {
            for (int k = 0; k < 4; ++k)
                s.of[b].piece[0].turn[k] = turned;
        }
        const mote_impact_found found = impact_ask(&s, impact_question(&s, 0));
        assert_int_equal(found.outcome, MOTE_IMPACT_FOUND);
        assert_true(fabs(mote_length(found.normal) - 1) < 1e-12);
        assert_true(mote_dot(found.normal, across) > 0.99);
        impact_scene_free(&s);
    }
}

/* Both spin fast, so that bounds of speeds are far above the speed at which the gap closes. */
TEST(mote_impact_query_slow_approach_of_spinning_bodies_is_found)
{
    impact_scene s;
    two_cubes(&s, mote_vec3_make(1 + 1e-6, 0, 0), mote_vec3_make(1 - 1e-6, 0, 0),
              mote_vec3_make(1e3, 0, 0));
    s.search->options.resolution = 1e-9;
    for (int b = 0; b < 2; ++b) {
        s.of[b].piece[0].spins = true;
        s.of[b].piece[0].spin = mote_vec3_make(1, 0, 0);
    }
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 0));
    assert_int_equal(found.outcome, MOTE_IMPACT_FOUND);
    assert_true(found.from <= 0.5 + 1e-6 && found.to >= 0.5 - 1e-6);
    assert_true(found.to - found.from < 5e-3);
    impact_scene_free(&s);
}

/* One passes along a face of the other: faces are beside each other from 1/3 to 2/3. */
static mote_impact_found pass_beside(double gap, impact_scene *s)
{
    two_cubes(s, mote_vec3_make(1 + gap, -3, 0), mote_vec3_make(1 + gap, 3, 0),
              mote_vec3_make(0, 0, 0));
    return impact_ask(s, impact_question(s, 0));
}

TEST(mote_impact_query_pass_within_rounding_is_grazing_and_what_follows_can_be_asked)
{
    static const double gaps[] = {1e-14, 1e-13, 1e-12};
    for (size_t k = 0; k < ROWS_OF(gaps); ++k) {
        impact_scene s;
        const mote_impact_found found = pass_beside(gaps[k], &s);
        assert_int_equal(found.outcome, MOTE_IMPACT_GRAZING);
        assert_true(found.from > 1 / 3.0 - 1e-9 && found.from < 1 / 3.0 + 1e-2);
        assert_true(found.to >= 2 / 3.0 && found.to < 0.75);
        assert_true(fabs(found.distance - gaps[k]) < 1e-11);
        assert_true(fabs(mote_length(found.normal) - 1) < 1e-12);
        mote_impact_question rest = impact_question(&s, 0);
        rest.begin = found.to;
        assert_int_equal(impact_ask(&s, rest).outcome, MOTE_IMPACT_NONE);
        impact_scene_free(&s);
    }
}

TEST(mote_impact_query_pass_that_touches_is_found)
{
    impact_scene s;
    const mote_impact_found touch = pass_beside(0, &s);
    impact_check_found(&touch, 1 / 3.0);
    impact_scene_free(&s);
    const mote_impact_found none = pass_beside(1e-9, &s);
    assert_int_equal(none.outcome, MOTE_IMPACT_NONE);
    impact_scene_free(&s);
}

/* The bodies graze, part, and meet: what ends the grazing is where to ask again. */
TEST(mote_impact_query_impact_after_a_grazing_is_found_when_asked_again)
{
    impact_scene s;
    pass_beside(1e-13, &s);
    s.of[0].path.count = s.of[1].path.count = 2;
    s.of[0].piece[1] = s.of[0].piece[0];
    s.of[1].piece[1] = s.of[1].piece[0];
    mote_path_line(mote_vec3_make(1 + 1e-13, 3, 0), mote_vec3_make(0, 0, 0),
                   s.of[1].piece[1].centre); /* y = 1 after two thirds of the piece */
    const mote_impact_found grazing = impact_ask(&s, impact_question(&s, 0));
    assert_int_equal(grazing.outcome, MOTE_IMPACT_GRAZING);
    mote_impact_question rest = impact_question(&s, 0);
    rest.begin = grazing.to;
    const mote_impact_found hit = impact_ask(&s, rest);
    impact_check_found(&hit, 0.5 + 1 / 3.0);
    impact_scene_free(&s);
}

/* It rests within rounding through piece 0, and goes in and out again in a twelfth of piece 1:
   looks start anew with each piece, and do not pass over that. */
TEST(mote_impact_query_short_impact_after_a_rest_within_rounding)
{
    impact_scene s;
    const mote_vec3 rest = mote_vec3_make(1 + 1e-13, 0, 0);
    two_cubes(&s, rest, rest, mote_vec3_make(0, 0, 0));
    s.of[0].path.count = s.of[1].path.count = 2;
    s.of[0].piece[1] = s.of[0].piece[0];
    s.of[1].piece[1] = s.of[1].piece[0];
    mote_vec3 *b = s.of[1].piece[1].centre; /* inwards until u = 1/11, outwards after it */
    b[0] = rest;
    b[1] = mote_vec3_make(rest.x - 0.1, 0, 0);
    b[2] = mote_vec3_make(rest.x + 1, 0, 0);
    b[3] = mote_vec3_make(rest.x + 3, 0, 0);
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 0));
    assert_int_equal(found.outcome, MOTE_IMPACT_FOUND);
    assert_true(found.from <= 0.5 && found.to >= 0.5 && found.to < 0.5 + 1e-9);
    impact_scene_free(&s);
}

/* The iterations end while the search only looks. */
TEST(mote_impact_query_iterations_are_spent_on_looks)
{
    impact_scene s;
    two_cubes(&s, mote_vec3_make(1 + 1e-13, -0.5, 0), mote_vec3_make(1 + 1e-13, 0.5, 0),
              mote_vec3_make(0, 0, 0));
    const mote_impact_found all = impact_ask(&s, impact_question(&s, 0));
    assert_int_equal(all.outcome, MOTE_IMPACT_GRAZING);
    assert_true(all.from <= 0 && all.to >= 1);
    assert_true(all.iterations > 10);
    s.search->options.iterations = 10;
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 0));
    assert_int_equal(found.outcome, MOTE_IMPACT_UNDECIDED);
    assert_int_equal(found.iterations, 10);
    assert_true(found.from <= 0 && found.to <= 0);
    assert_true(fabs(found.distance - 1e-13) < 1e-15);
    impact_scene_free(&s);
}
