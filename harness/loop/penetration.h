/* How deeply two closed, deformed surfaces penetrate each other. */
#ifndef MOTE_HARNESS_PENETRATION_H
#define MOTE_HARNESS_PENETRATION_H

#include "core/body/mesh.h"

typedef struct mote_penetration mote_penetration;

/* For two closed meshes (borrowed); MOTE_EINVAL for an open one. */
mote_status mote_penetration_create(const mote_mesh *a, const mote_mesh *b,
                                    mote_penetration **penetration);
void mote_penetration_destroy(mote_penetration *penetration); /* NULL is allowed */

/* Depth of the deepest vertex of either body inside the other one: its distance from that
   body's surface; `above` (>= 0) if none is deeper, since vertices known to be no deeper cost
   less. world_a, world_b: the vertices of the bodies. A vertex is inside if the surface winds
   around it, determined by signed crossings of a ray. The side of each edge is decided once for
   both of its faces, so no ray slips between them; points within rounding of the surface may be
   classified either way. Cost O(vertices + triangles) plus a pass over the triangles for each
   vertex deeper than all before. */
double mote_penetration_depth(mote_penetration *penetration, const mote_vec3 *world_a,
                              const mote_vec3 *world_b, double above);

#endif
