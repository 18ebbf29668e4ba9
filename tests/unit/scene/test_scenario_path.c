/* Paths of scenarios against the scenarios' own frames. */
#include "harness/scene/scenario_path.h"

#include "harness/scene/motion.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>

static mote_scenario *load(const char *name)
{
    mote_scenario *scenario = NULL;
    if (mote_scenario_load(name, &scenario) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return scenario;
}

/* The largest distance of some vertices between a path's state and the scenario's frame. */
static double apart(const mote_scenario *scenario, const mote_scenario_path *path, double time,
                    const mote_frame *frame)
{
    double most = 0;
    for (int i = 0; i < 2; ++i) {
        const mote_body *body = &scenario->body[i];
        double *weights = calloc(3 * (size_t)body->field->padded + 1, sizeof *weights);
        assert_non_null(weights);
        mote_body_state state;
        mote_path_state(mote_scenario_path_of(path, i), body, time, weights, &state);
        for (uint32_t v = 0; v < body->mesh->vertex_count; v += 97) {
            const mote_vec3 a = mote_body_position(body, &state, v);
            const mote_vec3 b = mote_body_position(body, &frame->body[i], v);
            most = fmax(most, mote_length(mote_sub(a, b)));
        }
        free(weights);
    }
    return most;
}

static void check_scenario(const char *name, double between)
{
    mote_scenario *scenario = load(name);
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_scenario_path *path = NULL;
    assert_int_equal(mote_scenario_path_create(scenario, 8, &path), MOTE_OK);
    static const uint32_t starts[] = {1, 60, 61};
    for (int s = 0; s < 3; ++s) {
        mote_scenario_path_set(path, starts[s]);
        assert_int_equal(mote_scenario_path_of(path, 0)->count, 8);
        for (uint32_t k = 0; k <= 16; ++k) {
            const double place = starts[s] + k / 2.0;
            const mote_frame *frame = mote_scenario_frame_at(scenario, buffer, place);
            const double limit = k % 2 == 0 ? 1e-12 : between;
            const double off = apart(scenario, path, k / 16.0, frame) / scenario->length;
            if (!(off <= limit))
                fail_msg("%s at %g: %g L beside the frame", name, place, off);
        }
    }
    mote_scenario_path_destroy(path);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(scenario);
}

TEST(mote_scenario_path_passes_through_the_frames)
{
    check_scenario("ww", 1e-5);
    check_scenario("rigid-ww", 1e-4);
    check_scenario("bison-15k", 0.05);
}

/* Derivatives at the end of a piece and at the start of the next are the same. */
TEST(mote_scenario_path_has_no_kinks)
{
    mote_scenario *scenario = load("mv");
    mote_scenario_path *path = NULL;
    assert_int_equal(mote_scenario_path_create(scenario, 5, &path), MOTE_OK);
    mote_scenario_path_set(path, 40);
    for (int i = 0; i < 2; ++i) {
        const mote_path *own = mote_scenario_path_of(path, i);
        for (uint32_t k = 1; k < own->count; ++k) {
            const mote_path_piece *a = &own->pieces[k - 1], *b = &own->pieces[k];
            const mote_vec3 end = mote_sub(a->centre[3], a->centre[2]);
            const mote_vec3 start = mote_sub(b->centre[1], b->centre[0]);
            assert_true(mote_length(mote_sub(end, start)) < 1e-14);
            const uint32_t padded = scenario->body[i].field->padded;
            for (uint32_t j = 0; j < 3 * padded; ++j) {
                const double out = a->weights[9 * padded + j] - a->weights[6 * padded + j];
                assert_true(fabs(out - (b->weights[3 * padded + j] - b->weights[j])) < 1e-14);
            }
        }
    }
    mote_scenario_path_destroy(path);
    mote_scenario_path_destroy(NULL);
    mote_scenario_destroy(scenario);
}
