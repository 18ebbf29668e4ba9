/* What takes the place of linear_algebra.c and parts_hacd.cpp where the core is built without
   other libraries (MOTE_CORE_ONLY): main axes by ourselves, no convex parts. Fits of CSRBF
   weights are left out there: weights come from the caller. */
#include "core/certificate/certificate_fit.h"
#include "core/base/linear_algebra.h"
#include "core/body/parts.h"

#include <math.h>

mote_status mote_eigen_symmetric(const mote_mat3 *matrix, mote_vec3 *values, mote_mat3 *vectors)
{
    mote_mat3 whole = *matrix; /* of which the lower triangle is read */
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            whole.m[i][k] = matrix->m[i > k ? i : k][i > k ? k : i];
            if (!isfinite(whole.m[i][k]))
                return mote_fail(MOTE_ENUMERIC,
                                 "a matrix whose main axes are asked is not finite");
        }
    }
    mote_mat3 work = whole;
    mote_vec3 axes[3]; /* falling */
    mote_cert_principal_axes(work.m, axes);
    axes[0] = mote_cross(axes[2], axes[1]);
    const mote_vec3 found = {mote_dot(axes[2], mote_rotate(&whole, axes[2])),
                             mote_dot(axes[1], mote_rotate(&whole, axes[1])),
                             mote_dot(axes[0], mote_rotate(&whole, axes[0]))};
    for (int k = 0; k < 3; ++k) {
        vectors->m[0][k] = axes[2 - k].x;
        vectors->m[1][k] = axes[2 - k].y;
        vectors->m[2][k] = axes[2 - k].z;
    }
    *values = found;
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
