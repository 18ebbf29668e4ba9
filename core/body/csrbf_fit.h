/* Weights of a CSRBF field that displaces given control points by given vectors (paper section
 * 4). */
#ifndef MOTE_CORE_CSRBF_FIT_H
#define MOTE_CORE_CSRBF_FIT_H

#include "core/body/field.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_csrbf_fit mote_csrbf_fit;

/* Factors the symmetric positive definite matrix phi_j(c_i) of a CSRBF field once (Cholesky,
   GSL). MOTE_EINVAL for another kind of field, MOTE_ENOMEM, MOTE_ENUMERIC when it is
   singular to working precision, that is, when the reciprocal condition number is below
   J^2 DBL_EPSILON (two equal centres, for example): the text names it. *reciprocal_condition
   is an estimate, 0 .. 1; it may be NULL. Cost O(J^3). GSL's error handler is switched off
   during the call, for all threads. */
mote_status mote_csrbf_fit_create(const mote_field *field, mote_csrbf_fit **fit,
                                  double *reciprocal_condition);

/* Solves for weights[J] such that the field displaces centre i by displacements[i]; weights may
   be displacements. MOTE_EINVAL, weights untouched, for one that is not finite. Threads
   may share a fit. Cost O(J^2). */
mote_status mote_csrbf_fit_solve(const mote_csrbf_fit *fit, const mote_vec3 *displacements,
                                 mote_vec3 *weights);

/* NULL is allowed. */
void mote_csrbf_fit_destroy(mote_csrbf_fit *fit);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
