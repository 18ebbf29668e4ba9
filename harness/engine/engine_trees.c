/* More than two bodies: a tree for each body in a near pair (baselines/body_trees.h). */
#include "harness/engine/engine_kind.h"

#include "harness/base/clock.h"
#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>

static mote_status trees_build(mote_engine *e)
{
    const mote_engine_setup *s = &e->setup;
    const mote_body_trees_setup setup = {.shapes = s->shapes,
                                         .shape_count = s->shape_count,
                                         .shape_of = s->shape_of,
                                         .body_count = s->count,
                                         .length = s->length,
                                         .ask = s->ask,
                                         .tolerance = s->tolerance,
                                         .every = e->refits_every};
    e->trees_kind = strcmp(e->choice.method->name, "fcl-aabb") == 0 ? &mote_fcl_body_trees
                                                                    : &mote_aabb_body_trees;
    mote_status status = mote_engine_build_near(e);
    if (status == MOTE_OK)
        status = e->trees_kind->create(&setup, &e->trees);
    for (uint32_t k = 0; k < s->shape_count && status == MOTE_OK; ++k)
        status = mote_deform_create(s->shapes[k], &e->deform[k]);
    e->looked_at = mote_allocate(s->count, sizeof *e->looked_at);
    return status;
}

static void trees_destroy(mote_engine *e)
{
    if (e->trees_kind)
        e->trees_kind->destroy(e->trees);
    free(e->looked_at);
    mote_engine_destroy_near(e);
}

/* Puts the vertices of body i into its tree, which may have to be built: deformed, or copied
   where they are given, which is part of the update. */
static mote_status look_at(mote_engine *e, uint32_t i, mote_engine_cost *cost)
{
    mote_vec3 *vertices;
    const bool given = mote_body_is_given(e->setup.shapes[e->setup.shape_of[i]]);
    const uint64_t from = mote_clock_ns();
    mote_status status = e->trees_kind->room(e->trees, i, &vertices);
    const uint64_t roomy = mote_clock_ns();
    if (status != MOTE_OK)
        return status;
    mote_deform_all(e->deform[e->setup.shape_of[i]], &e->states[i], vertices);
    const uint64_t deformed = mote_clock_ns();
    status = mote_engine_blame(e->trees_kind->move(e->trees, i), i);
    cost->build_ns += roomy - from;
    *(given ? &cost->update_ns : &cost->deform_ns) += deformed - roomy;
    cost->update_ns += mote_clock_ns() - deformed;
    return status;
}

/* Refits the trees of the marked bodies (NULL: of all). */
static mote_status refit(mote_engine *e, const bool *looked_at, mote_engine_cost *cost)
{
    mote_status status = MOTE_OK;
    e->trees_kind->begin(e->trees);
    for (uint32_t i = 0; i < e->setup.count && status == MOTE_OK; ++i) {
        if (!looked_at || looked_at[i])
            status = look_at(e, i, cost);
    }
    const uint64_t from = mote_clock_ns();
    if (status == MOTE_OK)
        status = e->trees_kind->refit(e->trees);
    cost->update_ns += mote_clock_ns() - from;
    return status;
}

/* Computes the boxes from the trees of all bodies, or from deformed roots. */
static mote_status find_boxes(mote_engine *e, mote_engine_cost *cost)
{
    if (!e->refits_every)
        return mote_engine_bound(e, cost);
    const mote_status status = refit(e, NULL, cost);
    for (uint32_t i = 0; i < e->setup.count && status == MOTE_OK; ++i)
        e->trees_kind->box(e->trees, i, &e->boxes[i]);
    return status;
}

static mote_status refit_near(mote_engine *e, mote_engine_cost *cost)
{
    if (e->refits_every)
        return MOTE_OK;
    memset(e->looked_at, 0, e->setup.count * sizeof *e->looked_at);
    for (size_t k = 0; k < e->now.count; ++k) {
        for (int side = 0; side < 2; ++side)
            e->looked_at[e->now.pairs[k].body[side]] = true;
    }
    return refit(e, e->looked_at, cost);
}

static mote_status trees_ask(mote_engine *e, mote_engine_cost *cost)
{
    mote_pairs_wanted wanted = {0};
    mote_status status = find_boxes(e, cost);
    if (status == MOTE_OK)
        status = mote_engine_find_near(e, cost, &wanted);
    if (status != MOTE_OK)
        return status;
    mote_engine_carry_over(e, wanted);
    status = refit_near(e, cost);
    for (size_t k = 0; k < e->now.count && status == MOTE_OK; ++k) {
        mote_near_pair *pair = &e->now.pairs[k];
        status = e->trees_kind->query(e->trees, pair->body, &e->now.memories[k].trees,
                                      &pair->answer);
    }
    return status;
}

const mote_engine_kind mote_engine_of_trees = {NULL, trees_build, trees_destroy, NULL,
                                               trees_ask};
