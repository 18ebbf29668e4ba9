#include "harness/scene/bodies.h"

#include "harness/base/memory.h"
#include "core/base/turn.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

void mote_bodies_destroy(mote_bodies *bodies)
{
    if (!bodies)
        return;
    for (uint32_t i = 0; bodies->shapes && i < bodies->shape_count; ++i) {
        mote_mesh_destroy((mote_mesh *)(uintptr_t)bodies->shapes[i].body.mesh);
        mote_field_destroy((mote_field *)(uintptr_t)bodies->shapes[i].body.field);
        mote_body_motion_free(&bodies->shapes[i].motion);
    }
    free(bodies->shapes);
    free(bodies->shape_of);
    free(bodies->paths);
    free(bodies->recorded);
    free(bodies->name);
    free(bodies->purpose);
    free(bodies->path);
    free(bodies);
}

static const mote_bodies_shape *shape_of(const mote_bodies *bodies, uint32_t i)
{
    return &bodies->shapes[bodies->shape_of[i]];
}

bool mote_bodies_any_given(const mote_bodies *bodies)
{
    for (uint32_t s = 0; s < bodies->shape_count; ++s) {
        if (mote_body_is_given(&bodies->shapes[s].body))
            return true;
    }
    return false;
}

/* Makes the playbacks of shapes with positions, and room for what their bodies show. */
static void make_vertices(const mote_bodies *bodies, mote_bodies_frame *frame)
{
    size_t vertices = 0;
    frame->shape_count = bodies->shape_count;
    frame->playbacks = mote_allocate(bodies->shape_count, sizeof(mote_playback *));
    for (uint32_t s = 0; s < bodies->shape_count; ++s) {
        if (bodies->shapes[s].motion.sequence)
            frame->playbacks[s] = mote_playback_create(bodies->shapes[s].motion.sequence);
    }
    for (uint32_t i = 0; i < bodies->count; ++i) {
        if (frame->playbacks[bodies->shape_of[i]])
            vertices += shape_of(bodies, i)->body.mesh->vertex_count;
    }
    frame->vertices = mote_allocate(vertices + 1, sizeof *frame->vertices);
    mote_vec3 *next = frame->vertices;
    for (uint32_t i = 0; i < bodies->count; ++i) {
        if (!frame->playbacks[bodies->shape_of[i]])
            continue;
        frame->states[i].vertices = next;
        next += shape_of(bodies, i)->body.mesh->vertex_count;
    }
}

mote_bodies_frame mote_bodies_frame_create(const mote_bodies *bodies)
{
    size_t numbers = 1, most = 1;
    for (uint32_t i = 0; i < bodies->count; ++i)
        numbers += (size_t)3 * shape_of(bodies, i)->body.field->padded;
    for (uint32_t s = 0; s < bodies->shape_count; ++s) {
        const uint32_t padded = bodies->shapes[s].body.field->padded;
        most = padded > most ? padded : most;
    }
    mote_bodies_frame made = {.states =
                                  mote_allocate((size_t)bodies->count + 1, sizeof *made.states),
                              .weights = mote_allocate(numbers, sizeof *made.weights),
                              .scratch = mote_allocate(most, sizeof *made.scratch)};
    double *next = made.weights;
    for (uint32_t i = 0; i < bodies->count; ++i) {
        const mote_field *field = shape_of(bodies, i)->body.field;
        const size_t padded = field->padded;
        made.states[i] = (mote_body_state){.shape_changed = true, .pose_changed = true};
        made.states[i].weights = (mote_weights){NULL, NULL, NULL, field->count, field->padded};
        if (padded > 0)
            made.states[i].weights = (mote_weights){next, next + padded, next + 2 * padded,
                                                    field->count, field->padded};
        next += 3 * padded;
    }
    make_vertices(bodies, &made);
    return made;
}

void mote_bodies_frame_free(mote_bodies_frame *frame)
{
    free(frame->states);
    free(frame->weights);
    free(frame->scratch);
    for (uint32_t s = 0; s < frame->shape_count; ++s)
        mote_playback_destroy(frame->playbacks[s]);
    free(frame->playbacks);
    free(frame->vertices);
    *frame = (mote_bodies_frame){0};
}

/* A coordinate that moves at a constant speed and is reflected at -room and room. */
static double between_walls(double start, double way, double room)
{
    if (!(room > 0))
        return 0;
    double phase = fmod(start + room + way, 4 * room);
    if (phase < 0)
        phase += 4 * room;
    return phase <= 2 * room ? phase - room : 3 * room - phase;
}

/* The record of body i at the recorded frame nearest to number; *frame is that frame. */
static const mote_bodies_record *record_at(const mote_bodies *bodies, uint32_t i, double number,
                                           double *frame)
{
    *frame = fmin(fmax(floor(number + 0.5), 1), bodies->frames);
    return &bodies->recorded[(size_t)(*frame - 1) * bodies->count + i];
}

mote_quaternion mote_bodies_turn(const mote_bodies *bodies, uint32_t i)
{
    const mote_bodies_path *path = &bodies->paths[i];
    return bodies->recorded
               ? bodies->recorded[i].turn
               : mote_quaternion_normalise(mote_quaternion_about(path->axis, path->degrees));
}

double mote_bodies_deformation(const mote_bodies *bodies, uint32_t i, double number)
{
    double frame;
    if (!bodies->recorded)
        return bodies->paths[i].time + number;
    const mote_bodies_record *record = record_at(bodies, i, number, &frame);
    return record->deformation + (number - frame);
}

static mote_pose recorded_pose(const mote_bodies *bodies, uint32_t i, double number)
{
    double frame;
    const mote_bodies_record *record = record_at(bodies, i, number, &frame);
    mote_pose pose = {.rotation = mote_quaternion_matrix(record->turn)};
    pose.translation = mote_sub(
        record->middle, mote_rotate(&pose.rotation, shape_of(bodies, i)->motion.centre));
    return pose;
}

mote_pose mote_bodies_pose(const mote_bodies *bodies, uint32_t i, double number)
{
    if (bodies->recorded)
        return recorded_pose(bodies, i, number);
    const mote_bodies_path *path = &bodies->paths[i];
    const double passed = number - 1;
    const mote_vec3 place = {
        between_walls(path->place.x, passed * path->velocity.x, bodies->room.x),
        between_walls(path->place.y, passed * path->velocity.y, bodies->room.y),
        between_walls(path->place.z, passed * path->velocity.z, bodies->room.z)};
    mote_pose pose;
    pose.rotation = mote_quaternion_matrix(
        mote_quaternion_about(path->axis, path->degrees + passed * path->spin));
    pose.translation =
        mote_sub(place, mote_rotate(&pose.rotation, shape_of(bodies, i)->motion.centre));
    return pose;
}

static void set_weights(const mote_bodies_shape *shape, double shown, const mote_pose *pose,
                        const mote_body_state *state, mote_bodies_frame *frame)
{
    const uint32_t count = shape->body.field->count;
    double *x = frame->weights + (state->weights.x - frame->weights);
    const size_t padded = state->weights.padded;
    if (shape->motion.player) {
        mote_player_weights(shape->motion.player, shown, &pose->rotation, x, x + padded,
                            x + 2 * padded);
        return;
    }
    mote_vec3 *w = frame->scratch;
    mote_motion_displacements(&shape->motion, shown, w);
    if (shape->motion.fit) {
        mote_status status = mote_csrbf_fit_solve(shape->motion.fit, w, w);
        assert(status == MOTE_OK); /* every number of a scenario was range-checked */
        (void)status;
    }
    for (uint32_t j = 0; j < count; ++j) {
        const mote_vec3 turned = mote_rotate(&pose->rotation, w[j]);
        x[j] = turned.x;
        x[padded + j] = turned.y;
        x[2 * padded + j] = turned.z;
    }
}

mote_status mote_bodies_deform(const mote_bodies *bodies, uint32_t i, double number,
                               const mote_pose *pose, mote_bodies_frame *frame)
{
    const mote_bodies_shape *shape = shape_of(bodies, i);
    mote_playback *playback = frame->playbacks[bodies->shape_of[i]];
    mote_body_state *state = &frame->states[i];
    const double shown = mote_bodies_deformation(bodies, i, number);
    state->pose = *pose;
    if (playback)
        return mote_playback_at(playback, shown, pose,
                                frame->vertices + (state->vertices - frame->vertices));
    if (shape->body.field->count > 0)
        set_weights(shape, shown, pose, state, frame);
    return MOTE_OK;
}

mote_status mote_bodies_frame_set(const mote_bodies *bodies, double number,
                                  mote_bodies_frame *frame)
{
    mote_status status = MOTE_OK;
    for (uint32_t i = 0; i < bodies->count && status == MOTE_OK; ++i) {
        const mote_pose pose = mote_bodies_pose(bodies, i, number);
        status = mote_bodies_deform(bodies, i, number, &pose, frame);
    }
    return status;
}
