#include "core/csrbf_fit.h"

#include "core/field_kinds.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>

struct mote_csrbf_fit {
    gsl_matrix *factor; /* Cholesky factor of phi_j(c_i) */
    gsl_vector *solution;
};

static double basis_between(const mote_field *field, uint32_t i, uint32_t j)
{
    const double inverse = 1 / field->support;
    const double dx = (field->centre_x[i] - field->centre_x[j]) * inverse;
    const double dy = (field->centre_y[i] - field->centre_y[j]) * inverse;
    const double dz = (field->centre_z[i] - field->centre_z[j]) * inverse;
    return mote_wendland_c2(sqrt(dx * dx + dy * dy + dz * dz));
}

/* Below this the matrix cannot be told from a singular one: rounding leaves two equal centres a
   pivot of some J epsilon instead of 0, and a column of the inverse adds up J terms. */
static double smallest_reciprocal(const mote_field *field)
{
    return (double)field->count * field->count * DBL_EPSILON;
}

/* gsl_linalg_cholesky_rcond needs a workspace of three times the size. */
static mote_status factor_matrix(mote_csrbf_fit *fit, const mote_field *field,
                                 double *reciprocal)
{
    gsl_vector *work = gsl_vector_alloc((size_t)3 * field->count);
    if (!work)
        return MOTE_ENOMEM;
    for (uint32_t i = 0; i < field->count; ++i) {
        for (uint32_t j = 0; j < field->count; ++j)
            gsl_matrix_set(fit->factor, i, j, basis_between(field, i, j));
    }
    *reciprocal = 0;
    int failed = gsl_linalg_cholesky_decomp1(fit->factor);
    if (!failed)
        failed = gsl_linalg_cholesky_rcond(fit->factor, reciprocal, work);
    gsl_vector_free(work);
    return failed ? MOTE_ENUMERIC : MOTE_OK;
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
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    made->factor = gsl_matrix_alloc(field->count, field->count);
    made->solution = gsl_vector_alloc(field->count);
    double reciprocal = 0;
    mote_status status =
        made->factor && made->solution ? factor_matrix(made, field, &reciprocal) : MOTE_ENOMEM;
    gsl_set_error_handler(handler);
    if (status == MOTE_ENOMEM)
        mote_fail(status, "no memory to fit %u centres", field->count);
    else if (status != MOTE_OK || reciprocal < smallest_reciprocal(field))
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

/* Solves for one coordinate of all weights, stored every third double from first. */
static void solve_coordinate(const mote_csrbf_fit *fit, const double *values, double *weights)
{
    const size_t count = fit->solution->size;
    for (size_t i = 0; i < count; ++i)
        gsl_vector_set(fit->solution, i, values[3 * i]);
    gsl_linalg_cholesky_svx(fit->factor, fit->solution);
    for (size_t i = 0; i < count; ++i)
        weights[3 * i] = gsl_vector_get(fit->solution, i);
}

mote_status mote_csrbf_fit_solve(const mote_csrbf_fit *fit, const mote_vec3 *displacements,
                                 mote_vec3 *weights)
{
    const size_t count = fit->solution->size;
    for (size_t i = 0; i < count; ++i) {
        const mote_vec3 d = displacements[i];
        if (!isfinite(d.x) || !isfinite(d.y) || !isfinite(d.z))
            return mote_fail(MOTE_EINVAL, "the displacement of control point %zu is not finite",
                             i);
    }
    for (int axis = 0; axis < 3; ++axis)
        solve_coordinate(fit, &displacements->x + axis, &weights->x + axis);
    return MOTE_OK;
}

void mote_csrbf_fit_destroy(mote_csrbf_fit *fit)
{
    if (!fit)
        return;
    gsl_matrix_free(fit->factor);
    gsl_vector_free(fit->solution);
    free(fit);
}
