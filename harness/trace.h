/* A simulated run as a scenario file, so that every method can be asked of the same frames. */
#ifndef MOTE_HARNESS_TRACE_H
#define MOTE_HARNESS_TRACE_H

#include "harness/simulate.h"

/* Writes the scenario with a key pose for each of states[count], count >= 2, in place of its
   motion and this contact tolerance, of L; deformation starts with frame 1. Positions come back
   to some 1e-16 L. MOTE_EIO, MOTE_EINVAL for a scenario that is no file (a pair), as its motion
   is found when loaded. */
mote_status mote_trace_write(const mote_scenario *scenario, const mote_mass mass[2],
                             const mote_rigid_state (*states)[2], uint32_t count,
                             double tolerance, const char *path);

#endif
