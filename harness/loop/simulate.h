/* The closed loop (paper section 4): rigid bodies whose surfaces deform as a scenario
   prescribes move freely, and where a method says that two of them touch, those collide. An
   exact method runs beside it and shows which contacts it misses. The same code simulates
   two bodies and many; many are also reflected at the walls of their box. */
#ifndef MOTE_HARNESS_SIMULATE_H
#define MOTE_HARNESS_SIMULATE_H

#include "harness/loop/simulator.h"

/* Simulates. trace: NULL, or [steps + 1][bodies], receives the states of each frame. Of several
   contacts at a step each is answered in the order of the bodies. A body turns back where its
   centre of mass leaves the room that the scenario gives to middles; walls do not turn it.
   MOTE_EINVAL when bodies are in contact at the start (there is no normal then),
   MOTE_EUNSUPPORTED when the method answers without distance or contact, or reports a contact
   of bodies that it has never given witness points of. The method starts anew each time. */
mote_status mote_simulator_run(mote_simulator *simulator, const mote_simulation_start *start,
                               mote_rigid_state *trace, mote_simulation_result *result);

#endif
