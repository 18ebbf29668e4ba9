#include "harness/engine/probe.h"

#include "core/body/deform.h"
#include "core/stream/stream_scene.h"
#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>

struct mote_probe {
    mote_engine_setup setup;
    mote_scene *certified; /* all shapes have fields; otherwise NULL, and: */
    mote_stream_scene *streamed;
    mote_deform **deforms;     /* [shape_count] */
    mote_vec3 **worlds;        /* [count] */
    mote_positions *positions; /* [count] */
    bool *unchanged;           /* [count] */
};

static mote_status create_streamed(mote_probe *p, const mote_scene_options *options)
{
    const mote_engine_setup *b = &p->setup;
    p->deforms = mote_allocate(b->shape_count, sizeof(mote_deform *));
    p->worlds = mote_allocate(b->count, sizeof(mote_vec3 *));
    p->positions = mote_allocate(b->count, sizeof *p->positions);
    p->unchanged = mote_allocate(b->count, sizeof *p->unchanged);
    for (uint32_t i = 0; i < b->count; ++i) {
        const uint32_t vertices = b->shapes[b->shape_of[i]]->mesh->vertex_count;
        p->worlds[i] = mote_allocate(vertices, sizeof **p->worlds);
        p->positions[i] = mote_positions_of(p->worlds[i]);
    }
    mote_status status = MOTE_OK;
    for (uint32_t s = 0; s < b->shape_count && status == MOTE_OK; ++s)
        status = mote_deform_create(b->shapes[s], &p->deforms[s]);
    return status == MOTE_OK ? mote_stream_scene_create(b->shapes, b->shape_count, b->shape_of,
                                                        b->count, options, &p->streamed)
                             : status;
}

static bool any_given(const mote_engine_setup *setup)
{
    for (uint32_t s = 0; s < setup->shape_count; ++s) {
        if (mote_body_is_given(setup->shapes[s]))
            return true;
    }
    return false;
}

mote_status mote_probe_create(const mote_engine_setup *setup, double clearance,
                              mote_probe **probe)
{
    const mote_scene_options options = {
        .ask = MOTE_ASK_CONTACT, .tolerance = clearance, .threads = 1};
    mote_probe *made = mote_allocate(1, sizeof *made);
    made->setup = *setup;
    const mote_status status =
        any_given(setup) ? create_streamed(made, &options)
                         : mote_scene_create(setup->shapes, setup->shape_count, setup->shape_of,
                                             setup->count, &options, &made->certified);
    if (status == MOTE_OK)
        *probe = made;
    else
        mote_probe_destroy(made);
    return status;
}

void mote_probe_destroy(mote_probe *probe)
{
    if (!probe)
        return;
    mote_scene_destroy(probe->certified);
    mote_stream_scene_destroy(probe->streamed);
    for (uint32_t s = 0; probe->deforms && s < probe->setup.shape_count; ++s)
        mote_deform_destroy(probe->deforms[s]);
    for (uint32_t i = 0; probe->worlds && i < probe->setup.count; ++i)
        free(probe->worlds[i]);
    free(probe->deforms);
    free(probe->worlds);
    free(probe->positions);
    free(probe->unchanged);
    free(probe);
}

static void deform(mote_probe *p, const mote_body_state *states, uint32_t i)
{
    mote_deform_all(p->deforms[p->setup.shape_of[i]], &states[i], p->worlds[i]);
    p->unchanged[i] = false;
}

mote_status mote_probe_all(mote_probe *probe, const mote_body_state *states,
                           mote_scene_box *boxes)
{
    if (probe->certified)
        return mote_scene_bounds(probe->certified, states, boxes);
    for (uint32_t i = 0; i < probe->setup.count; ++i)
        deform(probe, states, i);
    return mote_stream_scene_bounds(probe->streamed, probe->positions, probe->unchanged, boxes);
}

mote_status mote_probe_one(mote_probe *probe, const mote_body_state *states, uint32_t i,
                           mote_scene_box *boxes)
{
    if (probe->certified)
        return mote_scene_bounds_of(probe->certified, i, &states[i], &boxes[i]);
    memset(probe->unchanged, true, probe->setup.count * sizeof *probe->unchanged);
    deform(probe, states, i);
    return mote_stream_scene_bounds(probe->streamed, probe->positions, probe->unchanged, boxes);
}

mote_status mote_probe_pair(mote_probe *probe, const mote_body_state *states, uint32_t i,
                            uint32_t j, bool *too_near, double *distance)
{
    const uint32_t pair[1][2] = {{i, j}};
    size_t count;
    const mote_status status = probe->certified
                                   ? mote_scene_query(probe->certified, states, pair, 1)
                                   : mote_stream_scene_query(probe->streamed, pair, 1);
    if (status != MOTE_OK)
        return status;
    const mote_scene_pair *answer = probe->certified
                                        ? mote_scene_pairs(probe->certified, &count)
                                        : mote_stream_scene_pairs(probe->streamed, &count);
    *too_near = answer->contact;
    *distance = answer->distance;
    return MOTE_OK;
}
