/* How well a simulation conserves energy, momentum and angular momentum. */
#ifndef MOTE_HARNESS_DRIFT_H
#define MOTE_HARNESS_DRIFT_H

#include "core/motion/response.h"

#include <stdbool.h>
#include <stdint.h>

/* The observed bodies, all borrowed. */
typedef struct mote_drift_bodies {
    const mote_rigid_state *states; /* [count] */
    const mote_rigid_state *start;  /* [count] */
    const mote_mass *masses;        /* of the shapes */
    const uint32_t *shape_of;       /* [count] */
    uint32_t count;
    mote_vec3 gravity; /* absolute */
} mote_drift_bodies;

/* External changes of the bodies' totals so far. */
typedef struct mote_drift_lost {
    double energy;      /* in impacts */
    mote_vec3 momentum; /* at the walls */
} mote_drift_lost;

/* Zero-initialise. */
typedef struct mote_drift {
    bool begun;
    double energy_first, energy_size;
    mote_vec3 momentum_first, angular_first;
    double momentum_size, angular_size;
    /* The largest changes so far, each relative to the largest sum of the magnitudes of its
       parts. Angular momentum is about the origin; gravity and walls change it. */
    double energy, momentum, angular;
} mote_drift;

/* Compares the bodies at a time since the start with their state at the first call. */
void mote_drift_note(mote_drift *drift, const mote_drift_bodies *bodies,
                     const mote_drift_lost *lost, double time);

#endif
