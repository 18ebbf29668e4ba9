/* Displacements by a kind's own functions or, where it has none, by the sum over its basis. */
#include "core/body/field_kinds.h"

static mote_vec3 sum_over_basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                                const mote_weights *weights)
{
    double phi[MOTE_FIELD_MAX];
    field->kind->basis(field, mesh, vertex, phi);
    return mote_weighted_sum(phi, weights, field->padded);
}

mote_vec3 mote_field_displacement(const mote_field *field, const mote_mesh *mesh,
                                  uint32_t vertex, const mote_weights *weights)
{
    if (field->kind->displacement)
        return field->kind->displacement(field, mesh, vertex, weights);
    return sum_over_basis(field, mesh, vertex, weights);
}

static void sum_over_basis_single(const mote_field *field, const mote_mesh *mesh,
                                  uint32_t vertex, const mote_weights_single *weights,
                                  float displacement[3])
{
    double phi[MOTE_FIELD_MAX];
    float x[MOTE_LANES] = {0};
    float y[MOTE_LANES] = {0};
    float z[MOTE_LANES] = {0};
    field->kind->basis(field, mesh, vertex, phi);
    for (size_t j = 0; j < field->padded; j += MOTE_LANES) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            const float value = (float)phi[j + l];
            x[l] += value * weights->x[j + l];
            y[l] += value * weights->y[j + l];
            z[l] += value * weights->z[j + l];
        }
    }
    displacement[0] = mote_lane_sum_single(x);
    displacement[1] = mote_lane_sum_single(y);
    displacement[2] = mote_lane_sum_single(z);
}

void mote_field_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                    uint32_t vertex, const mote_weights_single *weights,
                                    float displacement[3])
{
    if (field->kind->displacement_single)
        field->kind->displacement_single(field, mesh, vertex, weights, displacement);
    else
        sum_over_basis_single(field, mesh, vertex, weights, displacement);
}
