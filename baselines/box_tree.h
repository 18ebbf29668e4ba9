/* A tree of axis-aligned boxes over the triangles of a mesh: built once at rest, refitted
   bottom-up in one pass. Blocks of eight boxes, stored by coordinate for vector
   instructions, without pointers. Used by aabb-tree. About 21 bytes a triangle. */
#ifndef MOTE_BASELINES_BOX_TREE_H
#define MOTE_BASELINES_BOX_TREE_H

#include "core/body/body.h"

/* Children of a node. */
#define MOTE_BOX_WIDTH 8

/* Triangles of a leaf, at most MOTE_BOX_WIDTH; the last leaf may have fewer. */
#define MOTE_BOX_LEAF 8

/* Enough for 2^31 triangles. */
#define MOTE_BOX_LEVELS 12

/* The boxes of a node's children, each with a margin that covers the rounding of the conversion
   to float and of mote_box_block_distance. A lane without a child has half = -infinity, which
   is infinitely far from everything. */
typedef struct mote_box_block {
    float centre[3][MOTE_BOX_WIDTH], half[3][MOTE_BOX_WIDTH];
} mote_box_block;

typedef struct mote_box {
    float centre[3], half[3];
} mote_box;

/* Node i of level l > 0 has its box in lane i % 8 of block i / 8 of level l - 1, and its
   children in block i of level l. Level 0 is the root, level `height` are the leaves. Leaf i
   has the triangles order[i * MOTE_BOX_LEAF] ... and the vertices leaf_vertex[leaf_start[i]] ..
   [leaf_start[i + 1] - 1], each once. */
typedef struct mote_box_tree {
    const mote_mesh *mesh; /* borrowed */
    uint32_t height, leaves;
    uint32_t first_block[MOTE_BOX_LEVELS + 1]; /* of each level, then their number */
    mote_box_block *blocks;
    uint32_t *order;      /* [triangle_count] */
    uint32_t *leaf_start; /* [leaves + 1] */
    uint32_t *leaf_vertex;
    float (*position)[4]; /* [vertex_count]: set by mote_float_positions */
    mote_box root;
} mote_box_tree;

/* Builds the tree over the rest pose; with samples, over it and the body's sample poses
   (core/body/sample_split.h). MOTE_ENOMEM. Cost O(t log t). Boxes are unset until the first
   refit. Free with mote_box_tree_free, also after a failure. */
mote_status mote_box_tree_init(mote_box_tree *tree, const mote_body *body, bool samples);

void mote_box_tree_free(mote_box_tree *tree);

/* Sets all boxes from position. coordinate_max is the largest coordinate of both trees that
   will be compared. Cost: about 2 ns a triangle. */
void mote_box_tree_refit(mote_box_tree *tree, float coordinate_max);

static inline mote_box mote_box_lane(const mote_box_block *block, uint32_t lane)
{
    mote_box box;
    for (int k = 0; k < 3; k++) {
        box.centre[k] = block->centre[k][lane];
        box.half[k] = block->half[k][lane];
    }
    return box;
}

static inline mote_box mote_box_of(const mote_box_tree *tree, uint32_t level, uint32_t node)
{
    if (level == 0)
        return tree->root;
    return mote_box_lane(&tree->blocks[tree->first_block[level - 1] + node / MOTE_BOX_WIDTH],
                         node % MOTE_BOX_WIDTH);
}

static inline const mote_box_block *mote_box_children(const mote_box_tree *tree, uint32_t level,
                                                      uint32_t node)
{
    return &tree->blocks[tree->first_block[level] + node];
}

/* Four times the squared distance from box to each of eight boxes, rounded down: gap + |gap| is
   2 max(gap, 0), without a comparison. */
static inline void mote_box_block_distance(const mote_box *box, const mote_box_block *block,
                                           float four_squared[MOTE_BOX_WIDTH])
{
    for (int i = 0; i < MOTE_BOX_WIDTH; i++) {
        float sum = 0;
        for (int k = 0; k < 3; k++) {
            float gap = fabsf(block->centre[k][i] - box->centre[k]) -
                        (block->half[k][i] + box->half[k]);
            gap += fabsf(gap);
            sum += gap * gap;
        }
        four_squared[i] = sum;
    }
}

#endif
