/* A short list of pairs of vertices, one of each body, nearest first, no two in the same
   neighbourhood: the ends of the tracker's walks. */
#ifndef MOTE_CORE_PAIRS_H
#define MOTE_CORE_PAIRS_H

#include "core/body/mesh.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MOTE_PAIRS_MAX 64

typedef struct mote_pair {
    double squared;                 /* their squared distance when last looked up */
    double longest_edge_squared[2]; /* at each vertex */
    double travelled;               /* the tracker's value when last looked up */
    uint32_t vertex[2];
    mote_vec3 shape[2]; /* their positions on their bodies */
    bool refined;       /* an exact check has ended here */
} mote_pair;

typedef struct mote_pairs {
    mote_pair list[MOTE_PAIRS_MAX];
    uint32_t count;
    const mote_mesh *mesh[2]; /* of the vertices, borrowed */
} mote_pairs;

/* Inserts a candidate by its distance, unless another one within a ring of it on both meshes is
   nearer or refined. Removes those within a ring that are neither, and the last of a full
   list. */
void mote_pairs_keep(mote_pairs *candidates, const mote_pair *candidate);

/* By how much the distance of the surfaces there may be below that of the vertices: the longest
   edges of both together. */
static inline double mote_pair_edges(const mote_pair *c)
{
    return sqrt(c->longest_edge_squared[0]) + sqrt(c->longest_edge_squared[1]);
}

#ifdef __cplusplus
}
#endif
#endif
