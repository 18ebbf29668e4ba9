/* Places the bodies of a scenario in their box; used by its loader only. */
#ifndef MOTE_HARNESS_BODIES_PLACE_H
#define MOTE_HARNESS_BODIES_PLACE_H

#include "harness/scene/bodies.h"

/* What a scenario's file says about its box and its bodies. Lengths are in L. */
typedef struct mote_bodies_wish {
    uint64_t seed;
    mote_vec3 box;      /* edges; 0: near_pairs decides */
    double near_pairs;  /* near pairs divided by bodies, over all frames; 0: box decides */
    double speed, spin; /* L per frame; degrees per frame */
    mote_vec3 *places;  /* [count] middles at frame 1, absolute, or NULL: drawn */
} mote_bodies_wish;

/* Sets box, room and paths of bodies, whose shapes and shape_of are known. MOTE_EINVAL: a box
   that is too small, bodies that overlap at frame 1 (less than 0.01 L apart), positions outside
   the box, a number of near pairs that no box gives. */
mote_status mote_bodies_place(mote_bodies *bodies, const mote_bodies_wish *wish);

#endif
