/* What a streamed query keeps of a mesh, whatever its positions are: triangles in leaves,
   leaves in groups, and for each group the vertices to read. Immutable once made; bodies of one
   shape share it. */
#ifndef MOTE_CORE_STREAM_TREE_H
#define MOTE_CORE_STREAM_TREE_H

#include "core/certificate/certificate_hulls.h"

/* Children of a node, leaves of a group. */
#define MOTE_STREAM_WIDTH 8

/* Triangles of a leaf and of a group. */
#define MOTE_STREAM_LEAF MOTE_CERT_LEAF_TRIANGLES
#define MOTE_STREAM_GROUP (MOTE_STREAM_LEAF * MOTE_STREAM_WIDTH)

/* Levels of boxes of groups: enough for 2^32 triangles. */
#define MOTE_STREAM_LEVELS 9

/* Vertices that are read at once where they follow each other. */
#define MOTE_STREAM_RUN 8

/* Node i of level l > 0 has its box in lane i % 8 of block i / 8 of level l - 1, and its
   children in block i of level l. Level 0 is the root, level `height` are the groups. Group i
   has the leaves 8 i .. 8 i + 7 (the last one fewer), leaf i the triangles order[32 i] .. and
   the vertices leaf_vertices[leaf_start[i]] .. [leaf_start[i + 1] - 1], each once. */
typedef struct mote_stream_tree {
    const mote_mesh *mesh; /* borrowed */
    mote_body body;        /* the same mesh, and nothing else */
    uint32_t leaves, groups, height;
    uint32_t first_block[MOTE_STREAM_LEVELS + 1]; /* of each level, then their number */
    uint32_t *order;                              /* [triangle_count] */
    size_t *leaf_start;                           /* [leaves + 1] */
    uint32_t *leaf_vertices;
    uint8_t (*corners)[3]; /* [triangle_count], in the order above: places in the leaf's list */
    /* The vertices of group g, each at least once: MOTE_STREAM_RUN from each of
       runs[run_start[g]] .. [run_start[g + 1] - 1] on, and those in singles, the number of
       which is a multiple of 4. The mesh's last vertex is no single, so that four numbers may
       be read at each; `last` says where it belongs. */
    size_t *run_start, *single_start; /* [groups + 1] */
    uint32_t *runs, *singles;
    bool *last; /* [groups]: the mesh's last vertex is one of the group's */
} mote_stream_tree;

/* Builds the tree of a body. MOTE_ENOMEM. Cost O(t log t). */
mote_status mote_stream_tree_create(const mote_body *body, mote_stream_tree **tree);

/* NULL is allowed. */
void mote_stream_tree_destroy(mote_stream_tree *tree);

size_t mote_stream_tree_bytes(const mote_stream_tree *tree);

/* Triangles of leaf i. */
static inline uint32_t mote_stream_leaf_faces(const mote_stream_tree *tree, uint32_t leaf)
{
    const uint32_t left = tree->mesh->triangle_count - leaf * MOTE_STREAM_LEAF;
    return left < MOTE_STREAM_LEAF ? left : MOTE_STREAM_LEAF;
}

#endif
