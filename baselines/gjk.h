/* The distance of two convex sets given by their support functions (Gilbert, Johnson and
   Keerthi 1988). Our own, since libccd says only whether two sets intersect. */
#ifndef MOTE_BASELINES_GJK_H
#define MOTE_BASELINES_GJK_H

#include "core/base/vec3.h"

/* A support point of each set. */
typedef struct mote_gjk_point {
    mote_vec3 a, b;
} mote_gjk_point;

/* The point of a that is farthest along direction, and the point of b that is farthest against
   it. direction need not have length 1. */
typedef mote_gjk_point (*mote_gjk_support)(void *context, mote_vec3 direction);

typedef struct mote_gjk_result {
    double distance;      /* 0 where the sets intersect or touch to rounding */
    double lower;         /* proven lower bound on the distance */
    mote_vec3 witness[2]; /* points of a and b, distance apart; of no meaning at 0 */
    unsigned iterations;
} mote_gjk_result;

/* Distance of a and b, starting with any direction that is not zero, to a relative 1e-12 or the
   rounding of the coordinates. Stops early once the distance is proven to be at least `enough`
   (infinite: never), or after max_iterations; distance is then an upper bound, and lower is
   what has been proven. No allocation. */
mote_gjk_result mote_gjk_distance(mote_gjk_support support, void *context, mote_vec3 start,
                                  double enough, unsigned max_iterations);

#endif
