/* Reads the motion of a body: key poses, each with a position, a rotation, or both. */
#include "harness/base/memory.h"
#include "harness/scene/scenario_read.h"

#include "harness/scene/spread.h"

#include <math.h>
#include <stdlib.h>

typedef struct key_list {
    uint32_t *position_frames, *rotation_frames;
    mote_vec3 *positions;
    mote_quaternion *rotations;
    uint32_t position_count, rotation_count;
} key_list;

static void free_keys(key_list *keys)
{
    free(keys->position_frames);
    free(keys->rotation_frames);
    free(keys->positions);
    free(keys->rotations);
}

static mote_status read_rotation(const mote_json *node, bool *present, mote_quaternion *q)
{
    mote_json axis = mote_json_member(node, "axis");
    mote_json degrees = mote_json_member(node, "degrees");
    mote_json quaternion = mote_json_member(node, "quaternion");
    *present = axis.value || degrees.value || quaternion.value;
    if (!*present)
        return MOTE_OK;
    if (quaternion.value) {
        if (axis.value || degrees.value)
            return mote_json_fail(node, "has two rotations; give axis and degrees, or "
                                        "quaternion");
        double w[4];
        mote_status status = mote_json_reals(&quaternion, 4, -2, 2, w);
        if (status != MOTE_OK)
            return status;
        const double norm = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3]);
        if (!(fabs(norm - 1) <= 1e-3))
            return mote_json_fail(&quaternion, "has length %g; give w, x, y, z of length 1",
                                  norm);
        *q = (mote_quaternion){w[0] / norm, w[1] / norm, w[2] / norm, w[3] / norm};
        return MOTE_OK;
    }
    mote_vec3 direction;
    double angle;
    mote_status status = mote_json_vec3(&axis, -1e6, 1e6, &direction);
    if (status == MOTE_OK && !(mote_length(direction) >= 1e-6))
        status = mote_json_fail(&axis, "has no direction; give a vector that is not zero");
    if (status == MOTE_OK)
        status = mote_json_real(&degrees, -1e6, 1e6, &angle);
    if (status == MOTE_OK)
        *q = mote_quaternion_about(direction, angle);
    return status;
}

static mote_status read_key(const mote_json *node, double length, key_list *keys)
{
    int64_t number = 0;
    mote_status status = mote_json_object(node, "frame|position|axis|degrees|quaternion");
    mote_json key = mote_json_member(node, "frame");
    if (status == MOTE_OK)
        status = mote_json_integer(&key, 1, MOTE_FRAMES_MAX, &number);
    mote_json position = mote_json_member(node, "position");
    if (status == MOTE_OK && position.value) {
        mote_vec3 *at = &keys->positions[keys->position_count];
        status = mote_json_vec3(&position, -1e6, 1e6, at);
        *at = mote_scale(*at, status == MOTE_OK ? length : 0);
        keys->position_frames[keys->position_count++] = (uint32_t)number;
    }
    bool rotates = false;
    if (status == MOTE_OK)
        status = read_rotation(node, &rotates, &keys->rotations[keys->rotation_count]);
    if (rotates)
        keys->rotation_frames[keys->rotation_count++] = (uint32_t)number;
    if (status == MOTE_OK && !position.value && !rotates)
        status = mote_json_fail(node, "sets nothing; give position, or axis and degrees, or "
                                      "quaternion");
    return status;
}

static mote_status make_curves(const mote_json *node, key_list *keys, mote_body_motion *motion)
{
    mote_status status = MOTE_OK;
    if (keys->position_count > 0)
        status = mote_curve_create(keys->position_frames, &keys->positions->x,
                                   keys->position_count, 3, &motion->position);
    if (status == MOTE_OK && keys->rotation_count > 0) {
        mote_quaternions_align(keys->rotations, keys->rotation_count);
        status = mote_curve_create(keys->rotation_frames, &keys->rotations->w,
                                   keys->rotation_count, 4, &motion->rotation);
    }
    return mote_json_blame(node, status);
}

/* Between keys far apart the curve could pass near the origin, where it gives no rotation. */
static mote_status check_rotation(const mote_json *node, uint32_t frames,
                                  const mote_curve *curve)
{
    for (uint32_t frame = 1; curve && frame <= frames; ++frame) {
        double q[4];
        mote_curve_evaluate(curve, frame, q);
        if (!(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] >= 0.04))
            return mote_json_fail(node,
                                  "frame %u: rotations too far apart to go through "
                                  "smoothly; give keys at most 90 degrees apart",
                                  frame);
    }
    return MOTE_OK;
}

/* "velocity": L per frame; "spin": degrees per frame about x, y, z. */
static mote_status read_velocities(const mote_json *body, double length,
                                   mote_body_motion *motion)
{
    const double pi = 3.14159265358979323846;
    mote_json velocity = mote_json_member(body, "velocity");
    mote_json spin = mote_json_member(body, "spin");
    mote_status status = MOTE_OK;
    motion->has_velocity = velocity.value != NULL;
    motion->has_spin = spin.value != NULL;
    if (motion->has_velocity)
        status = mote_json_vec3(&velocity, -1e3, 1e3, &motion->velocity);
    if (status == MOTE_OK && motion->has_spin)
        status = mote_json_vec3(&spin, -180, 180, &motion->spin);
    motion->velocity = mote_scale(motion->velocity, length);
    motion->spin = mote_scale(motion->spin, pi / 180);
    return status;
}

mote_status mote_scenario_read_motion(const mote_json *body, const mote_mesh *mesh,
                                      double length, uint32_t frames, mote_body_motion *motion)
{
    mote_json node = mote_json_member(body, "motion");
    /* Without a motion, given positions stay where their files have them. */
    if (node.value || !motion->sequence)
        motion->centre = mote_mesh_centre(mesh);
    mote_status status = read_velocities(body, length, motion);
    if (status != MOTE_OK || !node.value)
        return status;
    size_t count;
    status = mote_json_array(&node, 1, MOTE_FRAMES_MAX, &count);
    if (status != MOTE_OK)
        return status;
    key_list keys = {mote_allocate(count, sizeof *keys.position_frames),
                     mote_allocate(count, sizeof *keys.rotation_frames),
                     mote_allocate(count, sizeof *keys.positions),
                     mote_allocate(count, sizeof *keys.rotations),
                     0,
                     0};
    for (size_t k = 0; k < count && status == MOTE_OK; ++k) {
        mote_json element = mote_json_element(&node, k);
        status = read_key(&element, length, &keys);
    }
    if (status == MOTE_OK)
        status = make_curves(&node, &keys, motion);
    if (status == MOTE_OK)
        status = check_rotation(&node, frames, motion->rotation);
    free_keys(&keys);
    return status;
}
