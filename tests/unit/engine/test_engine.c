/* One method asked outside a measurement: its particles after it has answered. */
#include "harness/engine/engine.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"

#include <stddef.h>

/* What other calls leave where the stack of earlier ones was. */
static void overwrite_stack(void)
{
    volatile unsigned char used[16384];
    for (size_t i = 0; i < sizeof used; ++i)
        used[i] = 0xff;
}

/* Bodies that touch end the search at once: minima that were found before are then looked at
   for the first time in this frame when they are asked for. */
TEST(particles_after_the_answer_are_vertices_of_its_frame)
{
    void (*volatile between)(void) = overwrite_stack;
    mote_method_choice choice;
    assert_int_equal(mote_method_choice_read("particle:n=8", &choice), MOTE_OK);
    scene s;
    scene_init(&s, 24, 12, 1, true);
    mote_engine *probe = NULL;
    assert_int_equal(
        mote_engine_open_two(&s.body[0], &s.body[1], &choice, MOTE_ASK_DISTANCE, 0, 1, &probe),
        MOTE_OK);
    int touching = 0;
    (void)scene_next(&s, 0, false);
    for (int k = 0; k < 60; ++k) {
        mote_answer answer;
        s.frame.body[1].pose.translation.x = (1.2 - 0.02 * k) * s.length;
        scene_step(&s);
        assert_int_equal(mote_engine_answer(probe, &s.frame, &answer), MOTE_OK);
        between();
        for (int b = 0; b < 2; ++b) {
            mote_vec3 at[9];
            const size_t count = mote_engine_particles(probe, b, at, 9);
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
    mote_engine_destroy(probe);
    scene_free(&s);
}
