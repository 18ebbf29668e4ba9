/* More than two bodies: which are near, and what near pairs keep between frames. */
#include "harness/engine/engine_kind.h"

#include "harness/base/clock.h"
#include "harness/base/memory.h"

#include <stdlib.h>

mote_status mote_engine_build_near(mote_engine *e)
{
    const mote_engine_setup *s = &e->setup;
    e->boxes = mote_allocate(s->count, sizeof *e->boxes);
    mote_status status = mote_broad_phase_create(s->count, &e->broad);
    const mote_scene_options options = {
        .ask = s->ask, .tolerance = s->tolerance, .threads = e->threads};
    if (status == MOTE_OK && !e->refits_every)
        status = mote_scene_create(s->shapes, s->shape_count, s->shape_of, s->count, &options,
                                   &e->scene);
    return status;
}

void mote_engine_destroy_near(mote_engine *e)
{
    mote_scene_destroy(e->scene);
    mote_broad_phase_destroy(e->broad);
    free(e->boxes);
}

mote_status mote_engine_bound(mote_engine *e, mote_engine_cost *cost)
{
    const uint64_t from = mote_clock_ns();
    const mote_status status = mote_scene_bounds(e->scene, e->states, e->boxes);
    cost->bounds_ns = mote_clock_ns() - from;
    return status;
}

mote_status mote_engine_find_near(mote_engine *e, mote_engine_cost *cost,
                                  mote_pairs_wanted *wanted)
{
    const uint64_t from = mote_clock_ns();
    const mote_status status = mote_broad_phase_pairs(e->broad, e->boxes, e->setup.near,
                                                      &wanted->pairs, &wanted->count);
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
