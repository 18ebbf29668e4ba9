/* Boxes around sets of vertices, and linear fits of the basis functions over them. Used to
   build the tree. */
#ifndef MOTE_CORE_CERTIFICATE_FIT_H
#define MOTE_CORE_CERTIFICATE_FIT_H

#include "core/certificate/certificate_tree.h"

/* An oriented box. The values are floats, kept as doubles. */
typedef struct mote_cert_box {
    mote_vec3 centre;
    mote_vec3 half[3]; /* longest first; none is 0 */
} mote_cert_box;

/* Fits of all basis functions over one box. */
typedef struct mote_cert_fit {
    double slope[3][MOTE_FIELD_MAX];
    float offset[MOTE_FIELD_MAX];
    float residual[MOTE_FIELD_MAX];
    bool active[MOTE_FIELD_MAX]; /* not 0 at every vertex */
} mote_cert_fit;

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

/* The slopes of every basis function over the vertices of a box, by least squares. phi holds
   MOTE_FIELD_MAX doubles. */
void mote_cert_fit_slopes(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                          const mote_cert_box *box, double *phi, mote_cert_fit *fit);

/* Offsets and largest residuals for the slopes in fit, whatever they are, and which functions
   are active. Raises tree->row_bound. */
void mote_cert_fit_residuals(mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                             const mote_cert_box *box, double *phi, mote_cert_fit *fit);

/* A fit uses at most this many vertices. */
#define MOTE_CERT_FIT_CHUNK 512

#endif
