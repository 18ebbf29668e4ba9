/* Known defects of Coal 3.0 (datasets/defects.md). Used by tests only. */
#ifndef MOTE_TESTS_COAL_DEFECTS_H
#define MOTE_TESTS_COAL_DEFECTS_H

#include "core/body/mesh.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum coal_volume { COAL_AABB, COAL_OBB, COAL_RSS, COAL_OBBRSS, COAL_KIOS } coal_volume;

/* How far a cube of half side 1, turned by `degrees` about (1, -1, 0), sticks out of its sum
   with a cube 1 above it along z. Should be 0. */
double mote_coal_sum_outside(double degrees);

/* How far a corner of three small triangles sticks out of the swept rectangle that is fitted to
   them. Should be 0. */
double mote_coal_fit_outside(void);

/* Volumes of a tree that do not contain their triangles: `failing` of `volumes` by more than
   1e-9 of the mesh's diagonal, the worst by `worst` of it. */
typedef struct coal_refit {
    long failing, volumes;
    double worst;
} coal_refit;

/* Builds a tree over a mesh at rest, refits it to `poses` poses of
   vertices[poses][vertex_count], and counts. */
coal_refit mote_coal_refit(coal_volume volume, bool bottom_up, const mote_mesh *mesh,
                           const mote_vec3 *vertices, int poses);

/* The squared distance that AABB::overlap reports for two unit cubes, the first 1 apart along x
   and, in the opposite direction, 2 along y. Should be 5. */
double mote_coal_aabb_bound(void);

#ifdef __cplusplus
}
#endif
#endif
