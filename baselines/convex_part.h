/* The convex parts of a deforming mesh, with support points of their hulls. */
#ifndef MOTE_BASELINES_CONVEX_PART_H
#define MOTE_BASELINES_CONVEX_PART_H

#include "core/body/mesh.h"

/* A climb starts from the best of this many vertices spread over the part. */
#define MOTE_CONVEX_LANDMARKS 16

/* One part: the corners of its triangles, and which of them are neighbours. Indices into vertex
   are called local. */
typedef struct mote_convex_part {
    uint32_t count;
    uint32_t *vertex;     /* [count] of the mesh */
    uint32_t *ring_start; /* [count + 1] */
    uint32_t *ring;       /* [ring_start[count]] local neighbours */
    uint32_t landmark_count;
    uint32_t landmark[MOTE_CONVEX_LANDMARKS]; /* local, farthest points of the rest pose */
} mote_convex_part;

typedef struct mote_convex_parts {
    uint32_t count;
    mote_convex_part *part; /* [count] */
} mote_convex_parts;

/* Splits a mesh into its convex parts (core/parts/parts.h). A triangle belongs to the part that
   most of its vertices belong to, on a tie to that of the first; a vertex belongs to the parts
   of all its triangles, so that the hulls of the parts cover the surface. Errors as
   mote_parts_create. The caller destroys *parts. */
mote_status mote_convex_parts_create(const mote_mesh *mesh, mote_convex_parts **parts);

/* NULL is allowed. */
void mote_convex_parts_destroy(mote_convex_parts *parts);

/* The vertex of the mesh, among the part's, that is farthest along direction. positions are
   those of all vertices of the mesh. With scan, all of them are examined. Without, it climbs
   from neighbour to neighbour in O(sqrt count), and may end early where the part is not convex.
 */
uint32_t mote_convex_part_support(const mote_convex_part *part, const mote_vec3 *positions,
                                  mote_vec3 direction, bool scan);

/* The mean of the landmarks' positions. */
mote_vec3 mote_convex_part_centre(const mote_convex_part *part, const mote_vec3 *positions);

#endif
