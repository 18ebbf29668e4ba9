/* The range of some numbers, kept as a middle and a half size in floats that hold it. */
#ifndef MOTE_CORE_SKIN_RANGE_H
#define MOTE_CORE_SKIN_RANGE_H

#include "core/base/vec3.h"

#include <float.h>
#include <math.h>

typedef struct mote_range {
    double low, high;
} mote_range;

#define MOTE_RANGE_EMPTY                                                                       \
    {                                                                                          \
        DBL_MAX, -DBL_MAX                                                                      \
    }

/* For numbers near 1 or smaller: 2^-40 covers the rounding of a difference of doubles. */
static inline float mote_rounded_up(double x)
{
    return (float)x * (1 + 0x1p-22F) + 0x1p-40F;
}

static inline void mote_range_widen(mote_range *i, double x)
{
    i->low = x < i->low ? x : i->low;
    i->high = x > i->high ? x : i->high;
}

/* Writes middle and half size, and returns the sum of their sizes. */
static inline double mote_range_settle(const mote_range *i, float *middle, float *half)
{
    const double m = mote_as_float(0.5 * (i->low + i->high));
    *middle = (float)m;
    *half = mote_rounded_up(i->high - m > m - i->low ? i->high - m : m - i->low);
    return fabs(m) + (double)*half;
}

#endif
