/* Bodies in the closed loop: their shapes are the scenario's, turned with the simulated pose,
   of every kind of field; and no vertex moves farther than the bound says. */
#include "harness/loop/cast.h"

#include "core/base/random.h"
#include "harness/loop/reach.h"
#include "harness/scene/motion.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <stdlib.h>

enum { STEPS = 25 };

typedef struct stage {
    mote_scenario *scenario;
    mote_simulation_options options;
    mote_mass masses[2];
    mote_frame_buffer *buffer;
    void *cast;
} stage;

/* The bodies turn about the middles of their boxes, since not all meshes are closed. */
static void stage_init(stage *s, const char *scenario)
{
    assert_int_equal(mote_scenario_load(scenario, &s->scenario), MOTE_OK);
    const mote_subject subject = {.scenario = s->scenario};
    s->options = mote_default_simulation_options(&subject);
    s->options.time_step = 3;
    for (int i = 0; i < 2; ++i) {
        const mote_mesh *mesh = s->scenario->body[i].mesh;
        s->masses[i] = (mote_mass){.centre = mote_scale(mote_add(mesh->low, mesh->high), 0.5),
                                   .axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    }
    s->buffer = mote_frame_buffer_create(s->scenario);
    s->cast = mote_cast_pair.create(&subject, &s->options, s->masses);
    mote_cast_pair.restart(s->cast, &(mote_simulation_start){.first = 1});
}

static void stage_free(stage *s)
{
    mote_cast_pair.destroy(s->cast);
    mote_frame_buffer_destroy(s->buffer);
    mote_scenario_destroy(s->scenario);
}

/* Simulated bodies that turn and move. */
static const mote_body_state *show(stage *s, uint32_t k)
{
    mote_rigid_state states[2];
    for (int i = 0; i < 2; ++i) {
        const double angle = 0.02 * k * (i + 1), length = s->scenario->length;
        states[i] = (mote_rigid_state){
            .centre = mote_vec3_make(0.01 * k * length, i * length, 0.3 * length),
            .turn = mote_quaternion_normalise(
                (mote_quaternion){cos(angle), 0.2 * sin(angle), sin(angle), 0.4 * sin(angle)})};
    }
    return mote_cast_pair.show(s->cast, k, states);
}

static mote_vec3 own_position(const mote_body *body, const mote_body_state *state, uint32_t v)
{
    return mote_rotate_back(&state->pose.rotation, mote_sub(mote_body_position(body, state, v),
                                                            state->pose.translation));
}

/* Both states show the body in the same shape, wherever they place it. */
static void check_shapes(const stage *s, int i, const mote_body_state *a,
                         const mote_body_state *b)
{
    const mote_body *body = &s->scenario->body[i];
    for (uint32_t v = 0; v < body->mesh->vertex_count; v += 7) {
        const double off =
            mote_length(mote_sub(own_position(body, a, v), own_position(body, b, v)));
        if (!(off <= 1e-13 * s->scenario->length))
            fail_msg("%s, body %d: vertex %u is %g off", s->scenario->name, i, v, off);
    }
}

static const char *const scenarios[] = {"mv", "morph", "hand-shapes", "hands", "twist"};

TEST(mote_cast_pair_shows_the_shapes_of_the_scenario)
{
    for (size_t n = 0; n < ROWS_OF(scenarios); ++n) {
        stage s;
        stage_init(&s, scenarios[n]);
        for (uint32_t k = 0; k < STEPS; k += 8) {
            const mote_body_state *shown = show(&s, k);
            const mote_frame *frame =
                mote_scenario_frame_at(s.scenario, s.buffer, 1 + k * s.options.time_step);
            for (int i = 0; i < 2; ++i)
                check_shapes(&s, i, &shown[i], &frame->body[i]);
        }
        stage_free(&s);
    }
}

/* Weights in the bodies' own axes, with which a body that does not turn has the same shape. */
TEST(mote_cast_pair_weighs_in_the_axes_of_bodies)
{
    for (size_t n = 0; n < ROWS_OF(scenarios); ++n) {
        stage s;
        stage_init(&s, scenarios[n]);
        double *weights[2];
        for (int i = 0; i < 2; ++i)
            weights[i] =
                calloc(3 * (size_t)s.scenario->body[i].field->padded + 1, sizeof(double));
        mote_cast_pair.weigh(s.cast, 60, weights);
        const mote_frame *frame = mote_scenario_frame_at(s.scenario, s.buffer, 61);
        for (int i = 0; i < 2; ++i) {
            const mote_body *body = &s.scenario->body[i];
            const uint32_t padded = body->field->padded;
            const mote_body_state still = {
                .pose = {.rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
                .weights = {weights[i], weights[i] + padded, weights[i] + 2 * (size_t)padded,
                            body->field->count, padded}};
            check_shapes(&s, i, &still, &frame->body[i]);
            free(weights[i]);
        }
        stage_free(&s);
    }
}

TEST(mote_cast_pair_moved_bounds_every_vertex)
{
    for (size_t n = 0; n < ROWS_OF(scenarios); ++n) {
        stage s;
        stage_init(&s, scenarios[n]);
        mote_vec3 *before[2];
        for (int i = 0; i < 2; ++i)
            before[i] = calloc(s.scenario->body[i].mesh->vertex_count, sizeof(mote_vec3));
        for (uint32_t k = 0; k < STEPS; ++k) {
            const mote_body_state *shown = show(&s, k);
            double most[2] = {0, 0};
            for (int i = 0; i < 2; ++i) {
                const mote_body *body = &s.scenario->body[i];
                for (uint32_t v = 0; v < body->mesh->vertex_count; ++v) {
                    const mote_vec3 now = mote_body_position(body, &shown[i], v);
                    most[i] = fmax(most[i], mote_length(mote_sub(now, before[i][v])));
                    before[i][v] = now;
                }
            }
            if (k > 0 && !(mote_cast_pair.moved(s.cast) >= most[0] + most[1]))
                fail_msg("%s, step %u: moved by %g, not %g", scenarios[n], k, most[0] + most[1],
                         mote_cast_pair.moved(s.cast));
        }
        free(before[0]);
        free(before[1]);
        stage_free(&s);
    }
}

/* Two modes that move vertices by five times their weights: the sums bound displacements, and
   are not twice as large as they must be where one weight alone differs from 0. */
TEST(mote_reach_of_modes_bounds_displacements)
{
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(2));
    const uint32_t count = mesh->vertex_count;
    mote_vec3 *modes = malloc(2 * (size_t)count * sizeof *modes);
    mote_field *field = NULL;
    for (uint32_t v = 0; v < count; ++v) {
        modes[v] = mote_scale(mesh->positions[v], 5);
        modes[count + v] = mote_vec3_make(0, 5 * sin(9.0 * v), 1);
    }
    assert_int_equal(mote_field_create_modes(modes, 2, count, &field), MOTE_OK);
    double *sizes = mote_reach_sizes(&(mote_body){.mesh = mesh, .field = field});
    double numbers[3 * MOTE_LANES * 2];
    mote_vec3 zero[8] = {{0, 0, 0}}, weights[8] = {{0, 0, 0}};
    assert_int_equal(field->count, 6);
    mote_random random = {1};
    for (int k = 0; k < 200; ++k) {
        const uint32_t padded = field->padded;
        assert_true(3 * padded <= sizeof numbers / sizeof *numbers);
        for (uint32_t j = 0; j < padded; ++j) {
            const bool none = j >= 6 || (k < 100 && j != (uint32_t)k % 6);
            weights[j] = none ? zero[0] : mote_random_direction(&random);
            numbers[j] = weights[j].x;
            numbers[padded + j] = weights[j].y;
            numbers[2 * padded + j] = weights[j].z;
        }
        const mote_weights w = {numbers, numbers + padded, numbers + 2 * padded, 6, padded};
        double most = 0;
        for (uint32_t v = 0; v < count; ++v)
            most = fmax(most, mote_length(mote_field_displacement(field, mesh, v, &w)));
        const mote_reach grown = mote_reach_of(field, sizes, zero, weights);
        const mote_reach shrunk = mote_reach_of(field, sizes, weights, zero);
        assert_true(grown.change >= most * (1 - 1e-12) &&
                    (k >= 100 || grown.change <= 2 * most));
        assert_true(grown.shape == 0.0 && shrunk.shape == grown.change);
    }
    free(sizes);
    free(modes);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}
