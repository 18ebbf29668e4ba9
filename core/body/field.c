#include "core/body/field.h"

#include "core/body/field_kinds.h"

#include <stdlib.h>

mote_status mote_field_allocate(const mote_field_kind *kind, uint32_t count, mote_field **field)
{
    mote_field *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a field");
    made->kind = kind;
    made->count = count;
    made->padded = (count + MOTE_LANES - 1) / MOTE_LANES * MOTE_LANES;
    made->bytes = sizeof *made;
    *field = made;
    return MOTE_OK;
}

static void no_basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                     double *phi)
{
    (void)field, (void)mesh, (void)vertex, (void)phi;
}

static void no_gradient(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                        mote_vec3 *gradient)
{
    (void)field, (void)mesh, (void)vertex, (void)gradient;
}

static void free_plain(mote_field *field)
{
    free(field);
}

static const mote_field_kind static_kind = {
    .name = "static", .basis = no_basis, .gradient = no_gradient, .destroy = free_plain};

mote_status mote_field_create_static(mote_field **field)
{
    return mote_field_allocate(&static_kind, 0, field);
}

void mote_field_destroy(mote_field *field)
{
    if (field)
        field->kind->destroy(field);
}

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
