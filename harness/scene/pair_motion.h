/* Makes the motion of body 1 for a pair of meshes without a motion. */
#ifndef MOTE_HARNESS_PAIR_MOTION_H
#define MOTE_HARNESS_PAIR_MOTION_H

#include "harness/scene/scenario.h"

/* Places body 1's centre (absolute) in each frame: positions[scenario->frames], of 1,000
   frames. The bodies touch for the first time between frames 100 and 200, touch in 10 to 20 %
   of the frames in all, and are apart in the last. Body 0, the rotations and the deformations
   are the scenario's. Body 1 comes along direction; if that is 0, along the first of seven
   directions in which the bodies meet in every frame, first centre to centre, then vertex to
   vertex. MOTE_EINVAL with the reason if none works. About twenty queries per frame and
   direction. */
mote_status mote_pair_motion_find(const mote_scenario *scenario, mote_vec3 direction,
                                  mote_vec3 *positions);

#endif
