/* More than two bodies: which are near, and what near pairs keep between frames. */
#include "harness/engine/engine_kind.h"

#include "harness/base/clock.h"
#include "harness/base/memory.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A scene of the bodies that have fields. */
static mote_status build_scene(mote_engine *e, const mote_scene_options *options)
{
    const mote_engine_setup *s = &e->setup;
    const mote_body *shapes[MOTE_ENGINE_SHAPES_MAX];
    uint32_t number[MOTE_ENGINE_SHAPES_MAX], shape_count = 0, count = 0;
    for (uint32_t k = 0; k < s->shape_count; ++k) {
        number[k] = shape_count;
        if (!mote_body_is_given(s->shapes[k]))
            shapes[shape_count++] = s->shapes[k];
    }
    if (shape_count == s->shape_count)
        return mote_scene_create(shapes, shape_count, s->shape_of, s->count, options,
                                 &e->scene);
    uint32_t *shape_of = mote_allocate(s->count, sizeof *shape_of);
    e->scene_body = mote_allocate(s->count, sizeof *e->scene_body);
    for (uint32_t i = 0; i < s->count; ++i) {
        const bool given = mote_body_is_given(s->shapes[s->shape_of[i]]);
        e->scene_body[i] = given ? UINT32_MAX : count;
        if (!given)
            shape_of[count++] = number[s->shape_of[i]];
    }
    const mote_status status =
        count > 0 ? mote_scene_create(shapes, shape_count, shape_of, count, options, &e->scene)
                  : MOTE_OK;
    free(shape_of);
    return status;
}

mote_status mote_engine_build_near(mote_engine *e)
{
    const mote_engine_setup *s = &e->setup;
    e->boxes = mote_allocate(s->count, sizeof *e->boxes);
    mote_status status = mote_broad_phase_create(s->count, &e->broad);
    const mote_scene_options options = {
        .ask = s->ask, .tolerance = s->tolerance, .threads = e->threads};
    if (status == MOTE_OK && !e->refits_every)
        status = build_scene(e, &options);
    return status;
}

void mote_engine_destroy_near(mote_engine *e)
{
    mote_scene_destroy(e->scene);
    mote_broad_phase_destroy(e->broad);
    free(e->boxes);
    free(e->scene_body);
}

mote_status mote_engine_blame(mote_status status, uint32_t i)
{
    static const char word[] = "body ";
    const char *text = mote_error_text();
    if (status == MOTE_OK || strncmp(text, word, strlen(word)) != 0)
        return status;
    const char *digits = text + strlen(word);
    if (!isdigit((unsigned char)*digits))
        return status;
    char *rest;
    const uint32_t number = (uint32_t)strtoul(digits, &rest, 10);
    return mote_fail(status, "body %u%s", (i == MOTE_ENGINE_SAME ? number : i) + 1, rest);
}

/* The box of given positions. */
static mote_status box_positions(const mote_vec3 *at, uint32_t count, uint32_t body,
                                 mote_scene_box *box)
{
    mote_vec3 low = at[0], high = at[0];
    double zero = 0; /* NaN where a number is not finite */
    for (uint32_t v = 0; v < count; ++v) {
        low = mote_vec3_make(fmin(low.x, at[v].x), fmin(low.y, at[v].y), fmin(low.z, at[v].z));
        high =
            mote_vec3_make(fmax(high.x, at[v].x), fmax(high.y, at[v].y), fmax(high.z, at[v].z));
        zero += 0 * (at[v].x + at[v].y + at[v].z);
    }
    *box = (mote_scene_box){low, high};
    return isnan(zero) ? mote_fail(MOTE_EINVAL, "body %u: a position is not finite", body)
                       : MOTE_OK;
}

/* Bodies with fields and bodies of given positions. */
static mote_status bound_each(mote_engine *e)
{
    mote_status status = MOTE_OK;
    for (uint32_t i = 0; i < e->setup.count && status == MOTE_OK; ++i) {
        const uint32_t number = e->scene_body[i];
        const mote_mesh *mesh = e->setup.shapes[e->setup.shape_of[i]]->mesh;
        status = number == UINT32_MAX
                     ? box_positions(e->states[i].vertices, mesh->vertex_count, i, &e->boxes[i])
                     : mote_scene_bounds_of(e->scene, number, &e->states[i], &e->boxes[i]);
        status = mote_engine_blame(status, i); /* the scene has other numbers */
    }
    return status;
}

mote_status mote_engine_bound(mote_engine *e, mote_engine_cost *cost)
{
    const uint64_t from = mote_clock_ns();
    const mote_status status =
        e->scene_body ? bound_each(e)
                      : mote_engine_blame(mote_scene_bounds(e->scene, e->states, e->boxes),
                                          MOTE_ENGINE_SAME);
    cost->bounds_ns = mote_clock_ns() - from;
    return status;
}

mote_status mote_engine_find_near(mote_engine *e, mote_engine_cost *cost,
                                  mote_pairs_wanted *wanted)
{
    const uint64_t from = mote_clock_ns();
    mote_status status = mote_broad_phase_pairs(e->broad, e->boxes, e->setup.near,
                                                &wanted->pairs, &wanted->count);
    if (status == MOTE_OK && e->scene && !e->scene_body)
        status = mote_scene_sift(e->scene, e->states, e->setup.near, wanted->pairs,
                                 wanted->count, &wanted->pairs, &wanted->count);
    cost->broad_ns = mote_clock_ns() - from;
    return status;
}

void mote_engine_pair_list_make_room(mote_engine_pair_list *list, size_t count)
{
    if (count <= list->room)
        return;
    const size_t room = count + count / 4 + 16, kept = list->count;
    free(list->pairs);
    free(list->memories);
    *list = (mote_engine_pair_list){.pairs = mote_allocate(room, sizeof *list->pairs),
                                    .memories = mote_allocate(room, sizeof *list->memories),
                                    .count = kept,
                                    .room = room};
}

static void drop_state(const mote_engine *e, mote_pair_memory *memory)
{
    mote_method_destroy(e->choice.method, memory->state);
    memory->state = NULL;
}

void mote_engine_carry_over(mote_engine *e, mote_pairs_wanted wanted)
{
    const mote_engine_pair_list *old = &e->now;
    mote_engine_pair_list *list = &e->before;
    size_t at = 0;
    mote_engine_pair_list_make_room(list, wanted.count);
    list->count = wanted.count;
    for (size_t k = 0; k < wanted.count; ++k) {
        const uint32_t *pair = wanted.pairs[k];
        for (; at < old->count && mote_pair_order(old->pairs[at].body, pair) < 0; ++at)
            drop_state(e, &old->memories[at]);
        list->pairs[k] = (mote_near_pair){.body = {pair[0], pair[1]}, .steps = 1};
        list->memories[k] = (mote_pair_memory){.state = NULL};
        if (at < old->count && mote_pair_order(old->pairs[at].body, pair) == 0) {
            list->pairs[k].steps += old->pairs[at].steps;
            list->memories[k] = old->memories[at++];
        }
    }
    for (; at < old->count; ++at)
        drop_state(e, &old->memories[at]);
    const mote_engine_pair_list swapped = e->now;
    e->now = e->before;
    e->before = swapped;
    e->before.count = 0;
}
