#include "core/certificate/scene.h"

#include "core/certificate/certificate_shared.h"
#include "core/certificate/pair_list.h"
#include "core/certificate/scene_sift.h"
#include "core/base/pool.h"

#include <stdlib.h>
#include <string.h>

/* Bodies and pairs that a thread works on at a time. */
#define GRAIN_BODIES 64
#define GRAIN_PAIRS 4

struct mote_scene {
    mote_scene_options options;
    double length;
    mote_cert_tree **trees; /* [shape_count] */
    uint32_t shape_count;
    uint32_t *shape_of; /* [body_count] */
    uint32_t body_count;
    mote_pool *pool;
    mote_certificate **workspaces; /* [threads] */
    mote_pair_list now, before;
    mote_sift sift;
    /* Arguments of the loop that is running: */
    const mote_body_state *states;
    mote_scene_box *bounds;
};

mote_scene_options mote_default_scene_options(void)
{
    return (mote_scene_options){.ask = MOTE_ASK_DISTANCE, .threads = 1};
}

static mote_status build_trees(mote_scene *s, const mote_body *const *shapes)
{
    const mote_certificate_options plain = mote_default_certificate_options(s->length);
    const mote_cert_tree_options options = {
        .length = s->length, .width = plain.width, .linear_fits = plain.linear_fits};
    for (uint32_t i = 0; i < s->shape_count; ++i) {
        mote_status status = mote_cert_tree_create(shapes[i], &options, &s->trees[i]);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

static mote_status build(mote_scene *s, const mote_body *const *shapes,
                         const uint32_t *shape_of)
{
    for (uint32_t i = 0; i < s->shape_count; ++i)
        s->length = fmax(s->length, shapes[i]->mesh->diagonal);
    s->trees = calloc((size_t)s->shape_count + 1, sizeof(mote_cert_tree *));
    s->shape_of = malloc(s->body_count * sizeof *s->shape_of);
    s->workspaces = calloc(s->options.threads, sizeof(mote_certificate *));
    if (!s->trees || !s->shape_of || !s->workspaces)
        return mote_fail(MOTE_ENOMEM, "no memory for a scene of %u bodies", s->body_count);
    memcpy(s->shape_of, shape_of, s->body_count * sizeof *shape_of);
    mote_status status = build_trees(s, shapes);
    const mote_certificate_options options = mote_default_certificate_options(s->length);
    for (uint32_t i = 0; i < s->options.threads && status == MOTE_OK; ++i)
        status =
            mote_cert_workspace_create(s->trees, s->shape_count, &options, &s->workspaces[i]);
    return status;
}

mote_status mote_scene_create(const mote_body *const *shapes, uint32_t shape_count,
                              const uint32_t *shape_of, uint32_t body_count,
                              const mote_scene_options *options, mote_scene **scene)
{
    mote_status status = mote_scene_refuse_bad(shape_count, shape_of, body_count, options);
    if (status != MOTE_OK)
        return status;
    mote_scene *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a scene");
    made->options = *options;
    made->shape_count = shape_count;
    made->body_count = body_count;
    made->now.memory_size = made->before.memory_size = sizeof(mote_cert_memory);
    status = mote_pool_create(options->threads, &made->pool);
    if (status == MOTE_OK)
        status = build(made, shapes, shape_of);
    if (status == MOTE_OK)
        *scene = made;
    else
        mote_scene_destroy(made);
    return status;
}

void mote_scene_destroy(mote_scene *scene)
{
    if (!scene)
        return;
    mote_pool_destroy(scene->pool);
    for (uint32_t i = 0; scene->trees && i < scene->shape_count; ++i)
        mote_cert_tree_destroy(scene->trees[i]);
    for (uint32_t i = 0; scene->workspaces && i < scene->options.threads; ++i)
        mote_cert_workspace_destroy(scene->workspaces[i]);
    free(scene->trees);
    free(scene->workspaces);
    free(scene->shape_of);
    mote_pair_list_free(&scene->now);
    mote_pair_list_free(&scene->before);
    mote_sift_free(&scene->sift);
    free(scene);
}

size_t mote_scene_bytes(const mote_scene *scene)
{
    size_t bytes = sizeof *scene + scene->body_count * sizeof *scene->shape_of;
    for (uint32_t i = 0; i < scene->shape_count; ++i)
        bytes += mote_cert_tree_bytes(scene->trees[i]);
    for (uint32_t i = 0; i < scene->options.threads; ++i)
        bytes += mote_cert_workspace_bytes(scene->workspaces[i]);
    return bytes + mote_pair_list_bytes(&scene->now) + mote_pair_list_bytes(&scene->before) +
           mote_sift_bytes(&scene->sift, scene->body_count);
}

double mote_scene_length(const mote_scene *scene)
{
    return scene->length;
}

static void bound_range(void *context, uint32_t worker, size_t first, size_t end)
{
    mote_scene *s = context;
    for (size_t i = first; i < end; ++i)
        mote_cert_workspace_bounds(s->workspaces[worker], s->trees[s->shape_of[i]],
                                   &s->states[i], &s->bounds[i].low, &s->bounds[i].high);
}

static mote_status check_bounds(const mote_scene_box *bounds, uint32_t i)
{
    const mote_vec3 size = mote_sub(bounds->high, bounds->low);
    if (isfinite(size.x + size.y + size.z))
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL, "body %u: its pose or a weight is not finite", i);
}

mote_status mote_scene_bounds_of(mote_scene *scene, uint32_t i, const mote_body_state *state,
                                 mote_scene_box *bounds)
{
    mote_cert_workspace_bounds(scene->workspaces[0], scene->trees[scene->shape_of[i]], state,
                               &bounds->low, &bounds->high);
    return check_bounds(bounds, i);
}

mote_status mote_scene_bounds(mote_scene *scene, const mote_body_state *states,
                              mote_scene_box *bounds)
{
    scene->states = states;
    scene->bounds = bounds;
    mote_pool_run(scene->pool, bound_range, scene, scene->body_count, GRAIN_BODIES);
    mote_status status = MOTE_OK;
    for (uint32_t i = 0; i < scene->body_count && status == MOTE_OK; ++i)
        status = check_bounds(&bounds[i], i);
    return status;
}

mote_status mote_scene_sift(mote_scene *scene, const mote_body_state *states, double near,
                            const uint32_t (*pairs)[2], size_t count,
                            const uint32_t (**kept)[2], size_t *kept_count)
{
    const mote_sift_scene lent = {.pool = scene->pool,
                                  .workspaces = scene->workspaces,
                                  .trees = scene->trees,
                                  .shape_of = scene->shape_of,
                                  .body_count = scene->body_count,
                                  .states = states};
    if (!(near >= 0))
        return mote_fail(MOTE_EINVAL, "near: %g; it must not be negative", near);
    mote_status status = mote_pair_list_check(pairs, count, scene->body_count);
    *kept = pairs;
    *kept_count = count;
    if (status != MOTE_OK || isinf(near))
        return status;
    status = mote_sift_pairs(&scene->sift, &lent, near, pairs, count);
    if (status != MOTE_OK)
        return status;
    *kept = (const uint32_t(*)[2])scene->sift.pairs;
    *kept_count = scene->sift.count;
    return MOTE_OK;
}

static void answer_pair(mote_scene *s, mote_certificate *workspace, mote_scene_pair *pair,
                        mote_cert_memory *memory)
{
    const bool contact_only = s->options.ask == MOTE_ASK_CONTACT;
    mote_cert_tree *trees[2];
    mote_frame frame = {.number = 1};
    for (int k = 0; k < 2; ++k) {
        trees[k] = s->trees[s->shape_of[pair->body[k]]];
        frame.body[k] = s->states[pair->body[k]];
    }
    mote_certificate_answer answer;
    mote_cert_workspace_query(workspace, trees, &frame,
                              contact_only ? s->options.tolerance : -1, memory, &answer);
    pair->distance = answer.distance;
    pair->lower = answer.lower;
    pair->contact = answer.distance <= s->options.tolerance;
    pair->decided = pair->contact || answer.lower > s->options.tolerance || !answer.stopped;
    pair->witness[0] = answer.witness[0];
    pair->witness[1] = answer.witness[1];
    pair->counters = answer.counters;
}

static void answer_range(void *context, uint32_t worker, size_t first, size_t end)
{
    mote_scene *s = context;
    mote_cert_memory *memories = (mote_cert_memory *)(void *)s->now.memories;
    for (size_t k = first; k < end; ++k)
        answer_pair(s, s->workspaces[worker], &s->now.pairs[k], &memories[k]);
}

mote_status mote_scene_query(mote_scene *scene, const mote_body_state *states,
                             const uint32_t (*pairs)[2], size_t count)
{
    mote_status status =
        mote_pair_list_renew(&scene->now, &scene->before, pairs, count, scene->body_count);
    if (status != MOTE_OK)
        return status;
    scene->states = states;
    mote_pool_run(scene->pool, answer_range, scene, count, GRAIN_PAIRS);
    return MOTE_OK;
}

const mote_scene_pair *mote_scene_pairs(const mote_scene *scene, size_t *count)
{
    *count = scene->now.count;
    return scene->now.pairs;
}
