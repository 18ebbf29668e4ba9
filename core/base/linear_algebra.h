/* Dense linear algebra of symmetric matrices; the only user of GSL's linear algebra. GSL's
   error handler is switched off during a call, for all threads. */
#ifndef MOTE_CORE_LINEAR_ALGEBRA_H
#define MOTE_CORE_LINEAR_ALGEBRA_H

#include "core/base/status.h"
#include "core/base/vec3.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct mote_cholesky mote_cholesky;

/* Factors a symmetric positive definite matrix, size * size numbers by rows (the lower triangle
   is read), size >= 1. *reciprocal_condition is an estimate, 0 .. 1: the caller judges whether
   it is large enough. MOTE_ENUMERIC when the matrix is not positive definite to working
   precision, MOTE_ENOMEM. The caller destroys *cholesky. Cost O(size^3). */
mote_status mote_cholesky_create(uint32_t size, const double *matrix, mote_cholesky **cholesky,
                                 double *reciprocal_condition);
void mote_cholesky_destroy(mote_cholesky *cholesky); /* NULL is allowed */

/* Solves matrix * x = values for one coordinate of arrays of vectors: x[3 i] from values[3 i],
   i < size. The arrays may be the same. Threads may share a factor. Cost O(size^2). */
void mote_cholesky_solve_coordinate(const mote_cholesky *cholesky, const double *values,
                                    double *x);

/* Eigenvalues of a symmetric matrix, ascending, and its unit eigenvectors, the columns of a
   rotation: matrix = vectors diag(values) vectors^T. The lower triangle is read. MOTE_ENUMERIC
   when an entry is not finite or the iteration does not converge. */
mote_status mote_eigen_symmetric(const mote_mat3 *matrix, mote_vec3 *values,
                                 mote_mat3 *vectors);

#ifdef __cplusplus
}
#endif
#endif
