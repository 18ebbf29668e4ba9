#include "harness/loop/cast.h"

#include "harness/base/memory.h"
#include "harness/loop/reach.h"

#include <stdlib.h>
#include <string.h>

/* Weight j in the axes of its body, which has this rotation. */
static mote_vec3 own_weight(const mote_field *field, const mote_weights *weights,
                            const mote_mat3 *rotation, uint32_t j)
{
    const mote_vec3 w = {weights->x[j], weights->y[j], weights->z[j]};
    if (j >= mote_field_vectors(field))
        return w;
    if (field->numbers > 0 && j >= mote_field_first_axis(field)) {
        const uint32_t axis = j - mote_field_first_axis(field);
        return mote_vec3_make(axis == 0, axis == 1, axis == 2);
    }
    return mote_rotate_back(rotation, w);
}

void mote_cast_weights(const mote_field *field, const mote_body_state *state, double *weights)
{
    const size_t padded = state->weights.padded;
    for (uint32_t j = 0; j < state->weights.count; ++j) {
        const mote_vec3 w = own_weight(field, &state->weights, &state->pose.rotation, j);
        weights[j] = w.x;
        weights[padded + j] = w.y;
        weights[2 * padded + j] = w.z;
    }
}

typedef struct pair_cast {
    const mote_scenario *scenario;
    const mote_simulation_options *options;
    const mote_mass *masses;
    mote_frame_buffer *buffer;
    mote_body_state body[2]; /* as they are shown */
    uint32_t first;          /* deformation frame shown first */
    double radius[2];        /* greatest distance of a rest vertex from the centre of mass */
    double *sizes[2];        /* of the basis functions, or NULL */
    double *weights[2];      /* those of the frame, in world axes: x, y, z, [3][padded] */
    double *still[2];        /* the same in rest axes, [count][3] */
    double *before[2];       /* those of the previous frame */
    mote_rigid_state state[2], previous[2]; /* of this and the previous frame */
} pair_cast;

static void pair_destroy(void *cast)
{
    pair_cast *s = cast;
    for (int i = 0; i < 2; ++i) {
        free(s->sizes[i]);
        free(s->weights[i]);
        free(s->still[i]);
        free(s->before[i]);
    }
    mote_frame_buffer_destroy(s->buffer);
    free(s);
}

static void measure_body(pair_cast *s, int i)
{
    const mote_mesh *mesh = s->scenario->body[i].mesh;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        s->radius[i] =
            fmax(s->radius[i], mote_distance_squared(mesh->positions[v], s->masses[i].centre));
    s->radius[i] = sqrt(s->radius[i]);
    s->sizes[i] = mote_reach_sizes(&s->scenario->body[i]);
    const size_t numbers = (size_t)3 * s->scenario->body[i].field->padded;
    s->weights[i] = mote_allocate(numbers, sizeof(double));
    s->still[i] = mote_allocate(numbers, sizeof(double));
    s->before[i] = mote_allocate(numbers, sizeof(double));
}

static void *pair_create(const mote_subject *subject, const mote_simulation_options *options,
                         const mote_mass *masses)
{
    pair_cast *made = mote_allocate(1, sizeof *made);
    made->scenario = subject->scenario;
    made->options = options;
    made->masses = masses;
    made->buffer = mote_frame_buffer_create(made->scenario);
    for (int i = 0; i < 2; ++i)
        measure_body(made, i);
    return made;
}

static void pair_restart(void *cast, const mote_simulation_start *start)
{
    ((pair_cast *)cast)->first = start->first;
}

/* The frame whose deformation is shown so many frames after the beginning: forwards, then
   backwards, and so on. */
static double shown_place(const pair_cast *s, double frames)
{
    if (s->scenario->frames == 1)
        return 1;
    const double last = s->scenario->frames - 1.0;
    const double place = fmod(s->first - 1.0 + frames, 2 * last);
    return 1 + (place <= last ? place : 2 * last - place);
}

/* Rotates the weights of body i from the scenario's pose to the simulated one. */
static void turn_weights(pair_cast *s, int i, const mote_mat3 *shown)
{
    const mote_field *field = s->scenario->body[i].field;
    mote_body_state *body = &s->body[i];
    const uint32_t padded = body->weights.padded;
    double *world = s->weights[i], *still = s->before[i];
    s->before[i] = s->still[i];
    s->still[i] = still;
    for (uint32_t j = 0; j < body->weights.count; ++j) {
        const mote_vec3 w = own_weight(field, &body->weights, shown, j);
        const mote_vec3 turned =
            j < mote_field_vectors(field) ? mote_rotate(&body->pose.rotation, w) : w;
        memcpy(&still[(size_t)3 * j], &w, sizeof w);
        world[j] = turned.x;
        world[padded + j] = turned.y;
        world[2 * padded + j] = turned.z;
    }
    body->weights.x = world;
    body->weights.y = world + padded;
    body->weights.z = world + 2 * (size_t)padded;
}

/* The most that any point of body i has moved since the previous frame: by its centre, by
   rotation, and by deformation. */
static double body_moved(const pair_cast *s, int i)
{
    const mote_rigid_state *a = &s->previous[i], *b = &s->state[i];
    const mote_quaternion back = {a->turn.w, -a->turn.x, -a->turn.y, -a->turn.z};
    const mote_quaternion d = mote_quaternion_multiply(b->turn, back);
    const double chord = 2 * sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    const mote_vec3 *now = (const mote_vec3 *)(const void *)s->still[i];
    const mote_vec3 *then = (const mote_vec3 *)(const void *)s->before[i];
    const mote_reach reach = mote_reach_of(s->scenario->body[i].field, s->sizes[i], then, now);
    return mote_length(mote_sub(b->centre, a->centre)) + chord * (s->radius[i] + reach.shape) +
           reach.change;
}

static double pair_moved(const void *cast)
{
    const pair_cast *s = cast;
    return body_moved(s, 0) + body_moved(s, 1);
}

static const mote_body_state *pair_show(void *cast, uint32_t k, const mote_rigid_state *states)
{
    pair_cast *s = cast;
    memcpy(s->previous, s->state, sizeof s->previous);
    memcpy(s->state, states, sizeof s->state);
    memcpy(s->body,
           mote_scenario_frame_at(s->scenario, s->buffer,
                                  shown_place(s, k * s->options->time_step))
               ->body,
           sizeof s->body);
    for (int i = 0; i < 2; ++i) {
        mote_body_state *body = &s->body[i];
        const mote_mat3 shown = body->pose.rotation;
        body->pose = mote_rigid_pose(&s->masses[i], &states[i]);
        body->pose_changed = true;
        body->shape_changed = body->weights.count > 0 || k == 0;
        if (body->weights.count > 0)
            turn_weights(s, i, &shown);
    }
    return s->body;
}

static void pair_weigh(void *cast, double frames, double *const *weights)
{
    pair_cast *s = cast;
    const mote_frame *frame =
        mote_scenario_frame_at(s->scenario, s->buffer, shown_place(s, frames));
    for (int i = 0; i < 2; ++i)
        mote_cast_weights(s->scenario->body[i].field, &frame->body[i], weights[i]);
}

const mote_cast_kind mote_cast_pair = {pair_create, pair_destroy, pair_restart,
                                       pair_show,   pair_weigh,   pair_moved};
