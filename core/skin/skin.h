/* Linear blend skinning as a field: each vertex follows a few bones,

       p_i = sum over b of w_ib M_b x_i,   w_ib >= 0, sum over b of w_ib = 1,

   with an affine matrix M_b for each bone in each frame: rotation, translation, scale, shear;
   mirrored and singular ones too. That is linear in the entries of the matrices, so it is a
   field of four basis functions a bone, w_ib (x_i - o) / s and w_ib, whose weight vectors
   follow from the matrices (mote_skin_weights). o is the middle of the mesh's box at rest and s
   a power of two near L.

   Morph targets (blend shapes) move the vertices before the bones do:

       p_i = sum over b of w_ib M_b (x_i + sum over k of m_k d_ik),

   with a displacement d_ik for each vertex that a target moves, and an amount m_k, any finite
   number, for each target in each frame. Such a field is not linear in all of its weights; its
   displacement() defines what they do. Its weight vectors are those of the bones, three for the
   rotation of the body's pose, and one a target.

   A skin without targets is a sparse field. Both bring bounds of their own to the certified
   query (skin_bounds.h). */
#ifndef MOTE_CORE_SKIN_H
#define MOTE_CORE_SKIN_H

#include "core/skin/skin_data.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

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

/* The same with morph targets before the bones. Without bones (bones is 0, start, bone and
   weight are NULL) the targets alone move the mesh, as if one bone at rest moved all of it. All
   is copied; displacements are kept as floats times a power of two that fits their target: 14
   bytes for each that is not 0, and 4 a vertex. MOTE_EINVAL, naming the target and the vertex,
   where a displacement is not finite, a vertex does not exist, or a target names one twice, and
   as above. MOTE_ENOMEM. */
mote_status mote_field_create_morphs(const mote_mesh *mesh, uint32_t bones,
                                     const uint32_t *start, const uint16_t *bone,
                                     const double *weight, const mote_morph_targets *targets,
                                     mote_field **field);

/* The skin of a field made by one of the above, which owns it; NULL for a field of another
 * kind. */
const mote_skin *mote_field_skin(const mote_field *field);

/* Writes the weights of a frame to x, y and z, field->padded each. matrices[bone][row][column]
   take rest coordinates, with a 1 appended, to posed ones, before the body's pose; rotation is
   that of the body's pose. The amounts of morph targets are 0. Cost O(bones), 20 ns each. */
void mote_skin_weights(const mote_field *field, const double (*matrices)[3][4],
                       const mote_mat3 *rotation, double *x, double *y, double *z);

/* The same with an amount for each morph target. matrices may be NULL: all bones are at rest;
   so may amounts: all are 0. */
void mote_morph_weights(const mote_field *field, const double (*matrices)[3][4],
                        const double *amounts, const mote_mat3 *rotation, double *x, double *y,
                        double *z);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
