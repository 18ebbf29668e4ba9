/* Boxes of sets of vertices and what the basis functions do to them; used to build the rest
   tree. */
#ifndef MOTE_CORE_CERTIFICATE_FIT_H
#define MOTE_CORE_CERTIFICATE_FIT_H

#include "core/certificate_tree.h"

/* An oriented box. The values are floats, kept as doubles. */
typedef struct mote_cert_box {
    mote_vec3 centre;
    mote_vec3 half[3]; /* longest first; none is 0 */
} mote_cert_box;

/* Fits of all basis functions over one box. */
typedef struct mote_cert_fit {
    float offset[MOTE_FIELD_MAX];
    float slope[3][MOTE_FIELD_MAX];
    float rest[MOTE_FIELD_MAX];
    bool active[MOTE_FIELD_MAX]; /* not 0 at every vertex */
} mote_cert_fit;

/* Eigenvectors of a symmetric matrix, orthonormal, by descending eigenvalue. */
void mote_cert_principal_axes(double matrix[3][3], mote_vec3 axes[3]);

/* The box of count >= 1 vertices along their principal axes. Raises tree->radius and
   tree->leak. */
mote_cert_box mote_cert_box_of(mote_cert_tree *tree, const uint32_t *vertices, size_t count);

/* Fits every basis function over the vertices of a box. Raises tree->reach. phi holds
   MOTE_CERT_FIT_CHUNK * padded doubles. */
void mote_cert_fit_box(mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                       const mote_cert_box *box, bool linear, double *phi, mote_cert_fit *fit);

/* Vertices whose basis is held at a time. */
#define MOTE_CERT_FIT_CHUNK 512

#endif
