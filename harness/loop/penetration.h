/* How deep two closed, deformed surfaces penetrate each other. */
#ifndef MOTE_HARNESS_PENETRATION_H
#define MOTE_HARNESS_PENETRATION_H

#include "core/body/mesh.h"

typedef struct mote_penetration mote_penetration;

/* For two closed meshes (borrowed); MOTE_EINVAL for an open one. */
mote_status mote_penetration_create(const mote_mesh *a, const mote_mesh *b,
                                    mote_penetration **penetration);
void mote_penetration_destroy(mote_penetration *penetration); /* NULL is allowed */

/* Depth of the deepest vertex of either body inside the other one: its distance from that one's
   surface; `above` (>= 0) where none is deeper than that: a vertex known to be no deeper
   costs less. world_a, world_b: the vertices of either body. A vertex is inside where the
   surface winds around it: signed crossings of a ray, each edge's side decided once for both of
   its faces, so that no ray slips between them; what lies within rounding of the surface may be
   taken for either. Cost O(vertices + triangles) plus a pass over the triangles for each vertex
   that is deeper than all before. */
double mote_penetration_depth(mote_penetration *penetration, const mote_vec3 *world_a,
                              const mote_vec3 *world_b, double above);

#endif
