/* Linear blend skinning as a field: each vertex follows a few bones,

       p_i = sum over b of w_ib M_b x_i,   w_ib >= 0, sum over b of w_ib = 1,

   with an affine matrix M_b for each bone in each frame: rotation, translation, scale, shear;
   mirrored and singular ones too. That is linear in the entries of the matrices, so it is a
   field of four basis functions a bone, w_ib (x_i - o) / s and w_ib, whose weight vectors
   follow from the matrices (mote_skin_weights). o is the middle of the mesh's box at rest and s
   a power of two near L.

   The field is sparse, and brings bounds of its own to the certified query (skin_bounds.h). */
#ifndef MOTE_CORE_SKIN_H
#define MOTE_CORE_SKIN_H

#include "core/skin/skin_data.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MOTE_SKIN_BONES_MAX 65535

/* Makes the field of a mesh. Vertex i has the weights start[i] .. start[i + 1] - 1 of weight,
   each for the bone in the same place of bone; start[0] is 0. Weights are finite and >= 0, in
   any order and number; those of a vertex are divided by their sum, which must be positive,
   rounded to multiples of 2^-24, and dropped where that is 0. Several of one bone are added up.
   All is copied; 4 bytes a vertex and 6 a weight are kept. MOTE_EINVAL, naming the vertex, for
   anything else, and unless there are 1 to MOTE_SKIN_BONES_MAX bones. MOTE_ENOMEM. Free with
   mote_field_destroy. Cost O(weights). */
mote_status mote_field_create_skin(const mote_mesh *mesh, uint32_t bones, const uint32_t *start,
                                   const uint16_t *bone, const double *weight,
                                   mote_field **field);

/* The skin of a field made by the above, which owns it; NULL for a field of another kind. */
const mote_skin *mote_field_skin(const mote_field *field);

/* Writes the weights of a frame to x, y and z, field->padded each. matrices[bone][row][column]
   take rest coordinates, with a 1 appended, to posed ones, before the body's pose; rotation is
   that of the body's pose. Cost O(bones), 20 ns each. */
void mote_skin_weights(const mote_field *field, const double (*matrices)[3][4],
                       const mote_mat3 *rotation, double *x, double *y, double *z);

#ifdef __cplusplus
}
#endif
#endif
