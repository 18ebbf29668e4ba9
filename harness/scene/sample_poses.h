/* Sample poses of a scenario's bodies: build=samples splits trees by them (mote_body). */
#ifndef MOTE_HARNESS_SAMPLE_POSES_H
#define MOTE_HARNESS_SAMPLE_POSES_H

#include "harness/scene/scenario.h"

/* The number of frames whose weights are sampled, evenly over the scenario. */
#define MOTE_SAMPLE_FRAMES 8

typedef struct mote_sample_poses mote_sample_poses;

/* Cost: eight frames. Errors of mote_scenario_frame. mote_sample_poses_destroy allows NULL. */
mote_status mote_sample_poses_create(const mote_scenario *scenario, mote_sample_poses **poses);
void mote_sample_poses_destroy(mote_sample_poses *poses);

/* The scenario's bodies with these samples, which are borrowed. A body with its own samples
   keeps them; a body that does not deform gets none. */
void mote_sample_poses_bodies(const mote_sample_poses *poses, const mote_scenario *scenario,
                              mote_body body[2]);

#endif
