/* More than two bodies: the streamed scene, which reads the positions of all bodies. */
#include "harness/engine/engine_kind.h"

#include "core/stream/stream_scene.h"
#include "harness/base/clock.h"
#include "harness/base/memory.h"

#include <stdlib.h>

static mote_status streamed_build(mote_engine *e)
{
    const mote_engine_setup *s = &e->setup;
    const mote_scene_options options = {
        .ask = s->ask, .tolerance = s->tolerance, .threads = e->threads};
    e->boxes = mote_allocate(s->count, sizeof *e->boxes);
    e->looked_at = mote_allocate(s->count, sizeof *e->looked_at);
    e->positions = mote_allocate(s->count, sizeof *e->positions);
    e->worlds = mote_allocate(s->count, sizeof(mote_vec3 *));
    mote_status status = mote_broad_phase_create(s->count, &e->broad);
    if (status == MOTE_OK)
        status = mote_stream_scene_create(s->shapes, s->shape_count, s->shape_of, s->count,
                                          &options, &e->streamed);
    for (uint32_t k = 0; k < s->shape_count && status == MOTE_OK; ++k)
        status = mote_deform_create(s->shapes[k], &e->deform[k]);
    for (uint32_t i = 0; i < s->count && status == MOTE_OK; ++i) {
        const mote_body *body = s->shapes[s->shape_of[i]];
        if (mote_body_is_given(body))
            continue;
        e->worlds[i] = mote_allocate(body->mesh->vertex_count, sizeof **e->worlds);
        e->positions[i] = mote_positions_of(e->worlds[i]);
    }
    return status;
}

static void streamed_destroy(mote_engine *e)
{
    mote_stream_scene_destroy(e->streamed);
    mote_engine_destroy_near(e);
    for (uint32_t i = 0; e->worlds && i < e->setup.count; ++i)
        free(e->worlds[i]);
    free(e->worlds);
    free(e->positions);
    free(e->looked_at);
}

static void deform_all(mote_engine *e)
{
    for (uint32_t i = 0; i < e->setup.count; ++i) {
        e->looked_at[i] = e->states[i].shape_changed || e->states[i].pose_changed;
        if (!e->worlds[i])
            e->positions[i] = mote_positions_of(e->states[i].vertices);
        else if (e->looked_at[i])
            mote_deform_all(e->deform[e->setup.shape_of[i]], &e->states[i], e->worlds[i]);
    }
}

/* Deforms all bodies; with positions=given this is charged to no method. */
static void streamed_show(mote_engine *e)
{
    if (e->traits.given_vertices)
        deform_all(e);
}

static mote_status streamed_ask(mote_engine *e, mote_engine_cost *cost)
{
    const uint64_t from = mote_clock_ns();
    if (!e->traits.given_vertices)
        deform_all(e);
    const uint64_t deformed = mote_clock_ns();
    cost->deform_ns = e->traits.given_vertices ? 0 : deformed - from;
    for (uint32_t i = 0; i < e->setup.count; ++i)
        e->looked_at[i] = !e->looked_at[i]; /* from here on it means: unchanged */
    mote_pairs_wanted wanted = {0};
    mote_status status = mote_engine_blame(
        mote_stream_scene_bounds(e->streamed, e->positions, e->looked_at, e->boxes),
        MOTE_ENGINE_SAME);
    cost->bounds_ns = mote_clock_ns() - deformed;
    if (status == MOTE_OK)
        status = mote_engine_find_near(e, cost, &wanted);
    if (status == MOTE_OK)
        status = mote_stream_scene_query(e->streamed, wanted.pairs, wanted.count);
    if (status != MOTE_OK)
        return status;
    size_t count;
    const mote_scene_pair *answers = mote_stream_scene_pairs(e->streamed, &count);
    mote_engine_copy_answers(e, answers, count);
    return MOTE_OK;
}

const mote_engine_kind mote_engine_of_streamed = {NULL, streamed_build, streamed_destroy,
                                                  streamed_show, streamed_ask};
