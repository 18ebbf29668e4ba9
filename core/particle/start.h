/* The initial places of particles (paper 3.3: "random distribution works well enough"). */
#ifndef MOTE_CORE_START_H
#define MOTE_CORE_START_H

#include "core/body/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum mote_start {
    MOTE_START_RANDOM,  /* uniform over vertices (paper 3.3) */
    MOTE_START_FARTHEST /* each the farthest vertex from those before, at rest */
} mote_start;

/* Chooses count different vertices, at least one on every connected component, the same for the
   same seed. MOTE_EINVAL when count is 0 or above the vertex count, MOTE_EUNSUPPORTED when it
   is below the number of components. Cost O(v) for random, O(count * v) for farthest points. */
mote_status mote_start_vertices(const mote_mesh *mesh, uint32_t count, mote_start start,
                                uint64_t seed, uint32_t *vertices);

#ifdef __cplusplus
}
#endif
#endif
