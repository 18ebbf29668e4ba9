/* Displacements of kinds that do not sum by themselves. In a file of their own: inlined, their
   arrays would lengthen every call of the kinds that do. */
#include "core/body/field_kinds.h"

/* A function that is 0 adds +0 or -0 to a lane that is never -0, so that leaving it out changes
   no bit. */
static mote_vec3 sum_over_sparse(const mote_field *field, const mote_mesh *mesh,
                                 uint32_t vertex, const mote_weights *weights)
{
    uint32_t functions[MOTE_FIELD_SUMMED];
    double phi[MOTE_FIELD_SUMMED];
    double x[MOTE_LANES] = {0};
    double y[MOTE_LANES] = {0};
    double z[MOTE_LANES] = {0};
    const uint32_t count = field->kind->sparse(field, mesh, vertex, functions, phi);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t j = functions[i];
        x[j % MOTE_LANES] += phi[i] * weights->x[j];
        y[j % MOTE_LANES] += phi[i] * weights->y[j];
        z[j % MOTE_LANES] += phi[i] * weights->z[j];
    }
    return mote_vec3_make(mote_lane_sum(x), mote_lane_sum(y), mote_lane_sum(z));
}

mote_vec3 mote_field_sum(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                         const mote_weights *weights)
{
    if (field->kind->sparse)
        return sum_over_sparse(field, mesh, vertex, weights);
    double phi[MOTE_FIELD_SUMMED];
    field->kind->basis(field, mesh, vertex, phi);
    return mote_weighted_sum(phi, weights, field->padded);
}

static void sum_over_sparse_single(const mote_field *field, const mote_mesh *mesh,
                                   uint32_t vertex, const mote_weights_single *weights,
                                   float sum[3])
{
    uint32_t functions[MOTE_FIELD_SUMMED];
    double phi[MOTE_FIELD_SUMMED];
    float x[MOTE_LANES] = {0};
    float y[MOTE_LANES] = {0};
    float z[MOTE_LANES] = {0};
    const uint32_t count = field->kind->sparse(field, mesh, vertex, functions, phi);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t j = functions[i];
        const float value = (float)phi[i];
        x[j % MOTE_LANES] += value * weights->x[j];
        y[j % MOTE_LANES] += value * weights->y[j];
        z[j % MOTE_LANES] += value * weights->z[j];
    }
    sum[0] = mote_lane_sum_single(x);
    sum[1] = mote_lane_sum_single(y);
    sum[2] = mote_lane_sum_single(z);
}

void mote_field_sum_single(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                           const mote_weights_single *weights, float sum[3])
{
    if (field->kind->sparse) {
        sum_over_sparse_single(field, mesh, vertex, weights, sum);
        return;
    }
    double phi[MOTE_FIELD_SUMMED];
    field->kind->basis(field, mesh, vertex, phi);
    mote_weighted_sum_single(phi, weights, field->padded, sum);
}
