/* Finds a motion with a wished gap: for an author of scenarios, and for pairs of meshes that
   come without one. */
#ifndef MOTE_HARNESS_APPROACH_H
#define MOTE_HARNESS_APPROACH_H

#include "harness/scene/scenario.h"

typedef struct mote_approach_plan {
    mote_vec3 direction;    /* along which body 1 comes to body 0; any length > 0 */
    const uint32_t *frames; /* [count], within the scenario */
    const double *gaps;     /* [count], of L: the distance wished at each frame; below 0, how
                               far body 1 is pushed on from first contact, along direction */
    uint32_t count;
} mote_approach_plan;

/* For each frame of the plan, comes from far away along direction and stops at the first place
   with the wished distance (to 1e-4 L), by exact distances of fcl-aabb; rotations and
   deformations are the scenario's, as is body 0's place. Writes where body 1's centre is then:
   positions[count], absolute. Some twenty queries a frame. MOTE_EINVAL with frame and reason
   where the bodies pass without coming so close, or slide along each other at hardly more than
   that distance, so that the first place is not found in 2,000 queries. */
mote_status mote_approach_solve(const mote_scenario *scenario, const mote_approach_plan *plan,
                                mote_vec3 *positions);

#endif
