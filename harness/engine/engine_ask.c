/* The functions of harness/engine/engine.h, for any number of bodies. */
#include "harness/engine/engine_kind.h"

#include "harness/base/clock.h"
#include "harness/base/heap_count.h"
#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The way a choice is asked about more than two bodies. */
static const mote_engine_kind *kind_of_many(const mote_method_choice *choice)
{
    const char *name = choice->method->name;
    if (strcmp(name, "certified") == 0)
        return &mote_engine_of_certified;
    if (strcmp(name, "stream") == 0)
        return &mote_engine_of_streamed;
    if (strcmp(name, "fcl-aabb") == 0 || strcmp(name, "aabb-tree") == 0)
        return &mote_engine_of_trees;
    return &mote_engine_of_pairs;
}

static const mote_engine_kind *kind_of_two(mote_ask ask)
{
    return ask == MOTE_ASK_IMPACT ? &mote_engine_of_impact : &mote_engine_of_two;
}

mote_status mote_engine_create(const mote_engine_setup *setup, const mote_method_choice *choice,
                               mote_engine **engine)
{
    const bool two = setup->count == 2 && isinf(setup->near);
    mote_status status = two ? MOTE_OK : mote_engine_check_choice(choice);
    if (status != MOTE_OK)
        return status;
    mote_engine *made = mote_allocate(1, sizeof *made);
    made->setup = *setup;
    made->choice = *choice;
    made->traits = mote_method_traits(choice->method, choice->values);
    made->threads = (uint32_t)choice->scene[MOTE_SCENE_THREADS];
    made->refits_every = (int)choice->scene[MOTE_SCENE_REFIT] == MOTE_REFIT_EVERY;
    made->kind = two ? kind_of_two(setup->ask) : kind_of_many(choice);
    if (made->kind->create)
        status = made->kind->create(made);
    if (status == MOTE_OK)
        *engine = made;
    else
        mote_engine_destroy(made);
    return status;
}

mote_status mote_engine_build(mote_engine *engine)
{
    return engine->kind->build(engine);
}

void mote_engine_destroy(mote_engine *engine)
{
    if (!engine)
        return;
    engine->kind->destroy(engine);
    for (uint32_t k = 0; k < engine->setup.shape_count; ++k)
        mote_deform_destroy(engine->deform[k]);
    free(engine->now.pairs);
    free(engine->now.memories);
    free(engine->before.pairs);
    free(engine->before.memories);
    free(engine);
}

int64_t mote_engine_deform_bytes(const mote_engine *engine)
{
    size_t bytes = 0;
    for (int i = 0; i < 2 && !engine->traits.given_vertices; ++i) {
        if (engine->world[i])
            bytes += mote_deform_bytes(engine->deform[i]) +
                     engine->setup.shapes[i]->mesh->vertex_count * sizeof(mote_vec3);
    }
    return (int64_t)bytes;
}

void mote_engine_show(mote_engine *engine, const mote_body_state *states)
{
    engine->states = states;
    if (engine->kind->show)
        engine->kind->show(engine);
}

void mote_engine_show_paths(mote_engine *engine, const mote_path *const paths[2])
{
    engine->paths[0] = paths[0];
    engine->paths[1] = paths[1];
}

const mote_impact_answer *mote_engine_impact(const mote_engine *engine)
{
    return &engine->found;
}

/* A separate function, so that callgrind can count within it alone
   (harness/run/instructions.c). */
__attribute__((noinline)) static mote_status timed_step(mote_engine *e, mote_engine_cost *cost)
{
    return e->kind->ask(e, cost);
}

/* For more than two bodies: all time except deformation, refits and builds counts as query. */
static mote_status ask_many(mote_engine *e, mote_engine_cost *cost)
{
    const uint64_t allocations = mote_heap_read().allocations;
    const uint64_t from = mote_clock_ns();
    const mote_status status = timed_step(e, cost);
    cost->query_ns =
        mote_clock_ns() - from - cost->deform_ns - cost->update_ns - cost->build_ns;
    cost->allocations = mote_heap_read().allocations - allocations;
    return status;
}

/* Derives contacts from distances, and sums over the pairs. */
static void sum_up(mote_engine *e, mote_engine_cost *cost)
{
    cost->pairs = e->now.count;
    for (size_t k = 0; k < e->now.count; ++k) {
        mote_near_pair *pair = &e->now.pairs[k];
        mote_answer *answer = &pair->answer;
        if (!answer->has_contact && answer->has_distance) {
            answer->has_contact = true;
            answer->contact = answer->distance <= e->setup.tolerance;
        }
        cost->fresh += pair->steps == 1;
        cost->contacts += answer->contact;
#define ADD(name) cost->counters.name += answer->counters.name;
        MOTE_COUNTERS(ADD)
        MOTE_COUNTERS_MORE(ADD)
#undef ADD
    }
}

mote_status mote_engine_ask(mote_engine *engine, mote_engine_cost *cost)
{
    mote_engine_cost made = {0};
    const bool two =
        engine->kind == &mote_engine_of_two || engine->kind == &mote_engine_of_impact;
    const mote_status status = two ? engine->kind->ask(engine, &made) : ask_many(engine, &made);
    if (status != MOTE_OK)
        return status;
    sum_up(engine, &made);
    *cost = made;
    return MOTE_OK;
}

const mote_near_pair *mote_engine_pairs(const mote_engine *engine, size_t *count)
{
    *count = engine->now.count;
    return engine->now.pairs;
}
