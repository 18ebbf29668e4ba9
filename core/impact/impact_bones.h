/* Bounds on the motion of skins, by convexity (core/skin/skin.h).

   A point p = sum_b w_b M_b (x + m), with what the morph targets move it by, m, lies between
   what its bones make of x + m, since weights are not negative and add up to 1; and so do its
   derivatives:

       p'  = sum_b w_b (M_b' (x + m) + A_b m'),
       p'' = sum_b w_b (M_b'' (x + m) + 2 A_b' m' + A_b m''),

   A_b being M_b without its translation. So a bound for a group is the largest of those of the
   bones that move anything in it. Of each bone, with c the middle of the group and r its
   radius, |M_b' (x + m)| <= |M_b' c| + |A_b'| (r + |m|), and the same of the others. M_b c and
   its derivatives are cubics with the control points that those of the matrices give: a bone
   that turns about its joint moves what is near the joint slowly, which a sum of the sizes of
   its weights would not show. |A| is at most the root of the largest sum of a row of |A^T A|,
   which is exact for rotations; m, m' and m'' are bounded by the largest displacements of each
   target in the group. */
#ifndef MOTE_CORE_IMPACT_BONES_H
#define MOTE_CORE_IMPACT_BONES_H

#include "core/body/path.h"
#include "core/skin/skin_data.h"

/* The groups of a body's vertices: balls around them at rest. */
typedef struct mote_impact_balls {
    uint32_t count, padded;  /* padded to a multiple of MOTE_LANES */
    const mote_vec3 *middle; /* [count] */
    const double *radius;    /* [count] */
} mote_impact_balls;

/* Control points of a bone's matrix in a piece: those of the matrix, then, from
   MOTE_BONE_RATES on, those of its derivative, and from MOTE_BONE_CHANGES on of the second. */
#define MOTE_BONE_LANES 16
#define MOTE_BONE_RATES 4
#define MOTE_BONE_CHANGES 8

/* A bone in a piece: weight vectors [coordinate][function][control point], and bounds of |A|,
   |A'| and |A''|, and of the sizes of the weights. */
typedef struct mote_impact_bone {
    double control[3][4][MOTE_BONE_LANES];
    double stretch[3], size;
} mote_impact_bone;

typedef struct mote_impact_bones {
    const mote_skin *skin; /* borrowed */
    uint32_t *start;       /* [groups + 1]: the bones of each group are */
    uint16_t *bone;        /* bone[start[g]] .. [start[g + 1] - 1], ascending */
    double *moved;         /* [targets][padded]: the longest displacement in each group */
    double *moved_most;    /* [targets]: in any group */
    mote_impact_bone *at;  /* [bones] in a piece */
    double *morphed;       /* [3][padded]: bounds in a piece of |m|, |m'| and |m''| */
} mote_impact_bones;

/* For groups to be added one after the other. MOTE_ENOMEM. */
mote_status mote_impact_bones_create(const mote_skin *skin, uint32_t groups, uint32_t padded,
                                     mote_impact_bones **bones, size_t *bytes);

/* NULL is allowed. */
void mote_impact_bones_destroy(mote_impact_bones *bones);

/* Adds group g, the next one, of these vertices. */
void mote_impact_bones_add(mote_impact_bones *bones, uint32_t g, uint32_t padded,
                           const uint32_t *vertices, uint32_t count);

/* Bounds of the motion of each group in a piece, without the body's own rotation, in sums[3]
   [padded]: of the distance from the pivot, or from the axis through it where that is not 0 (of
   length 1), and of the lengths of the first two derivatives. weights: see mote_path_piece, or
   NULL. Returns a bound of the sizes of all terms of a position. */
double mote_impact_bones_bound(mote_impact_bones *bones, const mote_impact_balls *groups,
                               const mote_field *field, const double *weights, mote_vec3 pivot,
                               mote_vec3 axis, double *sums);

/* A bound of how far apart weights place any point, for weights a and b of [3][padded] or NULL.
 */
double mote_impact_bones_apart(const mote_impact_bones *bones, const mote_field *field,
                               const double *a, const double *b);

#endif
