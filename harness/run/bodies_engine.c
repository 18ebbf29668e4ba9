#include "harness/run/bodies_engine.h"

#include "baselines/body_trees.h"
#include "baselines/broad_phase.h"
#include "core/body/deform.h"
#include "core/base/pool.h"
#include "harness/base/heap_count.h"
#include "harness/base/memory.h"
#include "harness/run/clock.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GRAIN 4

/* What a pair keeps for its next query, where the certified scene does not keep it. */
typedef struct pair_memory {
    mote_body_trees_memory trees;
    void *state; /* of a method of the contract */
} pair_memory;

typedef struct pair_list {
    mote_bodies_pair *pairs; /* [room] */
    pair_memory *memories;
    size_t count, room;
} pair_list;

/* The first failure of a thread. */
typedef struct failure {
    mote_status status;
    char text[256];
} failure;

struct mote_bodies_engine {
    const mote_bodies *bodies;
    mote_method_choice choice;
    uint64_t seed;
    uint32_t threads;
    bool refits_every; /* body in every frame */
    const mote_body *shapes[MOTE_BODIES_SHAPES_MAX];
    mote_scene *scene; /* certified, and bounds from roots; NULL when every body is refitted */
    mote_scene_box *boxes;
    mote_broad_phase *broad;
    pair_list now, before;
    /* The controls: */
    const mote_body_trees_kind *kind; /* or NULL */
    void *trees;
    mote_deform *deform[MOTE_BODIES_SHAPES_MAX];
    bool *looked_at; /* [count] */
    /* Methods of the contract: */
    bool by_pairs;
    mote_pool *pool;
    failure *failures; /* [threads] */
    const mote_body_state *states;
};

static mote_status create_trees(mote_bodies_engine *e)
{
    const mote_bodies *b = e->bodies;
    const mote_body_trees_setup setup = {.shapes = e->shapes,
                                         .shape_count = b->shape_count,
                                         .shape_of = b->shape_of,
                                         .body_count = b->count,
                                         .length = b->length,
                                         .ask = b->ask,
                                         .tolerance = b->tolerance};
    mote_status status = e->kind->create(&setup, &e->trees);
    for (uint32_t s = 0; s < b->shape_count && status == MOTE_OK; ++s)
        status = mote_deform_create(e->shapes[s], &e->deform[s]);
    e->looked_at = mote_allocate(b->count, sizeof *e->looked_at);
    return status;
}

/* Convex parts would otherwise be counted again for each pair. */
static mote_status check_particles(const mote_method_choice *choice)
{
    const mote_method *method = choice->method;
    const mote_traits traits = mote_method_traits(method, choice->values);
    if (traits.needs_vertices || traits.given_vertices)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s: with several bodies only those in near pairs are deformed; leave "
                         "out positions=given",
                         choice->text);
    for (size_t i = 0; i < method->parameter_count; ++i) {
        if (strcmp(method->parameters[i].key, "n") == 0 && choice->values[i] < 0)
            return mote_fail(
                MOTE_EUNSUPPORTED,
                "%s: with several bodies the number of particles has to be given; give n=",
                choice->text);
    }
    return MOTE_OK;
}

static mote_status create_pairs(mote_bodies_engine *e)
{
    e->by_pairs = true;
    mote_status status = check_particles(&e->choice);
    if (status == MOTE_OK)
        status = mote_pool_create(e->threads, &e->pool);
    e->failures = mote_allocate(e->threads, sizeof *e->failures);
    return status;
}

static mote_status build(mote_bodies_engine *e)
{
    const mote_bodies *b = e->bodies;
    const char *name = e->choice.method->name;
    for (uint32_t s = 0; s < b->shape_count; ++s)
        e->shapes[s] = &b->shapes[s].body;
    e->boxes = mote_allocate(b->count, sizeof *e->boxes);
    mote_status status = mote_broad_phase_create(b->count, &e->broad);
    const mote_scene_options options = {
        .ask = b->ask, .tolerance = b->tolerance, .threads = e->threads};
    if (status == MOTE_OK && !e->refits_every)
        status = mote_scene_create(e->shapes, b->shape_count, b->shape_of, b->count, &options,
                                   &e->scene);
    if (status != MOTE_OK || strcmp(name, "certified") == 0)
        return status;
    if (strcmp(name, "fcl-aabb") == 0)
        e->kind = &mote_fcl_body_trees;
    else if (strcmp(name, "aabb-tree") == 0)
        e->kind = &mote_aabb_body_trees;
    return e->kind ? create_trees(e) : create_pairs(e);
}

mote_status mote_bodies_engine_create(const mote_bodies *bodies,
                                      const mote_method_choice *choice, uint64_t seed,
                                      mote_bodies_engine **engine)
{
    mote_status status = mote_bodies_choice_check(choice);
    if (status != MOTE_OK)
        return status;
    mote_bodies_engine *made = mote_allocate(1, sizeof *made);
    made->bodies = bodies;
    made->choice = *choice;
    made->seed = seed;
    made->threads = (uint32_t)choice->scene[MOTE_SCENE_THREADS];
    made->refits_every = (int)choice->scene[MOTE_SCENE_REFIT] == MOTE_REFIT_EVERY;
    status = build(made);
    if (status == MOTE_OK)
        *engine = made;
    else
        mote_bodies_engine_destroy(made);
    return status;
}

static void drop_state(const mote_bodies_engine *e, pair_memory *memory)
{
    mote_method_destroy(e->choice.method, memory->state);
    memory->state = NULL;
}

void mote_bodies_engine_destroy(mote_bodies_engine *engine)
{
    if (!engine)
        return;
    for (size_t k = 0; engine->by_pairs && k < engine->now.count; ++k)
        drop_state(engine, &engine->now.memories[k]);
    free(engine->now.pairs);
    free(engine->now.memories);
    free(engine->before.pairs);
    free(engine->before.memories);
    mote_scene_destroy(engine->scene);
    mote_broad_phase_destroy(engine->broad);
    if (engine->kind)
        engine->kind->destroy(engine->trees);
    for (uint32_t s = 0; s < engine->bodies->shape_count; ++s)
        mote_deform_destroy(engine->deform[s]);
    mote_pool_destroy(engine->pool);
    free(engine->failures);
    free(engine->looked_at);
    free(engine->boxes);
    free(engine);
}

/* Deforms the vertices of body i into its tree. */
static mote_status look_at(mote_bodies_engine *e, uint32_t i, mote_bodies_step *step)
{
    mote_vec3 *vertices;
    const uint64_t from = mote_clock_ns();
    mote_status status = e->kind->room(e->trees, i, &vertices);
    const uint64_t roomy = mote_clock_ns();
    if (status != MOTE_OK)
        return status;
    mote_deform_all(e->deform[e->bodies->shape_of[i]], &e->states[i], vertices);
    const uint64_t deformed = mote_clock_ns();
    status = e->kind->move(e->trees, i);
    step->deform_ns += deformed - roomy;
    step->update_ns += (roomy - from) + (mote_clock_ns() - deformed);
    return status;
}

/* Refits the trees of the bodies that are marked (NULL: of all). */
static mote_status refit(mote_bodies_engine *e, const bool *looked_at, mote_bodies_step *step)
{
    mote_status status = MOTE_OK;
    e->kind->begin(e->trees);
    for (uint32_t i = 0; i < e->bodies->count && status == MOTE_OK; ++i) {
        if (!looked_at || looked_at[i])
            status = look_at(e, i, step);
    }
    const uint64_t from = mote_clock_ns();
    if (status == MOTE_OK)
        status = e->kind->refit(e->trees);
    step->update_ns += mote_clock_ns() - from;
    return status;
}

static mote_status find_boxes(mote_bodies_engine *e, mote_bodies_step *step)
{
    mote_status status = MOTE_OK;
    if (e->refits_every) {
        status = refit(e, NULL, step);
        for (uint32_t i = 0; i < e->bodies->count && status == MOTE_OK; ++i)
            e->kind->box(e->trees, i, &e->boxes[i]);
        return status;
    }
    const uint64_t from = mote_clock_ns();
    status = mote_scene_bounds(e->scene, e->states, e->boxes);
    step->bounds_ns = mote_clock_ns() - from;
    return status;
}

/* Makes room for pairs; the old content of the list is lost where it grows. */
static void make_room(pair_list *list, size_t count)
{
    if (count <= list->room)
        return;
    const size_t room = count + count / 4 + 16;
    free(list->pairs);
    free(list->memories);
    *list = (pair_list){.pairs = mote_allocate(room, sizeof *list->pairs),
                        .memories = mote_allocate(room, sizeof *list->memories),
                        .room = room};
}

/* Makes the list of the step's pairs, each with its state if it has one; states of other
   pairs are freed. */
static void take_over(mote_bodies_engine *e, const uint32_t (*pairs)[2], size_t count)
{
    const pair_list *old = &e->now;
    pair_list *list = &e->before;
    size_t at = 0;
    list->count = count;
    for (size_t k = 0; k < count; ++k) {
        for (; at < old->count && mote_pair_order(old->pairs[at].body, pairs[k]) < 0; ++at)
            drop_state(e, &old->memories[at]);
        list->pairs[k] = (mote_bodies_pair){.body = {pairs[k][0], pairs[k][1]}, .steps = 1};
        list->memories[k] = (pair_memory){.state = NULL};
        if (at < old->count && mote_pair_order(old->pairs[at].body, pairs[k]) == 0) {
            list->pairs[k].steps += old->pairs[at].steps;
            list->memories[k] = old->memories[at++];
        }
    }
    for (; at < old->count; ++at)
        drop_state(e, &old->memories[at]);
    const pair_list swapped = e->now;
    e->now = e->before;
    e->before = swapped;
    e->before.count = 0;
}

static mote_status ask_trees(mote_bodies_engine *e, mote_bodies_step *step)
{
    mote_status status = MOTE_OK;
    if (!e->refits_every) {
        memset(e->looked_at, 0, e->bodies->count * sizeof *e->looked_at);
        for (size_t k = 0; k < e->now.count; ++k)
            e->looked_at[e->now.pairs[k].body[0]] = e->looked_at[e->now.pairs[k].body[1]] =
                true;
        status = refit(e, e->looked_at, step);
    }
    const uint64_t from = mote_clock_ns();
    for (size_t k = 0; k < e->now.count && status == MOTE_OK; ++k)
        status = e->kind->query(e->trees, e->now.pairs[k].body, &e->now.memories[k].trees,
                                &e->now.pairs[k].answer);
    step->query_ns += mote_clock_ns() - from;
    return status;
}

/* Makes states for pairs that are new. */
static mote_status add_states(mote_bodies_engine *e)
{
    const mote_bodies *b = e->bodies;
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < e->now.count && status == MOTE_OK; ++k) {
        if (e->now.memories[k].state)
            continue;
        const uint32_t *body = e->now.pairs[k].body;
        const mote_setup setup = {
            .body = {e->shapes[b->shape_of[body[0]]], e->shapes[b->shape_of[body[1]]]},
            .length = b->length,
            .ask = b->ask,
            .tolerance = b->tolerance,
            .seed = e->seed,
            .values = e->choice.values};
        status = mote_method_create(e->choice.method, &setup, &e->now.memories[k].state);
    }
    return status;
}

static mote_status ask_pair(mote_bodies_engine *e, size_t k)
{
    const mote_method *method = e->choice.method;
    mote_bodies_pair *pair = &e->now.pairs[k];
    void *state = e->now.memories[k].state;
    const mote_frame frame = {.number = pair->steps,
                              .body = {e->states[pair->body[0]], e->states[pair->body[1]]}};
    mote_status status = method->update ? method->update(state, &frame) : MOTE_OK;
    if (status == MOTE_OK)
        status = method->query(state, &frame, &pair->answer);
    if (!pair->answer.has_contact && pair->answer.has_distance) {
        pair->answer.has_contact = true;
        pair->answer.contact = pair->answer.distance <= e->bodies->tolerance;
    }
    return status;
}

static void ask_range(void *context, uint32_t worker, size_t first, size_t end)
{
    mote_bodies_engine *e = context;
    failure *failed = &e->failures[worker];
    for (size_t k = first; k < end && failed->status == MOTE_OK; ++k) {
        failed->status = ask_pair(e, k);
        if (failed->status != MOTE_OK)
            (void)snprintf(failed->text, sizeof failed->text, "%s", mote_error_text());
    }
}

static mote_status ask_pairs(mote_bodies_engine *e, mote_bodies_step *step)
{
    const uint64_t from = mote_clock_ns();
    mote_status status = add_states(e);
    memset(e->failures, 0, e->threads * sizeof *e->failures);
    if (status == MOTE_OK)
        mote_pool_run(e->pool, ask_range, e, e->now.count, GRAIN);
    step->query_ns += mote_clock_ns() - from;
    for (uint32_t w = 0; w < e->threads && status == MOTE_OK; ++w) {
        if (e->failures[w].status != MOTE_OK)
            status = mote_fail(e->failures[w].status, "%s", e->failures[w].text);
    }
    return status;
}

/* Converts the answers of the certified scene. */
static void copy_answers(mote_bodies_engine *e)
{
    size_t count;
    const mote_scene_pair *from = mote_scene_pairs(e->scene, &count);
    const bool distance = e->bodies->ask == MOTE_ASK_DISTANCE;
    e->now.count = count;
    for (size_t k = 0; k < count; ++k) {
        const mote_scene_pair *p = &from[k];
        e->now.pairs[k] =
            (mote_bodies_pair){.body = {p->body[0], p->body[1]},
                               .steps = p->steps,
                               .answer = {.has_distance = distance,
                                          .has_lower = true,
                                          .has_witness = distance || p->contact,
                                          .has_contact = true,
                                          .contact = p->contact,
                                          .distance = p->distance,
                                          .lower = p->lower,
                                          .witness = {p->witness[0], p->witness[1]},
                                          .counters = p->counters}};
    }
}

static mote_status ask_scene(mote_bodies_engine *e, const uint32_t (*pairs)[2], size_t count,
                             mote_bodies_step *step)
{
    const uint64_t from = mote_clock_ns();
    mote_status status = mote_scene_query(e->scene, e->states, pairs, count);
    step->query_ns = mote_clock_ns() - from;
    make_room(&e->now, count);
    if (status == MOTE_OK)
        copy_answers(e);
    return status;
}

static mote_status ask_near(mote_bodies_engine *e, const uint32_t (*pairs)[2], size_t count,
                            mote_bodies_step *step)
{
    if (!e->kind && !e->by_pairs)
        return ask_scene(e, pairs, count, step);
    const uint64_t from = mote_clock_ns();
    make_room(&e->before, count);
    take_over(e, pairs, count);
    step->query_ns = mote_clock_ns() - from;
    return e->kind ? ask_trees(e, step) : ask_pairs(e, step);
}

mote_status mote_bodies_engine_step(mote_bodies_engine *engine, const mote_body_state *states,
                                    mote_bodies_step *step)
{
    mote_bodies_engine *e = engine;
    mote_bodies_step made = {0};
    const uint32_t(*pairs)[2] = NULL;
    size_t count = 0;
    const uint64_t allocations = mote_heap_read().allocations;
    e->states = states;
    mote_status status = find_boxes(e, &made);
    const uint64_t from = mote_clock_ns();
    if (status == MOTE_OK)
        status = mote_broad_phase_pairs(e->broad, e->boxes, e->bodies->near, &pairs, &count);
    made.broad_ns = mote_clock_ns() - from;
    if (status == MOTE_OK)
        status = ask_near(e, pairs, count, &made);
    if (status != MOTE_OK)
        return status;
    made.allocations = mote_heap_read().allocations - allocations;
    made.pairs = e->now.count;
    for (size_t k = 0; k < e->now.count; ++k) {
        const mote_bodies_pair *pair = &e->now.pairs[k];
        made.fresh += pair->steps == 1;
        made.contacts += pair->answer.contact;
#define ADD(name) made.counters.name += pair->answer.counters.name;
        MOTE_COUNTERS(ADD)
        MOTE_COUNTERS_MORE(ADD)
#undef ADD
    }
    *step = made;
    return MOTE_OK;
}

const mote_bodies_pair *mote_bodies_engine_pairs(const mote_bodies_engine *engine,
                                                 size_t *count)
{
    *count = engine->now.count;
    return engine->now.pairs;
}
