/* Vectors, rotations and poses in three dimensions, double precision, by value. The unit is
   the caller's. Nothing here fails or checks its arguments. */
#ifndef MOTE_CORE_VEC3_H
#define MOTE_CORE_VEC3_H

#include <math.h>
#include <stdbool.h>

typedef struct mote_vec3 {
    double x, y, z;
} mote_vec3;

/* Rows of a matrix: m[row][column]. A rotation is orthonormal with determinant 1. */
typedef struct mote_mat3 {
    double m[3][3];
} mote_mat3;

/* world = rotation * rest + translation */
typedef struct mote_pose {
    mote_mat3 rotation;
    mote_vec3 translation;
} mote_pose;

static inline mote_vec3 mote_vec3_make(double x, double y, double z)
{
    mote_vec3 v = {x, y, z};
    return v;
}

static inline mote_vec3 mote_add(mote_vec3 a, mote_vec3 b)
{
    return mote_vec3_make(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline mote_vec3 mote_sub(mote_vec3 a, mote_vec3 b)
{
    return mote_vec3_make(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline mote_vec3 mote_scale(mote_vec3 a, double s)
{
    return mote_vec3_make(a.x * s, a.y * s, a.z * s);
}

/* a + s * b */
static inline mote_vec3 mote_add_scaled(mote_vec3 a, double s, mote_vec3 b)
{
    return mote_vec3_make(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static inline double mote_dot(mote_vec3 a, mote_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline mote_vec3 mote_cross(mote_vec3 a, mote_vec3 b)
{
    return mote_vec3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double mote_length_squared(mote_vec3 a)
{
    return mote_dot(a, a);
}

/* Whether all three coordinates are finite. */
static inline bool mote_is_finite(mote_vec3 a)
{
    return isfinite(0 * a.x + 0 * a.y + 0 * a.z); /* 0 times any other number is NaN */
}

/* The largest of the coordinates' sizes. */
static inline double mote_largest_coordinate(mote_vec3 v)
{
    const double a = fabs(v.x) > fabs(v.y) ? fabs(v.x) : fabs(v.y);
    return a > fabs(v.z) ? a : fabs(v.z);
}

/* The nearest number of single precision. Where gcc 12 vectorises (double)(float)x, it drops
   both conversions; a volatile float prevents that. */
static inline double mote_as_float(double x)
{
    volatile float rounded = (float)x;
    return (double)rounded;
}

static inline mote_vec3 mote_as_floats(mote_vec3 v)
{
    return mote_vec3_make(mote_as_float(v.x), mote_as_float(v.y), mote_as_float(v.z));
}

static inline double mote_length(mote_vec3 a)
{
    return sqrt(mote_dot(a, a));
}

static inline double mote_distance_squared(mote_vec3 a, mote_vec3 b)
{
    return mote_length_squared(mote_sub(a, b));
}

static inline mote_vec3 mote_rotate(const mote_mat3 *r, mote_vec3 v)
{
    return mote_vec3_make(r->m[0][0] * v.x + r->m[0][1] * v.y + r->m[0][2] * v.z,
                          r->m[1][0] * v.x + r->m[1][1] * v.y + r->m[1][2] * v.z,
                          r->m[2][0] * v.x + r->m[2][1] * v.y + r->m[2][2] * v.z);
}

/* The inverse rotation: transposed times v. */
static inline mote_vec3 mote_rotate_back(const mote_mat3 *r, mote_vec3 v)
{
    return mote_vec3_make(r->m[0][0] * v.x + r->m[1][0] * v.y + r->m[2][0] * v.z,
                          r->m[0][1] * v.x + r->m[1][1] * v.y + r->m[2][1] * v.z,
                          r->m[0][2] * v.x + r->m[1][2] * v.y + r->m[2][2] * v.z);
}

static inline mote_vec3 mote_pose_apply(const mote_pose *pose, mote_vec3 v)
{
    return mote_add(mote_rotate(&pose->rotation, v), pose->translation);
}

#endif
