/* Finds a motion with given gaps, for authors of scenarios and for pairs of meshes without a
   motion. */
#ifndef MOTE_HARNESS_APPROACH_H
#define MOTE_HARNESS_APPROACH_H

#include "harness/scene/scenario.h"

typedef struct mote_approach_plan {
    mote_vec3 direction;    /* of body 1's approach to body 0; any length > 0 */
    const uint32_t *frames; /* [count], within the scenario */
    const double *gaps;     /* [count], in L: the distance requested at each frame; negative:
                               how far body 1 is pushed on from first contact, along
                               direction */
    uint32_t count;
    const uint32_t *tips; /* [2]: a vertex of each body; both are aligned along direction, so
                             that the bodies cannot miss each other. NULL: the middles of their
                             boxes are aligned */
    bool must_touch;      /* if a gap is negative, body 1 is pushed less, down to nothing, until
                             the surfaces cross: thin bodies would pass through each other
                             otherwise */
} mote_approach_plan;

/* For each frame of the plan, brings body 1 from far away along direction and stops at the
   first place with the requested distance (to 1e-4 of the smaller body's L), measured by
   `certified`. Rotations, deformations and the position of body 0 are the scenario's. Writes
   the resulting centres of body 1: positions[count], absolute. About twenty queries per frame.
   MOTE_EINVAL with frame and reason if the bodies pass without coming that close, if they slide
   along each other at hardly more than that distance and 2,000 queries do not find the first
   place, or if they must touch but do not cross. MOTE_EUNSUPPORTED: of a body positions are
   given. */
mote_status mote_approach_solve(const mote_scenario *scenario, const mote_approach_plan *plan,
                                mote_vec3 *positions);

/* Checks with fcl-aabb that a scenario has the requested gaps at these frames, to 1e-3 L; a gap
   of -1e-3 or less must be a contact. MOTE_ENUMERIC names the first frame that fails. */
mote_status mote_approach_verify(const mote_scenario *scenario, const uint32_t *frames,
                                 const double *gaps, uint32_t count);

#endif
