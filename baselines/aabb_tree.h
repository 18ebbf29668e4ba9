/* The query of aabb-tree for two trees that the caller keeps and refits. */
#ifndef MOTE_BASELINES_AABB_TREE_H
#define MOTE_BASELINES_AABB_TREE_H

#include "baselines/box_tree.h"
#include "core/method/method.h"

typedef struct mote_aabb_pair {
    const mote_box_tree *tree[2];
    const mote_vec3 *vertices[2]; /* world positions that the trees were refitted to */
    double scale;                 /* of the trees' positions */
    float coordinate_max;         /* the value that they were refitted with */
    mote_ask ask;
    double tolerance;
    uint32_t last[2]; /* triangles of the last answer; replaced by those of this one */
    bool has_last;
} mote_aabb_pair;

/* Answers as the method aabb-tree does. No allocation. */
mote_status mote_aabb_pair_query(mote_aabb_pair *pair, mote_answer *answer);

#endif
