#include "harness/scene/sample_poses.h"

#include "harness/base/memory.h"

#include <stdlib.h>

struct mote_sample_poses {
    mote_weights weights[2][MOTE_SAMPLE_FRAMES];
    double *numbers[2]; /* padded x, y and z of the weights; NULL: no weights */
};

/* The weights of a state as if its body were not rotated. */
static mote_weights turn_back(const mote_body_state *state, double *numbers)
{
    const mote_weights *from = &state->weights;
    double *x = numbers, *y = x + from->padded, *z = y + from->padded;
    for (uint32_t j = 0; j < from->count; ++j) {
        const mote_vec3 w = mote_rotate_back(
            &state->pose.rotation, mote_vec3_make(from->x[j], from->y[j], from->z[j]));
        x[j] = w.x;
        y[j] = w.y;
        z[j] = w.z;
    }
    return (mote_weights){x, y, z, from->count, from->padded};
}

/* The weights of sample k of both bodies. */
static mote_status set_sample(const mote_scenario *scenario, mote_frame_buffer *buffer,
                              uint32_t k, mote_sample_poses *poses)
{
    const uint64_t middle = (2 * (uint64_t)k + 1) * scenario->frames;
    const uint32_t number = 1 + (uint32_t)(middle / (2 * MOTE_SAMPLE_FRAMES));
    const mote_frame *frame = mote_scenario_frame(
        scenario, buffer, number < scenario->frames ? number : scenario->frames, 0);
    if (!frame)
        return mote_error_status();
    for (int b = 0; b < 2; ++b) {
        const mote_body_state *state = &frame->body[b];
        if (poses->numbers[b])
            poses->weights[b][k] =
                turn_back(state, poses->numbers[b] + (size_t)3 * state->weights.padded * k);
    }
    return MOTE_OK;
}

mote_status mote_sample_poses_create(const mote_scenario *scenario, mote_sample_poses **poses)
{
    mote_sample_poses *made = mote_allocate(1, sizeof *made);
    for (int b = 0; b < 2; ++b) {
        const size_t padded = scenario->body[b].field->padded;
        if (padded > 0)
            made->numbers[b] = mote_allocate(3 * padded * MOTE_SAMPLE_FRAMES, sizeof(double));
    }
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_status status = MOTE_OK;
    for (uint32_t k = 0; k < MOTE_SAMPLE_FRAMES && status == MOTE_OK; ++k)
        status = set_sample(scenario, buffer, k, made);
    mote_frame_buffer_destroy(buffer);
    if (status == MOTE_OK)
        *poses = made;
    else
        mote_sample_poses_destroy(made);
    return status;
}

void mote_sample_poses_destroy(mote_sample_poses *poses)
{
    if (!poses)
        return;
    for (int b = 0; b < 2; ++b)
        free(poses->numbers[b]);
    free(poses);
}

void mote_sample_poses_bodies(const mote_sample_poses *poses, const mote_scenario *scenario,
                              mote_body body[2])
{
    for (int b = 0; b < 2; ++b) {
        body[b] = scenario->body[b];
        if (body[b].sample_count > 0 || !poses->numbers[b])
            continue;
        body[b].samples = poses->weights[b];
        body[b].sample_count = MOTE_SAMPLE_FRAMES;
    }
}
