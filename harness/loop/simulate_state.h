/* The state that a simulation keeps from step to step, and what its parts share. Private to
   harness/loop. */
#ifndef MOTE_HARNESS_SIMULATE_STATE_H
#define MOTE_HARNESS_SIMULATE_STATE_H

#include "harness/loop/contact_runs.h"
#include "harness/loop/drift.h"
#include "harness/loop/simulator_state.h"

/* The last witnesses of a near pair while it was apart. */
typedef struct mote_simulation_gap {
    uint32_t body[2];
    bool known;
    mote_vec3 witness[2];
} mote_simulation_gap;

typedef struct mote_simulation {
    mote_simulator *simulator;
    const mote_simulation_start *start;
    mote_rigid_state *states;
    const mote_body_state *shown;
    mote_stage_pairs said, truth;
    double lower;                          /* of the distance between two bodies, proven */
    mote_simulation_gap *gaps, *next_gaps; /* of the near pairs, in pair order */
    size_t gap_count, gap_capacity, next_capacity;
    mote_contact_runs runs;
    uint32_t looks; /* at which contacts were compared with the truth */
    mote_drift_lost lost;
    mote_drift drift;
    mote_simulation_result result;
} mote_simulation;

/* Compares what is said with the truth for the bodies as shown; they are watched as those of
   `step` unless it is UINT32_MAX. */
mote_status mote_simulation_look(mote_simulation *s, uint32_t step);

/* Lets the bodies that have left the room through a wall turn around. */
void mote_simulation_bounce(mote_simulation *s);

#endif
