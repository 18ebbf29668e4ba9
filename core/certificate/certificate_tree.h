/* The rest tree of certified mode: boxes that are deformed node by node, on demand, without
   evaluating the field (docs/architecture.md, "The certified query"; James and
   Pai's BD-tree with boxes for spheres).

   For a child box with centre c and half axes h_k let z_k = h_k.(x - c) / |h_k|^2, so that
   every rest vertex of the box is x = c + sum_k z_k h_k with |z_k| <= 1. A triangle is convex,
   so a box of its vertices encloses it. How a box at rest becomes one that encloses the
   deformed vertices is up to the bounds of the field's kind (certificate_bounds.h).

   Lengths are relative to origin and multiplied by scale, a power of two near 1 / L. */
#ifndef MOTE_CORE_CERTIFICATE_TREE_H
#define MOTE_CORE_CERTIFICATE_TREE_H

#include "core/body/body.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Children of a block: the lanes of every test of boxes. */
#define MOTE_CERT_WIDTH 8

/* A leaf's triangles and vertices, at most. */
#define MOTE_CERT_LEAF_TRIANGLES 32
#define MOTE_CERT_LEAF_VERTICES 40

/* One number for each child of a block. What is kept of a block's children beyond their boxes
   at rest is a run of these; what they mean is up to the tree's bounds (certificate_bounds.h).
 */
typedef float mote_cert_strip[MOTE_CERT_WIDTH];

typedef struct mote_cert_block {
    float centre[3][MOTE_CERT_WIDTH];
    float half[3][3][MOTE_CERT_WIDTH]; /* [axis, longest first][coordinate][child] */
    int32_t cut[3][MOTE_CERT_WIDTH];   /* [pair of axes: 01, 02, 12]: see mote_cert_cut_of */
    int32_t child[MOTE_CERT_WIDTH];    /* >= 0: a block; < 0: the leaf ~child */
    uint32_t first_strip;              /* of its bounds, in strips */
    uint32_t first_active;             /* what of the field moves it, ascending, in active */
    uint32_t active_count;
    uint32_t children;
    uint32_t mask; /* bit l: lane l has a child; the first `children` bits */
} mote_cert_block;

typedef struct mote_cert_leaf {
    uint32_t first_vertex; /* in leaf_vertices */
    uint32_t first_corner; /* in corners */
    uint32_t first_group;  /* of its vertices, in groups */
    uint8_t vertex_count;
    uint8_t triangle_count;
} mote_cert_leaf;

/* Coordinates of MOTE_CERT_WIDTH vertices of a leaf in its box. The last group of a leaf is
   filled up with copies of its last vertex. */
typedef struct mote_cert_group {
    float z[3][MOTE_CERT_WIDTH];
} mote_cert_group;

typedef struct mote_cert_tree {
    const mote_body *body;
    double scale;
    mote_vec3 origin;
    mote_cert_block *blocks; /* [block_count]; the root is the first */
    const struct mote_cert_bounds *bounds;
    void *fixed;             /* what the bounds keep of the whole tree, or NULL */
    mote_cert_strip *strips; /* [strip_count] */
    uint16_t *active;        /* [active_count] numbers of basis functions, or of a kind's own */
    mote_cert_leaf *leaves;  /* [leaf_count] */
    uint32_t *leaf_vertices; /* [leaf_vertex_count] */
    mote_cert_group *groups; /* [group_count] */
    uint8_t (*corners)[3];   /* [triangle_count], indices into the leaf's vertices */
    uint32_t block_count, leaf_count, leaf_vertex_count, group_count;
    size_t strip_count, active_count;
    size_t strip_room, active_room; /* while it is built */
    size_t fixed_bytes;
    uint32_t depth; /* blocks on the longest path from the root */
    double radius;  /* bound of |c| + |h_1| + |h_2| + |h_3| of any box */
    double leak;    /* how far a vertex sticks out of its box by the rounding of boxes */
} mote_cert_tree;

typedef struct mote_cert_tree_options {
    double length;    /* > 0: L of the pair, fixes the scale */
    uint32_t width;   /* children a block: 2, 4 or 8 */
    bool linear_fits; /* false: g = 0 (to measure what the fits bring) */
} mote_cert_tree_options;

/* Builds the tree of a body, which is borrowed. MOTE_EUNSUPPORTED where only its positions
   are given; MOTE_EINVAL for a skin of another mesh; MOTE_ENOMEM. Cost O(t log t + v J log t).
 */
mote_status mote_cert_tree_create(const mote_body *body, const mote_cert_tree_options *options,
                                  mote_cert_tree **tree);

/* Gives a block its strips and active numbers, zeroed, at the end of the tree's. Only while the
   tree is built. MOTE_ENOMEM. */
mote_status mote_cert_tree_keep(mote_cert_tree *tree, mote_cert_block *block, size_t strips,
                                size_t active);

/* NULL is allowed. */
void mote_cert_tree_destroy(mote_cert_tree *tree);

/* Bytes of heap that a tree holds. */
size_t mote_cert_tree_bytes(const mote_cert_tree *tree);

/* How much of the corners of a box is empty. For axes i < j and signs s, t let d be the largest
   s z_i + t z_j of the vertices; 2 - d, held within 0 .. 1, is stored rounded down to a whole
   number of 255ths, in one byte of a word for each pair of signs: ++ lowest, then +-, -+, --.
   For any a, b of these signs, a z_i + b z_j <= |a| + |b| - (2 - d) min(|a|, |b|). */
static inline int32_t mote_cert_cut_of(int32_t word, float a, float b)
{
    const int32_t half = a < 0 ? word >> 16 : word;
    const int32_t byte = b < 0 ? half >> 8 : half;
    return byte & 255;
}

/* Groups of a leaf's vertices. */
static inline uint32_t mote_cert_group_count(const mote_cert_leaf *leaf)
{
    return (leaf->vertex_count + MOTE_CERT_WIDTH - 1u) / MOTE_CERT_WIDTH;
}

/* A rest vertex in the tree's units. */
static inline mote_vec3 mote_cert_tree_position(const mote_cert_tree *tree, uint32_t vertex)
{
    return mote_scale(mote_sub(tree->body->mesh->positions[vertex], tree->origin), tree->scale);
}

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
