/* That two small bodies stay apart on their paths, proven in another way than by
   mote_impact_query: by interval arithmetic over pieces of time that are halved, without
   distances and without bounds of speeds. For a piece of time every vertex is enclosed in a
   box: cubics by the control points of their part, rotations by the ranges of their entries.
   Two triangles are apart where the boxes of their differences have a direction along which all
   are farther than the tolerance. */
#ifndef MOTE_TESTS_INTERVAL_IMPACT_H
#define MOTE_TESTS_INTERVAL_IMPACT_H

#include "core/body/path_place.h"
#include "core/body/triangle.h"
#include "tests/support/shapes.h"

#include <math.h>
#include <stdlib.h>

/* Pieces of time are halved down to this width. */
#define INTERVAL_LEAST 0x1p-22

typedef struct range {
    double low, high;
} range;

/* Rounding, as a part of the largest number in a sum: more than what a few operations make. */
#define RANGE_SLACK 1e-13

static inline range range_of(double a, double b)
{
    return (range){fmin(a, b), fmax(a, b)};
}

static inline range range_add(range a, range b)
{
    return (range){a.low + b.low, a.high + b.high};
}

static inline range range_times(range a, range b)
{
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    return (range){fmin(fmin(p, q), fmin(r, s)), fmax(fmax(p, q), fmax(r, s))};
}

static inline range range_scale(range a, double f)
{
    return range_of(a.low * f, a.high * f);
}

/* The cubic with control points b over the part [u, v] of its time. */
static inline range range_cubic(const double b[4], double u, double v)
{
    range all = {HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 4; ++i) { /* the blossom at i times v and 3 - i times u */
        double c[4] = {b[0], b[1], b[2], b[3]};
        for (int level = 0; level < 3; ++level) {
            const double t = level < i ? v : u;
            for (int k = 0; k < 3 - level; ++k)
                c[k] = (1 - t) * c[k] + t * c[k + 1];
        }
        all.low = fmin(all.low, c[0]);
        all.high = fmax(all.high, c[0]);
    }
    return all;
}

/* The entries of the rotation of a piece with cubic quaternions, over a part of its time. */
static inline void range_rotation(const mote_path_piece *piece, double u, double v,
                                  range entry[3][3])
{
    const mote_quaternion *t = piece->turn;
    const double w[4] = {t[0].w, t[1].w, t[2].w, t[3].w};
    const double x[4] = {t[0].x, t[1].x, t[2].x, t[3].x};
    const double y[4] = {t[0].y, t[1].y, t[2].y, t[3].y};
    const double z[4] = {t[0].z, t[1].z, t[2].z, t[3].z};
    const range q[4] = {range_cubic(w, u, v), range_cubic(x, u, v), range_cubic(y, u, v),
                        range_cubic(z, u, v)};
    range square[4], norm = {0, 0};
    for (int k = 0; k < 4; ++k) {
        square[k] = range_times(q[k], q[k]);
        square[k].low = fmax(square[k].low, 0);
        norm = range_add(norm, square[k]);
    }
    const range inverse = {1 / norm.high, norm.low > 0 ? 1 / norm.low : HUGE_VAL};
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const range turned = range_add(square[j + 1], square[k + 1]);
        entry[i][i] = range_times(range_scale(turned, -2), inverse);
        entry[i][i] = range_add(entry[i][i], (range){1, 1});
        const range product = range_times(q[i + 1], q[j + 1]),
                    rest = range_times(q[0], q[k + 1]);
        entry[i][j] =
            range_times(range_scale(range_add(product, range_scale(rest, -1)), 2), inverse);
        entry[j][i] = range_times(range_scale(range_add(product, rest), 2), inverse);
    }
}

typedef struct range_vector {
    range c[3];
} range_vector;

/* Where vertex i of a body is over a part of a piece. */
static inline range_vector range_vertex(const mote_body *body, const mote_path *path,
                                        uint32_t piece, double u, double v, uint32_t i)
{
    const mote_path_piece *at = &path->pieces[piece];
    const size_t padded = body->field->padded;
    const mote_vec3 rest = mote_sub(body->mesh->positions[i], path->pivot);
    range_vector local = {{{rest.x, rest.x}, {rest.y, rest.y}, {rest.z, rest.z}}}, world;
    double *phi = calloc(padded + 1, sizeof *phi);
    need(phi);
    if (body->field->count > 0)
        body->field->kind->basis(body->field, body->mesh, i, phi);
    for (size_t j = 0; j < body->field->count && at->weights; ++j) {
        for (size_t c = 0; c < 3; ++c) {
            double b[4];
            for (size_t k = 0; k < 4; ++k)
                b[k] = at->weights[3 * padded * k + c * padded + j];
            local.c[c] = range_add(local.c[c], range_scale(range_cubic(b, u, v), phi[j]));
        }
    }
    free(phi);
    range entry[3][3];
    range_rotation(at, u, v, entry);
    for (int r = 0; r < 3; ++r) {
        const double b[4] = {r == 0   ? at->centre[0].x
                             : r == 1 ? at->centre[0].y
                                      : at->centre[0].z,
                             r == 0   ? at->centre[1].x
                             : r == 1 ? at->centre[1].y
                                      : at->centre[1].z,
                             r == 0   ? at->centre[2].x
                             : r == 1 ? at->centre[2].y
                                      : at->centre[2].z,
                             r == 0   ? at->centre[3].x
                             : r == 1 ? at->centre[3].y
                                      : at->centre[3].z};
        world.c[r] = range_cubic(b, u, v);
        for (int c = 0; c < 3; ++c)
            world.c[r] = range_add(world.c[r], range_times(entry[r][c], local.c[c]));
    }
    return world;
}

static inline mote_vec3 range_middle(const range_vector *r)
{
    return mote_vec3_make(0.5 * (r->c[0].low + r->c[0].high),
                          0.5 * (r->c[1].low + r->c[1].high),
                          0.5 * (r->c[2].low + r->c[2].high));
}

/* Whether all points of b are farther than the tolerance in front of all of a, along n. */
static inline bool range_in_front(const range_vector *a[3], const range_vector *b[3],
                                  mote_vec3 n, double tolerance)
{
    const double along[3] = {n.x, n.y, n.z};
    double most = -HUGE_VAL, least = HUGE_VAL, size = tolerance;
    for (int k = 0; k < 3; ++k) {
        double of_a = 0, of_b = 0;
        for (int c = 0; c < 3; ++c) {
            of_a += range_scale(a[k]->c[c], along[c]).high;
            of_b += range_scale(b[k]->c[c], along[c]).low;
            size += fabs(a[k]->c[c].high) + fabs(b[k]->c[c].low);
        }
        most = fmax(most, of_a);
        least = fmin(least, of_b);
    }
    return least - most > tolerance * (1 + RANGE_SLACK) + RANGE_SLACK * size;
}

/* Whether two triangles are apart, by the direction between their nearest points in the middle
   of the time. */
static inline bool range_apart(const range_vector *a[3], const range_vector *b[3],
                               double tolerance)
{
    mote_vec3 s[3], t[3], p, q;
    for (int k = 0; k < 3; ++k) {
        s[k] = range_middle(a[k]);
        t[k] = range_middle(b[k]);
    }
    const double d = sqrt(mote_triangle_triangle(s, t, &p, &q));
    return d > 0 && range_in_front(a, b, mote_scale(mote_sub(q, p), 1 / d), tolerance);
}

typedef struct interval_question {
    const mote_body *body[2];
    const mote_path *path[2];
    double tolerance;
} interval_question;

/* Whether the bodies are apart over the part [u, v] of a piece. */
static inline bool interval_shows(const interval_question *q, uint32_t piece, double u,
                                  double v)
{
    range_vector *at[2];
    for (int i = 0; i < 2; ++i) {
        const uint32_t count = q->body[i]->mesh->vertex_count;
        at[i] = calloc(count, sizeof *at[i]);
        need(at[i]);
        for (uint32_t k = 0; k < count; ++k)
            at[i][k] = range_vertex(q->body[i], q->path[i], piece, u, v, k);
    }
    bool apart = true;
    for (uint32_t f = 0; f < q->body[0]->mesh->triangle_count && apart; ++f) {
        for (uint32_t g = 0; g < q->body[1]->mesh->triangle_count && apart; ++g) {
            const uint32_t *s = q->body[0]->mesh->triangles[f];
            const uint32_t *t = q->body[1]->mesh->triangles[g];
            const range_vector *a[] = {&at[0][s[0]], &at[0][s[1]], &at[0][s[2]]};
            const range_vector *b[] = {&at[1][t[0]], &at[1][t[1]], &at[1][t[2]]};
            apart = range_apart(a, b, q->tolerance);
        }
    }
    free(at[0]);
    free(at[1]);
    return apart;
}

/* The time up to which the bodies are shown to be apart over [u, v] of a piece; v: all of it.
 */
static inline double interval_until(const interval_question *q, uint32_t piece, double u,
                                    double v)
{
    if (interval_shows(q, piece, u, v))
        return v;
    if (v - u <= INTERVAL_LEAST)
        return u;
    const double middle = 0.5 * (u + v);
    const double reached = interval_until(q, piece, u, middle);
    return reached < middle ? reached : interval_until(q, piece, middle, v);
}

/* The time of the paths, 0 .. 1, up to which the bodies are proven to be apart by more than the
   tolerance. Of pieces with cubic quaternions. */
static inline double interval_apart_until(const interval_question *q)
{
    const uint32_t count = q->path[0]->count;
    for (uint32_t k = 0; k < count; ++k) {
        const double reached = interval_until(q, k, 0, 1);
        if (reached < 1)
            return (k + reached) / count;
    }
    return 1;
}

#endif
