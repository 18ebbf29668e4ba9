/* Two bodies: any contract method, with the vertices that it needs. */
#include "harness/engine/engine_kind.h"

#include "harness/base/clock.h"
#include "harness/base/heap_count.h"
#include "harness/base/memory.h"
#include "harness/base/statistics.h"

#include <stdlib.h>

/* Batches of empty calls that measure the overhead: the median over batches. */
#define BATCHES 21
#define BATCH 100

static mote_status make_vertices(mote_engine *e)
{
    for (int i = 0; i < 2; ++i) {
        const mote_body *body = e->setup.shapes[i];
        if (mote_body_is_given(body))
            continue;
        e->world[i] = mote_allocate(body->mesh->vertex_count, sizeof(mote_vec3));
        const mote_status status = mote_deform_create(body, &e->deform[i]);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

mote_status mote_engine_refuse_scene_keys(void)
{
    return mote_fail(
        MOTE_EINVAL,
        "refit, threads and ahead are keys for more than two bodies; leave them out");
}

static mote_status two_create(mote_engine *e)
{
    if (mote_method_choice_is_of_scenes(&e->choice))
        return mote_engine_refuse_scene_keys();
    e->now.count = 1;
    mote_engine_pair_list_make_room(&e->now, 1);
    e->now.pairs[0] = (mote_near_pair){.body = {0, 1}};
    return e->traits.given_vertices ? make_vertices(e) : MOTE_OK;
}

mote_setup mote_engine_setup_of_method(const mote_engine *e)
{
    return (mote_setup){.body = {e->setup.shapes[0], e->setup.shapes[1]},
                        .length = e->setup.length,
                        .ask = e->setup.ask,
                        .tolerance = e->setup.tolerance,
                        .seed = e->setup.seed,
                        .values = e->choice.values};
}

static mote_status two_build(mote_engine *e)
{
    const mote_setup setup = mote_engine_setup_of_method(e);
    mote_status status = MOTE_OK;
    if (e->traits.needs_vertices && !e->traits.given_vertices)
        status = make_vertices(e);
    return status == MOTE_OK ? mote_method_create(e->choice.method, &setup, &e->state) : status;
}

static void two_destroy(mote_engine *e)
{
    mote_method_destroy(e->choice.method, e->state);
    for (int i = 0; i < 2; ++i)
        free(e->world[i]);
}

/* Deforms the bodies that have changed. */
static void deform(mote_engine *e)
{
    for (int i = 0; i < 2; ++i) {
        mote_body_state *body = &e->frame.body[i];
        if (!e->deform[i])
            continue; /* the frame contains its vertices */
        if (body->shape_changed || body->pose_changed)
            mote_deform_all(e->deform[i], body, e->world[i]);
        body->vertices = e->world[i];
    }
}

static void two_show(mote_engine *e)
{
    for (int i = 0; i < 2; ++i)
        e->frame.body[i] = e->states[i];
    ++e->frame.number;
    if (e->traits.given_vertices)
        deform(e);
}

/* Separate functions for the timed calls, so that callgrind can count within them alone
   (harness/run/instructions.c). */
__attribute__((noinline)) static void timed_deform(mote_engine *e)
{
    deform(e);
}

__attribute__((noinline)) static mote_status timed_update(const mote_engine *e)
{
    return e->choice.method->update(e->state, &e->frame);
}

__attribute__((noinline)) static mote_status timed_query(const mote_engine *e,
                                                         mote_answer *answer)
{
    return e->choice.method->query(e->state, &e->frame, answer);
}

static uint64_t elapsed(const mote_engine *e, uint64_t start)
{
    const uint64_t ns = mote_clock_ns() - start;
    return ns > e->setup.clock_ns ? ns - e->setup.clock_ns : 0;
}

static mote_status two_ask(mote_engine *e, mote_engine_cost *cost)
{
    mote_status status = MOTE_OK;
    mote_near_pair *pair = &e->now.pairs[0];
    ++pair->steps;
    pair->answer = (mote_answer){0};
    if (e->traits.needs_vertices && !e->traits.given_vertices) {
        const uint64_t start = mote_clock_ns();
        timed_deform(e);
        cost->deform_ns = elapsed(e, start);
    }
    const uint64_t allocations = mote_heap_read().allocations;
    if (e->choice.method->update) {
        const uint64_t start = mote_clock_ns();
        status = timed_update(e);
        cost->update_ns = elapsed(e, start);
    }
    if (status == MOTE_OK) {
        const uint64_t start = mote_clock_ns();
        status = timed_query(e, &pair->answer);
        cost->query_ns = elapsed(e, start);
    }
    cost->allocations = mote_heap_read().allocations - allocations;
    return status;
}

const mote_engine_kind mote_engine_of_two = {two_create, two_build, two_destroy, two_show,
                                             two_ask};

static mote_status answer_nothing(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)state;
    (void)frame;
    (void)answer;
    return MOTE_OK;
}

double mote_engine_overhead_ns(uint64_t clock_ns)
{
    const mote_method nothing = {.query = answer_nothing};
    const mote_engine e = {.choice = {.method = &nothing}};
    double batches[BATCHES];
    for (size_t i = 0; i < BATCHES; ++i) {
        uint64_t sum = 0;
        for (size_t k = 0; k < BATCH; ++k) {
            mote_answer answer;
            const uint64_t start = mote_clock_ns();
            (void)timed_query(&e, &answer);
            sum += mote_clock_ns() - start;
        }
        batches[i] = (double)sum / BATCH - (double)clock_ns;
    }
    return mote_statistics_median(batches, BATCHES);
}

mote_engine_setup mote_engine_setup_of_two(const mote_body *a, const mote_body *b)
{
    static const uint32_t shape_of[] = {0, 1};
    return (mote_engine_setup){.shapes = {a, b},
                               .shape_count = 2,
                               .shape_of = shape_of,
                               .count = 2,
                               .length = fmax(a->mesh->diagonal, b->mesh->diagonal),
                               .near = HUGE_VAL};
}

mote_status mote_engine_open_two(const mote_body *a, const mote_body *b,
                                 const mote_method_choice *choice, mote_ask ask,
                                 double tolerance, uint64_t seed, mote_engine **engine)
{
    mote_engine *made = NULL;
    mote_engine_setup setup = mote_engine_setup_of_two(a, b);
    setup.ask = ask;
    setup.tolerance = tolerance;
    setup.seed = seed;
    mote_status status = mote_engine_create(&setup, choice, &made);
    if (status == MOTE_OK)
        status = mote_engine_build(made);
    if (status == MOTE_OK)
        *engine = made;
    else
        mote_engine_destroy(made);
    return status;
}

mote_status mote_engine_open_distance(const mote_body *bodies, const char *method,
                                      mote_engine **engine)
{
    mote_method_choice choice;
    mote_status status = mote_method_choice_read(method, &choice);
    if (status == MOTE_OK)
        status = mote_engine_open_two(&bodies[0], &bodies[1], &choice, MOTE_ASK_DISTANCE, 0, 0,
                                      engine);
    return status;
}

mote_status mote_engine_answer(mote_engine *engine, const mote_frame *frame,
                               mote_answer *answer)
{
    mote_engine *e = engine;
    if (!frame)
        return mote_error_status();
    const mote_method *method = e->choice.method;
    mote_answer given = {0};
    e->frame = *frame;
    for (int i = 0; i < 2; ++i) {
        if (!e->deform[i])
            continue;
        mote_deform_all(e->deform[i], &e->frame.body[i], e->world[i]);
        e->frame.body[i].vertices = e->world[i];
    }
    mote_status status = method->update ? method->update(e->state, &e->frame) : MOTE_OK;
    if (status == MOTE_OK)
        status = method->query(e->state, &e->frame, &given);
    if (status == MOTE_OK)
        *answer = given;
    return status;
}

size_t mote_engine_particles(const mote_engine *engine, int i, mote_vec3 *positions,
                             size_t capacity)
{
    const mote_method *method = engine->choice.method;
    return method->particles && engine->state
               ? method->particles(engine->state, i, positions, capacity)
               : 0;
}
