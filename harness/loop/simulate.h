/* The closed loop (paper section 4): rigid bodies whose surfaces deform as a scenario
   prescribes move freely, and collide when a method reports a contact. An exact method runs
   beside it and shows which contacts it misses. The same code simulates two bodies and many;
   many are also reflected at the walls of their box. */
#ifndef MOTE_HARNESS_SIMULATE_H
#define MOTE_HARNESS_SIMULATE_H

#include "harness/loop/simulator.h"

/* Simulates. trace: NULL, or [steps + 1][bodies], receives the states of each frame. Several
   contacts in a step are resolved in the order of the bodies. A body is reflected if its centre
   of mass leaves the scenario's room for middles; walls do not change its spin. MOTE_EINVAL if
   bodies are in contact at the start (there is no normal then), MOTE_EUNSUPPORTED if the method
   gives neither distance nor contact, or reports a contact of bodies for which it has never
   given witness points; with sampled steps such bodies go on as they are. The method restarts
   with each call. */
mote_status mote_simulator_run(mote_simulator *simulator, const mote_simulation_start *start,
                               mote_rigid_state *trace, mote_simulation_result *result);

#endif
