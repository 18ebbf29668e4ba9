#include "harness/scene/scenario.h"

#include "core/body/deform.h"
#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/mesh/faces.h"
#include "harness/scene/motion.h"
#include "harness/sequence/playback.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct mote_frame_buffer {
    mote_frame frame;
    double *weights[2];         /* 3 * padded: x, y, z */
    mote_vec3 *displacement[2]; /* [J], rest axes */
    mote_vec3 *before[2];       /* of the frame set before */
    mote_vec3 *solution[2];     /* [J], weights in rest axes */
    mote_playback *playback[2]; /* of a body without a field, otherwise NULL */
    mote_vec3 *world[2];        /* what it shows */
};

void mote_scenario_destroy(mote_scenario *scenario)
{
    if (!scenario)
        return;
    for (int i = 0; i < 2; ++i) {
        if (i == 0 || scenario->body[1].mesh != scenario->body[0].mesh)
            mote_mesh_destroy((mote_mesh *)(uintptr_t)scenario->body[i].mesh);
        mote_field_destroy((mote_field *)(uintptr_t)scenario->body[i].field);
        if (scenario->motion)
            mote_body_motion_free(&scenario->motion->body[i]);
    }
    free(scenario->motion);
    free(scenario->name);
    free(scenario->purpose);
    free(scenario->path);
    free(scenario);
}

mote_frame_buffer *mote_frame_buffer_create(const mote_scenario *scenario)
{
    mote_frame_buffer *made = mote_allocate(1, sizeof *made);
    for (int i = 0; i < 2; ++i) {
        const mote_field *field = scenario->body[i].field;
        if (scenario->motion->body[i].sequence) {
            made->playback[i] = mote_playback_create(scenario->motion->body[i].sequence);
            made->world[i] =
                mote_allocate(scenario->body[i].mesh->vertex_count, sizeof(mote_vec3));
        }
        if (field->count == 0)
            continue;
        made->weights[i] = mote_allocate((size_t)3 * field->padded, sizeof(double));
        made->displacement[i] = mote_allocate(field->count, sizeof(mote_vec3));
        made->before[i] = mote_allocate(field->count, sizeof(mote_vec3));
        made->solution[i] = mote_allocate(field->count, sizeof(mote_vec3));
    }
    return made;
}

void mote_frame_buffer_destroy(mote_frame_buffer *buffer)
{
    if (!buffer)
        return;
    for (int i = 0; i < 2; ++i) {
        free(buffer->weights[i]);
        free(buffer->displacement[i]);
        free(buffer->before[i]);
        free(buffer->solution[i]);
        mote_playback_destroy(buffer->playback[i]);
        free(buffer->world[i]);
    }
    free(buffer);
}

/* The position on the path of a frame, or of a place between frames. */
static double path_place(const mote_scenario *scenario, double number)
{
    return scenario->motion->start + (number - 1) * scenario->motion->pace;
}

/* Sets the weights that produce the motion's displacements of the control points, rotated with
   the body. */
static void set_weights(const mote_scenario *scenario, mote_frame_buffer *buffer, int i,
                        double place)
{
    const mote_field *field = scenario->body[i].field;
    const mote_body_motion *motion = &scenario->motion->body[i];
    mote_body_state *state = &buffer->frame.body[i];
    state->weights = (mote_weights){NULL, NULL, NULL, field->count, field->padded};
    if (field->count == 0)
        return;
    double *x = buffer->weights[i], *y = x + field->padded, *z = y + field->padded;
    state->weights.x = x;
    state->weights.y = y;
    state->weights.z = z;
    mote_motion_displacements(motion, place, buffer->displacement[i]);
    if (motion->player) {
        mote_player_weights(motion->player, place, &state->pose.rotation, x, y, z);
        return;
    }
    const mote_vec3 *solution = buffer->displacement[i];
    if (motion->fit) {
        mote_status status =
            mote_csrbf_fit_solve(motion->fit, buffer->displacement[i], buffer->solution[i]);
        assert(status == MOTE_OK); /* every number of a scenario was range-checked */
        (void)status;
        solution = buffer->solution[i];
    }
    for (uint32_t j = 0; j < field->count; ++j) {
        const mote_vec3 w = mote_rotate(&state->pose.rotation, solution[j]);
        x[j] = w.x;
        y[j] = w.y;
        z[j] = w.z;
    }
}

static void set_changes(const mote_scenario *scenario, mote_frame_buffer *buffer, int i,
                        double now, uint32_t previous)
{
    const mote_body_motion *motion = &scenario->motion->body[i];
    mote_body_state *state = &buffer->frame.body[i];
    state->shape_changed = true;
    state->pose_changed = true;
    if (previous == 0)
        return;
    const double before = path_place(scenario, previous);
    const mote_pose pose = mote_motion_pose(motion, before);
    state->pose_changed = memcmp(&pose, &state->pose, sizeof pose) != 0;
    if (buffer->playback[i]) {
        state->shape_changed = before != now;
        return;
    }
    const uint32_t count = scenario->body[i].field->count;
    if (count > 0)
        mote_motion_displacements(motion, before, buffer->before[i]);
    state->shape_changed = count > 0 && memcmp(buffer->before[i], buffer->displacement[i],
                                               count * sizeof(mote_vec3)) != 0;
}

static const mote_frame *set_frame(const mote_scenario *scenario, mote_frame_buffer *buffer,
                                   double number, uint32_t previous)
{
    const double place = path_place(scenario, number);
    for (int i = 0; i < 2; ++i) {
        mote_body_state *state = &buffer->frame.body[i];
        state->pose = mote_motion_pose(&scenario->motion->body[i], place);
        state->vertices = buffer->world[i];
        set_weights(scenario, buffer, i, place);
        set_changes(scenario, buffer, i, place, previous);
        if (buffer->playback[i] && mote_playback_at(buffer->playback[i], place, &state->pose,
                                                    buffer->world[i]) != MOTE_OK)
            return NULL;
    }
    return &buffer->frame;
}

const mote_frame *mote_scenario_frame(const mote_scenario *scenario, mote_frame_buffer *buffer,
                                      uint32_t number, uint32_t previous)
{
    buffer->frame.number = number;
    return set_frame(scenario, buffer, number, previous);
}

const mote_frame *mote_scenario_frame_at(const mote_scenario *scenario,
                                         mote_frame_buffer *buffer, double place)
{
    buffer->frame.number = 0;
    return set_frame(scenario, buffer, place, 0);
}

/* The axis of a rotation by more than a quarter turn. Its symmetric part tells it, all but its
   sign; twice_sine, which vanishes at half a turn, tells that. */
static mote_vec3 axis_of(double m[3][3], double cosine, mote_vec3 twice_sine)
{
    int k = m[1][1] > m[0][0] ? 1 : 0;
    k = m[2][2] > m[k][k] ? 2 : k;
    const mote_vec3 column = mote_vec3_make((m[0][k] + m[k][0]) / 2 - (k == 0 ? cosine : 0),
                                            (m[1][k] + m[k][1]) / 2 - (k == 1 ? cosine : 0),
                                            (m[2][k] + m[k][2]) / 2 - (k == 2 ? cosine : 0));
    const double sign = mote_dot(column, twice_sine) < 0 ? -1 : 1;
    return mote_scale(column, sign / mote_length(column));
}

/* The rotation vector of to * from^-1. */
static mote_vec3 rotation_between(const mote_mat3 *from, const mote_mat3 *to)
{
    double m[3][3];
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            m[r][c] = to->m[r][0] * from->m[c][0] + to->m[r][1] * from->m[c][1] +
                      to->m[r][2] * from->m[c][2];
    }
    const mote_vec3 twice_sine =
        mote_vec3_make(m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]);
    const double sine = mote_length(twice_sine) / 2;
    const double cosine = (m[0][0] + m[1][1] + m[2][2] - 1) / 2;
    if (cosine < 0)
        return mote_scale(axis_of(m, cosine, twice_sine), atan2(sine, cosine));
    return sine > 0 ? mote_scale(twice_sine, atan2(sine, cosine) / (2 * sine)) : twice_sine;
}

void mote_scenario_velocity(const mote_scenario *scenario, int i, mote_vec3 *velocity,
                            mote_vec3 *spin)
{
    const mote_body_motion *motion = &scenario->motion->body[i];
    const uint32_t next = scenario->frames > 1 ? 2 : 1;
    const mote_pose from = mote_motion_pose(motion, path_place(scenario, 1));
    const mote_pose to = mote_motion_pose(motion, path_place(scenario, next));
    *velocity = motion->has_velocity ? motion->velocity
                                     : mote_sub(mote_pose_apply(&to, motion->centre),
                                                mote_pose_apply(&from, motion->centre));
    *spin = motion->has_spin ? motion->spin : rotation_between(&from.rotation, &to.rotation);
}

static mote_status hash_frames(const mote_scenario *scenario, mote_frame_buffer *buffer,
                               mote_deform *const deform[2], mote_vec3 *world,
                               uint64_t *fingerprint)
{
    uint64_t hash = MOTE_HASH_START;
    for (uint32_t number = 1; number <= scenario->frames; ++number) {
        const mote_frame *frame = mote_scenario_frame(scenario, buffer, number, 0);
        if (!frame)
            return mote_error_status();
        for (int i = 0; i < 2; ++i) {
            mote_deform_all(deform[i], &frame->body[i], world);
            for (uint32_t v = 0; v < scenario->body[i].mesh->vertex_count; ++v) {
                hash = mote_hash_double(hash, world[v].x);
                hash = mote_hash_double(hash, world[v].y);
                hash = mote_hash_double(hash, world[v].z);
            }
        }
    }
    *fingerprint = hash;
    return MOTE_OK;
}

mote_status mote_scenario_fingerprint(const mote_scenario *scenario, uint64_t *fingerprint)
{
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_deform *deform[2] = {NULL, NULL};
    mote_status status = MOTE_OK;
    const uint32_t a = scenario->body[0].mesh->vertex_count;
    const uint32_t b = scenario->body[1].mesh->vertex_count;
    mote_vec3 *world = mote_allocate(a > b ? a : b, sizeof *world);
    for (int i = 0; i < 2 && status == MOTE_OK; ++i)
        status = mote_deform_create(&scenario->body[i], &deform[i]);
    if (status == MOTE_OK)
        status = hash_frames(scenario, buffer, deform, world, fingerprint);
    mote_deform_destroy(deform[0]);
    mote_deform_destroy(deform[1]);
    mote_frame_buffer_destroy(buffer);
    free(world);
    return status;
}

uint64_t mote_scenario_faces(const mote_scenario *scenario)
{
    return mote_faces_hash(mote_faces_hash(MOTE_HASH_START, scenario->body[0].mesh),
                           scenario->body[1].mesh);
}
