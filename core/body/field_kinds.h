/* Shared by the sources of all kinds of fields, and by those that tell the kinds apart. */
#ifndef MOTE_CORE_FIELD_KINDS_H
#define MOTE_CORE_FIELD_KINDS_H

#include "core/body/field.h"

/* The displacement of a kind that has no displacement of its own, and the same in single
   precision: sums over sparse() or basis(). */
mote_vec3 mote_field_sum(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                         const mote_weights *weights);
void mote_field_sum_single(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                           const mote_weights_single *weights, float sum[3]);

/* Of a field of linear modes, the largest coordinate of each mode's displacements, by its
   absolute value, [count / 3]; NULL for a field of another kind. */
const double *mote_modes_largest(const mote_field *field);

/* Wendland's C2 function (1-r)^4 (4r+1) for 0 <= r < 1, else 0, an infinite r included. */
static inline double mote_wendland_c2(double r)
{
    const double s = r < 1 ? r : 1;
    const double q2 = (1 - s) * (1 - s);
    return q2 * q2 * (4 * s + 1);
}

static inline float mote_wendland_c2_single(float r)
{
    const float s = r < 1 ? r : 1;
    const float q2 = (1 - s) * (1 - s);
    return q2 * q2 * (4 * s + 1);
}

static inline float mote_lane_sum_single(const float lane[MOTE_LANES])
{
    return ((lane[0] + lane[4]) + (lane[2] + lane[6])) +
           ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

/* sum_j phi_j w_j in MOTE_LANES lanes, added in the order of mote_lane_sum. */
MOTE_INLINE mote_vec3 mote_weighted_sum(const double *phi, const mote_weights *weights,
                                        size_t padded)
{
    double x[MOTE_LANES] = {0};
    double y[MOTE_LANES] = {0};
    double z[MOTE_LANES] = {0};
    for (size_t j = 0; j < padded; j += MOTE_LANES) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            x[l] += phi[j + l] * weights->x[j + l];
            y[l] += phi[j + l] * weights->y[j + l];
            z[l] += phi[j + l] * weights->z[j + l];
        }
    }
    return mote_vec3_make(mote_lane_sum(x), mote_lane_sum(y), mote_lane_sum(z));
}

/* The same in single precision. */
MOTE_INLINE void mote_weighted_sum_single(const double *phi, const mote_weights_single *weights,
                                          size_t padded, float sum[3])
{
    float x[MOTE_LANES] = {0};
    float y[MOTE_LANES] = {0};
    float z[MOTE_LANES] = {0};
    for (size_t j = 0; j < padded; j += MOTE_LANES) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            const float value = (float)phi[j + l];
            x[l] += value * weights->x[j + l];
            y[l] += value * weights->y[j + l];
            z[l] += value * weights->z[j + l];
        }
    }
    sum[0] = mote_lane_sum_single(x);
    sum[1] = mote_lane_sum_single(y);
    sum[2] = mote_lane_sum_single(z);
}

#endif
