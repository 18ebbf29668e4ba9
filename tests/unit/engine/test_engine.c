/* Engines: particles after an answer; two bodies, always near or in a scene. */
#include "harness/base/clock.h"
#include "harness/base/heap_count.h"
#include "harness/engine/engine.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

#include <stddef.h>

/* Overwrites the stack of earlier calls. */
static void overwrite_stack(void)
{
    volatile unsigned char used[16384];
    for (size_t i = 0; i < sizeof used; ++i)
        used[i] = 0xff;
}

/* Bodies that touch end the search at once. Minima found in earlier frames are then evaluated
   for this frame only when the particles are asked for. */
TEST(particles_after_the_answer_are_vertices_of_its_frame)
{
    void (*volatile between)(void) = overwrite_stack;
    mote_method_choice choice;
    assert_int_equal(mote_method_choice_read("particle:n=8", &choice), MOTE_OK);
    scene s;
    scene_init(&s, 24, 12, 1, true);
    mote_engine *engine = NULL;
    assert_int_equal(
        mote_engine_open_two(&s.body[0], &s.body[1], &choice, MOTE_ASK_DISTANCE, 0, 1, &engine),
        MOTE_OK);
    int touching = 0;
    (void)scene_next(&s, 0, false);
    for (int k = 0; k < 60; ++k) {
        mote_answer answer;
        s.frame.body[1].pose.translation.x = (1.2 - 0.02 * k) * s.length;
        scene_step(&s);
        assert_int_equal(mote_engine_answer(engine, &s.frame, &answer), MOTE_OK);
        between();
        for (int b = 0; b < 2; ++b) {
            mote_vec3 at[9];
            const size_t count = mote_engine_particles(engine, b, at, 9);
            assert_in_range(count, 1, 9);
            touching += count > 1 && answer.distance <= 0;
            for (size_t i = 0; i < count; ++i) {
                uint32_t v = 0;
                while (v < s.mesh[b]->vertex_count &&
                       mote_distance_squared(s.world[b][v], at[i]) > 1e-24)
                    ++v;
                assert_true(v < s.mesh[b]->vertex_count);
            }
        }
    }
    assert_true(touching > 10);
    mote_engine_destroy(engine);
    scene_free(&s);
}

static mote_engine *engine_of(const mote_engine_setup *setup, const char *text)
{
    mote_method_choice choice;
    mote_engine *engine = NULL;
    if (mote_scene_choice_read(text, &choice) != MOTE_OK ||
        mote_engine_create(setup, &choice, &engine) != MOTE_OK ||
        mote_engine_build(engine) != MOTE_OK)
        fail_msg("%s: %s", text, mote_error_text());
    return engine;
}

/* The engine's answer for the frame: its one pair, or NULL if none is near. */
static const mote_near_pair *ask(mote_engine *engine, const mote_frame *frame,
                                 mote_engine_cost *cost)
{
    size_t count;
    mote_engine_show(engine, frame->body);
    assert_int_equal(mote_engine_ask(engine, cost), MOTE_OK);
    const mote_near_pair *pairs = mote_engine_pairs(engine, &count);
    assert_true(count <= 1 && cost->pairs == count);
    return count == 1 ? pairs : NULL;
}

/* Two bodies that are always near, and the same two in a scene that searches for near pairs:
   equal distances, which are those of brute force. Only the scene drops the pair when it is
   far. */
TEST(two_bodies_are_a_scene_of_two)
{
    static const char *const methods[] = {"certified", "aabb-tree", "fcl-aabb"};
    for (size_t m = 0; m < sizeof methods / sizeof methods[0]; ++m) {
        scene s;
        scene_init(&s, 24, 12, 1, true);
        mote_engine_setup two = mote_engine_setup_of_two(&s.body[0], &s.body[1]);
        mote_engine_setup many = two;
        many.near = 0.3 * s.length;
        mote_engine *pair = engine_of(&two, methods[m]);
        mote_engine *crowd = engine_of(&many, methods[m]);
        uint32_t near_frames = 0, lost_frames = 0;
        (void)scene_next(&s, 0, false);
        for (uint32_t k = 0; k < 30; ++k) {
            mote_engine_cost one, other;
            s.frame.body[1].pose.translation.x = (0.5 + 0.05 * k) * s.length;
            scene_step(&s);
            for (int b = 0; b < 2; ++b)
                s.frame.body[b].pose_changed = s.frame.body[b].shape_changed = true;
            const mote_near_pair *said = ask(pair, &s.frame, &one);
            const mote_near_pair *found = ask(crowd, &s.frame, &other);
            test_row("%s, frame %u", methods[m], k);
            assert_non_null(said);
            assert_int_equal(said->steps, k + 1);
            assert_true(said->answer.has_contact);
            assert_int_equal(one.broad_ns + one.bounds_ns, 0); /* no search for pairs */
            near_frames += found != NULL;
            lost_frames += found == NULL;
            if (found)
                assert_close(found->answer.distance, said->answer.distance, 1e-12 * s.length);
            else
                assert_true(said->answer.distance > many.near);
            if (k % 10 == 0)
                assert_close(said->answer.distance, scene_truth(&s), 1e-12 * s.length);
        }
        assert_true(near_frames > 3 && lost_frames > 3);
        mote_engine_destroy(pair);
        mote_engine_destroy(crowd);
        scene_free(&s);
    }
}

/* What the first step of a scene of two large bodies takes by the clock, and what of it the
   method is charged for. */
static double charged_part_of_first_step(const mote_engine_setup *setup, const char *method,
                                         const mote_frame *frame)
{
    mote_engine_cost cost;
    mote_engine *engine = engine_of(setup, method);
    const uint64_t from = mote_clock_ns();
    assert_non_null(ask(engine, frame, &cost));
    const uint64_t taken = mote_clock_ns() - from;
    const uint64_t charged = cost.deform_ns + cost.update_ns + cost.query_ns;
    assert_true(charged <= taken);
    mote_engine_destroy(engine);
    return (double)charged / (double)taken;
}

/* FCL takes ten times as long to build a tree as to refit it and answer. One of five tries must
   find the machine free enough to show it. */
TEST(building_trees_of_several_bodies_is_charged_to_no_frame)
{
    scene s;
    scene_init(&s, 80, 40, 1, true);
    mote_engine_setup many = mote_engine_setup_of_two(&s.body[0], &s.body[1]);
    many.near = s.length;
    const mote_frame *frame = scene_next(&s, 0.5, false);
    double part = 1;
    for (int k = 0; k < 5 && part > 0.5; ++k)
        part = charged_part_of_first_step(&many, "fcl-aabb", frame);
    assert_true(part < 0.5);
    scene_free(&s);
}

TEST(trees_that_every_body_needs_are_built_before_the_first_frame)
{
    static const char *const methods[] = {"fcl-aabb:refit=every", "aabb-tree:refit=every"};
    if (!mote_heap_read().counted)
        skip();
    scene s;
    scene_init(&s, 80, 40, 1, true);
    mote_engine_setup many = mote_engine_setup_of_two(&s.body[0], &s.body[1]);
    many.near = s.length;
    const mote_frame *frame = scene_next(&s, 0.5, false);
    for (size_t m = 0; m < ROWS_OF(methods); ++m) {
        mote_engine_cost cost;
        mote_engine *engine = engine_of(&many, methods[m]);
        const int64_t built = mote_heap_read().live_bytes;
        assert_non_null(ask(engine, frame, &cost));
        test_row("%s", methods[m]);
        assert_true(mote_heap_read().live_bytes - built < 10000); /* a tree is far larger */
        mote_engine_destroy(engine);
    }
    scene_free(&s);
}
