/* A simulation as a scenario file, so that every method can be run over the same frames. */
#ifndef MOTE_HARNESS_TRACE_H
#define MOTE_HARNESS_TRACE_H

#include "harness/loop/simulator.h"

/* Writes the scenario with the motion of states[count][bodies], count >= 2, instead of its own,
   and with the tolerance of the simulation. MOTE_EIO.

   Two bodies: a key pose for each state; deformation starts with frame 1. Positions are
   reproduced to about 1e-16 L. Names of meshes and the active interval are adapted to the new
   file (harness/run/scenario_save.h). MOTE_EINVAL if a body deforms at a rate other than one
   frame per step, or beyond the last frame: a scenario cannot express that.

   Many: the poses, with the deformation of each body, are in a CSV beside the scenario
   (harness/scene/bodies_poses.h). MOTE_EINVAL if path is a stream, which cannot have a file
   beside it. */
mote_status mote_trace_write(const mote_subject *subject, const mote_mass *masses,
                             const mote_rigid_state *states, uint32_t count,
                             const mote_simulation_options *options, const char *path);

#endif
