/* The motion of a simulation's bodies between two moments as paths (core/body/path.h), for
   steps of several frames. A path is planned from the states and weights at its beginning, in
   pieces of at most a frame: centres fall freely, rotations follow the rigid motion's steps,
   and weights pass through those that the scenario has at the ends of the pieces. Private to
   harness/loop. */
#ifndef MOTE_HARNESS_FLIGHT_H
#define MOTE_HARNESS_FLIGHT_H

#include "core/body/path.h"
#include "harness/loop/simulator_state.h"

typedef struct mote_flight mote_flight;

/* For flights of up to `longest` frames. The simulator is borrowed. */
mote_flight *mote_flight_create(const mote_simulator *simulator, double longest);
void mote_flight_destroy(mote_flight *flight); /* NULL is allowed */

/* The weights are those of the beginning of the simulation again. */
void mote_flight_restart(mote_flight *flight);

/* The most pieces that a flight has. */
uint32_t mote_flight_pieces_max(const mote_flight *flight);

/* Plans a flight from the states, `now` frames after the beginning, for `duration` frames.
   Errors of mote_rigid_step. */
mote_status mote_flight_plan(mote_flight *flight, const mote_rigid_state *states, double now,
                             double duration);

/* The paths of all bodies over the flight, valid until the next plan. */
const mote_path *mote_flight_paths(const mote_flight *flight);

/* The first end of a piece, as a part of the flight, at which a centre of mass is outside of
   the room and leaves it; 1 if there is none. */
double mote_flight_wall(const mote_flight *flight);

/* The bodies at a part of the flight, 0 .. 1, valid until the next call. */
const mote_body_state *mote_flight_show(mote_flight *flight, double part);

/* Of two bodies: the most by which they can have approached between the last two shown. */
double mote_flight_moved(const mote_flight *flight);

/* Ends the flight at a part of it: sets the states, and keeps the weights for the next. */
void mote_flight_end(mote_flight *flight, double part, mote_rigid_state *states);

#endif
