/* Random pairs of triangles of every hard sort: slivers, points, parallel, coplanar, touching,
   nearly touching, of very different size. */
#ifndef MOTE_TESTS_TRIANGLE_PAIRS_H
#define MOTE_TESTS_TRIANGLE_PAIRS_H

#include "core/base/vec3.h"

#include <stdint.h>

typedef enum pair_sort {
    PAIR_GENERAL, /* two triangles in the cube of side 2 about 0: a quarter intersect */
    PAIR_BESIDE,  /* one beside the other */
    PAIR_APART,   /* at up to five sizes */
    PAIR_FLAT,    /* the first nearly a segment, its third vertex between the others */
    PAIR_NEEDLE,  /* the second with one very short edge */
    PAIR_BOTH_FLAT,
    PAIR_PARALLEL_EDGES, /* one edge of each nearly parallel */
    PAIR_COPLANAR,       /* both nearly in one plane */
    PAIR_VERTEX_FACE,    /* a vertex nearly on the other's face */
    PAIR_EDGE_EDGE,      /* an edge nearly on an edge */
    PAIR_SIZES,          /* the second much smaller */
    PAIR_PARALLEL_FACES,
    PAIR_SHARED_VERTEX, /* a vertex nearly shared */
    PAIR_SHARED_EDGE,   /* an edge nearly shared */
    PAIR_DEGENERATE,    /* segments and points */
    PAIR_LATTICE,       /* whole coordinates 0 .. 3: exact touching and coplanar pairs */
    PAIR_PIERCED_FLAT,  /* an edge through a sliver, nearly in its plane */
    PAIR_VERTEX_FLAT,   /* a vertex nearly on a sliver */
    PAIR_ULPS,          /* touching within eight units in the last place */
    PAIR_SORTS
} pair_sort;

/* A number in [0, 1) from a linear congruential generator. */
static inline double pair_uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/* A point in the cube of side 2 about 0. */
static inline mote_vec3 pair_point(uint64_t *state)
{
    double x = 2 * pair_uniform(state) - 1, y = 2 * pair_uniform(state) - 1;
    return mote_vec3_make(x, y, 2 * pair_uniform(state) - 1);
}

/* A small number with a logarithm that is uniform between 1e-16 and 1. */
static inline double pair_small(uint64_t *state)
{
    return pow(10, -16 * pair_uniform(state));
}

/* t[0] + u (t[1] - t[0]) + v (t[2] - t[0]) */
static inline mote_vec3 pair_inside(const mote_vec3 t[3], double u, double v)
{
    return mote_add_scaled(mote_add_scaled(t[0], u, mote_sub(t[1], t[0])), v,
                           mote_sub(t[2], t[0]));
}

static inline mote_vec3 pair_near(mote_vec3 p, double small, uint64_t *state)
{
    return mote_add_scaled(p, small, pair_point(state));
}

static inline void pair_move(mote_vec3 t[3], mote_vec3 by)
{
    for (int k = 0; k < 3; k++)
        t[k] = mote_add(t[k], by);
}

/* Presses a triangle towards the plane z = 0. */
static inline void pair_press(mote_vec3 t[3], double factor)
{
    for (int k = 0; k < 3; k++)
        t[k].z *= factor;
}

static inline void pair_flatten(mote_vec3 t[3], uint64_t *state)
{
    double u = pair_uniform(state), small = pair_small(state);
    t[2] = pair_near(pair_inside(t, u, 0), small, state);
}

static inline void pair_pierce_flat(mote_vec3 s[3], mote_vec3 t[3], double small,
                                    uint64_t *state)
{
    pair_flatten(s, state);
    double u = pair_uniform(state), v = pair_uniform(state);
    mote_vec3 p = pair_inside(s, 0.3, 0.4);
    mote_vec3 d = pair_near(mote_sub(pair_inside(s, u, v), p), small, state);
    t[0] = mote_add_scaled(p, -pair_uniform(state), d);
    t[1] = mote_add_scaled(p, pair_uniform(state), d);
}

static inline void pair_degenerate(mote_vec3 s[3], mote_vec3 t[3], uint64_t *state)
{
    s[2] = pair_uniform(state) < 0.5 ? s[0] : s[1];
    if (pair_uniform(state) < 0.5)
        t[1] = t[0];
    if (pair_uniform(state) < 0.3)
        t[2] = t[0];
}

/* A vertex on the other's face or edge, or a shared edge, within a few units in the last
   place. */
static inline void pair_ulps(mote_vec3 s[3], mote_vec3 t[3], double u, uint64_t *state)
{
    double small = floor(9 * pair_uniform(state)) * 0x1p-53;
    int which = (int)(3 * pair_uniform(state));
    if (which == 2)
        t[1] = pair_near(s[1], small, state);
    mote_vec3 at = which == 0 ? pair_inside(s, 0.5 * u, 0.4) : pair_inside(s, u, 0);
    t[0] = pair_near(which == 2 ? s[0] : at, small, state);
}

static inline void pair_lattice(mote_vec3 t[3], uint64_t *state)
{
    for (int k = 0; k < 3; k++) {
        double x = floor(4 * pair_uniform(state)), y = floor(4 * pair_uniform(state));
        t[k] = mote_vec3_make(x, y, floor(4 * pair_uniform(state)));
    }
}

/* Turns the general pair s, t into one of the sort. */
static inline void pair_place(pair_sort sort, mote_vec3 s[3], mote_vec3 t[3], uint64_t *state)
{
    double small = pair_small(state), u = pair_uniform(state);
    switch (sort) {
    case PAIR_BESIDE:
        pair_move(t, mote_vec3_make(2, 0, 0));
        break;
    case PAIR_APART:
        pair_move(t, mote_scale(pair_point(state), 5));
        break;
    case PAIR_BOTH_FLAT:
        pair_flatten(t, state);
        pair_flatten(s, state);
        break;
    case PAIR_FLAT:
        pair_flatten(s, state);
        break;
    case PAIR_NEEDLE:
        t[2] = pair_near(t[1], small, state);
        break;
    case PAIR_PARALLEL_EDGES:
        t[1] = pair_near(mote_add_scaled(t[0], 2 * u - 1, mote_sub(s[1], s[0])), small, state);
        break;
    case PAIR_COPLANAR:
        pair_press(s, small);
        pair_press(t, small);
        break;
    case PAIR_VERTEX_FLAT:
        pair_flatten(s, state);
        pair_move(t, mote_sub(pair_near(pair_inside(s, 0.3, 0.4), small, state), t[0]));
        break;
    case PAIR_VERTEX_FACE:
        pair_move(t, mote_sub(pair_near(pair_inside(s, 0.5 * u, 0.4), small, state), t[0]));
        break;
    case PAIR_EDGE_EDGE:
        pair_move(t, mote_sub(pair_near(pair_inside(s, u, 0), small, state),
                              pair_inside(t, pair_uniform(state), 0)));
        break;
    case PAIR_SIZES:
        for (int k = 0; k < 3; k++)
            t[k] = mote_scale(t[k], small);
        break;
    case PAIR_PARALLEL_FACES:
        for (int k = 0; k < 3; k++) {
            s[k].z = 0;
            t[k].z = 2 * u - 1;
        }
        break;
    case PAIR_SHARED_EDGE:
        t[1] = pair_near(s[1], small, state);
        t[0] = pair_near(s[0], small, state);
        break;
    case PAIR_SHARED_VERTEX:
        t[0] = pair_near(s[0], small, state);
        break;
    case PAIR_DEGENERATE:
        pair_degenerate(s, t, state);
        break;
    case PAIR_LATTICE:
        pair_lattice(s, state);
        pair_lattice(t, state);
        break;
    case PAIR_ULPS:
        pair_ulps(s, t, u, state);
        break;
    case PAIR_PIERCED_FLAT:
        pair_pierce_flat(s, t, small, state);
        break;
    default:
        break;
    }
}

static inline void pair_make(pair_sort sort, mote_vec3 s[3], mote_vec3 t[3], uint64_t *state)
{
    for (int k = 0; k < 3; k++) {
        s[k] = pair_point(state);
        t[k] = pair_point(state);
    }
    pair_place(sort, s, t, state);
}

/* The larger of the longest edge of both and the distance. */
static inline double pair_extent(const mote_vec3 s[3], const mote_vec3 t[3], double distance)
{
    double extent = distance;
    for (int k = 0; k < 3; k++) {
        extent = fmax(extent, mote_length(mote_sub(s[k], s[(k + 1) % 3])));
        extent = fmax(extent, mote_length(mote_sub(t[k], t[(k + 1) % 3])));
    }
    return extent;
}

#endif
