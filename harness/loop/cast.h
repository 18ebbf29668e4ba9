/* How the bodies of a stage are shown: their poses are the simulation's, their deformation is
   the scenario's. A scenario of two names weights in world axes and lasts for its frames, so
   that the deformation is turned with the body and played back at the end; bodies of a scene
   deform in their own axes for ever. Private to harness/loop. */
#ifndef MOTE_HARNESS_CAST_H
#define MOTE_HARNESS_CAST_H

#include "harness/loop/simulation.h"

typedef struct mote_cast_kind {
    /* Everything is borrowed; masses are those of the shapes. */
    void *(*create)(const mote_subject *subject, const mote_simulation_options *options,
                    const mote_mass *masses);
    void (*destroy)(void *cast);
    void (*restart)(void *cast, const mote_simulation_start *start);
    const mote_body_state *(*show)(void *cast, uint32_t k, const mote_rigid_state *states);
    /* The most by which the bodies can have come nearer since the step before; NULL: not
       known. */
    double (*moved)(const void *cast);
} mote_cast_kind;

extern const mote_cast_kind mote_cast_pair, mote_cast_scene;

#endif
