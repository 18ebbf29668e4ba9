#include "core/certificate_shared.h"

#include "core/certificate_state.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* A room for count elements that begins on a cache line; count is at least 1. */
static void *aligned_room(size_t count, size_t size)
{
    return aligned_alloc(64, (count * size + 63) / 64 * 64);
}

/* What the rooms of a workspace have to hold for the largest of its trees. */
typedef struct rooms {
    const mote_body *widest; /* of most vertices */
    uint32_t nodes, depth;
} rooms;

static rooms rooms_for(mote_cert_tree *const *trees, uint32_t count)
{
    rooms most = {.widest = trees[0]->body};
    for (uint32_t i = 0; i < count; ++i) {
        const mote_body *body = trees[i]->body;
        if (body->mesh->vertex_count > most.widest->mesh->vertex_count)
            most.widest = body;
        most.nodes = larger(most.nodes, trees[i]->block_count);
        most.depth = larger(most.depth, trees[i]->depth);
    }
    /* As for a certificate of its own: a query that needs more computes it again. */
    const uint32_t vertices = most.widest->mesh->vertex_count;
    const uint32_t enough = vertices / 64 < 4072 ? 24 + vertices / 64 : 4096;
    if (most.nodes > enough)
        most.nodes = enough;
    return most;
}

static mote_status side_create(mote_cert_side *side, const rooms *most)
{
    const uint32_t vertices = most->widest->mesh->vertex_count;
    const uint32_t expected = vertices / 8 < 1920 ? 128 + vertices / 8 : 2048;
    mote_status status = mote_lazy_init(&side->lazy, most->widest, expected);
    if (status != MOTE_OK)
        return status;
    side->lazy.fixed = true;
    side->node_room = most->nodes;
    side->nodes = aligned_room(side->node_room, sizeof *side->nodes);
    return side->nodes ? MOTE_OK : mote_fail(MOTE_ENOMEM, "no memory for a query's boxes");
}

mote_status mote_cert_workspace_create(mote_cert_tree *const *trees, uint32_t count,
                                       const mote_certificate_options *options,
                                       mote_certificate **workspace)
{
    mote_certificate *c = aligned_room(1, sizeof *c);
    if (!c)
        return mote_fail(MOTE_ENOMEM, "no memory for a certificate");
    memset(c, 0, sizeof *c);
    c->options = *options;
    c->scale = trees[0]->scale;
    const rooms most = rooms_for(trees, count);
    mote_status status = side_create(&c->side[0], &most);
    if (status == MOTE_OK)
        status = side_create(&c->side[1], &most);
    c->spare_room = 4 * most.depth;
    if (status == MOTE_OK && !(c->spare = aligned_room(c->spare_room, sizeof *c->spare)))
        status = mote_fail(MOTE_ENOMEM, "no memory for a query's boxes");
    if (status == MOTE_OK)
        *workspace = c;
    else
        mote_cert_workspace_destroy(c);
    return status;
}

void mote_cert_workspace_destroy(mote_certificate *workspace)
{
    if (!workspace)
        return;
    workspace->side[0].tree = workspace->side[1].tree = NULL; /* borrowed */
    mote_certificate_destroy(workspace);
}

size_t mote_cert_workspace_bytes(const mote_certificate *workspace)
{
    size_t bytes = sizeof *workspace + workspace->spare_room * sizeof *workspace->spare;
    for (int s = 0; s < 2; ++s) {
        const mote_cert_side *side = &workspace->side[s];
        bytes += (side->lazy.mask + (size_t)1) * sizeof(mote_lazy_slot) +
                 side->node_room * sizeof *side->nodes;
    }
    return bytes;
}

void mote_cert_workspace_query(mote_certificate *workspace, mote_cert_tree *const trees[2],
                               const mote_frame *frame, double enough, mote_cert_memory *memory,
                               mote_certificate_answer *answer)
{
    for (int s = 0; s < 2; ++s) {
        workspace->side[s].tree = trees[s];
        workspace->side[s].lazy.body = trees[s]->body;
    }
    memcpy(workspace->last, memory->last, sizeof workspace->last);
    workspace->leap = memory->leap;
    workspace->has_last = memory->has_last;
    workspace->steady = memory->steady;
    workspace->saddle = memory->saddle;
    mote_certificate_query(workspace, frame, NULL, enough, answer);
    memcpy(memory->last, workspace->last, sizeof memory->last);
    memory->leap = workspace->leap;
    memory->has_last = workspace->has_last;
    memory->steady = workspace->steady;
    memory->saddle = workspace->saddle;
}

/* The margins of a box's coordinates hold for its half width as well, and for the rounding of
   world coordinates (certificate_deform.c); sums here are in double precision. */
void mote_cert_workspace_bounds(mote_certificate *workspace, mote_cert_tree *tree,
                                const mote_body_state *state, mote_vec3 *low, mote_vec3 *high)
{
    mote_cert_side *side = &workspace->side[0];
    /* Near the middle of the body, where single precision is finest. */
    const mote_vec3 origin = mote_pose_apply(&state->pose, tree->origin);
    side->tree = tree;
    mote_cert_side_begin(side, state, origin);
    mote_cert_node *root = mote_cert_root(workspace, 0);
    mote_cert_make_boxes(workspace, 0, root);
    double least[3] = {DBL_MAX, DBL_MAX, DBL_MAX};
    double most[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (size_t l = 0; l < root->block->children; ++l) {
        for (int k = 0; k < 3; ++k) {
            const double centre = (double)root->centre[k][l];
            const double half = fabs((double)root->axis[0][k][l]) +
                                fabs((double)root->axis[1][k][l]) +
                                fabs((double)root->axis[2][k][l]) + (double)root->width[k][l];
            /* A number that is no number is in every lane: none is passed over. */
            least[k] = centre - half >= least[k] ? least[k] : centre - half;
            most[k] = centre + half <= most[k] ? most[k] : centre + half;
        }
    }
    const double unit = 1 / tree->scale;
    *low = mote_add_scaled(origin, unit, mote_vec3_make(least[0], least[1], least[2]));
    *high = mote_add_scaled(origin, unit, mote_vec3_make(most[0], most[1], most[2]));
}
