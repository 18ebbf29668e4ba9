/* Sample poses of a scenario's bodies: what build=samples splits trees by (mote_body). */
#ifndef MOTE_HARNESS_SAMPLE_POSES_H
#define MOTE_HARNESS_SAMPLE_POSES_H

#include "harness/scene/scenario.h"

/* Frames whose weights are kept, evenly over the scenario. */
#define MOTE_SAMPLE_FRAMES 8

typedef struct mote_sample_poses mote_sample_poses;

/* Cost: eight frames. Destroy it; NULL is allowed there. */
mote_sample_poses *mote_sample_poses_create(const mote_scenario *scenario);
void mote_sample_poses_destroy(mote_sample_poses *poses);

/* The scenario's bodies with these samples, which are borrowed. A body that has samples of its
   own keeps them, and one that does not deform gets none. */
void mote_sample_poses_bodies(const mote_sample_poses *poses, const mote_scenario *scenario,
                              mote_body body[2]);

#endif
