/* How many convex parts a mesh has, and which vertex belongs to which: the number of particles
   follows from it (paper 3.5), and convex methods work on the parts. */
#ifndef MOTE_CORE_PARTS_H
#define MOTE_CORE_PARTS_H

#include "core/body/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* The mesh is first simplified to about this many triangles, since HACD's time grows faster
   than the square of their number (letters: 0.3 s at 800, 5 s at 1,380). Where the shape does
   not allow so few, up to twice as many are taken. */
#define MOTE_PARTS_TRIANGLES 800

/* The processor time that HACD has for a mesh: fifteen times what it takes for letters, but
   minutes are possible (an open flat grid, simplified to 800 triangles: 100 s). */
#define MOTE_PARTS_SECONDS 10

typedef struct mote_parts {
    uint32_t count;        /* convex parts, >= 1 and at least one a connected component */
    uint32_t vertex_count; /* of the mesh */
    uint32_t *label;       /* [vertex_count], the part of each vertex, 0 .. count - 1 */
    uint32_t without_hacd; /* components that HACD crashed on, or did not finish in time */
} mote_parts;

/* Decomposes a mesh into approximately convex parts with HACD (Mamou 2009; concavity 100 of a
   size of 1,000) on a simplification by meshoptimizer; the labels of the vertices that it keeps
   spread along the edges to the nearest others. Components are decomposed one by one, each with
   its share of the triangles, 100 at least; one that is the whole surface of a convex solid, or
   a flat sheet with a convex outline, is one part without HACD.

   HACD 3.24 frees memory twice on some meshes with faces of hardly any area, and takes minutes
   for others. So it runs in a child process (fork), whose crash or delay does no harm: what it
   does not answer within MOTE_PARTS_SECONDS is split by our own means, by the planes of the
   faces, and counted in without_hacd. Callers with threads, or children of their own, notice
   nothing but a SIGCHLD; one that waits for any child may be told of ours, and what was left
   is then split by planes. Where SIGCHLD is ignored, a crash counts as a delay.

   positions are [vertex_count] and finite; NULL means the mesh's rest positions. Each part has
   at least one vertex. Deterministic, but for a mesh on which HACD crashes or needs about the
   time that it has: whether a crash comes depends on the heap. Cost: HACD's, about half a
   second as a rule, MOTE_PARTS_SECONDS at most (of the clock, ten times that on a machine that
   is busy), and O(v log v). MOTE_EINVAL: a position that is not finite. MOTE_ENOMEM: no memory,
   or no process. The caller destroys *parts. */
mote_status mote_parts_create(const mote_mesh *mesh, const mote_vec3 *positions,
                              mote_parts **parts);

/* NULL is allowed. */
void mote_parts_destroy(mote_parts *parts);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
