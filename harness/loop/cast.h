/* The appearance of a stage's bodies: poses come from the simulation, deformation from the
   scenario. A scenario of two bodies has weights in world axes and a limited number of frames,
   so the deformation is rotated with the body and runs backwards after the end; bodies of a
   scene deform in their own axes without end. Private to harness/loop. */
#ifndef MOTE_HARNESS_CAST_H
#define MOTE_HARNESS_CAST_H

#include "harness/loop/simulation.h"

typedef struct mote_cast_kind {
    /* Everything is borrowed; masses are per shape. */
    void *(*create)(const mote_subject *subject, const mote_simulation_options *options,
                    const mote_mass *masses);
    void (*destroy)(void *cast);
    void (*restart)(void *cast, const mote_simulation_start *start);
    const mote_body_state *(*show)(void *cast, uint32_t k, const mote_rigid_state *states);
    /* Writes the weights of all bodies [count], in their own axes, coordinate by coordinate and
       padded, `frames` after the beginning. What was shown is no longer valid. */
    void (*weigh)(void *cast, double frames, double *const *weights);
    /* The most by which the bodies can have approached since the previous step; NULL:
       unknown. */
    double (*moved)(const void *cast);
} mote_cast_kind;

/* The weights of a state in its body's own axes, as above; the padding is left as it is. */
void mote_cast_weights(const mote_field *field, const mote_body_state *state, double *weights);

extern const mote_cast_kind mote_cast_pair, mote_cast_scene;

#endif
