/* What becomes of a box of the rest tree under linear blend skinning.

   Leaves, relative to a reference bone. Over a box x = c + sum_k z_k h_k, |z_k| <= 1, and for
   any of its bones r, p = M_r x + sum over b != r of w_b (M_b - M_r) x, since weights add up to
   1: what one bone moves alone stays as tight as at rest. With e the image of c under M_b -
   M_r, d_k that of h_k without translation, and over the vertices of the box w_b = f + sum_k
   g_k z_k + q,  |q| <= m,    (w_b - f) z_k = s_k + q_k,  |q_k| <= m_k, it is w_b (M_b - M_r) x
   = f e + sum_k s_k d_k  +  sum_k z_k (g_k e + f d_k)  +  q e + sum_k q_k d_k, which adds to
   the centre, to the three half axes, and m |e| + sum_k m_k |d_k| to the half width.

   Above the leaves, convexity. Weights are not negative and add up to 1, so p lies between the
   M_b x of its bones: in a box around the images under M_b of those boxes, one a bone, that
   hold the vertices that b moves. These are boxes in z, with a middle and a half size along
   each axis, and a radius: in units of the half sizes these vertices are within a ball too,
   which cuts off the box's corners. A sum of the kind above would be wide here, where one bone
   moves little of what is in the box.

   Both hold for any matrices: nothing is assumed of them.

   Morph targets. Displacements of target k are fitted over the vertices of a box by d_k = f +
   sum_i g_i z_i + r,  |r| <= m in each coordinate, vectors all. With amounts m_k the vertices
   are then, before the bones move them, in a box with the centre c + sum_k m_k f, the half axes
   h_i + sum_k m_k g_i and, added to it, the half width e = sum_k |m_k| m. The bones move that
   box as they would the box at rest. What they make of the half width lies, since weights are
   not negative and add up to 1, within the largest |M_b| e of the bones, translation left out.
 */
#ifndef MOTE_CORE_SKIN_BOUNDS_H
#define MOTE_CORE_SKIN_BOUNDS_H

#include "core/certificate/certificate_bounds.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A block's strips: a head, then a row for each of its bones, then one for each of its targets,
   in the order of its active numbers. The active numbers of a block of leaves begin with the
   reference bone of each child. */
typedef struct mote_skin_head {
    float convex; /* 1: rows are mote_skin_convex_row, 0: mote_skin_leaf_row */
    float
        row_sum;  /* leaves: the largest sum of abs(f), m, abs(g_k), abs(s_k), m_k of a child */
    float morphs; /* how many of the rows, the last ones, are mote_skin_morph_row */
    float unused[MOTE_CERT_WIDTH - 3];
} mote_skin_head;

typedef struct mote_skin_convex_row {
    mote_cert_strip middle[3];
    mote_cert_strip half[3];
    mote_cert_strip radius; /* in units of half; 0 where the bone moves none of the vertices */
} mote_skin_convex_row;

/* Two numbers a child, of which a row at leaves is made: the first in the upper half of a word,
   the second in the lower, both in multiples of 2^-14. f, g_k and s_k may be any of these,
   since m and m_k are measured after that, and rounded up. */
typedef uint32_t mote_skin_pairs[MOTE_CERT_WIDTH];
#define MOTE_SKIN_UNIT 0x1p-14

/* The sum of abs(g_k) is held within this: w - f is within 1.75 then, and fits 16 bits. */
#define MOTE_SKIN_SLOPES 0.75

typedef struct mote_skin_leaf_row {
    mote_skin_pairs offset;    /* f, and m, which is more than 0 where the bone has a row */
    mote_skin_pairs slope[3];  /* g_k and s_k */
    mote_skin_pairs spread[2]; /* m_1 and m_2; m_3 and 0 */
} mote_skin_leaf_row;

/* Either number of a pair, exact once it is multiplied by this. Words of one size only, since
   loops over lanes that mix sizes are vectorised by the narrowest vectors. */
#define MOTE_SKIN_PACKED 0x1p-30F

static inline float mote_skin_first(uint32_t pair)
{
    return (float)(int32_t)(pair & 0xffff0000u);
}

static inline float mote_skin_second(uint32_t pair)
{
    return (float)(int32_t)(pair << 16);
}

/* In the target's size. [coordinate], slopes [axis][coordinate]. */
typedef struct mote_skin_morph_row {
    mote_cert_strip offset[3];
    mote_cert_strip slope[3][3];
    mote_cert_strip residual[3];
} mote_skin_morph_row;

#define MOTE_MORPH_STRIPS (sizeof(mote_skin_morph_row) / sizeof(mote_cert_strip))

extern const mote_cert_bounds mote_skin_bounds;

/* mote_cert_bounds.start, fit, store and stop of these. */
mote_status mote_skin_fit_start(mote_cert_tree *tree, bool linear_fits, void **fitter);
void mote_skin_fit(void *fitter, mote_cert_tree *tree, const mote_cert_part *part);
mote_status mote_skin_fit_store(void *fitter, mote_cert_tree *tree, mote_cert_block *block);
void mote_skin_fit_stop(void *fitter);

#ifdef __cplusplus
}
#endif
#endif
