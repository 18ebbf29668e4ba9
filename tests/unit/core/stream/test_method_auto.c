/* The methods stream and auto through the interface. */
#include "core/method/method.h"
#include "tests/support/shapes.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"

#include <stdio.h>

/* Deforms more strongly than boxes of the rest tree can follow. */
static void bend_hard(scene *s, double size)
{
    for (int b = 0; b < 2; ++b) {
        for (uint32_t j = 0; j < s->field[b]->count; ++j) {
            for (int k = 0; k < 3; ++k)
                s->weights[b][k][j] += scene_random(s, -size, size) * s->length;
        }
        mote_deform_all(s->deform[b], &s->frame.body[b], s->world[b]);
    }
}

TEST(stream_and_auto_equal_all_pairs)
{
    static const char *const names[] = {"stream", "auto", "auto"};
    static const char *const keys[] = {"", "", "positions=given"};
    scene s;
    scene_init(&s, 25, 11, 1, true);
    for (int contact = 0; contact < 2; ++contact) {
        const double tolerance = 0.03 * s.length;
        const mote_ask ask = contact ? MOTE_ASK_CONTACT : MOTE_ASK_DISTANCE;
        method_run u[3];
        for (int i = 0; i < 3; ++i)
            method_run_init(&u[i], names[i], keys[i], scene_setup(&s, ask, tolerance, NULL));
        for (int k = 0; k < 90; ++k) {
            scene_next(&s, 1.4, false);
            if (k >= 30 && k < 60)
                bend_hard(&s, 0.6);
            const double truth = scene_distance(&s);
            for (int i = 0; i < 3; ++i) {
                test_row("%s:%s frame %d", names[i], keys[i], k);
                const mote_answer a = method_run_ask(&u[i], &s.frame);
                assert_true(a.has_contact);
                assert_int_equal(a.contact, truth <= tolerance);
                assert_true(a.has_lower && a.lower <= truth);
                assert_int_equal(a.has_distance, !contact);
                assert_true(contact || fabs(a.distance - truth) <= 1e-12 * s.length);
            }
        }
        for (int i = 0; i < 3; ++i)
            mote_method_destroy(u[i].method, u[i].state);
    }
    scene_free(&s);
}

/* Streamed frames count every vertex that they read; certified ones only those that they
   evaluate. */
static bool was_streamed(const scene *s, const mote_answer *a)
{
    return a->counters.positions >=
           s->mesh[0]->vertex_count + (uint64_t)s->mesh[1]->vertex_count;
}

static void gentle_then_hard(double size, int *streamed)
{
    scene s;
    scene_init(&s, 60, 30, 1, true);
    method_run u;
    method_run_init(&u, "auto", "positions=given", scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL));
    scene_next(&s, 1.4, false);
    *streamed = 0;
    for (int k = 0; k < 120; ++k) {
        scene_next(&s, 0, true);
        s.frame.body[1].pose.translation.x = 1.3 * s.length;
        for (int b = 0; b < 2; ++b) {
            s.frame.body[b].shape_changed = true;
            memset(s.weights[b], 0, sizeof s.weights[b]);
        }
        bend_hard(&s, size);
        const mote_answer a = method_run_ask(&u, &s.frame);
        *streamed += was_streamed(&s, &a);
    }
    mote_method_destroy(u.method, u.state);
    scene_free(&s);
}

TEST(auto_chooses_by_the_deformation)
{
    int gentle = 0, hard = 0;
    gentle_then_hard(0.001, &gentle);
    gentle_then_hard(4, &hard);
    assert_in_range(gentle, 0, 30);
    assert_in_range(hard, 90, 120);
}

TEST(auto_where_nothing_changes_repeats_its_answer)
{
    scene s;
    scene_init(&s, 14, 9, 1, true);
    method_run u;
    method_run_init(&u, "auto", "", scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL));
    scene_next(&s, 1.4, false);
    const mote_answer first = method_run_ask(&u, &s.frame);
    for (int b = 0; b < 2; ++b)
        s.frame.body[b].shape_changed = s.frame.body[b].pose_changed = false;
    const mote_answer second = method_run_ask(&u, &s.frame);
    assert_true(second.distance == first.distance && second.lower == first.lower);
    assert_int_equal(second.counters.box_tests, 0);
    mote_method_destroy(u.method, u.state);
    scene_free(&s);
}

/* Without a known field auto streams; a method that needs one is refused (test_method.c). */
TEST(auto_without_a_field_streams)
{
    scene s;
    scene_init(&s, 25, 11, 1, true);
    mote_field *given = NULL;
    assert_int_equal(mote_field_create_given(&given), MOTE_OK);
    scene told = s; /* the same bodies, one without a known field */
    told.body[0].field = given;
    method_run u;
    method_run_init(&u, "auto", "", scene_setup(&told, MOTE_ASK_DISTANCE, 0, NULL));
    for (int k = 0; k < 10; ++k) {
        scene_next(&s, 1.4, false);
        mote_frame frame = s.frame;
        frame.body[1].vertices = NULL;
        const mote_answer a = method_run_ask(&u, &frame);
        assert_true(was_streamed(&s, &a) || !(a.distance > 0));
        assert_true(fabs(a.distance - scene_distance(&s)) <= 1e-12 * s.length);
    }
    mote_method_destroy(u.method, u.state);
    mote_field_destroy(given);
    scene_free(&s);
}

TEST(stream_without_positions_says_so)
{
    scene s;
    scene_init(&s, 14, 9, 1, true);
    method_run u;
    method_run_init(&u, "stream", "", scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL));
    mote_frame frame = *scene_next(&s, 1.4, false);
    frame.body[1].vertices = NULL;
    mote_answer a = {0};
    assert_int_equal(u.method->query(u.state, &frame, &a), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 1 has no positions"));
    mote_method_destroy(u.method, u.state);
    scene_free(&s);
}
