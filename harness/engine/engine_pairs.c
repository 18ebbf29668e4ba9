/* More than two bodies: a contract method, with a state for each near pair. */
#include "harness/engine/engine_kind.h"

#include "harness/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pairs per unit of work of a thread. */
#define GRAIN 4

/* n must be given: n=auto would count the convex parts again for each pair. */
static mote_status pairs_create(mote_engine *e)
{
    const mote_method *method = e->choice.method;
    if (e->traits.needs_vertices || e->traits.given_vertices)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s: with several bodies only those in near pairs are deformed; leave "
                         "out positions=given",
                         e->choice.text);
    for (size_t i = 0; i < method->parameter_count; ++i) {
        if (strcmp(method->parameters[i].key, "n") == 0 && e->choice.values[i] < 0)
            return mote_fail(
                MOTE_EUNSUPPORTED,
                "%s: with several bodies the number of particles has to be given; give n=",
                e->choice.text);
    }
    return MOTE_OK;
}

static mote_status pairs_build(mote_engine *e)
{
    mote_status status = mote_engine_build_near(e);
    if (status == MOTE_OK)
        status = mote_pool_create(e->threads, &e->pool);
    e->failures = mote_allocate(e->threads, sizeof *e->failures);
    return status;
}

static void pairs_destroy(mote_engine *e)
{
    for (size_t k = 0; k < e->now.count; ++k)
        mote_method_destroy(e->choice.method, e->now.memories[k].state);
    mote_pool_destroy(e->pool);
    free(e->failures);
    mote_engine_destroy_near(e);
}

/* Makes states for new pairs. */
static mote_status add_states(mote_engine *e)
{
    const mote_engine_setup *s = &e->setup;
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < e->now.count && status == MOTE_OK; ++k) {
        if (e->now.memories[k].state)
            continue;
        const uint32_t *body = e->now.pairs[k].body;
        const mote_setup setup = {
            .body = {s->shapes[s->shape_of[body[0]]], s->shapes[s->shape_of[body[1]]]},
            .length = s->length,
            .ask = s->ask,
            .tolerance = s->tolerance,
            .seed = s->seed,
            .values = e->choice.values};
        status = mote_method_create(e->choice.method, &setup, &e->now.memories[k].state);
    }
    return status;
}

static mote_status ask_pair(mote_engine *e, size_t k)
{
    const mote_method *method = e->choice.method;
    mote_near_pair *pair = &e->now.pairs[k];
    void *state = e->now.memories[k].state;
    const mote_frame frame = {.number = pair->steps,
                              .body = {e->states[pair->body[0]], e->states[pair->body[1]]}};
    const mote_status status = method->update ? method->update(state, &frame) : MOTE_OK;
    return status == MOTE_OK ? method->query(state, &frame, &pair->answer) : status;
}

static void ask_range(void *context, uint32_t worker, size_t first, size_t end)
{
    mote_engine *e = context;
    mote_thread_failure *failed = &e->failures[worker];
    for (size_t k = first; k < end && failed->status == MOTE_OK; ++k) {
        failed->status = ask_pair(e, k);
        if (failed->status != MOTE_OK)
            (void)snprintf(failed->text, sizeof failed->text, "%s", mote_error_text());
    }
}

static mote_status pairs_ask(mote_engine *e, mote_engine_cost *cost)
{
    mote_pairs_wanted wanted = {0};
    mote_status status = mote_engine_bound(e, cost);
    if (status == MOTE_OK)
        status = mote_engine_find_near(e, cost, &wanted);
    if (status != MOTE_OK)
        return status;
    mote_engine_carry_over(e, wanted);
    status = add_states(e);
    memset(e->failures, 0, e->threads * sizeof *e->failures);
    if (status == MOTE_OK)
        mote_pool_run(e->pool, ask_range, e, e->now.count, GRAIN);
    for (uint32_t w = 0; w < e->threads && status == MOTE_OK; ++w) {
        if (e->failures[w].status != MOTE_OK)
            status = mote_fail(e->failures[w].status, "%s", e->failures[w].text);
    }
    return status;
}

const mote_engine_kind mote_engine_of_pairs = {pairs_create, pairs_build, pairs_destroy, NULL,
                                               pairs_ask};
