/* An independent, slow triangle distance, to decide where other methods disagree: every pair of
   features by its textbook formula, in 113 bits where the compiler has them, without any of the
   shortcuts of core/body/triangle.c. */
#ifndef MOTE_BASELINES_WIDE_TRIANGLE_H
#define MOTE_BASELINES_WIDE_TRIANGLE_H

#include "core/base/vec3.h"

#include <stdbool.h>

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 wide;
#else
typedef long double wide;
#endif

typedef struct wide3 {
    wide x, y, z;
} wide3;

static inline wide3 wide_from(mote_vec3 a)
{
    wide3 r = {(wide)a.x, (wide)a.y, (wide)a.z};
    return r;
}

static inline wide3 wide_sub(wide3 a, wide3 b)
{
    wide3 r = {a.x - b.x, a.y - b.y, a.z - b.z};
    return r;
}

/* a + s * b */
static inline wide3 wide_along(wide3 a, wide s, wide3 b)
{
    wide3 r = {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
    return r;
}

static inline wide wide_dot(wide3 a, wide3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline wide3 wide_cross(wide3 a, wide3 b)
{
    wide3 r = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return r;
}

static inline wide wide_min(wide a, wide b)
{
    return a < b ? a : b;
}

/* A square root by two steps of Newton's from the double's. */
static inline double wide_sqrt(wide x)
{
    if (!(x > 0))
        return 0;
    wide y = (wide)sqrt((double)x);
    y = (y + x / y) / 2;
    return (double)((y + x / y) / 2);
}

/* Squared distance from p to the segment a b. */
static inline wide reference_point_segment(wide3 p, wide3 a, wide3 b)
{
    wide3 d = wide_sub(b, a), w = wide_sub(p, a);
    wide dd = wide_dot(d, d), x = dd > 0 ? wide_dot(w, d) / dd : 0;
    x = x < 0 ? 0 : x > 1 ? 1 : x;
    wide3 r = wide_along(w, -x, d);
    return wide_dot(r, r);
}

/* Squared distance from p to the plane of t where it projects inside t, else `best`: by
   repeated projection, from the corner that is opposite the longest edge. */
static inline wide reference_point_face(wide3 p, const wide3 t[3], wide best)
{
    wide longest = -1;
    int corner = 0;
    for (int k = 0; k < 3; k++) {
        wide3 d = wide_sub(t[(k + 2) % 3], t[(k + 1) % 3]);
        if (wide_dot(d, d) > longest) {
            longest = wide_dot(d, d);
            corner = k;
        }
    }
    wide3 o = t[corner], e1 = wide_sub(t[(corner + 1) % 3], o);
    wide3 e2 = wide_sub(t[(corner + 2) % 3], o), w = wide_sub(p, o), left = w;
    wide3 n = wide_cross(e1, e2);
    wide nn = wide_dot(n, n), u = 0, v = 0;
    for (int k = 0; k < 2 && nn > 0; k++) {
        u += wide_dot(wide_cross(left, e2), n) / nn;
        v += wide_dot(wide_cross(e1, left), n) / nn;
        left = wide_along(wide_along(w, -u, e1), -v, e2);
    }
    if (nn > 0 && u >= 0 && v >= 0 && u + v <= 1)
        best = wide_min(best, wide_dot(left, left));
    return best;
}

/* Squared distance from p to the triangle t. */
static inline wide reference_point_triangle(wide3 p, const wide3 t[3])
{
    wide best = reference_point_segment(p, t[0], t[1]);
    best = wide_min(best, reference_point_segment(p, t[1], t[2]));
    best = wide_min(best, reference_point_segment(p, t[2], t[0]));
    return reference_point_face(p, t, best);
}

/* Squared distance between the segments a b and c d where the nearest point of the line of the
   first is inside it, by the normal equations; else `best`. */
static inline wide reference_segments_inside(wide3 a, wide3 b, wide3 c, wide3 d, wide best)
{
    wide3 e = wide_sub(b, a), f = wide_sub(d, c), r = wide_sub(a, c);
    wide ee = wide_dot(e, e), ef = wide_dot(e, f), ff = wide_dot(f, f), det = ee * ff - ef * ef;
    if (!(det > 0))
        return best;
    wide x = (ef * wide_dot(f, r) - wide_dot(e, r) * ff) / det;
    if (x < 0 || x > 1)
        return best;
    return wide_min(best, reference_point_segment(wide_along(a, x, e), c, d));
}

/* Squared distance between the segments a b and c d. */
static inline wide reference_segment_segment(wide3 a, wide3 b, wide3 c, wide3 d)
{
    wide best = reference_point_segment(a, c, d);
    best = wide_min(best, reference_point_segment(b, c, d));
    best = wide_min(best, reference_point_segment(c, a, b));
    best = wide_min(best, reference_point_segment(d, a, b));
    return reference_segments_inside(a, b, c, d, best);
}

/* True if the segment a b meets the triangle t, by the signs of volumes. */
static inline bool reference_pierces(wide3 a, wide3 b, const wide3 t[3])
{
    wide3 n = wide_cross(wide_sub(t[1], t[0]), wide_sub(t[2], t[0])), d = wide_sub(b, a);
    wide ha = wide_dot(n, wide_sub(a, t[0])), hb = wide_dot(n, wide_sub(b, t[0]));
    if ((ha > 0 && hb > 0) || (ha < 0 && hb < 0) || ha == hb)
        return false;
    int positive = 0, negative = 0;
    for (int k = 0; k < 3; k++) {
        wide3 to = wide_sub(t[k], a), edge = wide_sub(t[(k + 1) % 3], t[k]);
        wide volume = wide_dot(d, wide_cross(to, edge));
        positive += volume > 0;
        negative += volume < 0;
    }
    return positive == 0 || negative == 0;
}

/* Squared distance between the triangles s and t, which do not intersect. */
static inline wide reference_apart(const wide3 s[3], const wide3 t[3])
{
    wide best = reference_point_triangle(s[0], t);
    for (int i = 0; i < 3; i++) {
        best = wide_min(best, reference_point_triangle(s[i], t));
        best = wide_min(best, reference_point_triangle(t[i], s));
        for (int j = 0; j < 3; j++)
            best = reference_segments_inside(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3], best);
    }
    return best;
}

/* Squared distance between the triangles s and t; 0 where they intersect. */
static inline wide reference_triangle_triangle(const mote_vec3 s[3], const mote_vec3 t[3])
{
    wide3 a[3] = {wide_from(s[0]), wide_from(s[1]), wide_from(s[2])};
    wide3 b[3] = {wide_from(t[0]), wide_from(t[1]), wide_from(t[2])};
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        if (reference_pierces(a[i], a[next], b) || reference_pierces(b[i], b[next], a))
            return 0;
    }
    return reference_apart(a, b);
}

#endif
