/* Spreads points evenly over a mesh. */
#ifndef MOTE_HARNESS_SPREAD_H
#define MOTE_HARNESS_SPREAD_H

#include "core/body/mesh.h"

/* Picks count different vertices by the farthest-point rule: the first is the farthest from the
   middle of the bounding box, each further one the farthest from all before; the lowest index
   wins a tie. MOTE_EINVAL if there are fewer different positions. O(count * vertices). */
mote_status mote_spread(const mote_mesh *mesh, uint32_t count, mote_vec3 *points);

/* The same, but stops before the first point closer than `apart` to another: picks *count
   points, from one to `most`. */
mote_status mote_spread_apart(const mote_mesh *mesh, uint32_t most, double apart,
                              mote_vec3 *points, uint32_t *count);

/* The middle of the bounding box at rest. */
mote_vec3 mote_mesh_centre(const mote_mesh *mesh);

#endif
