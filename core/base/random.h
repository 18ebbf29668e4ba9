/* A random number generator with a small state (splitmix64: Steele, Lea, Flood 2014). A seed
   gives the same sequence on every machine. For start positions and random scenes. */
#ifndef MOTE_CORE_RANDOM_H
#define MOTE_CORE_RANDOM_H

#include "core/base/vec3.h"

#include <stdint.h>

typedef struct mote_random {
    uint64_t state;
} mote_random;

static inline uint64_t mote_random_next(mote_random *random)
{
    uint64_t z = (random->state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Uniform in 0 .. bound - 1; bound is at least 1. Unbiased (rejection). */
static inline uint64_t mote_random_below(mote_random *random, uint64_t bound)
{
    const uint64_t limit = UINT64_MAX - UINT64_MAX % bound;
    uint64_t value = mote_random_next(random);
    while (value >= limit)
        value = mote_random_next(random);
    return value % bound;
}

/* Uniform in [0, 1). */
static inline double mote_random_unit(mote_random *random)
{
    return (double)(mote_random_next(random) >> 11) * 0x1p-53;
}

/* Uniform on the unit sphere (rejection in a ball). */
static inline mote_vec3 mote_random_direction(mote_random *random)
{
    for (;;) {
        const double x = 2 * mote_random_unit(random) - 1;
        const double y = 2 * mote_random_unit(random) - 1;
        const double z = 2 * mote_random_unit(random) - 1;
        const mote_vec3 v = mote_vec3_make(x, y, z);
        const double square = mote_length_squared(v);
        if (square > 0.01 && square <= 1)
            return mote_scale(v, 1 / sqrt(square));
    }
}

#endif
