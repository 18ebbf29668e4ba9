/* The closed loop with several bodies: they move freely in their box, deform as the scenario
   says, collide where a method says that they touch, and turn back at the walls. What the
   method lets pass is found by an exact one beside it, as in harness/loop/simulate.h. */
#ifndef MOTE_HARNESS_BODIES_SIMULATE_H
#define MOTE_HARNESS_BODIES_SIMULATE_H

#include "core/motion/response.h"
#include "harness/loop/bodies_book.h"
#include "harness/loop/simulate.h"

typedef struct mote_bodies_simulation {
    uint32_t steps;        /* made */
    mote_bodies_book book; /* its touches are gone */
    uint64_t responses;    /* impacts that changed the motion */
    uint64_t bounces;      /* off the walls */
    double near_pairs;     /* mean a step */
    double query_ns;       /* mean a step of the method, everything included */
    double energy_drift;   /* largest change not due to impacts below restitution 1, relative */
    double momentum_drift; /* likewise, of the sum of m |V|, without what the walls gave */
} mote_bodies_simulation;

/* Simulates `steps` steps from frame 1: places and velocities of the scenario's paths. options
   and the method's seed as for two bodies. A body turns back where its centre of mass leaves
   the room that the scenario gives to middles; walls do not turn it. Of several contacts at a
   step each is answered in the order of the bodies. MOTE_EINVAL: options out of range, an open
   mesh, bodies in contact at the start, a tolerance above `near`; MOTE_EUNSUPPORTED: the method
   reports a contact of bodies that it has never given witness points of. */
mote_status mote_bodies_simulate(const mote_bodies *bodies, const mote_method_choice *choice,
                                 const mote_simulation_options *options, uint32_t steps,
                                 uint64_t seed, mote_bodies_simulation *result);

#endif
