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
    return made;
}

void mote_bodies_frame_free(mote_bodies_frame *frame)
{
    free(frame->states);
    free(frame->weights);
    free(frame->scratch);
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

void mote_bodies_deform(const mote_bodies *bodies, uint32_t i, double number,
                        const mote_pose *pose, mote_bodies_frame *frame)
{
    const mote_bodies_shape *shape = shape_of(bodies, i);
    const uint32_t count = shape->body.field->count;
    mote_body_state *state = &frame->states[i];
    state->pose = *pose;
    if (count == 0)
        return;
    double *x = frame->weights + (state->weights.x - frame->weights);
    const size_t padded = state->weights.padded;
    const double shown = mote_bodies_deformation(bodies, i, number);
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

void mote_bodies_frame_set(const mote_bodies *bodies, double number, mote_bodies_frame *frame)
{
    for (uint32_t i = 0; i < bodies->count; ++i) {
        const mote_pose pose = mote_bodies_pose(bodies, i, number);
        mote_bodies_deform(bodies, i, number, &pose, frame);
    }
}
