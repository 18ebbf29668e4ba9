/* A coarse-to-fine graph over the vertices of a mesh: each level is a maximal independent set
   of the one below, about a quarter of it, and its nodes are neighbours where their cells (the
   vertices nearest to each) touch. Walking it finds the way over the mesh in steps that are
   long first and short last. Immutable once made. */
#ifndef MOTE_CORE_LEVELS_H
#define MOTE_CORE_LEVELS_H

#include "core/body/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MOTE_LEVELS_MAX 24

/* Levels are made while there are more nodes than this. */
#define MOTE_LEVELS_COARSEST 48

/* The neighbours of node i are neighbour[start[i]] .. neighbour[start[i + 1] - 1]: each once,
   none being i, symmetric; connected where the mesh is connected. */
typedef struct mote_level {
    uint32_t count;
    uint32_t *start;     /* [count + 1] */
    uint32_t *neighbour; /* [start[count]] */
    double spacing;      /* mean distance of neighbours at rest, in the mesh's unit; L where no
                            node has any */
} mote_level;

/* Node i of a level is node i of every finer one; the finest level has index 0. */
typedef struct mote_levels {
    uint32_t depth;                    /* levels, >= 1 */
    mote_level level[MOTE_LEVELS_MAX]; /* counts shrink */
    uint32_t *vertex;                  /* [level[0].count], the mesh vertex of each node */
} mote_levels;

/* Makes the levels of a mesh, at least one; every connected component of the mesh has a node on
   every level. The same on every machine. About 11 bytes a vertex; cost O(v). The caller
   destroys *levels. */
mote_status mote_levels_create(const mote_mesh *mesh, mote_levels **levels);

/* NULL is allowed. */
void mote_levels_destroy(mote_levels *levels);

/* Heap held, in bytes. */
size_t mote_levels_bytes(const mote_levels *levels);

/* Chooses count different nodes of a level, the first at random from seed: with farthest, each
   the farthest (at rest) from those before, else at random. Each component gets its first node
   before any gets a second. count is 1 .. the level's count. Cost O(count * level's count) with
   farthest; the first nodes of all components together cost O(level's count). */
mote_status mote_levels_spread(const mote_levels *levels, const mote_mesh *mesh, uint32_t level,
                               uint32_t count, bool farthest, uint64_t seed, uint32_t *nodes);

/* For every vertex of the mesh the node of a level that is the fewest edges away. The caller
   frees *home, [vertex_count]. Cost O(v). */
mote_status mote_levels_home(const mote_levels *levels, const mote_mesh *mesh, uint32_t level,
                             uint32_t **home);

#ifdef __cplusplus
}
#endif
#endif
