/* The methods that answer impacts, through the interface: certified, and the control
   impact-sampled. */
#include "core/method/impact_method.h"

#include "tests/support/impact_scene.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"

/* Two boxes of length 1, asked by a method. */
typedef struct asked {
    impact_scene s;
    const mote_impact_method *method;
    double values[MOTE_PARAMETERS_MAX];
    void *state;
} asked;

static void asked_init(asked *a, const char *name, const char *keys, double tolerance)
{
    impact_scene_init(&a->s, impact_box(1, 1, 1), impact_box(1, 1, 1), IMPACT_RIGID, 1);
    (void)method_with(name, keys, a->values);
    a->method = mote_impact_method_find(name);
    assert_non_null(a->method);
    const mote_setup setup = {.body = {&a->s.of[0].body, &a->s.of[1].body},
                              .length = a->s.length,
                              .ask = MOTE_ASK_IMPACT,
                              .tolerance = tolerance,
                              .seed = 1,
                              .values = a->values};
    assert_int_equal(a->method->create(&setup, 2, &a->state), MOTE_OK);
}

static void asked_free(asked *a)
{
    a->method->destroy(a->state);
    impact_scene_free(&a->s);
}

static mote_status query(asked *a, mote_impact_answer *answer)
{
    const mote_path *const path[2] = {&a->s.of[0].path, &a->s.of[1].path};
    *answer = (mote_impact_answer){.answered = false};
    return a->method->query(a->state, path, answer);
}

/* Body 1's middle goes along x. */
static mote_impact_answer move(asked *a, double from, double to)
{
    mote_impact_answer answer;
    mote_path_line(mote_vec3_make(from, 0.1, 0), mote_vec3_make(to, 0.1, 0),
                   a->s.of[1].piece[0].centre);
    if (query(a, &answer) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return answer;
}

static void check_impact(const mote_impact_answer *answer, double time, double tolerance)
{
    assert_true(answer->answered && answer->impact && answer->has_witness);
    assert_true(answer->from <= time && time <= answer->to + 1e-12);
    assert_true(answer->to - answer->from <= 1.0001e-6);
    const mote_vec3 gap = mote_sub(answer->witness[1], answer->witness[0]);
    assert_true(mote_length(gap) <= tolerance);
    assert_true(answer->iterations > 0);
}

/* Faces at 0.5 and 4.5 - 5 t: both methods find the same, the one by proof, the other as it
   looks at 11 moments and bisects. */
TEST(impact_methods_find_when_boxes_meet)
{
    static const char *const names[] = {"certified", "impact-sampled"};
    static const double tolerances[] = {0, 0.25};
    for (int m = 0; m < 2; ++m) {
        for (int k = 0; k < 2; ++k) {
            asked a;
            test_row("%s, tolerance %g", names[m], tolerances[k]);
            asked_init(&a, names[m], "", tolerances[k]);
            const mote_impact_answer hit = move(&a, 5, 0);
            check_impact(&hit, (4 - tolerances[k]) / 5, tolerances[k]);
            const mote_impact_answer start = move(&a, 0.75, 5);
            check_impact(&start, 0, tolerances[k]);
            assert_true(!(start.to > 0));
            assert_int_equal(start.iterations, 1);
            const mote_impact_answer none = move(&a, 5, 2);
            assert_true(none.answered && !none.impact && !none.has_witness);
            assert_true(none.from >= 1);
            asked_free(&a);
        }
    }
}

/* It is through within a tenth of the time: only what is proven sees it. */
TEST(impact_sampled_misses_what_passes_between_two_moments)
{
    static const struct {
        const char *name, *keys;
        bool sees;
    } rows[] = {{"certified", "", true},
                {"impact-sampled", "samples=1", false},
                {"impact-sampled", "samples=10", false},
                {"impact-sampled", "samples=1000", true}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        asked a;
        test_row("%s:%s", rows[i].name, rows[i].keys);
        asked_init(&a, rows[i].name, rows[i].keys, 0);
        const mote_impact_answer answer = move(&a, 51.3, -48.7);
        assert_int_equal(answer.impact, rows[i].sees);
        if (rows[i].sees)
            check_impact(&answer, 0.503, 0); /* 50.8 - 100 t = 0.5 */
        asked_free(&a);
    }
}

/* A distance that is the tolerance but for rounding is no answer; a path that is wrong is
   refused. */
TEST(impact_method_certified_without_an_answer)
{
    asked a;
    mote_impact_answer answer;
    asked_init(&a, "certified", "", 1 - 1e-15);
    mote_path_line(mote_vec3_make(2, 0, 0), mote_vec3_make(2, 0.5, 0),
                   a.s.of[1].piece[0].centre);
    assert_int_equal(query(&a, &answer), MOTE_OK);
    assert_true(!answer.answered && !answer.impact && !answer.has_witness);
    assert_in_range(answer.iterations, 2, 300); /* it looks for a touch until the end */
    a.s.of[1].piece[0].centre[2].y = NAN;
    assert_int_equal(query(&a, &answer), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "centre in piece 0 of body 1"));
    assert_int_equal(answer.iterations, 0);
    asked_free(&a);
}

/* impact-sampled answers nothing else. */
TEST(impact_sampled_refuses_distances_and_contacts)
{
    asked a;
    asked_init(&a, "impact-sampled", "", 0);
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *method = method_with("impact-sampled", "", values);
    const mote_setup setup = {
        .body = {&a.s.of[0].body, &a.s.of[1].body}, .length = a.s.length, .values = values};
    void *state = NULL;
    assert_true(a.method->alone && method->traits(values).needs_field);
    assert_int_equal(method->create(&setup, &state), MOTE_EUNSUPPORTED);
    assert_non_null(strstr(mote_error_text(), "answers impacts alone"));
    assert_null(state);
    mote_answer answer = {.has_distance = false};
    assert_int_equal(method->query(state, NULL, &answer), MOTE_EUNSUPPORTED);
    assert_false(answer.has_distance);
    asked_free(&a);
}
