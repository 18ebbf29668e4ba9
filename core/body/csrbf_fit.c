#include "core/body/csrbf_fit.h"

#include "core/body/field_kinds.h"
#include "core/base/linear_algebra.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

struct mote_csrbf_fit {
    uint32_t count;
    mote_cholesky *factor; /* of phi_j(c_i) */
};

static double basis_between(const mote_field *field, uint32_t i, uint32_t j)
{
    const double inverse = 1 / field->support;
    const double dx = (field->centre_x[i] - field->centre_x[j]) * inverse;
    const double dy = (field->centre_y[i] - field->centre_y[j]) * inverse;
    const double dz = (field->centre_z[i] - field->centre_z[j]) * inverse;
    return mote_wendland_c2(sqrt(dx * dx + dy * dy + dz * dz));
}

/* Below this, the matrix cannot be distinguished from a singular one: with two equal centres,
   rounding leaves a pivot of about J epsilon instead of 0, and a column of the inverse adds J
   terms. */
static double smallest_reciprocal(const mote_field *field)
{
    return (double)field->count * field->count * DBL_EPSILON;
}

static mote_status factor_matrix(const mote_field *field, mote_cholesky **factor,
                                 double *reciprocal)
{
    const size_t count = field->count;
    double *matrix = malloc(count * count * sizeof *matrix);
    if (!matrix)
        return mote_fail(MOTE_ENOMEM, "no memory to fit %zu centres", count);
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t j = 0; j < count; ++j)
            matrix[i * count + j] = basis_between(field, i, j);
    }
    const mote_status status = mote_cholesky_create(field->count, matrix, factor, reciprocal);
    free(matrix);
    return status;
}

mote_status mote_csrbf_fit_create(const mote_field *field, mote_csrbf_fit **fit,
                                  double *reciprocal_condition)
{
    if (field->count == 0 || !field->centre_x)
        return mote_fail(MOTE_EINVAL,
                         "a field of kind %s has no centres to fit; CSRBF is needed",
                         field->kind->name);
    mote_csrbf_fit *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a fit");
    made->count = field->count;
    double reciprocal = 0;
    mote_status status = factor_matrix(field, &made->factor, &reciprocal);
    if (status == MOTE_ENUMERIC ||
        (status == MOTE_OK && reciprocal < smallest_reciprocal(field)))
        status = mote_fail(MOTE_ENUMERIC,
                           "the matrix of %u CSRBF centres is singular to working precision "
                           "(reciprocal condition %.3g); centres must be further apart, or the "
                           "support radius smaller",
                           field->count, reciprocal);
    if (status != MOTE_OK) {
        mote_csrbf_fit_destroy(made);
        return status;
    }
    if (reciprocal_condition)
        *reciprocal_condition = reciprocal;
    *fit = made;
    return MOTE_OK;
}

mote_status mote_csrbf_fit_solve(const mote_csrbf_fit *fit, const mote_vec3 *displacements,
                                 mote_vec3 *weights)
{
    const size_t count = fit->count;
    for (size_t i = 0; i < count; ++i) {
        const mote_vec3 d = displacements[i];
        if (!mote_is_finite(d))
            return mote_fail(MOTE_EINVAL, "the displacement of control point %zu is not finite",
                             i);
    }
    for (int axis = 0; axis < 3; ++axis)
        mote_cholesky_solve_coordinate(fit->factor, &displacements->x + axis,
                                       &weights->x + axis);
    return MOTE_OK;
}

void mote_csrbf_fit_destroy(mote_csrbf_fit *fit)
{
    if (!fit)
        return;
    mote_cholesky_destroy(fit->factor);
    free(fit);
}
