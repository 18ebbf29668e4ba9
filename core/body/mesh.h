/* A rest-pose triangle mesh with ordered one-rings (paper 3.1: adjacency is known and does not
   change). Immutable once made; shared by all methods and threads. */
#ifndef MOTE_CORE_MESH_H
#define MOTE_CORE_MESH_H

#include "core/base/status.h"
#include "core/base/vec3.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Set on a ring entry that no triangle joins to the next entry (the end of an open fan). */
#define MOTE_RING_END 0x80000000u
#define MOTE_RING_VERTEX(entry) ((entry) & ~MOTE_RING_END)

/* L of a mesh is in this range, in which squares of distances from L down to what rounding
   leaves of them are normal numbers. */
#define MOTE_LENGTH_MIN 1e-130
#define MOTE_LENGTH_MAX 1e130

/* There are fewer than 2^31 vertices. The ring of vertex v is the entries ring[ring_start[v]]
   .. ring[ring_start[v + 1] - 1], each neighbour of v once per fan, in order around v. Two
   consecutive entries k, k + 1 and v form a triangle unless entry k has MOTE_RING_END; the last
   entry is followed by the first when the vertex has one closed fan (no entry has MOTE_RING_END
   then). At a boundary each fan ends with MOTE_RING_END; a closed fan at a vertex with several
   fans repeats its first neighbour at its end. */
typedef struct mote_mesh {
    uint32_t vertex_count;
    uint32_t triangle_count;
    mote_vec3 *positions;     /* [vertex_count], rest pose, the input's unit of length */
    uint32_t (*triangles)[3]; /* [triangle_count], three different vertices each */
    uint32_t *ring_start;     /* [vertex_count + 1] */
    uint32_t *ring;           /* [ring_start[vertex_count]] */
    uint32_t *component; /* [vertex_count], connected component, 0 .. component_count - 1 */
    uint32_t component_count;
    uint32_t edge_count;
    uint32_t open_edge_count; /* edges with one triangle; 0 when the surface is closed */
    mote_vec3 low, high;      /* bounding box at rest */
    double diagonal;          /* L: length of the box's diagonal */
    double mean_edge;         /* mean length of an edge at rest */
} mote_mesh;

/* Makes a mesh from xyz (3 * vertex_count doubles) and indices (3 * triangle_count), both
   copied. MOTE_EINVAL, with a text that names the vertex, face or edge: no triangle, 2^31
   vertices or 2^31 / 3 triangles or more, a coordinate that is not finite, an index out of
   range, a face with two equal indices, an edge with more than two faces, a vertex in no face,
   no extent (L = 0), an L below MOTE_LENGTH_MIN or above MOTE_LENGTH_MAX. MOTE_ENOMEM. Faces of
   zero area are allowed, and so are faces wound differently. Cost O(v + t). The caller destroys
   *mesh. */
mote_status mote_mesh_create(const double *xyz, size_t vertex_count, const uint32_t *indices,
                             size_t triangle_count, mote_mesh **mesh);

/* Frees a mesh; NULL is allowed. */
void mote_mesh_destroy(mote_mesh *mesh);

/* Bytes of heap that the mesh holds. */
size_t mote_mesh_bytes(const mote_mesh *mesh);

/* The Euler characteristic, vertices - edges + faces: 2 for each closed component without
   handles. O(1). */
int64_t mote_mesh_euler(const mote_mesh *mesh);

/* The smallest angle of any triangle at rest, in degrees; 0 where a face is degenerate.
   O(t). */
double mote_mesh_smallest_angle(const mote_mesh *mesh);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
