/* How far weights move the vertices of a body at most: for bounds of how much nearer two bodies
   can have come. Private to harness/loop. */
#ifndef MOTE_HARNESS_REACH_H
#define MOTE_HARNESS_REACH_H

#include "core/body/body.h"

/* The largest size of each basis function at any vertex: [count], or NULL where the
   displacement is not linear in the weights. The caller frees it. Cost: every function at every
   vertex. */
double *mote_reach_sizes(const mote_body *body);

/* Sums over all weights of the size of each function times the length of the weight, and times
   the length of its change. Both are infinite where there are no sizes. */
typedef struct mote_reach {
    double shape, change;
} mote_reach;

/* then, now [count]: the weights before and after, in the body's axes. */
mote_reach mote_reach_of(const mote_field *field, const double *sizes, const mote_vec3 *then,
                         const mote_vec3 *now);

#endif
