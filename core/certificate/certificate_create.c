/* Allocating what one query needs: for a certificate with trees of its own, or for a workspace
   that works on the trees of others. */
#include "core/certificate/certificate_shared.h"
#include "core/base/pool.h"
#include "core/certificate/certificate_bounds.h"
#include "core/certificate/certificate_state.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint32_t at_most(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* Memory for count elements that begins on a cache line; count is at least 1. */
static void *allocate_aligned(size_t count, size_t size)
{
    return aligned_alloc(64, (count * size + 63) / 64 * 64);
}

/* What one side must have room for: the largest of several trees. */
typedef struct capacity {
    const mote_body *largest; /* the body with the most vertices */
    uint32_t blocks, depth;   /* the most blocks, and the greatest depth, of any tree */
    uint32_t positions;       /* the most that are likely to be looked at in a query */
    size_t frame;             /* the most bytes that bounds keep of a frame */
} capacity;

/* How many exact positions a query is likely to look at. With sparse fields, of which leaves
   are placed in single precision, it is 20 to 50 of both bodies in the mean, 87 at most with
   the characters of 15,000 triangles and 280 with those of 330,000. */
static uint32_t positions_for(const mote_body *body)
{
    const uint32_t one_in = body->field->kind->sparse ? 64 : 8;
    return at_most(128 + body->mesh->vertex_count / one_in, 2048);
}

static capacity capacity_for(mote_cert_tree *const *trees, uint32_t count)
{
    capacity most = {.largest = trees[0]->body};
    for (uint32_t i = 0; i < count; ++i) {
        const mote_body *body = trees[i]->body;
        if (body->mesh->vertex_count > most.largest->mesh->vertex_count)
            most.largest = body;
        most.blocks = larger(most.blocks, trees[i]->block_count);
        most.depth = larger(most.depth, trees[i]->depth);
        most.positions = larger(most.positions, positions_for(body));
        const size_t frame = trees[i]->bounds->frame_bytes(trees[i]);
        most.frame = frame > most.frame ? frame : most.frame;
    }
    return most;
}

/* The capacity grows with the mesh up to a fixed limit. A query that needs more computes things
   again instead of allocating. */
static mote_status side_create(mote_cert_side *side, const capacity *most)
{
    const uint32_t vertices = most->largest->mesh->vertex_count;
    mote_status status = mote_lazy_init(&side->lazy, most->largest, most->positions);
    if (status != MOTE_OK)
        return status;
    side->lazy.fixed = true;
    side->node_room = at_most(most->blocks, at_most(24 + vertices / 64, 4096));
    side->nodes = allocate_aligned(side->node_room, sizeof *side->nodes);
    side->frame_bytes = most->frame;
    side->frame = allocate_aligned(most->frame, 1);
    if (!side->nodes || !side->frame)
        return mote_fail(MOTE_ENOMEM, "no memory for a query's boxes");
    memset(side->frame, 0, most->frame); /* find_anew projects before there is a plane */
    return MOTE_OK;
}

/* A workspace for trees of one scale. */
static mote_status create(const mote_certificate_options *options, double scale,
                          const capacity most[2], mote_certificate **made)
{
    mote_certificate *c = allocate_aligned(1, sizeof *c);
    if (!c)
        return mote_fail(MOTE_ENOMEM, "no memory for a certificate");
    memset(c, 0, sizeof *c);
    c->options = *options;
    c->scale = scale;
    mote_status status = side_create(&c->side[0], &most[0]);
    if (status == MOTE_OK)
        status = side_create(&c->side[1], &most[1]);
    c->spare_room = 2 * (most[0].depth + most[1].depth);
    if (status == MOTE_OK && !(c->spare = allocate_aligned(c->spare_room, sizeof *c->spare)))
        status = mote_fail(MOTE_ENOMEM, "no memory for a query's boxes");
    if (status == MOTE_OK)
        *made = c;
    else
        mote_cert_workspace_destroy(c);
    return status;
}

/* Two trees to be built, and how that went: texts of failures belong to the thread they happen
   in. */
typedef struct order {
    const mote_body *const *bodies;
    mote_cert_tree_options plan;
    mote_cert_tree **trees;
    mote_status status[2];
    char text[2][256];
} order;

static void build_range(void *context, uint32_t worker, size_t first, size_t end)
{
    order *o = context;
    (void)worker;
    for (size_t i = first; i < end; ++i) {
        o->status[i] = mote_cert_tree_create(o->bodies[i], &o->plan, &o->trees[i]);
        if (o->status[i] != MOTE_OK)
            (void)snprintf(o->text[i], sizeof o->text[i], "%s", mote_error_text());
    }
}

/* Builds the trees of both bodies. trees: NULL where they fail. */
static mote_status build_trees(const mote_body *const body[2],
                               const mote_certificate_options *options,
                               mote_cert_tree *trees[2])
{
    order o = {.bodies = body,
               .plan = {.length = options->length,
                        .width = options->width,
                        .linear_fits = options->linear_fits},
               .trees = trees};
    mote_pool *pool;
    const mote_status status = mote_pool_create(options->threads < 2 ? 1 : 2, &pool);
    if (status != MOTE_OK)
        return status;
    mote_pool_run(pool, build_range, &o, 2, 1);
    mote_pool_destroy(pool);
    const int failed = o.status[0] != MOTE_OK ? 0 : 1;
    return o.status[failed] == MOTE_OK ? MOTE_OK
                                       : mote_fail(o.status[failed], "%s", o.text[failed]);
}

mote_status mote_certificate_create(const mote_body *const body[2],
                                    const mote_certificate_options *options,
                                    mote_certificate **certificate)
{
    mote_cert_tree *trees[2] = {NULL, NULL};
    mote_certificate *made = NULL;
    mote_status status = build_trees(body, options, trees);
    if (status == MOTE_OK) {
        const capacity own[2] = {capacity_for(&trees[0], 1), capacity_for(&trees[1], 1)};
        status = create(options, trees[0]->scale, own, &made);
    }
    if (status != MOTE_OK) {
        mote_cert_tree_destroy(trees[0]);
        mote_cert_tree_destroy(trees[1]);
        return status;
    }
    made->side[0].tree = trees[0];
    made->side[1].tree = trees[1];
    *certificate = made;
    return MOTE_OK;
}

mote_status mote_cert_workspace_create(mote_cert_tree *const *trees, uint32_t count,
                                       const mote_certificate_options *options,
                                       mote_certificate **workspace)
{
    const capacity any = capacity_for(trees, count);
    return create(options, trees[0]->scale, (const capacity[2]){any, any}, workspace);
}

void mote_cert_workspace_destroy(mote_certificate *workspace)
{
    if (!workspace)
        return;
    for (int s = 0; s < 2; ++s) {
        mote_lazy_free(&workspace->side[s].lazy);
        free(workspace->side[s].nodes);
        free(workspace->side[s].frame);
    }
    free(workspace->spare);
    free(workspace);
}

void mote_certificate_destroy(mote_certificate *certificate)
{
    if (!certificate)
        return;
    for (int s = 0; s < 2; ++s)
        mote_cert_tree_destroy(certificate->side[s].tree);
    mote_cert_workspace_destroy(certificate);
}

size_t mote_cert_workspace_bytes(const mote_certificate *workspace)
{
    size_t bytes = sizeof *workspace + workspace->spare_room * sizeof *workspace->spare;
    for (int s = 0; s < 2; ++s) {
        const mote_cert_side *side = &workspace->side[s];
        bytes += (side->lazy.mask + (size_t)1) * sizeof(mote_lazy_slot) +
                 side->node_room * sizeof *side->nodes + side->frame_bytes;
    }
    return bytes;
}

size_t mote_certificate_bytes(const mote_certificate *certificate)
{
    return mote_cert_workspace_bytes(certificate) +
           mote_cert_tree_bytes(certificate->side[0].tree) +
           mote_cert_tree_bytes(certificate->side[1].tree);
}
