/* Coal's methods against brute force, if Coal was found. */
#include "tests/support/shapes.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

#include <stdio.h>

typedef struct variant {
    const char *method, *options;
} variant;

static const variant distances[] = {
    {"coal-aabb", ""},
    {"coal-aabb", "call=api"},
    {"coal-aabb", "bound=full"},
    {"coal-aabb", "bound=full,seed=previous"},
    {"coal-aabb", "bound=full,queue=64"},
    {"coal-aabb", "update=refit-top-down"},
    {"coal-aabb", "update=rebuild,positions=given"},
    {"coal-rss", ""},
    {"coal-rss", "call=api"},
    {"coal-obbrss", "seed=previous,queue=64"},
    {"coal-kios", ""},
};

static const variant rigid[] = {
    {"coal-rss", "update=none"},
    {"coal-obbrss", "update=none,seed=previous"},
    {"coal-kios", "update=none,call=api"},
};

static const variant contacts[] = {
    {"coal-aabb", ""},         {"coal-aabb", "contact=distance,bound=full"},
    {"coal-aabb", "call=api"}, {"coal-rss", ""},
    {"coal-obbrss", ""},       {"coal-kios", "contact=distance"},
};

static bool is_missing(void)
{
    if (mote_method_find("coal-aabb"))
        return false;
    (void)fprintf(stderr, "skipped: Coal was not found when this was built\n");
    return true;
}

static mote_status make(const variant *v, const scene *s, mote_ask ask, double tolerance,
                        void **state)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = method_with(v->method, v->options, values);
    const mote_setup setup = scene_setup(s, ask, tolerance, values);
    return m->create(&setup, state);
}

static mote_answer ask_one(const variant *v, void *state, const mote_frame *frame)
{
    return method_answer(mote_method_find(v->method), state, frame);
}

static void expect_distances(const variant *v, double size, bool deforming)
{
    scene s;
    void *state = NULL;
    scene_init(&s, 14, 9, size, deforming);
    assert_int_equal(make(v, &s, MOTE_ASK_DISTANCE, 0, &state), MOTE_OK);
    int touching = 0;
    for (int f = 0; f < 30; ++f) {
        const mote_frame *frame = scene_next(&s, 1.3, false);
        const double expected = scene_truth(&s);
        const mote_answer a = ask_one(v, state, frame);
        touching += expected == 0;
        assert_true(a.has_distance);
        if (!(fabs(a.distance - expected) <= 1e-12 * s.length))
            fail_msg("%s:%s frame %d: %.17g instead of %.17g", v->method, v->options, f,
                     a.distance, expected);
        if (a.has_witness)
            assert_true(fabs(mote_length(mote_sub(a.witness[0], a.witness[1])) - expected) <=
                        1e-12 * s.length);
        assert_true(a.has_witness || expected == 0);
    }
    assert_in_range(touching, 3, 27);
    mote_method_find(v->method)->destroy(state);
    scene_free(&s);
}

TEST(distances_agree_with_brute_force)
{
    if (is_missing())
        return;
    for (size_t i = 0; i < ROWS_OF(distances); ++i) {
        expect_distances(&distances[i], 1, true);
        expect_distances(&distances[i], 0x1p-30, true);
    }
    for (size_t i = 0; i < ROWS_OF(rigid); ++i)
        expect_distances(&rigid[i], 1, false);
}

TEST(contacts_agree_with_brute_force)
{
    if (is_missing())
        return;
    for (size_t i = 0; i < ROWS_OF(contacts); ++i) {
        scene s;
        void *state = NULL;
        scene_init(&s, 14, 9, 1, true);
        const double tolerance = i % 2 ? 0.05 * s.length : 0;
        assert_int_equal(make(&contacts[i], &s, MOTE_ASK_CONTACT, tolerance, &state), MOTE_OK);
        for (int f = 0; f < 30; ++f) {
            const mote_frame *frame = scene_next(&s, 1.3, false);
            const mote_answer a = ask_one(&contacts[i], state, frame);
            if (a.contact != (scene_truth(&s) <= tolerance))
                fail_msg("%s:%s frame %d: contact %d", contacts[i].method, contacts[i].options,
                         f, a.contact);
        }
        mote_method_find(contacts[i].method)->destroy(state);
        scene_free(&s);
    }
}

/* Bodies of which only the positions in each frame are known: they move by these, not by their
   poses, also in volumes that Coal could transform in place. */
TEST(bodies_of_given_positions_follow_them)
{
    if (is_missing())
        return;
    mote_field *given = NULL;
    assert_int_equal(mote_field_create_given(&given), MOTE_OK);
    for (size_t i = 0; i < ROWS_OF(distances); ++i) {
        scene s;
        double values[MOTE_PARAMETERS_MAX];
        void *state = NULL;
        scene_init(&s, 14, 9, 1, true);
        const mote_method *m = method_with(distances[i].method, distances[i].options, values);
        mote_setup setup = scene_setup(&s, MOTE_ASK_DISTANCE, 0, values);
        const mote_body known = {.mesh = s.mesh[1], .field = given};
        setup.body[1] = &known;
        assert_int_equal(m->create(&setup, &state), MOTE_OK);
        for (int f = 0; f < 5; ++f) {
            const double distance =
                method_answer(m, state, scene_next(&s, 1.3, false)).distance;
            test_row("%s:%s frame %d", distances[i].method, distances[i].options, f);
            assert_true(fabs(distance - scene_truth(&s)) <= 1e-12 * s.length);
        }
        m->destroy(state);
        scene_free(&s);
    }
    mote_field_destroy(given);
}

TEST(bodies_of_given_positions_are_not_moved_by_poses_alone)
{
    if (is_missing())
        return;
    mote_field *given = NULL;
    assert_int_equal(mote_field_create_given(&given), MOTE_OK);
    scene s;
    scene_init(&s, 14, 9, 1, false);
    s.body[1].field = given;
    for (size_t i = 0; i < ROWS_OF(rigid); ++i) {
        void *state = NULL;
        assert_int_equal(make(&rigid[i], &s, MOTE_ASK_DISTANCE, 0, &state), MOTE_EUNSUPPORTED);
        assert_non_null(strstr(mote_error_text(), "body 1 deforms"));
    }
    mote_field_destroy(given);
    scene_free(&s);
}

/* The corrected bound covers three axes, as it should, so fewer boxes are tested. */
TEST(the_mended_bound_tests_fewer_boxes)
{
    if (is_missing())
        return;
    uint64_t tests[2] = {0};
    for (size_t i = 0; i < 2; ++i) {
        scene s;
        void *state = NULL;
        const variant v = {"coal-aabb", i ? "bound=full" : "bound=coal"};
        scene_init(&s, 14, 9, 1, true);
        assert_int_equal(make(&v, &s, MOTE_ASK_DISTANCE, 0, &state), MOTE_OK);
        for (int f = 0; f < 30; ++f)
            tests[i] += ask_one(&v, state, scene_next(&s, 1.3, false)).counters.box_tests;
        mote_method_find(v.method)->destroy(state);
        scene_free(&s);
    }
    assert_true(tests[1] * 2 < tests[0]);
}

TEST(what_coal_cannot_answer_is_refused)
{
    static const variant lacking[] = {{"coal-obb", ""},
                                      {"coal-obb", "call=api"},
                                      {"coal-rss", "bound=full"},
                                      {"coal-aabb", "call=api,queue=64"},
                                      {"coal-aabb", "update=none"},
                                      {"coal-rss", "update=none"},
                                      {"coal-aabb", "call=api,bound=full"}};
    if (is_missing())
        return;
    scene s;
    void *state = NULL;
    scene_init(&s, 14, 9, 1, true);
    for (size_t i = 0; i < ROWS_OF(lacking); ++i)
        assert_int_equal(make(&lacking[i], &s, MOTE_ASK_DISTANCE, 0, &state),
                         MOTE_EUNSUPPORTED);
    assert_int_equal(make(&contacts[0], &s, MOTE_ASK_CONTACT, 0, &state), MOTE_OK);
    const mote_frame good = *scene_next(&s, 1.3, false);
    mote_frame bad = good;
    bad.body[1].vertices = NULL;
    const mote_method *m = mote_method_find("coal-aabb");
    assert_int_equal(m->update(state, &bad), MOTE_EINVAL);
    bad = good;
    bad.body[0].pose.translation.x = NAN;
    assert_int_equal(m->update(state, &bad), MOTE_EINVAL);
    /* What was refused is no known shape: that it did not change helps nothing. */
    bad = good;
    s.world[1][3].y = HUGE_VAL;
    assert_int_equal(m->update(state, &bad), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 1: vertex 3 is"));
    bad.body[1].shape_changed = bad.body[1].pose_changed = false;
    assert_int_equal(m->update(state, &bad), MOTE_EINVAL);
    const bool contact = ask_one(&contacts[0], state, scene_next(&s, 1.3, false)).contact;
    assert_int_equal(contact, scene_truth(&s) <= 0);
    m->destroy(state);
    s.mesh[1]->positions[0].y = HUGE_VAL;
    assert_int_equal(make(&contacts[0], &s, MOTE_ASK_CONTACT, 0, &state), MOTE_EINVAL);
    scene_free(&s);
}
