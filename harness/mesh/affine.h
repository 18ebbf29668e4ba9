/* Affine maps of space, three rows of four numbers: x -> A x + t. */
#ifndef MOTE_HARNESS_AFFINE_H
#define MOTE_HARNESS_AFFINE_H

#include "core/base/vec3.h"

#include <stdbool.h>

typedef struct mote_affine {
    double m[3][4];
} mote_affine;

static inline mote_affine mote_affine_identity(void)
{
    mote_affine i = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    return i;
}

/* a after b: applies b first. */
static inline mote_affine mote_affine_multiply(const mote_affine *a, const mote_affine *b)
{
    mote_affine p;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            p.m[r][c] = a->m[r][0] * b->m[0][c] + a->m[r][1] * b->m[1][c] +
                        a->m[r][2] * b->m[2][c] + (c == 3 ? a->m[r][3] : 0);
    }
    return p;
}

/* Maps a direction: without the translation. */
static inline mote_vec3 mote_affine_turn(const mote_affine *a, mote_vec3 v)
{
    return mote_vec3_make(a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
                          a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
                          a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z);
}

static inline mote_vec3 mote_affine_apply(const mote_affine *a, mote_vec3 v)
{
    return mote_add(mote_affine_turn(a, v), mote_vec3_make(a->m[0][3], a->m[1][3], a->m[2][3]));
}

static inline bool mote_affine_is_finite(const mote_affine *a)
{
    double sum = 0;
    for (int k = 0; k < 12; ++k)
        sum += a->m[k / 4][k % 4] * 0;
    return sum == 0;
}

/* False, with *inverse unchanged, if the map is singular: if it shrinks volumes by more than
   1e12 relative to the product of its columns' lengths. */
static inline bool mote_affine_invert(const mote_affine *a, mote_affine *inverse)
{
    const mote_vec3 x = mote_vec3_make(a->m[0][0], a->m[1][0], a->m[2][0]);
    const mote_vec3 y = mote_vec3_make(a->m[0][1], a->m[1][1], a->m[2][1]);
    const mote_vec3 z = mote_vec3_make(a->m[0][2], a->m[1][2], a->m[2][2]);
    const mote_vec3 rows[3] = {mote_cross(y, z), mote_cross(z, x), mote_cross(x, y)};
    const double volume = mote_dot(x, rows[0]);
    if (!(fabs(volume) > 1e-12 * mote_length(x) * mote_length(y) * mote_length(z)) ||
        !isfinite(1 / volume))
        return false;
    mote_affine made;
    for (int r = 0; r < 3; ++r) {
        const mote_vec3 row = mote_scale(rows[r], 1 / volume);
        made.m[r][0] = row.x;
        made.m[r][1] = row.y;
        made.m[r][2] = row.z;
        made.m[r][3] = -(row.x * a->m[0][3] + row.y * a->m[1][3] + row.z * a->m[2][3]);
    }
    *inverse = made;
    return true;
}

#endif
