/* The methods stream and auto through the interface. */
#include "core/method/method.h"
#include "tests/support/skin_scene.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

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
            const double truth = scene_truth(&s);
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
    const mote_counters nothing = {0};
    assert_memory_equal(&second.counters, &nothing, sizeof nothing);
    mote_method_destroy(u.method, u.state);
    scene_free(&s);
}

static void check_distance(const scene *s, const mote_answer *a)
{
    const double truth = scene_truth(s);
    assert_true(fabs(a->distance - truth) <= 1e-12 * s->length);
    assert_true(a->has_lower && a->lower <= truth);
}

/* A frame in which one body moves a little and deforms by a size, and nothing else changes. */
static void change_only(scene *s, int moving, double size)
{
    mote_body_state *state = &s->frame.body[moving];
    for (int b = 0; b < 2; ++b) {
        s->frame.body[b].shape_changed = b == moving && size > 0;
        s->frame.body[b].pose_changed = b == moving;
    }
    state->pose.translation.x += scene_random(s, -0.02, 0.02) * s->length;
    for (uint32_t j = 0; j < s->field[moving]->count && size > 0; ++j) {
        for (int k = 0; k < 3; ++k)
            s->weights[moving][k][j] = scene_random(s, -size, size) * s->length;
    }
    mote_deform_all(s->deform[moving], state, s->world[moving]);
    ++s->frame.number;
}

/* Whichever method answers, a body that rests is not read again. */
TEST(auto_while_one_body_rests_equals_all_pairs)
{
    static const char *const keys[] = {"", "positions=given"};
    static const double sizes[] = {0.001, 4};
    for (int i = 0; i < 4; ++i) {
        scene s;
        method_run u;
        scene_init(&s, 16, 9, 1, true);
        method_run_init(&u, "auto", keys[i % 2], scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL));
        scene_next(&s, 1.4, false);
        for (int k = 0; k < 90; ++k) {
            test_row("%s, size %g, frame %d", keys[i % 2], sizes[i / 2], k);
            if (k > 0)
                change_only(&s, k < 60, sizes[i / 2]);
            const mote_answer a = method_run_ask(&u, &s.frame);
            if (k % 4 == 0)
                check_distance(&s, &a);
        }
        method_run_free(&u);
        scene_free(&s);
    }
}

/* A skin, whose functions are 0 at most vertices. */
TEST(auto_with_skins_equals_all_pairs)
{
    skinned k;
    method_run u;
    skinned_init(&k, 16, 9, (skin_plan){.bones = 4, .each = 2});
    method_run_init(&u, "auto", "", scene_setup(&k.s, MOTE_ASK_DISTANCE, 0, NULL));
    for (int i = 0; i < 40; ++i) {
        test_row("frame %d", i);
        next_pose(&k, 0.3, 1.4);
        const mote_answer a = method_run_ask(&u, &k.s.frame);
        check_distance(&k.s, &a);
    }
    method_run_free(&u);
    skinned_free(&k);
}

/* Without a known field auto streams; a method that needs one is refused (test_method.c). A
   body that does not change is not read again; one without positions is refused, and the frame
   after that is answered. */
TEST(auto_without_a_field_streams)
{
    for (int g = 0; g < 2; ++g) {
        scene s;
        test_row("body %d is given", g);
        scene_init(&s, 14, 9, 1, true);
        mote_field *given = NULL;
        assert_int_equal(mote_field_create_given(&given), MOTE_OK);
        scene told = s; /* the same bodies, one without a known field */
        told.body[g].field = given;
        method_run u;
        method_run_init(&u, "auto", "", scene_setup(&told, MOTE_ASK_DISTANCE, 0, NULL));
        uint64_t all = 0, one = 0;
        for (int k = 0; k < 24; ++k) {
            if (k % 8 == 0)
                scene_next(&s, 1.4, false);
            else
                change_only(&s, k / 8 % 2, 0);
            mote_frame frame = s.frame;
            frame.body[1 - g].vertices = NULL;
            const mote_answer a = method_run_ask(&u, &frame);
            assert_true(k % 8 || was_streamed(&s, &a) || !(a.distance > 0));
            check_distance(&s, &a);
            all += k % 8 == 0 ? a.counters.positions : 0;
            one += k % 8 ? a.counters.positions : 0;
        }
        assert_true(one / 21 < all / 3);
        mote_frame frame = s.frame;
        mote_answer a = {0};
        frame.body[0].pose_changed = frame.body[1].pose_changed = true;
        frame.body[g].vertices = NULL;
        assert_int_equal(u.method->query(u.state, &frame, &a), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "has no positions"));
        assert_false(a.has_distance);
        frame.body[g].vertices = s.world[g];
        frame.body[0].pose_changed = frame.body[1].pose_changed = false;
        a = method_run_ask(&u, &frame);
        check_distance(&s, &a);
        method_run_free(&u);
        mote_field_destroy(given);
        scene_free(&s);
    }
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

/* Where certified is a little faster than stream, but dearer than stream may be at best: stream
   is tried for two frames after 8, then after 48, and each time after twice as many, up to
   1,536. Frames of the same four poses again and again. */
TEST(auto_tries_in_vain_more_and_more_seldom)
{
    scene s;
    method_run u;
    scene_init(&s, 14, 9, 1, true);
    method_run_init(&u, "auto", "positions=given", scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL));
    uint32_t next = 9, memory = 48, tried = 0;
    for (uint32_t k = 0; k < 4600; ++k) {
        if (k % 4 == 0)
            s.random = 5;
        scene_next(&s, 0, false);
        s.frame.body[1].pose.translation.x = 1.3 * s.length;
        for (int b = 0; b < 2; ++b)
            memset(s.weights[b], 0, sizeof s.weights[b]);
        bend_hard(&s, 0.3);
        const mote_answer a = method_run_ask(&u, &s.frame);
        test_row("frame %u", k);
        assert_int_equal(was_streamed(&s, &a), k == next || k == next + 1);
        if (k != next + 1)
            continue;
        ++tried;
        next += memory + 3; /* the trial's two frames, and one that is not measured */
        memory = memory < 1536 ? 2 * memory : memory;
    }
    assert_int_equal(tried, 8);
    method_run_free(&u);
    scene_free(&s);
}

/* What a method promises by its parameters. */
TEST(stream_and_auto_traits_follow_the_parameters)
{
    static const struct {
        const char *name, *keys;
        mote_traits traits;
    } rows[] = {
        {"stream", "", {.given_vertices = true, .keeps_state = true, .exact = true}},
        {"stream", "slack=0.1", {.given_vertices = true, .keeps_state = true}},
        {"stream", "budget=100", {.given_vertices = true, .keeps_state = true}},
        {"stream", "seed=none", {.given_vertices = true, .exact = true}},
        {"stream",
         "positions=deform",
         {.needs_vertices = true, .keeps_state = true, .exact = true}},
        {"auto", "", {.uses_field = true, .keeps_state = true, .exact = true}},
        {"auto",
         "positions=given",
         {.uses_field = true, .given_vertices = true, .keeps_state = true, .exact = true}}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        double values[MOTE_PARAMETERS_MAX];
        test_row("%s:%s", rows[i].name, rows[i].keys);
        const mote_traits got = method_with(rows[i].name, rows[i].keys, values)->traits(values);
        assert_int_equal(got.exact, rows[i].traits.exact);
        assert_int_equal(got.keeps_state, rows[i].traits.keeps_state);
        assert_int_equal(got.needs_vertices, rows[i].traits.needs_vertices);
        assert_int_equal(got.given_vertices, rows[i].traits.given_vertices);
        assert_int_equal(got.uses_field, rows[i].traits.uses_field);
        assert_int_equal(got.needs_field, rows[i].traits.needs_field);
    }
}
