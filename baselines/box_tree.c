#include "baselines/box_tree.h"

#include "baselines/float_positions.h"
#include "core/base/clones.h"
#include "core/body/leaf_order.h"

#include <stdlib.h>
#include <string.h>

void mote_box_tree_free(mote_box_tree *tree)
{
    free(tree->blocks);
    free(tree->order);
    free(tree->leaf_start);
    free(tree->leaf_vertex);
    free(tree->position);
    *tree = (mote_box_tree){0};
}

/* --- building -------------------------------------------------------------------------------
 */

static uint32_t leaf_end(const mote_box_tree *tree, uint32_t leaf)
{
    uint32_t end = (leaf + 1) * MOTE_BOX_LEAF;
    return end < tree->mesh->triangle_count ? end : tree->mesh->triangle_count;
}

/* Appends a vertex to a leaf's list unless it is already there. */
static uint32_t add_vertex(uint32_t *list, uint32_t from, uint32_t end, uint32_t vertex)
{
    for (uint32_t i = from; i < end; i++) {
        if (list[i] == vertex)
            return end;
    }
    list[end] = vertex;
    return end + 1;
}

/* Lists the vertices of every leaf, each once, and shrinks the list to its length. */
static void list_vertices(mote_box_tree *tree)
{
    uint32_t end = 0;
    for (uint32_t leaf = 0; leaf < tree->leaves; leaf++) {
        tree->leaf_start[leaf] = end;
        for (uint32_t i = leaf * MOTE_BOX_LEAF; i < leaf_end(tree, leaf); i++) {
            for (int k = 0; k < 3; k++)
                end = add_vertex(tree->leaf_vertex, tree->leaf_start[leaf], end,
                                 tree->mesh->triangles[tree->order[i]][k]);
        }
    }
    tree->leaf_start[tree->leaves] = end;
    uint32_t *cut = realloc(tree->leaf_vertex, (end > 0 ? end : 1) * sizeof *cut);
    tree->leaf_vertex = cut ? cut : tree->leaf_vertex;
}

/* Numbers the blocks of all levels. */
static void lay_out(mote_box_tree *tree)
{
    uint32_t count[MOTE_BOX_LEVELS], height = 0, nodes = tree->leaves;
    do {
        nodes = (nodes + MOTE_BOX_WIDTH - 1) / MOTE_BOX_WIDTH;
        count[height++] = nodes;
    } while (nodes > 1);
    tree->height = height;
    tree->first_block[0] = 0;
    for (uint32_t level = 0; level < height; level++)
        tree->first_block[level + 1] = tree->first_block[level] + count[height - 1 - level];
}

static bool allocate(mote_box_tree *tree)
{
    size_t triangles = tree->mesh->triangle_count;
    tree->blocks = aligned_alloc(64, tree->first_block[tree->height] * sizeof *tree->blocks);
    tree->order = calloc(triangles, sizeof *tree->order);
    tree->leaf_start = malloc(((size_t)tree->leaves + 1) * sizeof *tree->leaf_start);
    tree->leaf_vertex = malloc(3 * triangles * sizeof *tree->leaf_vertex);
    tree->position = malloc(tree->mesh->vertex_count * sizeof *tree->position);
    return tree->blocks && tree->order && tree->leaf_start && tree->leaf_vertex &&
           tree->position;
}

mote_status mote_box_tree_init(mote_box_tree *tree, const mote_body *body, bool samples)
{
    const mote_mesh *mesh = body->mesh;
    *tree = (mote_box_tree){.mesh = mesh};
    tree->leaves = (mesh->triangle_count + MOTE_BOX_LEAF - 1) / MOTE_BOX_LEAF;
    lay_out(tree);
    if (!allocate(tree))
        return mote_fail(MOTE_ENOMEM, "no memory for a tree of %u triangles",
                         mesh->triangle_count);
    mote_body ordered = *body;
    if (!samples)
        ordered.sample_count = 0;
    mote_status status = mote_leaf_order(&ordered, MOTE_BOX_LEAF, tree->order);
    if (status != MOTE_OK)
        return status;
    list_vertices(tree);
    return MOTE_OK;
}

/* --- refit ----------------------------------------------------------------------------------
 */

static inline float smaller(float a, float b)
{
    return a < b ? a : b;
}

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

/* Writes the box of leaf i to its lane. */
static inline void refit_leaf(mote_box_tree *tree, uint32_t leaf, float margin)
{
    const uint32_t *v = tree->leaf_vertex + tree->leaf_start[leaf];
    const uint32_t *end = tree->leaf_vertex + tree->leaf_start[leaf + 1];
    float low[4], high[4];
    memcpy(low, tree->position[*v], sizeof low);
    memcpy(high, low, sizeof high);
    while (++v < end) {
        const float *p = tree->position[*v];
        for (int k = 0; k < 4; k++) {
            low[k] = smaller(p[k], low[k]);
            high[k] = larger(p[k], high[k]);
        }
    }
    mote_box_block *block =
        &tree->blocks[tree->first_block[tree->height - 1] + leaf / MOTE_BOX_WIDTH];
    for (int k = 0; k < 3; k++) {
        block->centre[k][leaf % MOTE_BOX_WIDTH] = 0.5f * (low[k] + high[k]);
        block->half[k][leaf % MOTE_BOX_WIDTH] = 0.5f * (high[k] - low[k]) + margin;
    }
}

/* The box around the boxes of a block, along axis k. */
static inline void enclose(const mote_box_block *block, int k, float margin, float *centre,
                           float *half)
{
    float low[MOTE_BOX_WIDTH], high[MOTE_BOX_WIDTH];
    for (int i = 0; i < MOTE_BOX_WIDTH; i++) {
        bool empty = block->half[k][i] < 0;
        low[i] = empty ? HUGE_VALF : block->centre[k][i] - block->half[k][i];
        high[i] = empty ? -HUGE_VALF : block->centre[k][i] + block->half[k][i];
    }
    for (int width = MOTE_BOX_WIDTH / 2; width > 0; width /= 2) {
        for (int i = 0; i < width; i++) {
            low[i] = smaller(low[i], low[i + width]);
            high[i] = larger(high[i], high[i + width]);
        }
    }
    *centre = 0.5f * (low[0] + high[0]);
    *half = 0.5f * (high[0] - low[0]) + margin;
}

/* Marks the lanes without a child in the last block of a level as empty. */
static void empty_lanes(mote_box_tree *tree, uint32_t level, uint32_t nodes)
{
    mote_box_block *block =
        &tree->blocks[tree->first_block[level] + (nodes - 1) / MOTE_BOX_WIDTH];
    for (uint32_t i = (nodes - 1) % MOTE_BOX_WIDTH + 1; i < MOTE_BOX_WIDTH; i++) {
        for (int k = 0; k < 3; k++) {
            block->centre[k][i] = 0;
            block->half[k][i] = -HUGE_VALF;
        }
    }
}

MOTE_CLONES
void mote_box_tree_refit(mote_box_tree *tree, float coordinate_max)
{
    float margin = mote_float_margin(coordinate_max);
    for (uint32_t leaf = 0; leaf < tree->leaves; leaf++)
        refit_leaf(tree, leaf, margin);
    empty_lanes(tree, tree->height - 1, tree->leaves);
    for (uint32_t level = tree->height - 1; level > 0; level--) {
        uint32_t nodes = tree->first_block[level + 1] - tree->first_block[level];
        for (uint32_t i = 0; i < nodes; i++) {
            const mote_box_block *from = &tree->blocks[tree->first_block[level] + i];
            mote_box_block *to =
                &tree->blocks[tree->first_block[level - 1] + i / MOTE_BOX_WIDTH];
            for (int k = 0; k < 3; k++)
                enclose(from, k, margin, &to->centre[k][i % MOTE_BOX_WIDTH],
                        &to->half[k][i % MOTE_BOX_WIDTH]);
        }
        empty_lanes(tree, level - 1, nodes);
    }
    for (int k = 0; k < 3; k++)
        enclose(tree->blocks, k, margin, &tree->root.centre[k], &tree->root.half[k]);
}
