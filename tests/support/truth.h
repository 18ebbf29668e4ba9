/* The distance of small scenes by all pairs of triangles, without those whose boxes are farther
   apart than the nearest pair: the same number as scene_distance (tests/support/shapes.h), in a
   fraction of the time. Boxes must be apart by 1e-9 L more than that pair, so that no rounding
   can leave out the nearest. */
#ifndef MOTE_TESTS_TRUTH_H
#define MOTE_TESTS_TRUTH_H

#include "core/body/triangle.h"
#include "tests/support/shapes.h"

enum { TRUTH_FACES = 1024 }; /* of a body; larger scenes are left to scene_distance */

typedef struct truth_faces {
    uint32_t count;
    mote_vec3 corner[TRUTH_FACES][3];
    double low[3][TRUTH_FACES], high[3][TRUTH_FACES];
} truth_faces;

static inline void truth_set_faces(const scene *s, int b, truth_faces *f)
{
    f->count = s->mesh[b]->triangle_count;
    for (uint32_t i = 0; i < f->count; ++i) {
        for (int k = 0; k < 3; ++k) {
            const mote_vec3 p = s->world[b][s->mesh[b]->triangles[i][k]];
            const double at[3] = {p.x, p.y, p.z};
            f->corner[i][k] = p;
            for (int axis = 0; axis < 3; ++axis) {
                double *low = &f->low[axis][i], *high = &f->high[axis][i];
                *low = k == 0 || at[axis] < *low ? at[axis] : *low;
                *high = k == 0 || at[axis] > *high ? at[axis] : *high;
            }
        }
    }
}

/* The squares of the distances of one box of f from all boxes of g. */
static inline void truth_gaps(const truth_faces *f, uint32_t i, const truth_faces *g,
                              double *gap)
{
    for (uint32_t j = 0; j < g->count; ++j)
        gap[j] = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = f->low[axis][i], high = f->high[axis][i];
        for (uint32_t j = 0; j < g->count; ++j) {
            const double above = g->low[axis][j] - high, below = low - g->high[axis][j];
            const double apart = above > below ? above : below;
            gap[j] += apart > 0 ? apart * apart : 0;
        }
    }
}

/* A bound to begin with: of the pair whose boxes are nearest. */
static inline double truth_first(const truth_faces *f, const truth_faces *g, double *gap)
{
    double least = HUGE_VAL;
    uint32_t at[2] = {0, 0};
    for (uint32_t i = 0; i < f->count; ++i) {
        truth_gaps(f, i, g, gap);
        for (uint32_t j = 0; j < g->count; ++j) {
            if (gap[j] < least) {
                least = gap[j];
                at[0] = i;
                at[1] = j;
            }
        }
    }
    return mote_triangle_triangle_below(f->corner[at[0]], g->corner[at[1]], HUGE_VAL, NULL,
                                        NULL);
}

static inline double scene_truth(const scene *s)
{
    static truth_faces face[2];
    static double gap[TRUTH_FACES];
    const truth_faces *f = &face[0], *g = &face[1];
    if (s->mesh[0]->triangle_count > TRUTH_FACES || s->mesh[1]->triangle_count > TRUTH_FACES)
        return scene_distance(s);
    for (int b = 0; b < 2; ++b)
        truth_set_faces(s, b, &face[b]);
    double best = truth_first(f, g, gap);
    for (uint32_t i = 0; i < f->count; ++i) {
        truth_gaps(f, i, g, gap);
        for (uint32_t j = 0; j < g->count; ++j) {
            const double reach = sqrt(best) + 1e-9 * s->length;
            if (gap[j] > reach * reach)
                continue;
            const double d =
                mote_triangle_triangle_below(f->corner[i], g->corner[j], best, NULL, NULL);
            best = d < best ? d : best;
        }
    }
    return sqrt(best);
}

#endif
