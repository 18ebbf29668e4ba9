/* The options of a simulation, what a caller can watch, and its results. */
#ifndef MOTE_HARNESS_SIMULATION_H
#define MOTE_HARNESS_SIMULATION_H

#include "core/motion/response.h"
#include "harness/run/subject.h"

/* The truth is not computed if a lower bound of the distance between two bodies exceeds this
   fraction of L. */
#define MOTE_SIMULATION_NEAR 0.05

/* The largest step, in frames, and the largest number of steps. */
#define MOTE_SIMULATION_STEP_MAX 1000.0
#define MOTE_SIMULATION_STEPS_MAX 1000000u

/* What happens within a step. */
typedef enum mote_simulation_steps {
    MOTE_STEPS_WHOLE,     /* a step is one step of the rigid motion, and nobody looks within */
    MOTE_STEPS_SAMPLED,   /* bodies follow a path, in pieces of at most a frame; the method is
                             asked at the ends of steps, the truth four times a frame */
    MOTE_STEPS_CONTINUOUS /* the same, but impacts are found on the path and answered when they
                             happen */
} mote_simulation_steps;

/* Within a step, the truth is compared with what was said this often. */
#define MOTE_SIMULATION_LOOKS 4 /* a frame */

/* A pair that touches again within this many frames of its last impact is pushed apart, so that
   resting contact does not stall the loop. */
#define MOTE_SIMULATION_FLOOR 1.0

typedef struct mote_simulation_options {
    double density;     /* of all bodies, > 0 */
    double restitution; /* 0 .. 1 */
    double tolerance;   /* contact, in L: above 0, at most MOTE_SIMULATION_NEAR */
    mote_vec3 gravity;  /* L per frame squared; 0: none */
    double time_step;   /* frames by which motion and deformation advance per step, > 0 */
    mote_simulation_steps within;
} mote_simulation_options;

/* Density 1, restitution 1, no gravity, the scenario's tolerance or, if that is 0, 0.005, one
   frame per step. */
mote_simulation_options mote_default_simulation_options(const mote_subject *subject);

/* MOTE_EINVAL, with the valid range, for options out of range. */
mote_status mote_simulation_options_check(const mote_simulation_options *options);

/* The name of the exact method that runs beside a method: certified, or aabb-tree if certified
   itself is tested. */
const char *mote_simulation_exact_method(const mote_method_choice *choice);

/* A step before the bodies respond, for pictures. Borrowed for the call. */
typedef struct mote_simulation_view {
    uint32_t step;                 /* from 0 */
    const mote_body_state *states; /* current bodies, [count]; vertices are NULL */
    const mote_near_pair *said;    /* the method's answers for the near pairs, [said_count] */
    size_t said_count;
    const mote_engine *method; /* two bodies: for mote_engine_particles */
    bool contact;              /* the method reports a contact of some pair */
    bool truth;                /* some pair is in contact */
} mote_simulation_view;

/* Sees every step; a status other than MOTE_OK ends the simulation. */
typedef mote_status (*mote_simulation_watch)(void *context, const mote_simulation_view *view);

/* Where a simulation begins and how long it lasts. */
typedef struct mote_simulation_start {
    const mote_rigid_state *states; /* of the bodies */
    uint32_t first; /* deformation frame that two bodies show first (1 .. frames); after the
                       last frame their deformation runs backwards. Many begin with frame 1 */
    uint32_t steps; /* of options.time_step, >= 1 */
    double apart;   /* end early if two bodies separate and are certainly this far apart
                       (absolute); 0: never */
    uint64_t seed;  /* for the method */
    bool depth_unreported; /* measure depth only until a contact is reported, since depth takes
                              longest */
    mote_simulation_watch watch; /* may be NULL */
    void *context;               /* for watch */
} mote_simulation_start;

/* Steps are counted once for each pair that is in contact or reported to be. */
typedef struct mote_simulation_result {
    uint64_t steps;         /* made */
    uint64_t contact_steps; /* with a true contact */
    uint64_t missed_steps;  /* of these, not reported by the method */
    uint64_t false_steps;   /* reported by the method without a true contact */
    uint64_t truth_asked;   /* steps at which the truth was computed because it was needed */
    uint64_t responses;     /* impacts that changed the motion */
    uint64_t impacts;       /* found between the ends of steps */
    uint64_t pushes;        /* of these, answered by a push: they came within the floor */
    uint64_t unproven;      /* flights of a pair without a proof that it stays apart, since
                               pushes did not help */
    uint64_t bounces;       /* at the walls */
    uint64_t approaches;    /* maximal runs of steps with a true contact */
    uint64_t passes;        /* of these, never reported by the method */
    uint64_t deep_passes;   /* of these, with a vertex of one body inside the other */
    uint64_t intersections; /* runs in which the surfaces intersected */
    uint64_t delay_sum, delay_max; /* steps from the beginning of a run to its first report */
    double depth_max;              /* of L: deepest vertex inside another body */
    double depth_passes;           /* the same during passes only */
    double energy_drift;   /* largest change not due to impacts below restitution 1, relative */
    double momentum_drift; /* the same for the sum of m |V|, without the momentum from walls */
    double angular_drift;  /* of the angular momentum about the origin; MOTE_NONE with gravity
                              or bounces, which change it */
    double near_pairs;     /* mean per step */
    double query_ns;       /* mean time per step of deforming, updating and asking the method:
                              processor time for two bodies; wall time for many, which may use several
                              threads */
} mote_simulation_result;

#endif
