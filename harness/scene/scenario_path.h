/* The path of a scenario's bodies between two frames, for the time of impact.

   Between two successive frames a body's centre, its rotation and its weights follow the cubic
   through both frames whose derivatives are those of the parabolas through each frame and its
   neighbours, as a scenario's own curves do between keys (Catmull and Rom). So a path needs
   nothing but the frames, is once continuously differentiable, and agrees with every frame. */
#ifndef MOTE_HARNESS_SCENARIO_PATH_H
#define MOTE_HARNESS_SCENARIO_PATH_H

#include "core/body/path.h"
#include "harness/scene/scenario.h"

typedef struct mote_scenario_path mote_scenario_path;

/* For paths of `step` >= 1 frames. MOTE_EUNSUPPORTED for a body of which positions are given or
   whose field is not linear in its weights. The caller destroys *path. */
mote_status mote_scenario_path_create(const mote_scenario *scenario, uint32_t step,
                                      mote_scenario_path **path);
void mote_scenario_path_destroy(mote_scenario_path *path); /* NULL is allowed */

/* Sets the paths of both bodies, of `step` pieces, from a frame (1 .. frames) on. Beyond the
   first and last frame a body stands where its curves end. */
void mote_scenario_path_set(mote_scenario_path *path, uint32_t frame);

/* The path of body i, valid until the next set. */
const mote_path *mote_scenario_path_of(const mote_scenario_path *path, int i);

/* Carries a fingerprint (mote_scenario_fingerprint) on over the control points of the bodies'
   paths between all frames: what comes before the first and after the last frame has a part in
   them. Errors of mote_scenario_path_create. */
mote_status mote_scenario_path_fingerprint(const mote_scenario *scenario,
                                           uint64_t *fingerprint);

#endif
