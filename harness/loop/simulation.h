/* The options of a simulation, what a caller can watch, and its results. */
#ifndef MOTE_HARNESS_SIMULATION_H
#define MOTE_HARNESS_SIMULATION_H

#include "core/motion/response.h"
#include "harness/run/subject.h"

/* The truth is not computed where a lower bound of the distance of two bodies exceeds this
   part of L. */
#define MOTE_SIMULATION_NEAR 0.05

/* Frames a step, and steps, at most. */
#define MOTE_SIMULATION_STEP_MAX 1000.0
#define MOTE_SIMULATION_STEPS_MAX 1000000u

typedef struct mote_simulation_options {
    double density;     /* of all bodies, > 0 */
    double restitution; /* 0 .. 1 */
    double tolerance;   /* of L, above 0, at most MOTE_SIMULATION_NEAR: contact */
    mote_vec3 gravity;  /* L a frame squared; 0: none */
    double time_step;   /* by how many frames motion and deformation advance in a step, > 0 */
} mote_simulation_options;

/* Density 1, restitution 1, no gravity, the scenario's tolerance or, when that is 0, 0.005, a
   frame a step. */
mote_simulation_options mote_default_simulation_options(const mote_subject *subject);

/* MOTE_EINVAL, saying what would be right, for options out of range. */
mote_status mote_simulation_options_check(const mote_simulation_options *options);

/* The name of the exact method that stands beside a method: certified, or aabb-tree where
   certified is itself in question. */
const char *mote_simulation_exact_method(const mote_method_choice *choice);

/* A step, before the bodies respond: for pictures. Borrowed for the call. */
typedef struct mote_simulation_view {
    uint32_t step;                 /* from 0 */
    const mote_body_state *states; /* where the bodies are, [count]; vertices are NULL */
    const mote_near_pair *said;    /* the method's answers for the near pairs, [said_count] */
    size_t said_count;
    const mote_engine *method; /* of two bodies, asked just now: mote_engine_particles */
    bool contact;              /* the method reports a contact of some pair */
    bool truth;                /* some pair is */
} mote_simulation_view;

/* Sees every step; a status other than MOTE_OK ends the simulation with it. */
typedef mote_status (*mote_simulation_watch)(void *context, const mote_simulation_view *view);

/* Where a simulation begins and how long it lasts. */
typedef struct mote_simulation_start {
    const mote_rigid_state *states; /* of the bodies */
    uint32_t first; /* frame whose deformation two bodies show first (1 .. frames); after the
                       last frame their deformation runs backwards. Many begin with frame 1 */
    uint32_t steps; /* of options.time_step, >= 1 */
    double apart;   /* end early when two bodies move apart and are certainly this far apart
                       (absolute); 0: never */
    uint64_t seed;  /* of the method */
    bool
        depth_unreported; /* measure depth only until a contact is reported: it takes longest */
    mote_simulation_watch watch; /* or NULL */
    void *context;               /* what watch is called with */
} mote_simulation_start;

/* Steps are counted once for each pair that is in contact or reported to be. */
typedef struct mote_simulation_result {
    uint64_t steps;         /* made */
    uint64_t contact_steps; /* truth is a contact */
    uint64_t missed_steps;  /* of them the method said none */
    uint64_t false_steps;   /* the method reported a contact, the truth is none */
    uint64_t
        truth_asked;    /* steps at which the truth was computed; at others it was not needed */
    uint64_t responses; /* impacts that changed the motion */
    uint64_t bounces;   /* off the walls */
    uint64_t approaches;           /* maximal runs of steps at which truth is a contact */
    uint64_t passes;               /* of these, never reported by the method: passes through */
    uint64_t deep_passes;          /* of these, with a vertex of one body inside the other */
    uint64_t delay_sum, delay_max; /* steps from the beginning of a run to its first report */
    double depth_max;              /* of L: deepest vertex inside another body */
    double depth_passes;           /* the same in passes only */
    double energy_drift;   /* largest change not due to impacts below restitution 1, relative */
    double momentum_drift; /* likewise, of the sum of m |V|, without what the walls gave */
    double angular_drift;  /* of the angular momentum about the origin; MOTE_NONE with gravity
                              or bounces, which change it */
    double near_pairs;     /* mean a step */
    double query_ns; /* mean time a step of deforming, updating, asking the method: processor
                        time for two bodies; of many, which threads may share, real time */
} mote_simulation_result;

#endif
