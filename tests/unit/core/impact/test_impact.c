/* The time of impact: closed forms, the ends of what may be asked, and random paths against
   samples (tests/studies/impacts.c has many more). */
#include "core/impact/impact.h"

#include "core/skin/skin.h"
#include "harness/base/heap_count.h"
#include "tests/unit/core/impact/impact_ask.h"

static const double pi = 3.141592653589793;

static void check_close(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g and %.17g differ by more than %g", a, b, tolerance);
}

/* Two boxes; body 0 stands at the origin. */
static void two_boxes(impact_scene *s, double a, double b)
{
    impact_scene_init(s, impact_box(a, a, a), impact_box(b, b, b), IMPACT_RIGID, 1);
}

TEST(mote_impact_query_boxes_on_a_line_meet_when_they_must)
{
    static const double tolerances[] = {0, 1e-9, 0.1, 1};
    static const double sizes[] = {1, 1e-9, 1e30, 1e-128, 1e128};
    for (size_t k = 0; k < ROWS_OF(sizes); ++k) {
        const double size = sizes[k];
        impact_scene s;
        two_boxes(&s, 2 * size, size);
        mote_path_line(mote_vec3_make(5 * size, 0.1 * size, 0),
                       mote_vec3_make(-5 * size, 0.1 * size, 0), s.of[1].piece[0].centre);
        for (int i = 0; i < 4; ++i) {
            const double tolerance = tolerances[i] * size;
            const mote_impact_found found = impact_ask(&s, impact_question(&s, tolerance));
            /* faces at 1 and 4.5 - 10 t */
            impact_check_found(&found, (3.5 - tolerances[i]) / 10);
            assert_true(found.distance <= tolerance);
            check_close(found.normal.x, 1, 1e-9);
            check_close(found.witness[0].x, size, 2e-5 * size);
        }
        impact_scene_free(&s);
    }
}

/* It passes through within a hundredth of the time, and is away again at any sample of 20. */
TEST(mote_impact_query_fast_body_does_not_pass)
{
    impact_scene s;
    two_boxes(&s, 0.5, 0.5);
    mote_path_line(mote_vec3_make(51.3, 0, 0), mote_vec3_make(-48.7, 0, 0),
                   s.of[1].piece[0].centre);
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 1e-3));
    impact_check_found(&found, (51.3 - 0.501) / 100);
    impact_scene_free(&s);
}

/* A bar of half length 1 turns about its middle; a small box beyond stands in the way of its
   tip. The corner (1, 0.05) of the bar comes to the box's face x = 0.9 at an angle from above.
 */
TEST(mote_impact_query_spinning_bar_meets_a_wall)
{
    static const double turns[] = {0.4, 3, 20};
    for (int k = 0; k < 3; ++k) {
        impact_scene s;
        impact_scene_init(&s, impact_box(2, 0.1, 0.1), impact_box(1, 4, 1), IMPACT_RIGID, 1);
        mote_path_piece *bar = s.of[0].piece;
        bar->spins = true;
        bar->turn[0] = impact_spun(mote_vec3_make(0, 0, pi / 2), bar->turn[0]);
        bar->spin = mote_vec3_make(0, 0, -2 * pi * turns[k]);
        for (int i = 0; i < 4; ++i)
            s.of[1].piece[0].centre[i] = mote_vec3_make(1.4, 0, 0);
        const mote_impact_found found = impact_ask(&s, impact_question(&s, 0));
        /* the upper right corner's radius and angle, as seen from the bar's axis */
        const double radius = sqrt(1 + 0.05 * 0.05), corner = atan2(0.05, 1);
        const double angle = pi / 2 - acos(0.9 / radius) - corner;
        impact_check_found(&found, angle / (2 * pi * turns[k]));
        impact_scene_free(&s);
    }
}

/* Out and back within the interval: at both ends the bodies are as far apart as can be. */
TEST(mote_impact_query_body_that_returns)
{
    impact_scene s;
    two_boxes(&s, 1, 1);
    mote_path_piece *p = s.of[1].piece;
    p->centre[0] = p->centre[3] = mote_vec3_make(3, 0.2, 0.1);
    p->centre[1] = p->centre[2] = mote_vec3_make(0, 0.2, 0.1); /* x = 3 - 9 t (1 - t) */
    const mote_impact_found hit = impact_ask(&s, impact_question(&s, 0));
    impact_check_found(&hit, 0.5 - sqrt(0.25 - 2.0 / 9));
    const mote_impact_found touch = impact_ask(&s, impact_question(&s, 0.5));
    impact_check_found(&touch, 0.5 - sqrt(0.25 - 1.5 / 9));
    p->centre[1] = p->centre[2] = mote_vec3_make(1, 0.2, 0.1); /* 3 - 6 t (1 - t): to 1.5 */
    const mote_impact_found none = impact_ask(&s, impact_question(&s, 0.4999));
    assert_int_equal(none.outcome, MOTE_IMPACT_NONE);
    assert_true(none.from >= 1);
    const mote_impact_found near = impact_ask(&s, impact_question(&s, 0.5001));
    impact_check_found(&near, 0.5 - sqrt(0.25 - 1.4999 / 6));
    impact_scene_free(&s);
}

TEST(mote_impact_query_both_still_and_touching_at_the_start)
{
    impact_scene s;
    two_boxes(&s, 1, 1);
    for (int i = 0; i < 4; ++i)
        s.of[1].piece[0].centre[i] = mote_vec3_make(2, 0, 0);
    const mote_impact_found apart = impact_ask(&s, impact_question(&s, 0.5));
    assert_int_equal(apart.outcome, MOTE_IMPACT_NONE);
    assert_int_equal(apart.iterations, 1);
    const mote_impact_found touching = impact_ask(&s, impact_question(&s, 1));
    assert_int_equal(touching.outcome, MOTE_IMPACT_FOUND);
    check_close(touching.from, 0, 0);
    check_close(touching.to, 0, 0);
    for (int i = 0; i < 4; ++i)
        s.of[1].piece[0].centre[i] = mote_vec3_make(0.9, 0, 0);
    const mote_impact_found within = impact_ask(&s, impact_question(&s, 0));
    assert_int_equal(within.outcome, MOTE_IMPACT_FOUND);
    check_close(within.to, 0, 0);
    assert_true(!(mote_length(within.normal) > 0));
    impact_scene_free(&s);
}

/* Just above the tolerance, where nothing can be told from rounding. */
TEST(mote_impact_query_distance_of_the_tolerance_is_grazing)
{
    impact_scene s;
    two_boxes(&s, 1, 1);
    mote_path_line(mote_vec3_make(2, 0, 0), mote_vec3_make(2, 0.5, 0), s.of[1].piece[0].centre);
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 1 - 1e-15));
    assert_int_equal(found.outcome, MOTE_IMPACT_GRAZING);
    check_close(found.distance, 1, 1e-12);
    impact_scene_free(&s);
}

TEST(mote_impact_query_gives_up_after_its_iterations)
{
    impact_scene s;
    two_boxes(&s, 1, 1);
    mote_impact_options options = mote_default_impact_options(s.length);
    options.iterations = 2;
    const mote_body *const bodies[2] = {&s.of[0].body, &s.of[1].body};
    mote_impact_search *few = NULL;
    assert_int_equal(mote_impact_create(bodies, &options, &few), MOTE_OK);
    for (int b = 0; b < 2; ++b) {
        s.of[b].piece[0].spins = true;
        s.of[b].piece[0].spin = mote_vec3_make(1000, 0, 0);
    }
    mote_path_line(mote_vec3_make(3, 0, 0), mote_vec3_make(1.01, 0, 0),
                   s.of[1].piece[0].centre);
    const mote_impact_question question = impact_question(&s, 0);
    mote_impact_found found;
    assert_int_equal(mote_impact_query(few, &question, &found), MOTE_OK);
    assert_int_equal(found.outcome, MOTE_IMPACT_UNDECIDED);
    assert_true(found.from < 1 && found.distance > 0);
    mote_impact_destroy(few);
    impact_scene_free(&s);
}

/* An impact is the same one, whatever part of the path before it is asked about. */
TEST(mote_impact_query_parts_of_the_interval)
{
    impact_scene s;
    two_boxes(&s, 1, 1);
    mote_path_line(mote_vec3_make(6, 0, 0), mote_vec3_make(-4, 0, 0), s.of[1].piece[0].centre);
    mote_impact_question question = impact_question(&s, 0);
    question.end = 0.49;
    assert_int_equal(impact_ask(&s, question).outcome, MOTE_IMPACT_NONE);
    question.begin = question.end;
    assert_int_equal(impact_ask(&s, question).outcome, MOTE_IMPACT_NONE); /* empty */
    question.end = 0.6;
    const mote_impact_found found = impact_ask(&s, question);
    impact_check_found(&found, 0.5);
    question.begin = question.end = 0.55;
    assert_int_equal(impact_ask(&s, question).outcome, MOTE_IMPACT_FOUND);
    impact_scene_free(&s);
}

/* The same path in one piece and in four. */
TEST(mote_impact_query_pieces_change_nothing)
{
    impact_scene s;
    two_boxes(&s, 1, 1);
    mote_path_line(mote_vec3_make(6, 0, 0), mote_vec3_make(-4, 0, 0), s.of[1].piece[0].centre);
    check_close(impact_ask(&s, impact_question(&s, 0)).to, 0.5, 2e-6);
    for (int k = 0; k < 4; ++k)
        mote_path_line(mote_vec3_make(6 - 2.5 * k, 0, 0), mote_vec3_make(3.5 - 2.5 * k, 0, 0),
                       s.of[1].piece[k].centre);
    s.of[0].path.count = s.of[1].path.count = 4;
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 0));
    impact_check_found(&found, 0.5);
    impact_scene_free(&s);
}

static void check_refused(impact_scene *s, const mote_impact_question *question,
                          const char *part)
{
    mote_impact_found found;
    assert_int_equal(mote_impact_query(s->search, question, &found), MOTE_EINVAL);
    if (!strstr(mote_error_text(), part))
        fail_msg("\"%s\" does not say \"%s\"", mote_error_text(), part);
}

TEST(mote_impact_query_bad_questions_are_refused)
{
    impact_scene s;
    two_boxes(&s, 1, 1);
    mote_path_line(mote_vec3_make(6, 0, 0), mote_vec3_make(4, 0, 0), s.of[1].piece[0].centre);
    const mote_impact_question good = impact_question(&s, 0.1);
    static const double intervals[][2] = {{0.5, 0.4}, {-0.1, 1}, {0, 1.1},
                                          {NAN, 1},   {0, NAN},  {0, INFINITY}};
    for (size_t i = 0; i < sizeof intervals / sizeof intervals[0]; ++i) {
        mote_impact_question q = good;
        q.begin = intervals[i][0];
        q.end = intervals[i][1];
        check_refused(&s, &q, "two times within 0 and 1");
    }
    static const double tolerances[] = {-1, NAN, INFINITY};
    for (int i = 0; i < 3; ++i) {
        mote_impact_question q = good;
        q.tolerance = tolerances[i];
        check_refused(&s, &q, "a tolerance of");
    }
    s.of[1].path.count = 2;
    s.of[1].piece[1] = s.of[1].piece[0];
    check_refused(&s, &good, "does not begin where");
    mote_path_line(mote_vec3_make(4, 0, 0), mote_vec3_make(4, 0, 0), s.of[1].piece[1].centre);
    check_refused(&s, &good, "give both as many");
    s.of[1].path.count = 0;
    check_refused(&s, &good, "has 0 pieces");
    s.of[1].path.count = 129;
    check_refused(&s, &good, "takes 1 to 128");
    s.of[1].path.count = 1;
    s.of[1].path.pivot.y = NAN;
    check_refused(&s, &good, "pivot of body 1");
    impact_scene_free(&s);
}

TEST(mote_impact_query_bad_pieces_are_refused)
{
    impact_scene s;
    impact_scene_init(&s, make_torus(7, 5, 1), impact_box(1, 1, 1), IMPACT_CSRBF, 1);
    const mote_impact_question good = impact_question(&s, 0.1);
    mote_path_piece *p = s.of[0].piece;
    const mote_path_piece kept = *p;
    p->centre[2].y = INFINITY;
    check_refused(&s, &good, "centre in piece 0 of body 0");
    *p = kept;
    s.of[0].control[0][3] = NAN;
    check_refused(&s, &good, "weight in piece 0 of body 0");
    s.of[0].control[0][3] = 0;
    p->turn[2] = (mote_quaternion){-1, 0, 0, 0};
    check_refused(&s, &good, "pass near 0");
    p->turn[2].w = NAN;
    check_refused(&s, &good, "pass near 0");
    static const double lengths[] = {0, 1e-160, 1e150, 1e160}; /* squares of the
                                                                  last are infinite */
    for (size_t i = 0; i < ROWS_OF(lengths); ++i) {
        for (int k = 0; k < 4; ++k)
            p->turn[k].w = lengths[i];
        check_refused(&s, &good, "pass near 0");
    }
    *p = kept;
    p->spins = true;
    p->spin.z = 2 * MOTE_PATH_SPIN_MAX;
    check_refused(&s, &good, "radians");
    p->spin.z = NAN;
    check_refused(&s, &good, "radians");
    p->spin.z = 1;
    p->turn[0].w = 2;
    check_refused(&s, &good, "squared length");
    impact_scene_free(&s);
}

/* Of a field that is not linear in its weights. */
static mote_vec3 bend(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                      const mote_weights *weights)
{
    (void)field, (void)mesh, (void)vertex;
    return mote_vec3_make(sin(weights->x[0]), 0, 0);
}

TEST(mote_impact_create_refuses_what_it_cannot_answer)
{
    impact_scene s;
    two_boxes(&s, 1, 1);
    const mote_body *const bodies[2] = {&s.of[0].body, &s.of[1].body};
    mote_impact_search *made = NULL;
    static const struct {
        mote_impact_options options; /* length, resolution, pieces, iterations */
        const char *says;
    } bad[] = {{{0, 1e-6, 1, 1, 0}, "a length of 0"},
               {{INFINITY, 1e-6, 1, 1, 0}, "a length of inf"},
               {{NAN, 1e-6, 1, 1, 0}, "a length of"},
               {{1, 0, 1, 1, 0}, "a resolution of 0"},
               {{1, NAN, 1, 1, 0}, "a resolution of"},
               {{1, 1.5, 1, 1, 0}, "a resolution of 1.5"},
               {{1, 1e-6, 0, 1, 0}, "0 pieces and 1 iterations"},
               {{1, 1e-6, 1048577, 1, 0}, "1048577 pieces"},
               {{1, 1e-6, 1, 0, 0}, "1 pieces and 0 iterations"}};
    for (size_t i = 0; i < ROWS_OF(bad); ++i) {
        test_row("%s", bad[i].says);
        assert_int_equal(mote_impact_create(bodies, &bad[i].options, &made), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), bad[i].says));
    }
    const mote_impact_options options = mote_default_impact_options(s.length);
    const mote_field_kind kind = {.name = "bent", .displacement = bend};
    const mote_field bent = {.kind = &kind, .count = 1, .padded = MOTE_LANES};
    const mote_body rod = {.mesh = s.of[0].mesh, .field = &bent};
    const mote_body *const bending[2] = {bodies[0], &rod};
    assert_int_equal(mote_impact_create(bending, &options, &made), MOTE_EUNSUPPORTED);
    assert_null(made);
    impact_scene_free(&s);
}

/* Their weights, pure numbers, are squared: those of such modes leave the range of doubles. */
TEST(mote_impact_create_modes_that_move_far_beyond_or_below_the_bodies_are_refused)
{
    static const struct {
        double size;
        mote_status status;
    } rows[] = {{0, MOTE_OK},          {1e-99, MOTE_OK},     {1e99, MOTE_OK},
                {1e-101, MOTE_EINVAL}, {1e101, MOTE_EINVAL}, {1e300, MOTE_EINVAL}};
    impact_scene s;
    two_boxes(&s, 1, 1);
    const mote_impact_options options = mote_default_impact_options(1);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("a mode of %g", rows[i].size);
        mote_vec3 moves[8] = {{0}};
        moves[3].y = -rows[i].size;
        mote_field *field = NULL;
        assert_int_equal(mote_field_create_modes(moves, 1, 8, &field), MOTE_OK);
        const mote_body moved = {.mesh = s.of[0].mesh, .field = field};
        const mote_body *const bodies[2] = {&s.of[1].body, &moved};
        mote_impact_search *made = NULL;
        assert_int_equal(mote_impact_create(bodies, &options, &made), rows[i].status);
        if (rows[i].status != MOTE_OK)
            assert_non_null(strstr(mote_error_text(), "mode 0 of body 1 moves"));
        mote_impact_destroy(made);
        mote_field_destroy(field);
    }
    impact_scene_free(&s);
}

/* Random paths of every kind of field: no sample before the bracket is in contact, and at its
   end all pairs of triangles are. */
static void check_random(impact_scene *s, double tolerance)
{
    const mote_impact_found found = impact_ask(s, impact_question(s, tolerance));
    for (int i = 0; i <= 40; ++i) {
        const double time = i / 40.0 * found.from;
        if (i < 40 || found.outcome == MOTE_IMPACT_NONE)
            assert_true(impact_distance(s, time) > tolerance);
    }
    if (found.outcome == MOTE_IMPACT_FOUND) {
        const double distance = impact_distance(s, found.to);
        assert_true(distance <= tolerance);
        check_close(distance, found.distance, 1e-12 * s->length);
        assert_true(found.to - found.from <= 1.0001e-6);
    }
}

TEST(mote_impact_query_random_paths_agree_with_samples)
{
    for (int kind = 0; kind < 2 * IMPACT_KINDS; ++kind) {
        impact_scene s;
        impact_scene_init_patient(&s, make_torus(9, 5, 1), make_torus(7, 5, 0.7),
                                  (impact_kind)(kind / 2), (uint64_t)kind, kind % 2 ? 0 : 10);
        for (int k = 0; k < 6; ++k) {
            for (int b = 0; b < 2; ++b) {
                const impact_wild w = {.pieces = 1 + 2 * (uint32_t)(k % 3),
                                       .from = mote_vec3_make(b ? 3 : 0, 0.4 * k - 2, 0),
                                       .to = mote_vec3_make(b ? -1 : 1, 1, 0.5),
                                       .stray = 0.3,
                                       .turn = k % 4,
                                       .spins = k % 2 == 0,
                                       .weights = 0.1};
                impact_path_random(&s.of[b], &w, &s.random);
            }
            check_random(&s, k % 3 ? 0.01 * s.length : 0);
        }
        impact_scene_free(&s);
    }
}

/* A bar that turns away from a small box and, in the second piece, back to it. The second piece
   has the negative quaternions of the first: the derivatives of both are the same where they
   join, but the angular velocity is reversed. */
TEST(mote_impact_query_bar_that_turns_back_by_negative_quaternions)
{
    for (int k = 0; k < 12; ++k) {
        impact_scene s;
        impact_scene_init_patient(&s, impact_box(2, 0.1, 0.1), impact_box(0.1, 0.1, 0.1),
                                  IMPACT_RIGID, 1, k % 2 ? 0 : 10);
        const double most = 0.2 + 0.03 * k, at = 2 * atan(most) - 0.3; /* of the box */
        s.of[0].path.count = s.of[1].path.count = 2;
        for (int i = 0; i < 4; ++i) {
            const mote_quaternion q = {1, 0, 0, most * i / 3};
            s.of[0].piece[0].turn[i] = q;
            s.of[0].piece[1].turn[3 - i] = (mote_quaternion){-q.w, -q.x, -q.y, -q.z};
            for (int piece = 0; piece < 2; ++piece)
                s.of[1].piece[piece].centre[i] =
                    mote_vec3_make(0.9 * cos(at), 0.9 * sin(at), 0);
        }
        mote_impact_question question = impact_question(&s, 0);
        question.begin = 0.46;
        double apart = 0.5, met = 1 - 0.5 * tan(at / 2) / most; /* the bar is amid the box */
        assert_true(impact_distance(&s, question.begin) > 0.01);
        for (int i = 0; i < 40; ++i) {
            const double middle = 0.5 * (apart + met);
            *(impact_distance(&s, middle) > 0 ? &apart : &met) = middle;
        }
        const mote_impact_found found = impact_ask(&s, question);
        impact_check_found(&found, apart);
        impact_scene_free(&s);
    }
}

/* A body that passes another at a thousandth of its size: speeds alone need hundreds of steps,
   directions a few, and both find the same. */
TEST(mote_impact_query_sweeps_save_iterations)
{
    uint32_t iterations[2];
    for (int k = 0; k < 2; ++k) {
        impact_scene s;
        impact_scene_init_patient(&s, impact_box(1, 1, 1), impact_box(1, 1, 1), IMPACT_RIGID, 1,
                                  k ? 0 : UINT32_MAX);
        mote_path_line(mote_vec3_make(-3, 1.001, 0), mote_vec3_make(3, 1.001, 0),
                       s.of[1].piece[0].centre);
        const mote_impact_found past = impact_ask(&s, impact_question(&s, 1e-6));
        assert_int_equal(past.outcome, MOTE_IMPACT_NONE);
        iterations[k] = past.iterations;
        const mote_impact_found hit = impact_ask(&s, impact_question(&s, 0.0011));
        impact_check_found(&hit, (2 - sqrt(0.0011 * 0.0011 - 0.001 * 0.001)) / 6);
        impact_scene_free(&s);
    }
    assert_true(iterations[0] > 500);
    assert_true(iterations[1] < 20);
}

/* A target that pulls the box's face x = 0.5 out by its amount, before a bone turns the box by
   a quarter about z: what was pulled out meets a box above. */
TEST(mote_impact_query_a_target_before_a_bone)
{
    for (int bones = 0; bones < 2; ++bones) {
        impact_scene s;
        impact_scene_init(&s, impact_box(1, 1, 1), impact_box(1, 1, 1), IMPACT_RIGID, 1);
        const mote_mesh *mesh = s.of[0].mesh;
        const uint32_t start[] = {0, 4}, vertex[] = {1, 3, 5, 7};
        const mote_vec3 move[] = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
        const mote_morph_targets targets = {1, start, vertex, move};
        const uint32_t first[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
        const uint16_t bone[8] = {0};
        const double weight[] = {1, 1, 1, 1, 1, 1, 1, 1};
        mote_field *field = NULL;
        assert_int_equal(mote_field_create_morphs(mesh, (uint32_t)bones, bones ? first : NULL,
                                                  bones ? bone : NULL, bones ? weight : NULL,
                                                  &targets, &field),
                         MOTE_OK);
        const mote_body body = {.mesh = mesh, .field = field};
        const mote_body *const bodies[2] = {&body, &s.of[1].body};
        const mote_impact_options options = mote_default_impact_options(s.length);
        mote_impact_search *search = NULL;
        assert_int_equal(mote_impact_create(bodies, &options, &search), MOTE_OK);
        const double quarter[1][3][4] = {{{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}}};
        const mote_mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        const size_t n = field->padded;
        double control[12 * 64] = {0};
        assert_true(n <= 64);
        for (size_t i = 0; i < 4; ++i) {
            const double amount = (double)i; /* 3 t */
            mote_morph_weights(field, bones ? quarter : NULL, &amount, &same,
                               control + 3 * i * n, control + (3 * i + 1) * n,
                               control + (3 * i + 2) * n);
        }
        s.of[0].piece[0].weights = control;
        for (int i = 0; i < 4; ++i)
            s.of[1].piece[0].centre[i] =
                bones ? mote_vec3_make(0.1, 2.5, 0) : mote_vec3_make(2.5, 0.1, 0);
        const mote_impact_question question = impact_question(&s, 0);
        mote_impact_found found;
        assert_int_equal(mote_impact_query(search, &question, &found), MOTE_OK);
        impact_check_found(&found, 0.5); /* 0.5 + 3 t = 2 */
        check_close(bones ? found.normal.y : found.normal.x, 1, 1e-9);
        /* of the rotation's columns, behind the bone's four; of the amount, in y */
        const size_t wrong[] = {4 + 1, n + field->count - 1};
        for (size_t i = 0; i < ROWS_OF(wrong); ++i) {
            const double kept = control[wrong[i]];
            control[wrong[i]] = 0.5;
            assert_int_equal(mote_impact_query(search, &question, &found), MOTE_EINVAL);
            assert_true(strstr(mote_error_text(), "mote_morph_weights"));
            control[wrong[i]] = kept;
        }
        mote_impact_destroy(search);
        s.of[0].piece[0].weights = NULL;
        mote_field_destroy(field);
        impact_scene_free(&s);
    }
}

TEST(mote_impact_query_does_not_allocate)
{
    impact_scene s;
    impact_scene_init_patient(&s, make_torus(9, 5, 1), make_torus(7, 5, 0.7), IMPACT_CSRBF, 5,
                              0);
    const impact_wild w = {.pieces = 3,
                           .from = {3, 0, 0},
                           .to = {-2, 0, 0},
                           .turn = 1,
                           .spins = true,
                           .weights = 0.1};
    impact_path_random(&s.of[1], &w, &s.random);
    const impact_wild still = {.pieces = 3};
    impact_path_random(&s.of[0], &still, &s.random);
    const mote_impact_question question = impact_question(&s, 0.01);
    mote_impact_found found;
    const uint64_t before = mote_heap_read().allocations;
    assert_int_equal(mote_impact_query(s.search, &question, &found), MOTE_OK);
    assert_int_equal(mote_heap_read().allocations, before);
    assert_true(mote_impact_bytes(s.search) > 1000);
    impact_scene_free(&s);
}

/* What a search says that it holds is what the heap holds, of small bodies and of fine ones. */
TEST(mote_impact_bytes_are_those_of_the_heap)
{
    static const uint32_t across[] = {9, 90};
    for (size_t k = 0; k < ROWS_OF(across); ++k) {
        impact_scene s;
        impact_scene_init(&s, make_torus(across[k], 50, 1), make_torus(7, 5, 0.7), IMPACT_CSRBF,
                          1);
        assert_true((s.of[0].mesh->vertex_count > 4096) == (k == 1));
        const mote_body *const bodies[2] = {&s.of[0].body, &s.of[1].body};
        const mote_impact_options options = mote_default_impact_options(s.length);
        mote_impact_search *search = NULL;
        const int64_t before = mote_heap_read().live_bytes;
        assert_int_equal(mote_impact_create(bodies, &options, &search), MOTE_OK);
        const double held = (double)(mote_heap_read().live_bytes - before);
        if (mote_heap_read().counted) /* a sanitizer counts no heap */
            check_close((double)mote_impact_bytes(search), held, 0.05 * held);
        mote_impact_destroy(search);
        impact_scene_free(&s);
    }
}
