#include "harness/scene/bodies.h"

#include "core/body/deform.h"
#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/mesh/faces.h"

#include <stdlib.h>

static uint64_t hash_vec3(uint64_t hash, mote_vec3 v)
{
    return mote_hash_double(mote_hash_double(mote_hash_double(hash, v.x), v.y), v.z);
}

/* The poses of all bodies at every frame. */
static uint64_t hash_paths(const mote_bodies *bodies)
{
    uint64_t hash = mote_hash_word(MOTE_HASH_START, bodies->frames);
    hash = hash_vec3(mote_hash_double(hash, bodies->near), bodies->room);
    for (uint32_t i = 0; i < bodies->count; ++i) {
        const mote_bodies_path *path = &bodies->paths[i];
        hash = hash_vec3(mote_hash_word(hash, bodies->shape_of[i]), path->place);
        hash = hash_vec3(hash_vec3(hash, path->velocity), path->axis);
        hash = mote_hash_double(mote_hash_double(hash, path->degrees), path->spin);
        hash = mote_hash_double(hash, path->time);
    }
    const size_t records = bodies->recorded ? (size_t)bodies->frames * bodies->count : 0;
    for (size_t r = 0; r < records; ++r) {
        const mote_bodies_record *record = &bodies->recorded[r];
        hash = mote_hash_double(hash_vec3(hash, record->middle), record->deformation);
        hash = mote_hash_double(mote_hash_double(hash, record->turn.w), record->turn.x);
        hash = mote_hash_double(mote_hash_double(hash, record->turn.y), record->turn.z);
    }
    return hash;
}

/* The weights of every body, and the deformed vertices of the first of each shape. */
static mote_status hash_frame(const mote_bodies *bodies, const mote_bodies_frame *frame,
                              uint64_t *hash)
{
    bool seen[MOTE_BODIES_SHAPES_MAX] = {false};
    mote_status status = MOTE_OK;
    for (uint32_t i = 0; i < bodies->count && status == MOTE_OK; ++i) {
        const mote_weights *w = &frame->states[i].weights;
        for (uint32_t j = 0; j < w->count; ++j)
            *hash = hash_vec3(*hash, mote_vec3_make(w->x[j], w->y[j], w->z[j]));
        const mote_body *body = &bodies->shapes[bodies->shape_of[i]].body;
        if (seen[bodies->shape_of[i]])
            continue;
        seen[bodies->shape_of[i]] = true;
        const uint32_t count = body->mesh->vertex_count;
        mote_deform *deform = NULL;
        mote_vec3 *world = mote_allocate(count, sizeof *world);
        status = mote_deform_create(body, &deform);
        if (status == MOTE_OK)
            mote_deform_all(deform, &frame->states[i], world);
        for (uint32_t v = 0; v < count && status == MOTE_OK; ++v)
            *hash = hash_vec3(*hash, world[v]);
        mote_deform_destroy(deform);
        free(world);
    }
    return status;
}

/* The vertices of shapes with positions, in their own axes, in every frame that they show. */
static mote_status hash_sequences(const mote_bodies *bodies, const mote_bodies_frame *frame,
                                  uint64_t *hash)
{
    const mote_pose rest = {.rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    mote_status status = MOTE_OK;
    for (uint32_t s = 0; s < bodies->shape_count; ++s) {
        const mote_body *body = &bodies->shapes[s].body;
        if (!mote_body_is_given(body))
            continue;
        const uint32_t count = body->mesh->vertex_count;
        mote_vec3 *world = mote_allocate(count, sizeof *world);
        for (uint32_t k = 1; k <= bodies->frames && status == MOTE_OK; ++k) {
            status = mote_playback_at(frame->playbacks[s], k, &rest, world);
            for (uint32_t v = 0; v < count && status == MOTE_OK; ++v)
                *hash = hash_vec3(*hash, world[v]);
        }
        free(world);
    }
    return status;
}

mote_status mote_bodies_fingerprint(const mote_bodies *bodies, uint64_t *fingerprint)
{
    const uint32_t numbers[] = {1, (bodies->frames + 1) / 2, bodies->frames};
    uint64_t hash = hash_paths(bodies);
    mote_bodies_frame frame = mote_bodies_frame_create(bodies);
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0] && status == MOTE_OK; ++k) {
        status = mote_bodies_frame_set(bodies, numbers[k], &frame);
        if (status == MOTE_OK)
            status = hash_frame(bodies, &frame, &hash);
    }
    if (status == MOTE_OK)
        status = hash_sequences(bodies, &frame, &hash);
    mote_bodies_frame_free(&frame);
    if (status == MOTE_OK)
        *fingerprint = hash;
    return status;
}

uint64_t mote_bodies_faces(const mote_bodies *bodies)
{
    uint64_t hash = MOTE_HASH_START;
    for (uint32_t s = 0; s < bodies->shape_count; ++s)
        hash = mote_faces_hash(hash, bodies->shapes[s].body.mesh);
    return hash;
}
