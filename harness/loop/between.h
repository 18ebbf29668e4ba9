/* Steps of several frames in which bodies follow a path: the truth is looked at between their
   ends, and with MOTE_STEPS_CONTINUOUS impacts are found and answered there. Private to
   harness/loop.

   A continuous step flies to the earliest impact (core/impact/impact_scene.h), changes the
   motion of the two bodies there, and plans the rest of the step anew. From then on the pair is
   asked for half of the distance that it has, until it is farther apart than the tolerance
   again: so each flight begins with a proof. If it comes to an impact again within the floor
   (MOTE_SIMULATION_FLOOR), it is also pushed apart. A pair for which even this leaves no
   distance to prove, or which has more impacts in a step than the floor allows, is left out
   for a floor's time, and counted as unproven. */
#ifndef MOTE_HARNESS_BETWEEN_H
#define MOTE_HARNESS_BETWEEN_H

#include "harness/loop/simulate_state.h"

typedef struct mote_between mote_between;

/* For the simulator's bodies; it is borrowed. *between is NULL if its steps are whole. Errors
   of mote_impact_scene_create. */
mote_status mote_between_create(const mote_simulator *simulator, mote_between **between);
void mote_between_destroy(mote_between *between); /* NULL is allowed */

/* Starts a simulation. */
void mote_between_restart(mote_between *between);

/* Looks at the bodies at the beginning of step k. What is said is what the method answers, or,
   with continuous steps, which pairs have just been answered. */
mote_status mote_between_begin(mote_between *between, mote_simulation *s, uint32_t k);

/* Advances the states from the beginning of step k to its end; looks within. */
mote_status mote_between_fly(mote_between *between, mote_simulation *s, uint32_t k);

#endif
