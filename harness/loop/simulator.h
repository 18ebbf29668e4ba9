/* The bodies of a simulation with their masses, and the methods that answer for them. */
#ifndef MOTE_HARNESS_SIMULATOR_H
#define MOTE_HARNESS_SIMULATOR_H

#include "harness/loop/simulator_state.h"

/* Makes the masses of the scenario's bodies, the method, and the exact method beside it:
   certified, or aabb-tree if certified itself is tested. MOTE_EINVAL for an open mesh, which
   has no volume, and for options out of range; for many bodies also for a tolerance above
   `near`. Everything but the options is borrowed. */
mote_status mote_simulator_create(const mote_subject *subject, const mote_method_choice *choice,
                                  const mote_simulation_options *options,
                                  mote_simulator **simulator);
void mote_simulator_destroy(mote_simulator *simulator); /* NULL is allowed */

mote_simulated mote_simulator_bodies(const mote_simulator *simulator);

/* The masses of the shapes; of two bodies, those of each body. */
const mote_mass *mote_simulator_masses(const mote_simulator *simulator);

/* The scenario's own start: poses of frame 1, its velocities or those that lead from frame 1 to
   frame 2; steps until the last frame, at most MOTE_SIMULATION_STEPS_MAX. Its states live as
   long as the simulator. */
mote_simulation_start mote_simulation_start_of(const mote_simulator *simulator);

#endif
