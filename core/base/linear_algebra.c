#include "core/base/linear_algebra.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <stdlib.h>

struct mote_cholesky {
    gsl_matrix *factor;
};

/* gsl_linalg_cholesky_rcond needs a workspace of three times the size. */
static mote_status factor_matrix(mote_cholesky *cholesky, uint32_t size, const double *matrix,
                                 double *reciprocal)
{
    cholesky->factor = gsl_matrix_alloc(size, size);
    gsl_vector *work = gsl_vector_alloc((size_t)3 * size);
    mote_status status = MOTE_OK;
    if (!cholesky->factor || !work)
        status = mote_fail(MOTE_ENOMEM, "no memory for a matrix of %u rows", size);
    for (size_t i = 0; i < size && status == MOTE_OK; ++i) {
        for (size_t j = 0; j < size; ++j)
            gsl_matrix_set(cholesky->factor, i, j, matrix[i * size + j]);
    }
    if (status == MOTE_OK && (gsl_linalg_cholesky_decomp1(cholesky->factor) ||
                              gsl_linalg_cholesky_rcond(cholesky->factor, reciprocal, work)))
        status = mote_fail(MOTE_ENUMERIC, "a matrix of %u rows is not positive definite", size);
    gsl_vector_free(work);
    return status;
}

mote_status mote_cholesky_create(uint32_t size, const double *matrix, mote_cholesky **cholesky,
                                 double *reciprocal_condition)
{
    mote_cholesky *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a factor");
    double reciprocal = 0;
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    const mote_status status = factor_matrix(made, size, matrix, &reciprocal);
    gsl_set_error_handler(handler);
    if (status != MOTE_OK) {
        mote_cholesky_destroy(made);
        return status;
    }
    *reciprocal_condition = reciprocal;
    *cholesky = made;
    return MOTE_OK;
}

void mote_cholesky_destroy(mote_cholesky *cholesky)
{
    if (!cholesky)
        return;
    gsl_matrix_free(cholesky->factor);
    free(cholesky);
}

void mote_cholesky_solve_coordinate(const mote_cholesky *cholesky, const double *values,
                                    double *x)
{
    const size_t size = cholesky->factor->size1;
    for (size_t i = 0; i < size; ++i)
        x[3 * i] = values[3 * i];
    gsl_vector_view solution = gsl_vector_view_array_with_stride(x, 3, size);
    gsl_linalg_cholesky_svx(cholesky->factor, &solution.vector);
}

/* A right-handed frame: the third axis follows from the first two. */
static mote_mat3 right_handed(const double columns[9])
{
    mote_mat3 r;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 2; ++k)
            r.m[i][k] = columns[3 * i + k];
    }
    const mote_vec3 third = mote_cross(mote_vec3_make(r.m[0][0], r.m[1][0], r.m[2][0]),
                                       mote_vec3_make(r.m[0][1], r.m[1][1], r.m[2][1]));
    r.m[0][2] = third.x;
    r.m[1][2] = third.y;
    r.m[2][2] = third.z;
    return r;
}

mote_status mote_eigen_symmetric(const mote_mat3 *matrix, mote_vec3 *values, mote_mat3 *vectors)
{
    double entries[9], eigenvalues[3] = {0}, columns[9] = {0};
    for (int i = 0; i < 9; ++i) {
        entries[i] = matrix->m[i / 3][i % 3];
        if (!isfinite(entries[i]))
            return mote_fail(MOTE_ENUMERIC,
                             "the matrix is not finite; its eigenvectors do not exist");
    }
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    gsl_matrix_view view = gsl_matrix_view_array(entries, 3, 3);
    gsl_vector_view eigenvalue_view = gsl_vector_view_array(eigenvalues, 3);
    gsl_matrix_view columns_view = gsl_matrix_view_array(columns, 3, 3);
    gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(3);
    int failed = 0;
    if (work) {
        failed =
            gsl_eigen_symmv(&view.matrix, &eigenvalue_view.vector, &columns_view.matrix, work);
        (void)gsl_eigen_symmv_sort(&eigenvalue_view.vector, &columns_view.matrix,
                                   GSL_EIGEN_SORT_VAL_ASC);
    }
    gsl_set_error_handler(handler);
    if (!work)
        return mote_fail(MOTE_ENOMEM, "no memory for eigenvectors");
    gsl_eigen_symmv_free(work);
    if (failed)
        return mote_fail(MOTE_ENUMERIC, "the eigenvectors of a matrix did not converge");
    *values = mote_vec3_make(eigenvalues[0], eigenvalues[1], eigenvalues[2]);
    *vectors = right_handed(columns);
    return MOTE_OK;
}
