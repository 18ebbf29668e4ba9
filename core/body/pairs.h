/* A short list of pairs of vertices, one of each body, nearest first, no two of them in the
   same neighbourhood: where the tracker's walks have ended. */
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
    double squared;          /* of their distance, when last looked at */
    double reach_squared[2]; /* of the longest edge at each */
    double travelled;        /* the tracker's, when last looked at */
    uint32_t vertex[2];
    mote_vec3 shape[2]; /* where they are on their bodies */
    bool refined;       /* an exact check has ended here */
} mote_pair;

typedef struct mote_pairs {
    mote_pair list[MOTE_PAIRS_MAX];
    uint32_t count;
    const mote_mesh *mesh[2]; /* of the vertices, borrowed */
} mote_pairs;

/* Puts a candidate in its place by distance, unless one within a ring of it on both meshes is
   nearer or refined; drops those within a ring that are not, and the last one when the list is
   full. */
void mote_pairs_keep(mote_pairs *candidates, const mote_pair *candidate);

/* What the distance of the surfaces there may be less than that of the vertices: the longest
   edges of both. */
static inline double mote_pair_reach(const mote_pair *c)
{
    return sqrt(c->reach_squared[0]) + sqrt(c->reach_squared[1]);
}

#ifdef __cplusplus
}
#endif
#endif
