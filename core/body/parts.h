/* How many convex parts a mesh has, and which vertex belongs to which: the number of particles
   follows from it (paper 3.5), and convex methods work on the parts. */
#ifndef MOTE_CORE_PARTS_H
#define MOTE_CORE_PARTS_H

#include "core/body/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* The mesh is first simplified to at most this many triangles, since HACD's time grows faster
   than the square of their number (letters: 0.3 s at 800, 5 s at 1,380). */
#define MOTE_PARTS_TRIANGLES 800

typedef struct mote_parts {
    uint32_t count;        /* convex parts, >= 1 and at least one a connected component */
    uint32_t vertex_count; /* of the mesh */
    uint32_t *label;       /* [vertex_count], the part of each vertex, 0 .. count - 1 */
} mote_parts;

/* Decomposes a mesh into approximately convex parts with HACD (Mamou 2009; concavity 100 of a
   size of 1,000) on a simplification by meshoptimizer; the labels of the vertices that it keeps
   spread along the edges to the nearest others. Components are decomposed one by one, each with
   its share of the triangles, 100 at least; one that is the whole surface of a convex solid is
   one part without HACD. positions are [vertex_count] and finite; NULL
   means the mesh's rest positions. Each part has at least one vertex. Deterministic. Cost:
   HACD's, about a second as a rule (a cylinder of 1,024 triangles that is open along a side
   took 30), and O(v log v). MOTE_EINVAL: a position that is not finite. MOTE_ENOMEM.
   MOTE_ENUMERIC: HACD failed. The caller destroys *parts. */
mote_status mote_parts_create(const mote_mesh *mesh, const mote_vec3 *positions,
                              mote_parts **parts);

/* NULL is allowed. */
void mote_parts_destroy(mote_parts *parts);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
