/* The closed loop (paper section 4): two rigid bodies whose surfaces deform as a scenario
   prescribes move freely, and where a method says that they touch, they collide. What the
   method lets pass is found by an exact method beside it. */
#ifndef MOTE_HARNESS_SIMULATE_H
#define MOTE_HARNESS_SIMULATE_H

#include "core/motion/response.h"
#include "harness/base/method_choice.h"
#include "harness/scene/probe.h"
#include "harness/scene/scenario.h"

/* Truth is not asked where a lower bound of the distance exceeds this part of L. */
#define MOTE_SIMULATION_NEAR 0.05

/* Frames a step, and steps, at most. */
#define MOTE_SIMULATION_STEP_MAX 1000.0
#define MOTE_SIMULATION_STEPS_MAX 1000000u

typedef struct mote_simulation_options {
    double density;     /* of both bodies, > 0 */
    double restitution; /* 0 .. 1 */
    double tolerance;   /* of L, above 0, at most MOTE_SIMULATION_NEAR: contact */
    mote_vec3 gravity;  /* L a frame squared; 0: none */
    double time_step;   /* frames that motion and deformation go on by in a step, > 0 */
} mote_simulation_options;

/* Density 1, restitution 1, no gravity, the scenario's tolerance or, when that is 0, 0.005, a
   frame a step. */
mote_simulation_options mote_default_simulation_options(const mote_scenario *scenario);

/* MOTE_EINVAL, saying what would be right, for options out of range. */
mote_status mote_simulation_options_check(const mote_simulation_options *options);

/* A step, before the bodies respond: for pictures. Borrowed for the call. */
typedef struct mote_simulation_view {
    uint32_t step;            /* from 0 */
    const mote_frame *frame;  /* where the bodies are; vertices are NULL */
    const mote_answer *said;  /* the method's answer */
    const mote_probe *method; /* asked just now: mote_probe_particles */
    bool contact;             /* the method says contact */
    bool truth;               /* the bodies are in contact */
} mote_simulation_view;

/* Sees every step; a status other than MOTE_OK ends the simulation with it. */
typedef mote_status (*mote_simulation_watch)(void *context, const mote_simulation_view *view);

/* Where a simulation begins and how long it lasts. */
typedef struct mote_simulation_start {
    mote_rigid_state state[2];
    uint32_t first; /* frame whose deformation is shown first (1 .. frames); after the last
                       frame the deformation runs backwards */
    uint32_t steps; /* of options.time_step, >= 1 */
    double apart;   /* end early when the bodies, moving apart, are so far apart for certain
                       (absolute); 0: never */
    uint64_t seed;  /* of the method */
    bool
        depth_unreported; /* measure depth only until a contact is reported: it takes longest */
    mote_simulation_watch watch; /* or NULL */
    void *context;               /* what watch is called with */
} mote_simulation_start;

typedef struct mote_simulation_result {
    uint32_t steps;         /* made */
    uint32_t contact_steps; /* truth is a contact */
    uint32_t missed_steps;  /* of them the method said none */
    uint32_t false_steps;   /* the method said contact, truth none */
    uint32_t truth_asked;   /* steps at which truth was asked; none was needed at the others */
    uint32_t responses;     /* impacts that changed the motion */
    uint32_t approaches;    /* maximal runs of steps at which truth is a contact */
    uint32_t passes;        /* of them the method never said contact: passes through */
    uint32_t deep_passes;   /* of them a vertex of one body was inside the other */
    uint32_t delay_sum, delay_max; /* steps from a run's begin to its first report */
    double depth_max;              /* of L: deepest vertex inside the other body */
    double depth_passes;           /* the same in passes only */
    double energy_drift;   /* largest change not due to impacts below restitution 1, relative */
    double momentum_drift; /* likewise, of the sum of m |V| */
    double angular_drift; /* of the angular momentum about the origin; MOTE_NONE with gravity */
    double query_ns; /* mean processor time a step of deforming, updating, asking the method */
} mote_simulation_result;

typedef struct mote_simulator mote_simulator;

/* Masses of the scenario's bodies, the method, and the exact method beside it: certified, or
   aabb-tree where certified is itself in question. MOTE_EINVAL for an open mesh, which has no
   volume, and for options out of range. Everything is borrowed. */
mote_status mote_simulator_create(const mote_scenario *scenario,
                                  const mote_method_choice *choice,
                                  const mote_simulation_options *options,
                                  mote_simulator **simulator);
void mote_simulator_destroy(mote_simulator *simulator); /* NULL is allowed */

/* The masses of the two bodies. */
const mote_mass *mote_simulator_masses(const mote_simulator *simulator);

/* The scenario's own start: poses of frame 1, the velocities that it names, or those that lead
   from frame 1 to frame 2; steps until the last frame, MOTE_SIMULATION_STEPS_MAX at most. */
mote_simulation_start mote_simulation_start_of(const mote_simulator *simulator);

/* Simulates. trace: NULL, or [steps + 1][2], receives the states of each frame. MOTE_EINVAL
   when the bodies are in contact at the start (there is no normal then), MOTE_EUNSUPPORTED when
   the method answers without distance or contact, or reports a contact without ever having
   given witness points. The method starts anew each time. */
mote_status mote_simulator_run(mote_simulator *simulator, const mote_simulation_start *start,
                               mote_rigid_state (*trace)[2], mote_simulation_result *result);

#endif
