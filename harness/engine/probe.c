#include "harness/engine/probe.h"

#include "core/body/deform.h"
#include "core/stream/stream_scene.h"
#include "harness/base/memory.h"
#include "harness/engine/engine_kind.h"

#include <stdlib.h>
#include <string.h>

/* Where a shape has no field: two bodies of each shape, which stand for those asked about. So
   there are the positions of few bodies at once, and asking about one costs the same however
   many there are. */
struct mote_probe {
    mote_engine_setup setup;
    mote_scene *certified; /* all shapes have fields; otherwise NULL, and: */
    mote_stream_scene *streamed;
    mote_deform **deforms;     /* [shape_count] */
    mote_vec3 **worlds;        /* [stand_ins] */
    mote_positions *positions; /* [stand_ins] */
    bool *unchanged;           /* [stand_ins] */
    mote_scene_box *boxes;     /* [stand_ins] */
    uint32_t stand_ins;
};

static mote_status create_streamed(mote_probe *p, const mote_scene_options *options)
{
    const mote_engine_setup *b = &p->setup;
    p->stand_ins = 2 * b->shape_count;
    p->deforms = mote_allocate(b->shape_count, sizeof(mote_deform *));
    p->worlds = mote_allocate(p->stand_ins, sizeof(mote_vec3 *));
    p->positions = mote_allocate(p->stand_ins, sizeof *p->positions);
    p->unchanged = mote_allocate(p->stand_ins, sizeof *p->unchanged);
    p->boxes = mote_allocate(p->stand_ins, sizeof *p->boxes);
    uint32_t *shape_of = mote_allocate(p->stand_ins, sizeof *shape_of);
    for (uint32_t k = 0; k < p->stand_ins; ++k) {
        shape_of[k] = k % b->shape_count;
        const mote_mesh *mesh = b->shapes[shape_of[k]]->mesh;
        p->worlds[k] = mote_copy(mesh->positions, mesh->vertex_count * sizeof(mote_vec3));
        p->positions[k] = mote_positions_of(p->worlds[k]);
    }
    mote_status status = MOTE_OK;
    for (uint32_t s = 0; s < b->shape_count && status == MOTE_OK; ++s)
        status = mote_deform_create(b->shapes[s], &p->deforms[s]);
    if (status == MOTE_OK)
        status = mote_stream_scene_create(b->shapes, b->shape_count, shape_of, p->stand_ins,
                                          options, &p->streamed);
    if (status == MOTE_OK)
        status = mote_stream_scene_bounds(p->streamed, p->positions, NULL, p->boxes);
    free(shape_of);
    return status;
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
    for (uint32_t k = 0; probe->worlds && k < probe->stand_ins; ++k)
        free(probe->worlds[k]);
    free(probe->deforms);
    free(probe->worlds);
    free(probe->positions);
    free(probe->unchanged);
    free(probe->boxes);
    free(probe);
}

/* Shows body i in the place of a stand-in of its shape. */
static void show(mote_probe *p, const mote_body_state *states, uint32_t i, uint32_t stand_in)
{
    mote_deform_all(p->deforms[p->setup.shape_of[i]], &states[i], p->worlds[stand_in]);
    p->unchanged[stand_in] = false;
}

/* Makes the boxes of the stand-ins that were shown something. */
static mote_status bound(mote_probe *p)
{
    const mote_status status =
        mote_stream_scene_bounds(p->streamed, p->positions, p->unchanged, p->boxes);
    memset(p->unchanged, true, p->stand_ins * sizeof *p->unchanged);
    return status;
}

static mote_status bound_body(mote_probe *p, const mote_body_state *states, uint32_t i,
                              mote_scene_box *box)
{
    const uint32_t stand_in = p->setup.shape_of[i];
    show(p, states, i, stand_in);
    const mote_status status = bound(p);
    if (status == MOTE_OK)
        *box = p->boxes[stand_in];
    return mote_engine_blame(status, i); /* it names the stand-in */
}

mote_status mote_probe_all(mote_probe *probe, const mote_body_state *states,
                           mote_scene_box *boxes)
{
    if (probe->certified)
        return mote_scene_bounds(probe->certified, states, boxes);
    mote_status status = MOTE_OK;
    for (uint32_t i = 0; i < probe->setup.count && status == MOTE_OK; ++i)
        status = bound_body(probe, states, i, &boxes[i]);
    return status;
}

mote_status mote_probe_one(mote_probe *probe, const mote_body_state *states, uint32_t i,
                           mote_scene_box *boxes)
{
    return probe->certified ? mote_scene_bounds_of(probe->certified, i, &states[i], &boxes[i])
                            : bound_body(probe, states, i, &boxes[i]);
}

/* Asks about two bodies by their stand-ins. */
static mote_status query_streamed(mote_probe *p, const mote_body_state *states, uint32_t i,
                                  uint32_t j)
{
    const uint32_t pair[1][2] = {
        {p->setup.shape_of[i], p->setup.shape_count + p->setup.shape_of[j]}};
    show(p, states, i, pair[0][0]);
    show(p, states, j, pair[0][1]);
    const mote_status status = bound(p);
    return status == MOTE_OK ? mote_stream_scene_query(p->streamed, pair, 1) : status;
}

mote_status mote_probe_pair(mote_probe *probe, const mote_body_state *states, uint32_t i,
                            uint32_t j, bool *too_near, double *distance)
{
    const uint32_t pair[1][2] = {{i, j}};
    size_t count;
    const mote_status status = probe->certified
                                   ? mote_scene_query(probe->certified, states, pair, 1)
                                   : query_streamed(probe, states, i, j);
    if (status != MOTE_OK)
        return status;
    const mote_scene_pair *answer = probe->certified
                                        ? mote_scene_pairs(probe->certified, &count)
                                        : mote_stream_scene_pairs(probe->streamed, &count);
    *too_near = answer->contact;
    *distance = answer->distance;
    return MOTE_OK;
}
