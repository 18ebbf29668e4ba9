/* Boxes around sets of vertices at rest. Used to build the tree. */
#ifndef MOTE_CORE_CERTIFICATE_BOX_H
#define MOTE_CORE_CERTIFICATE_BOX_H

#include "core/certificate/certificate_tree.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* An oriented box. The values are floats, kept as doubles. */
typedef struct mote_cert_box {
    mote_vec3 centre;
    mote_vec3 half[3]; /* longest first; none is 0 */
} mote_cert_box;

/* Eigenvectors of a symmetric matrix, orthonormal, by descending eigenvalue. */
void mote_cert_principal_axes(double matrix[3][3], mote_vec3 axes[3]);

/* The box of count >= 1 vertices along their principal axes. Raises tree->radius and
   tree->leak. */
mote_cert_box mote_cert_box_of(mote_cert_tree *tree, const uint32_t *vertices, size_t count);

/* z of a vertex in a box, held within -1 .. 1. */
void mote_cert_box_coordinates(const mote_cert_box *box, mote_vec3 x, double z[3]);

/* How much of the corners of a box its vertices leave empty, for each pair of axes: see
   mote_cert_cut_of. */
void mote_cert_cut_corners(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                           const mote_cert_box *box, int32_t cut[3]);

/* Least squares over a box, with z = (1, z_1, z_2, z_3): replaces the lower half of the normal
   equations' matrix a by its Cholesky factor, and solves for one right side with that factor.
 */
void mote_cert_factor(double a[4][4]);
void mote_cert_solve(const double a[4][4], double b[4]);

/* Where there are more vertices, axes and slopes are found from a sample of about this many. */
#define MOTE_CERT_FIT_CHUNK 512

/* Every how many of count vertices one is taken for that. */
static inline size_t mote_cert_sample_stride(size_t count)
{
    return (count + MOTE_CERT_FIT_CHUNK - 1) / MOTE_CERT_FIT_CHUNK;
}

/* z of each stride-th of count vertices, MOTE_CERT_FIT_CHUNK of them at most, and copies of the
   last one up to a multiple of MOTE_LANES; returns how many there are without the copies. The
   bits of mote_cert_box_coordinates. No allocation. */
size_t mote_cert_box_sample(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                            const mote_cert_box *box, size_t stride,
                            double z[3][MOTE_CERT_FIT_CHUNK]);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
