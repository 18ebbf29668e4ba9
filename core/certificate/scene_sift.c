#include "core/certificate/scene_sift.h"

#include <stdlib.h>
#include <string.h>

/* Outlines and pairs that a thread works on at a time. */
#define GRAIN_OUTLINES 16
#define GRAIN_PAIRS 32

#define NO_OUTLINE UINT32_MAX

void mote_sift_free(mote_sift *sift)
{
    free(sift->outlines);
    free(sift->bodies);
    free(sift->outline_of);
    free(sift->pairs);
    free(sift->near);
    *sift = (mote_sift){0};
}

size_t mote_sift_bytes(const mote_sift *sift, uint32_t body_count)
{
    return sift->outline_room * (sizeof *sift->outlines + sizeof *sift->bodies) +
           (sift->outline_of ? body_count * sizeof *sift->outline_of : 0) +
           sift->pair_room * (sizeof *sift->pairs + sizeof *sift->near);
}

static mote_status no_memory(size_t count)
{
    return mote_fail(MOTE_ENOMEM, "no memory to look at %zu pairs of bodies", count);
}

static mote_status make_pair_room(mote_sift *sift, size_t count)
{
    if (count <= sift->pair_room)
        return MOTE_OK;
    const size_t room = count + count / 4 + 16;
    uint32_t(*pairs)[2] = malloc(room * sizeof *pairs);
    bool *near = malloc(room * sizeof *near);
    if (!pairs || !near) {
        free(pairs);
        free(near);
        return no_memory(count);
    }
    free(sift->pairs);
    free(sift->near);
    sift->pairs = pairs;
    sift->near = near;
    sift->pair_room = room;
    return MOTE_OK;
}

static mote_status make_outline_room(mote_sift *sift, uint32_t count, uint32_t body_count)
{
    if (count <= sift->outline_room)
        return MOTE_OK;
    const uint32_t more = count + count / 4 + 16;
    const uint32_t room = more < body_count ? more : body_count;
    mote_cert_outline *outlines = malloc(room * sizeof *outlines);
    uint32_t *bodies = malloc(room * sizeof *bodies);
    if (!outlines || !bodies) {
        free(outlines);
        free(bodies);
        return no_memory(count);
    }
    free(sift->outlines);
    free(sift->bodies);
    sift->outlines = outlines;
    sift->bodies = bodies;
    sift->outline_room = room;
    return MOTE_OK;
}

/* Numbers the bodies in pairs; returns how many there are. */
static uint32_t number_bodies(uint32_t *outline_of, uint32_t body_count,
                              const uint32_t (*pairs)[2], size_t count)
{
    uint32_t used = 0;
    for (uint32_t i = 0; i < body_count; ++i)
        outline_of[i] = NO_OUTLINE;
    for (size_t k = 0; k < count; ++k) {
        for (int s = 0; s < 2; ++s) {
            uint32_t *number = &outline_of[pairs[k][s]];
            if (*number == NO_OUTLINE)
                *number = used++;
        }
    }
    return used;
}

/* Arguments of the loops. */
typedef struct task {
    mote_sift *sift;
    const mote_sift_scene *scene;
    double near;
    const uint32_t (*pairs)[2];
} task;

static void outline_range(void *context, uint32_t worker, size_t first, size_t end)
{
    const task *t = context;
    for (size_t i = first; i < end; ++i) {
        const uint32_t body = t->sift->bodies[i];
        mote_cert_workspace_outline(t->scene->workspaces[worker],
                                    t->scene->trees[t->scene->shape_of[body]],
                                    &t->scene->states[body], &t->sift->outlines[i]);
    }
}

static void pair_range(void *context, uint32_t worker, size_t first, size_t end)
{
    const task *t = context;
    const mote_sift *sift = t->sift;
    const double scale = t->scene->trees[0]->scale;
    (void)worker;
    for (size_t k = first; k < end; ++k) {
        const mote_cert_outline *const both[2] = {
            &sift->outlines[sift->outline_of[t->pairs[k][0]]],
            &sift->outlines[sift->outline_of[t->pairs[k][1]]]};
        sift->near[k] = mote_cert_outlines_near(both[0], both[1], scale, t->near);
    }
}

mote_status mote_sift_pairs(mote_sift *sift, const mote_sift_scene *scene, double near,
                            const uint32_t (*pairs)[2], size_t count)
{
    task t = {.sift = sift, .scene = scene, .near = near, .pairs = pairs};
    sift->count = 0;
    mote_status status = make_pair_room(sift, count);
    if (status == MOTE_OK && !sift->outline_of)
        sift->outline_of = malloc(scene->body_count * sizeof *sift->outline_of);
    if (status != MOTE_OK || !sift->outline_of)
        return no_memory(count);
    const uint32_t used = number_bodies(sift->outline_of, scene->body_count, pairs, count);
    status = make_outline_room(sift, used, scene->body_count);
    if (status != MOTE_OK)
        return status;
    for (uint32_t i = 0; i < scene->body_count; ++i) {
        if (sift->outline_of[i] != NO_OUTLINE)
            sift->bodies[sift->outline_of[i]] = i;
    }
    mote_pool_run(scene->pool, outline_range, &t, used, GRAIN_OUTLINES);
    mote_pool_run(scene->pool, pair_range, &t, count, GRAIN_PAIRS);
    for (size_t k = 0; k < count; ++k) {
        if (sift->near[k])
            memcpy(sift->pairs[sift->count++], pairs[k], sizeof pairs[k]);
    }
    return MOTE_OK;
}
