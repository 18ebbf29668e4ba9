#include "core/stream/stream_scene.h"

#include "core/base/pool.h"
#include "core/certificate/pair_list.h"
#include "core/stream/stream_state.h"

#include <stdlib.h>
#include <string.h>

/* Bodies and pairs that a thread works on at a time. */
#define GRAIN_BODIES 1
#define GRAIN_PAIRS 4

struct mote_stream_scene {
    mote_scene_options options;
    double length, scale;
    mote_stream_tree **trees; /* [shape_count] */
    uint32_t shape_count;
    mote_stream_body *bodies; /* [body_count] */
    uint32_t body_count;
    mote_pool *pool;
    mote_stream_search *searches; /* [threads] */
    mote_pair_list now, before;
    /* Of the loop that is running: */
    mote_scene_box *bounds;
};

static mote_status build_bodies(mote_stream_scene *s, const uint32_t *shape_of)
{
    mote_status status = MOTE_OK;
    for (uint32_t i = 0; i < s->body_count && status == MOTE_OK; ++i)
        status = mote_stream_body_init(&s->bodies[i], s->trees[shape_of[i]]);
    return status;
}

static mote_status build_searches(mote_stream_scene *s)
{
    mote_stream_options options = mote_default_stream_options(s->length);
    const mote_body *largest = &s->trees[0]->body;
    uint32_t groups = 0;
    for (uint32_t i = 0; i < s->shape_count; ++i) {
        const mote_stream_tree *tree = s->trees[i];
        if (tree->mesh->vertex_count > largest->mesh->vertex_count)
            largest = &tree->body;
        groups = tree->groups > groups ? tree->groups : groups;
    }
    const mote_body *const both[2] = {largest, largest};
    const uint32_t room[2] = {groups, groups};
    mote_status status = MOTE_OK;
    for (uint32_t i = 0; i < s->options.threads && status == MOTE_OK; ++i)
        status = mote_stream_search_init(&s->searches[i], &options, both, room);
    return status;
}

static mote_status build(mote_stream_scene *s, const mote_body *const *shapes,
                         const uint32_t *shape_of)
{
    s->trees = calloc((size_t)s->shape_count + 1, sizeof(mote_stream_tree *));
    s->bodies = calloc(s->body_count, sizeof *s->bodies);
    s->searches = calloc(s->options.threads, sizeof *s->searches);
    if (!s->trees || !s->bodies || !s->searches)
        return mote_fail(MOTE_ENOMEM, "no memory for a scene of %u bodies", s->body_count);
    mote_status status = mote_pool_create(s->options.threads, &s->pool);
    for (uint32_t i = 0; i < s->shape_count && status == MOTE_OK; ++i) {
        s->length = fmax(s->length, shapes[i]->mesh->diagonal);
        status = mote_stream_tree_create(shapes[i], &s->trees[i]);
    }
    if (status != MOTE_OK)
        return status;
    s->scale = ldexp(1, -ilogb(s->length));
    status = build_bodies(s, shape_of);
    return status == MOTE_OK ? build_searches(s) : status;
}

mote_status mote_stream_scene_create(const mote_body *const *shapes, uint32_t shape_count,
                                     const uint32_t *shape_of, uint32_t body_count,
                                     const mote_scene_options *options,
                                     mote_stream_scene **scene)
{
    mote_status status = mote_scene_refuse_bad(shape_count, shape_of, body_count, options);
    if (status != MOTE_OK)
        return status;
    mote_stream_scene *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a scene");
    made->options = *options;
    made->shape_count = shape_count;
    made->body_count = body_count;
    made->now.memory_size = made->before.memory_size = sizeof(mote_stream_memory);
    status = build(made, shapes, shape_of);
    if (status == MOTE_OK)
        *scene = made;
    else
        mote_stream_scene_destroy(made);
    return status;
}

void mote_stream_scene_destroy(mote_stream_scene *scene)
{
    if (!scene)
        return;
    mote_pool_destroy(scene->pool);
    for (uint32_t i = 0; scene->searches && i < scene->options.threads; ++i)
        mote_stream_search_free(&scene->searches[i]);
    for (uint32_t i = 0; scene->bodies && i < scene->body_count; ++i)
        mote_stream_body_free(&scene->bodies[i]);
    for (uint32_t i = 0; scene->trees && i < scene->shape_count; ++i)
        mote_stream_tree_destroy(scene->trees[i]);
    free(scene->trees);
    free(scene->bodies);
    free(scene->searches);
    mote_pair_list_free(&scene->now);
    mote_pair_list_free(&scene->before);
    free(scene);
}

size_t mote_stream_scene_bytes(const mote_stream_scene *scene)
{
    size_t bytes = sizeof *scene + mote_pair_list_bytes(&scene->now) +
                   mote_pair_list_bytes(&scene->before);
    for (uint32_t i = 0; i < scene->shape_count; ++i)
        bytes += mote_stream_tree_bytes(scene->trees[i]);
    for (uint32_t i = 0; i < scene->body_count; ++i)
        bytes += sizeof scene->bodies[i] + mote_stream_body_bytes(&scene->bodies[i]);
    for (uint32_t i = 0; i < scene->options.threads; ++i)
        bytes += sizeof scene->searches[i] + mote_stream_search_bytes(&scene->searches[i]);
    return bytes;
}

/* The root's box in the world. Its numbers are wrong by 2^-23 of themselves; what is added is
   rounded by less than 2^-50. */
static mote_scene_box box_around(const mote_stream_body *body)
{
    const double origin[3] = {body->origin.x, body->origin.y, body->origin.z};
    double low[3], high[3];
    for (int k = 0; k < 3; ++k) {
        const double least = (double)body->root.low[k], most = (double)body->root.high[k];
        low[k] = origin[k] + (least - 0x1p-22 * fabs(least)) / body->scale;
        high[k] = origin[k] + (most + 0x1p-22 * fabs(most)) / body->scale;
        low[k] -= 0x1p-50 * (fabs(origin[k]) + fabs(low[k]));
        high[k] += 0x1p-50 * (fabs(origin[k]) + fabs(high[k]));
    }
    return (mote_scene_box){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

/* A body that fails has no boxes afterwards; the calling thread then finds out why. */
static void bound_range(void *context, uint32_t worker, size_t first, size_t end)
{
    mote_stream_scene *s = context;
    (void)worker;
    for (size_t i = first; i < end; ++i) {
        mote_stream_body *body = &s->bodies[i];
        if (!body->placed)
            (void)mote_stream_pass(body, mote_position_at(&body->positions, 0), s->scale, NULL,
                                   (int)i);
        if (body->placed)
            s->bounds[i] = box_around(body);
    }
}

/* After a frame that was refused, an unchanged one has the positions of that frame. */
static void forget_boxes(mote_stream_scene *scene)
{
    for (uint32_t i = 0; i < scene->body_count; ++i)
        scene->bodies[i].placed = scene->bodies[i].checked = false;
}

mote_status mote_stream_scene_bounds(mote_stream_scene *scene, const mote_positions *positions,
                                     const bool *unchanged, mote_scene_box *bounds)
{
    for (uint32_t i = 0; i < scene->body_count; ++i) {
        mote_status status = mote_stream_check(&positions[i], (int)i);
        if (status != MOTE_OK) {
            forget_boxes(scene);
            return status;
        }
    }
    for (uint32_t i = 0; i < scene->body_count; ++i) {
        mote_stream_body *body = &scene->bodies[i];
        body->positions = positions[i];
        body->placed = body->checked = body->placed && unchanged && unchanged[i];
    }
    scene->bounds = bounds;
    mote_pool_run(scene->pool, bound_range, scene, scene->body_count, GRAIN_BODIES);
    for (uint32_t i = 0; i < scene->body_count; ++i) {
        if (!scene->bodies[i].placed)
            return mote_stream_finite(&scene->bodies[i], (int)i);
    }
    return MOTE_OK;
}

/* A pair that is too far apart has no distance afterwards. */
static void answer_pair(mote_stream_scene *scene, mote_stream_search *s, mote_scene_pair *pair,
                        mote_stream_memory *memory)
{
    const bool contact_only = scene->options.ask == MOTE_ASK_CONTACT;
    mote_stream_body *const body[2] = {&scene->bodies[pair->body[0]],
                                       &scene->bodies[pair->body[1]]};
    const bool near =
        mote_stream_seed(s, body, memory, contact_only ? scene->options.tolerance : -1);
    s->scale = scene->scale;
    s->origin = mote_scale(mote_add(s->best.witness[0], s->best.witness[1]), 0.5);
    pair->distance = (double)NAN;
    pair->decided = false;
    if (!isfinite(s->upper) || (!s->done && mote_stream_prove(s, !near) != MOTE_OK))
        return;
    mote_certificate_answer answer;
    mote_stream_write(s, memory, &answer);
    pair->distance = answer.distance;
    pair->lower = answer.lower;
    pair->contact = answer.distance <= scene->options.tolerance;
    pair->decided = true;
    pair->witness[0] = answer.witness[0];
    pair->witness[1] = answer.witness[1];
    pair->counters = answer.counters;
}

static void answer_range(void *context, uint32_t worker, size_t first, size_t end)
{
    mote_stream_scene *s = context;
    mote_stream_memory *memories = (mote_stream_memory *)(void *)s->now.memories;
    for (size_t k = first; k < end; ++k)
        answer_pair(s, &s->searches[worker], &s->now.pairs[k], &memories[k]);
}

mote_status mote_stream_scene_query(mote_stream_scene *scene, const uint32_t (*pairs)[2],
                                    size_t count)
{
    for (uint32_t i = 0; i < scene->body_count; ++i) {
        if (!scene->bodies[i].placed)
            return mote_fail(MOTE_EINVAL, "body %u has no boxes; call mote_stream_scene_bounds",
                             i);
    }
    mote_status status =
        mote_pair_list_renew(&scene->now, &scene->before, pairs, count, scene->body_count);
    if (status != MOTE_OK)
        return status;
    mote_pool_run(scene->pool, answer_range, scene, count, GRAIN_PAIRS);
    for (size_t k = 0; k < count; ++k) {
        if (isnan(scene->now.pairs[k].distance))
            return mote_fail(MOTE_EINVAL,
                             "bodies %u and %u are more than 10^18 times as far apart as L, %g",
                             pairs[k][0], pairs[k][1], scene->length);
    }
    return MOTE_OK;
}

const mote_scene_pair *mote_stream_scene_pairs(const mote_stream_scene *scene, size_t *count)
{
    *count = scene->now.count;
    return scene->now.pairs;
}
