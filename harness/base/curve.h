/* A smooth curve through keys: cubic Hermite pieces whose tangents come from the neighbouring
   keys (Catmull-Rom for uneven steps), so it is once continuously differentiable. Before the
   first key it has the first value, after the last key the last. */
#ifndef MOTE_HARNESS_CURVE_H
#define MOTE_HARNESS_CURVE_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct mote_curve {
    uint32_t count, width; /* keys, numbers per key */
    uint32_t *frames;      /* [count], rising */
    double *values;        /* [count * width] */
    double *tangents;      /* [count * width], per frame */
} mote_curve;

/* count >= 1 keys of width numbers each; both arrays are copied. MOTE_EINVAL unless frames
   rise. */
mote_status mote_curve_create(const uint32_t *frames, const double *values, uint32_t count,
                              uint32_t width, mote_curve **curve);
void mote_curve_destroy(mote_curve *curve); /* NULL is allowed */

/* Writes value[width]. */
void mote_curve_evaluate(const mote_curve *curve, double frame, double *value);

#endif
