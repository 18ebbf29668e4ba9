/* Two bodies on their paths between two moments: any method that answers impacts. It moves and
   deforms the bodies itself, as often as it looks at them: all of that is query_ns. */
#include "harness/engine/engine_kind.h"

#include "harness/base/clock.h"
#include "harness/base/heap_count.h"

static mote_status impact_create(mote_engine *e)
{
    const char *name = e->choice.method->name;
    if (mote_method_choice_is_of_scenes(&e->choice))
        return mote_engine_refuse_scene_keys();
    e->impact = mote_impact_method_find(name);
    if (!e->impact)
        return mote_fail(
            MOTE_EUNSUPPORTED,
            "%s does not answer impacts; `mote list methods` says which methods do", name);
    e->now.count = 1;
    mote_engine_pair_list_make_room(&e->now, 1);
    e->now.pairs[0] = (mote_near_pair){.body = {0, 1}};
    return MOTE_OK;
}

static mote_status impact_build(mote_engine *e)
{
    const mote_setup setup = mote_engine_setup_of_method(e);
    return e->impact->create(&setup, e->setup.step, &e->state);
}

static void impact_destroy(mote_engine *e)
{
    if (e->impact)
        e->impact->destroy(e->state);
}

/* A separate function, so that callgrind can count within it alone
   (harness/run/instructions.c). */
__attribute__((noinline)) static mote_status timed_impact(mote_engine *e)
{
    return e->impact->query(e->state, e->paths, &e->found);
}

static mote_status impact_ask(mote_engine *e, mote_engine_cost *cost)
{
    mote_near_pair *pair = &e->now.pairs[0];
    ++pair->steps;
    e->found = (mote_impact_answer){.answered = false};
    const uint64_t allocations = mote_heap_read().allocations;
    const uint64_t start = mote_clock_ns();
    const mote_status status = timed_impact(e);
    const uint64_t ns = mote_clock_ns() - start;
    cost->query_ns = ns > e->setup.clock_ns ? ns - e->setup.clock_ns : 0;
    cost->allocations = mote_heap_read().allocations - allocations;
    pair->answer = (mote_answer){.has_contact = e->found.answered,
                                 .contact = e->found.impact,
                                 .has_witness = e->found.has_witness && e->found.impact,
                                 .witness = {e->found.witness[0], e->found.witness[1]},
                                 .counters = e->found.counters};
    return status;
}

const mote_engine_kind mote_engine_of_impact = {impact_create, impact_build, impact_destroy,
                                                NULL, impact_ask};
