/* Finds a motion with given gaps, for authors of scenarios and for pairs of meshes that have
   no motion. */
#ifndef MOTE_HARNESS_APPROACH_H
#define MOTE_HARNESS_APPROACH_H

#include "harness/scene/scenario.h"

typedef struct mote_approach_plan {
    mote_vec3 direction;    /* along which body 1 comes to body 0; any length > 0 */
    const uint32_t *frames; /* [count], within the scenario */
    const double *gaps;     /* [count], of L: the distance wished at each frame; below 0, how
                               far body 1 is pushed on from first contact, along direction */
    uint32_t count;
    const uint32_t *tips; /* [2]: a vertex of each body, which are brought onto one line along
                             direction, so that the bodies cannot pass each other; or NULL: the
                             middles of their boxes are */
    bool must_touch;      /* where the gap is below 0, body 1 is pushed on by less, down to
                             nothing, until the surfaces cross: thin bodies pass through each
                             other otherwise */
} mote_approach_plan;

/* For each frame of the plan, brings body 1 from far away along direction and stops at the
   first place with the wished distance (to 1e-4 of the smaller body's L), measured by
   `certified`. Rotations, deformations and the place of body 0 are the scenario's. Writes
   where the centre of body 1 is then: positions[count], absolute. Some twenty queries a
   frame. MOTE_EINVAL with frame and reason where the bodies pass without coming so close,
   slide along each other at hardly more than that distance, so that the first place is not
   found in 2,000 queries, or do not cross although they must touch. */
mote_status mote_approach_solve(const mote_scenario *scenario, const mote_approach_plan *plan,
                                mote_vec3 *positions);

/* Checks with fcl-aabb that a scenario has the wished gaps at these frames, to 1e-3 L; a gap
   of -1e-3 or less must be a contact. MOTE_ENUMERIC names the first frame where it does not. */
mote_status mote_approach_verify(const mote_scenario *scenario, const uint32_t *frames,
                                 const double *gaps, uint32_t count);

#endif
