/* Positions of bodies in single precision: relative to an origin near them, in a unit near L.
   Converted in the pass over the vertices that checks them. */
#ifndef MOTE_BASELINES_FLOAT_POSITIONS_H
#define MOTE_BASELINES_FLOAT_POSITIONS_H

#include "core/method/method.h"

/* Writes scale * (world - origin), and 0, to to[count]. *coordinate_max is the largest absolute
   coordinate written. MOTE_EINVAL, as mote_input_check_vertices says it, where world is NULL or
   a position is not finite; or where one is beyond the range of floats. body: its number, for
   messages. Cost: about 1 ns a vertex. */
mote_status mote_float_positions(float (*to)[4], const mote_vec3 *world, uint32_t count,
                                 mote_vec3 origin, double scale, int body,
                                 float *coordinate_max);

/* A bound on the rounding errors of positions, sums of positions, and their differences, of
   which none is larger than coordinate_max. */
static inline float mote_float_margin(float coordinate_max)
{
    return 0x1p-20f * coordinate_max;
}

/* As a comparison each, where fmin and fmax are calls. */
static inline float mote_float_smallest(float a, float b, float c)
{
    a = b < a ? b : a;
    return c < a ? c : a;
}

static inline float mote_float_largest(float a, float b, float c)
{
    a = b > a ? b : a;
    return c > a ? c : a;
}

/* The positions of a pair of bodies, relative to one origin. Set count, position and scale;
   zero-initialise the rest. */
typedef struct mote_float_pair {
    uint32_t count[2];
    float (*position[2])[4]; /* [count], borrowed */
    double scale;            /* brings L near 1: a power of two */
    mote_vec3 origin;
    float coordinate_max[2]; /* of each body */
    bool placed;             /* there is an origin, and positions are relative to it */
} mote_float_pair;

/* Converts the bodies that a frame changes: moved says which. Both where the origin has to be
   renewed, in the first frame and where the first vertex of body 0 is more than 8 L away from
   it. No body is converted twice. Errors as mote_float_positions; then the next frame converts
   both. */
mote_status mote_float_pair_update(mote_float_pair *pair, const mote_frame *frame,
                                   bool moved[2]);

#endif
