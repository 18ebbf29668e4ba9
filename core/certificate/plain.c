/* Replaces linear_algebra.c and core/parts where the core is built without other libraries
   (MOTE_CORE_ONLY): principal axes by our own code, no convex parts. CSRBF weights are not
   fitted there: they come from the caller. */
#include "core/certificate/certificate_box.h"
#include "core/base/linear_algebra.h"
#include "core/parts/parts.h"

#include <math.h>

mote_status mote_eigen_symmetric(const mote_mat3 *matrix, mote_vec3 *values, mote_mat3 *vectors)
{
    mote_mat3 whole = *matrix; /* of which the lower triangle is read */
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            whole.m[i][k] = matrix->m[i > k ? i : k][i > k ? k : i];
            if (!isfinite(whole.m[i][k]))
                return mote_fail(MOTE_ENUMERIC,
                                 "the matrix is not finite; its eigenvectors do not exist");
        }
    }
    mote_mat3 work = whole;
    mote_vec3 axes[3]; /* by descending eigenvalue */
    mote_cert_principal_axes(work.m, axes);
    axes[0] = mote_cross(axes[2], axes[1]);
    const mote_vec3 eigenvalues = {mote_dot(axes[2], mote_rotate(&whole, axes[2])),
                                   mote_dot(axes[1], mote_rotate(&whole, axes[1])),
                                   mote_dot(axes[0], mote_rotate(&whole, axes[0]))};
    for (int k = 0; k < 3; ++k) {
        vectors->m[0][k] = axes[2 - k].x;
        vectors->m[1][k] = axes[2 - k].y;
        vectors->m[2][k] = axes[2 - k].z;
    }
    *values = eigenvalues;
    return MOTE_OK;
}

mote_status mote_parts_create(const mote_mesh *mesh, const mote_vec3 *positions,
                              mote_parts **parts)
{
    (void)mesh, (void)positions, (void)parts;
    return mote_fail(MOTE_EUNSUPPORTED,
                     "this library was built without the decomposition into convex parts; give "
                     "the number of particles");
}

void mote_parts_destroy(mote_parts *parts)
{
    (void)parts; /* none was made */
}
