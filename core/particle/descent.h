/* Walking a pair of vertices, one on each body, to where neither can come nearer to the other:
   on one level of the graph, or coarse to fine down to the mesh. */
#ifndef MOTE_CORE_DESCENT_H
#define MOTE_CORE_DESCENT_H

#include "core/body/lazy.h"
#include "core/particle/levels.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The level below the finest one: the vertices of the mesh. */
#define MOTE_MESH_LEVEL (-1)

/* One body in a frame. The next step of a walk is chosen in the rest shape, into which the
   target is moved back by the rigid motion of the current vertex; it is taken if the positions
   of the frame confirm that it comes nearer. So a walk evaluates about one position a step
   instead of one a neighbour. The whole ring is evaluated only where a walk on the mesh ends.
 */
typedef struct mote_ground {
    mote_lazy *lazy;
    const mote_levels *levels;
    const mote_vec3 *shape;    /* [vertex_count], at rest, or the frame's when all are given */
    const mote_mat3 *rotation; /* of the body; NULL when shape is the frame's */
} mote_ground;

/* Where a walk is on one body. */
typedef struct mote_walker {
    uint32_t node; /* on the level walked; on MOTE_MESH_LEVEL the vertex */
    uint32_t vertex;
    mote_vec3 world;
} mote_walker;

/* A body whose lazy positions have begun a frame. levels may be NULL when only MOTE_MESH_LEVEL
   is walked. */
mote_ground mote_ground_of(mote_lazy *lazy, const mote_levels *levels);

/* The place of a node of a level, or of a vertex of the mesh. */
mote_walker mote_walker_at(const mote_ground *ground, int level, uint32_t node);

/* Walks both places in turn, each to neighbours nearer to the other, until neither has one (on
   levels of the graph as far as shape tells). level: of each body's walk. Returns the squared
   distance; *moves grows by the moves made. Ends, since each move comes nearer. */
double mote_walk(const mote_ground ground[2], const int level[2], mote_walker at[2],
                 uint64_t *moves);

/* Moves both places once on the levels given and on each finer one, then walks on the mesh; a
   place that is given on the mesh waits there for the other one.
   Gives up and returns HUGE_VAL on a level from which it is unlikely to come nearer than
   `worth` (may be infinite: never gives up), and on the mesh where both places are within two
   edges of the vertices known[2] of a minimum (NULL: none), since most descents end at the
   nearest one. *least: an estimate of the distance that it could still have reached. */
double mote_descend(const mote_ground ground[2], const int level[2], mote_walker at[2],
                    double worth, const uint32_t *known, double *least, uint64_t *moves);

#ifdef __cplusplus
}
#endif
#endif
