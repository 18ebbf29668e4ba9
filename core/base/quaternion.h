/* Rotations as quaternions, double precision, by value. Nothing here fails or checks its
   arguments. */
#ifndef MOTE_CORE_QUATERNION_H
#define MOTE_CORE_QUATERNION_H

#include "core/base/vec3.h"

/* w + xi + yj + zk; of length 1 where it stands for a rotation. */
typedef struct mote_quaternion {
    double w, x, y, z;
} mote_quaternion;

/* The rotation b, then a. */
static inline mote_quaternion mote_quaternion_multiply(mote_quaternion a, mote_quaternion b)
{
    mote_quaternion q = {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
                         a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                         a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                         a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
    return q;
}

/* Of length 1; q must not be 0. */
static inline mote_quaternion mote_quaternion_normalise(mote_quaternion q)
{
    const double length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    mote_quaternion unit = {q.w / length, q.x / length, q.y / length, q.z / length};
    return unit;
}

/* The matrix of a quaternion of any length > 0. */
static inline mote_mat3 mote_quaternion_matrix(mote_quaternion q)
{
    const mote_quaternion u = mote_quaternion_normalise(q);
    const double w = u.w, x = u.x, y = u.y, z = u.z;
    mote_mat3 r = {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                    {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                    {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
    return r;
}

#endif
