#include "harness/report/replay_keys.h"

#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Chooses the first frame, the last, and others evenly between. */
static void choose_frames(uint32_t first, uint32_t last, uint32_t vertices,
                          mote_replay_keys *keys)
{
    const uint32_t frames = last - first + 1, room = MOTE_REPLAY_KEYED / (3 * vertices);
    const uint32_t least = room < 2 ? 2 : room;
    keys->count = least < frames ? least : frames;
    keys->frame = mote_allocate(keys->count, sizeof *keys->frame);
    for (uint32_t k = 0; k < keys->count; ++k)
        keys->frame[k] =
            keys->count > 1 ? first + (uint32_t)((uint64_t)k * (frames - 1) / (keys->count - 1))
                            : first;
}

/* The displacement of each vertex from rest, in the body's axes. */
static void displacements(const mote_body *body, const mote_body_state *state, mote_vec3 *mode)
{
    for (uint32_t v = 0; v < body->mesh->vertex_count; ++v) {
        const mote_vec3 local = mote_rotate_back(
            &state->pose.rotation, mote_sub(state->vertices[v], state->pose.translation));
        mode[v] = mote_sub(local, body->mesh->positions[v]);
    }
}

static mote_status make_modes(const mote_scenario *scenario, int i, mote_replay_keys *keys)
{
    const mote_body *body = &scenario->body[i];
    const uint32_t vertices = body->mesh->vertex_count;
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_vec3 *modes = mote_allocate((size_t)keys->count * vertices, sizeof *modes);
    mote_status status = MOTE_OK;
    for (uint32_t k = 0; k < keys->count && status == MOTE_OK; ++k) {
        const mote_frame *frame = mote_scenario_frame(scenario, buffer, keys->frame[k], 0);
        if (frame)
            displacements(body, &frame->body[i], modes + (size_t)k * vertices);
        else
            status = mote_error_status();
    }
    if (status == MOTE_OK)
        status = mote_field_create_modes(modes, keys->count, vertices, &keys->field);
    mote_frame_buffer_destroy(buffer);
    free(modes);
    return status;
}

mote_status mote_replay_keys_make(const mote_scenario *scenario, int i, uint32_t first,
                                  uint32_t last, mote_replay_keys *keys)
{
    const mote_body *body = &scenario->body[i];
    if (!mote_body_is_given(body))
        return MOTE_OK;
    choose_frames(first, last, body->mesh->vertex_count, keys);
    return make_modes(scenario, i, keys);
}

void mote_replay_keys_free(mote_replay_keys *keys)
{
    mote_field_destroy(keys->field);
    free(keys->frame);
    *keys = (mote_replay_keys){0};
}

void mote_replay_keys_weights(const mote_replay_keys *keys, uint32_t frame, double *weights)
{
    memset(weights, 0, (size_t)9 * keys->count * sizeof *weights);
    uint32_t k = 0;
    while (k + 1 < keys->count && keys->frame[k + 1] <= frame)
        ++k;
    const double span = k + 1 < keys->count ? keys->frame[k + 1] - keys->frame[k] : 1;
    const double part = (frame - keys->frame[k]) / span;
    for (uint32_t axis = 0; axis < 3; ++axis) {
        const size_t entry = 3 * (size_t)axis + axis; /* of function 3 k + axis */
        weights[(size_t)9 * k + entry] = 1 - part;
        if (part > 0)
            weights[(size_t)9 * (k + 1) + entry] = part;
    }
}
