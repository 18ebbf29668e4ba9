#include "core/impact/impact_leaf.h"

#include "core/base/clones.h"
#include "core/body/triangle.h"

#include <math.h>

/* Steps of a pair of triangles, at most; what the last one shows counts even if more would
   follow. */
#define STEPS_MOST 12

/* A pair is left where a step gains less than this part of what is left of the step. */
#define GAIN_LEAST 1e-3

/* Until which s >= now g + m s - bend s^2, which is concave, stays above 0; 0 where it is not
   above 0 at `now`. */
static double root_of(double g, double m, double bend, double now)
{
    const double square = m * m + 4 * bend * g;
    if (!(g + (m - bend * now) * now > 0) || !(square > 0))
        return 0;
    const double root = sqrt(square);
    return m >= 0 ? (m + root) / (2 * bend) : 2 * g / (root - m);
}

/* Until when all vertices of b stay farther than the tolerance from all of a along n, from
   `now` on; 0 where they are not at `now`, as n is rounded: along it, ends of long triangles
   that are nearly parallel may reach beyond each other. */
static double apart_along(const mote_moving_triangle *a, const mote_moving_triangle *b,
                          mote_vec3 n, const mote_leaf_question *question, double now)
{
    double until = HUGE_VAL;
    double pa[3], da[3];
    for (int i = 0; i < 3; ++i) {
        pa[i] = mote_dot(n, a->p[i]);
        da[i] = mote_dot(n, a->d[i]);
    }
    for (int j = 0; j < 3; ++j) {
        const double pb = mote_dot(n, b->p[j]) - question->tolerance;
        const double db = mote_dot(n, b->d[j]);
        for (int i = 0; i < 3; ++i)
            until = fmin(until, root_of(pb - pa[i], db - da[i], question->bend, now));
    }
    return until;
}

/* Whether all of b stays farther than that from all of a along n, up to the part: the gap, less
   its bend, is concave, and least at one of both ends. */
static bool stays_apart(const mote_moving_triangle *a, const mote_moving_triangle *b,
                        mote_vec3 n, const mote_leaf_question *question, double part)
{
    double near[2] = {-HUGE_VAL, -HUGE_VAL}, far[2] = {HUGE_VAL, HUGE_VAL};
    for (int i = 0; i < 3; ++i) {
        const double pa = mote_dot(n, a->p[i]), pb = mote_dot(n, b->p[i]);
        const double ea = pa + part * mote_dot(n, a->d[i]);
        const double eb = pb + part * mote_dot(n, b->d[i]);
        near[0] = pa > near[0] ? pa : near[0];
        near[1] = ea > near[1] ? ea : near[1];
        far[0] = pb < far[0] ? pb : far[0];
        far[1] = eb < far[1] ? eb : far[1];
    }
    return far[0] - near[0] > question->tolerance &&
           far[1] - near[1] > question->tolerance + question->bend * part * part;
}

static void place(const mote_moving_triangle *t, double s, mote_vec3 at[3])
{
    for (int k = 0; k < 3; ++k)
        at[k] = mote_add_scaled(t->p[k], s, t->d[k]);
}

/* A bound on how far the two come together over the whole step. */
static double closing(const mote_moving_triangle *a, const mote_moving_triangle *b)
{
    double own = 0, other = 0;
    for (int i = 1; i < 3; ++i) {
        own = fmax(own, mote_distance_squared(a->d[i], a->d[0]));
        other = fmax(other, mote_distance_squared(b->d[i], b->d[0]));
    }
    return mote_length(mote_sub(b->d[0], a->d[0])) + sqrt(own) + sqrt(other);
}

double mote_moving_triangles(const mote_moving_triangle *a, const mote_moving_triangle *b,
                             mote_leaf_question *q, double part, uint64_t *tests)
{
    if (stays_apart(a, b, q->apart, q, part))
        return part;
    const double speed = closing(a, b);
    double s = 0;
    for (int step = 0; step < STEPS_MOST; ++step) {
        mote_vec3 at[2][3], w[2];
        place(a, s, at[0]);
        place(b, s, at[1]);
        /* too far apart to come together in what is left? */
        const double far =
            (q->tolerance + q->bend * part * part + (part - s) * speed) * (1 + 1e-12);
        ++*tests;
        const double squared =
            mote_triangle_triangle_below(at[0], at[1], far * far, &w[0], &w[1]);
        if (squared >= far * far)
            return part;
        if (!(squared > 0))
            return s;
        const mote_vec3 n = mote_scale(mote_sub(w[1], w[0]), 1 / sqrt(squared));
        const double until = apart_along(a, b, n, q, s) * (1 - 1e-12);
        if (until >= part) {
            q->apart = n;
            return part;
        }
        if (until - s < GAIN_LEAST * (part - s))
            return fmax(s, until);
        s = until;
    }
    return s;
}

static double most_of(double a, double b)
{
    return a > b ? a : b;
}

static mote_vec3 vertex_of(const double p[3][MOTE_CERT_LEAF_VERTICES], uint32_t i)
{
    return mote_vec3_make(p[0][i], p[1][i], p[2][i]);
}

static void load_triangle(const mote_moving_leaf *leaf, uint32_t triangle,
                          mote_moving_triangle *t)
{
    for (int k = 0; k < 3; ++k) {
        t->p[k] = vertex_of(leaf->p, leaf->corners[triangle][k]);
        t->d[k] = vertex_of(leaf->d, leaf->corners[triangle][k]);
    }
}

/* How far each vertex comes along u over the part of the step; returns the most. */
MOTE_CLONES
static double reach_along(const mote_moving_leaf *restrict leaf, mote_vec3 u, double part,
                          double reach[MOTE_CERT_LEAF_VERTICES])
{
    for (size_t i = 0; i < MOTE_CERT_LEAF_VERTICES; ++i) {
        const double start = u.x * leaf->p[0][i] + u.y * leaf->p[1][i] + u.z * leaf->p[2][i];
        const double step = u.x * leaf->d[0][i] + u.y * leaf->d[1][i] + u.z * leaf->d[2][i];
        const double end = start + part * step;
        reach[i] = start > end ? start : end;
    }
    double most = reach[0];
    for (size_t i = 1; i < MOTE_CERT_LEAF_VERTICES; ++i)
        most = reach[i] > most ? reach[i] : most;
    return most;
}

/* The ball around triangle i and its motion. */
static void add_ball(mote_moving_leaf *leaf, uint32_t i)
{
    mote_moving_triangle t;
    load_triangle(leaf, i, &t);
    const mote_vec3 p = mote_scale(mote_add(t.p[0], mote_add(t.p[1], t.p[2])), 1.0 / 3);
    const mote_vec3 d = mote_scale(mote_add(t.d[0], mote_add(t.d[1], t.d[2])), 1.0 / 3);
    double radius = 0, moved = 0;
    for (int k = 0; k < 3; ++k) {
        radius = most_of(radius, mote_distance_squared(t.p[k], p));
        moved = most_of(moved, mote_distance_squared(t.d[k], d));
    }
    leaf->middle[0][i] = p.x;
    leaf->middle[1][i] = p.y;
    leaf->middle[2][i] = p.z;
    leaf->moved[0][i] = d.x;
    leaf->moved[1][i] = d.y;
    leaf->moved[2][i] = d.z;
    leaf->radius[i] = (sqrt(radius) + leaf->part * sqrt(moved)) * (1 + 1e-12);
}

void mote_moving_leaf_load(mote_cert_side *side, mote_lazy *moved, int32_t leaf,
                           mote_vec3 facing, double part, mote_moving_leaf *out)
{
    const mote_cert_tree *tree = side->tree;
    const mote_cert_leaf *own = &tree->leaves[leaf];
    const uint32_t *vertices = tree->leaf_vertices + own->first_vertex;
    out->number = leaf;
    out->vertices = own->vertex_count;
    out->triangles = own->triangle_count;
    out->corners = (const uint8_t(*)[3])tree->corners + own->first_corner;
    out->part = part;
    mote_lazy_fetch(&side->lazy, vertices, own->vertex_count);
    mote_lazy_fetch(moved, vertices, own->vertex_count);
    for (uint32_t i = 0; i < MOTE_CERT_LEAF_VERTICES; ++i) {
        const uint32_t v = vertices[i < out->vertices ? i : out->vertices - 1];
        const mote_vec3 p = mote_lazy_position(&side->lazy, v),
                        d = mote_lazy_position(moved, v);
        out->p[0][i] = p.x;
        out->p[1][i] = p.y;
        out->p[2][i] = p.z;
        out->d[0][i] = d.x;
        out->d[1][i] = d.y;
        out->d[2][i] = d.z;
    }
    double reach[MOTE_CERT_LEAF_VERTICES];
    out->reach = reach_along(out, facing, part, reach);
    for (uint32_t t = 0; t < out->triangles; ++t) {
        const uint8_t *c = out->corners[t];
        add_ball(out, t);
        out->along[t] = most_of(reach[c[0]], most_of(reach[c[1]], reach[c[2]]));
    }
}

/* Which triangles of the second leaf may come nearer to triangle a of the first than `need`. */
MOTE_CLONES
static uint32_t near_triangles(const mote_moving_leaf *restrict first, uint32_t a,
                               const mote_moving_leaf *restrict second, double part,
                               double need)
{
    const double along = first->along[a] + need, own = first->radius[a] + need;
    double spare[MOTE_CERT_LEAF_TRIANGLES];
    for (size_t b = 0; b < MOTE_CERT_LEAF_TRIANGLES; ++b) {
        const double x = second->middle[0][b] - first->middle[0][a];
        const double y = second->middle[1][b] - first->middle[1][a];
        const double z = second->middle[2][b] - first->middle[2][a];
        const double dx = second->moved[0][b] - first->moved[0][a];
        const double dy = second->moved[1][b] - first->moved[1][a];
        const double dz = second->moved[2][b] - first->moved[2][a];
        /* where the middles are nearest to each other, held within the part */
        double s = -(x * dx + y * dy + z * dz) / (dx * dx + dy * dy + dz * dz + 0x1p-900);
        s = s > 0 ? s : 0;
        s = s < part ? s : part;
        const double cx = x + s * dx, cy = y + s * dy, cz = z + s * dz;
        const double sum = (own + second->radius[b]) * (1 + 1e-12);
        const double ball = cx * cx + cy * cy + cz * cz - sum * sum;
        const double plane = -(along + second->along[b]);
        spare[b] = ball > plane ? ball : plane;
    }
    uint32_t bits = 0;
    for (uint32_t b = 0; b < second->triangles; ++b)
        bits |= spare[b] > 0 ? 0 : 1u << b;
    return bits;
}

/* The middle of a leaf's first and last vertices in the middle of the part: about its place. */
static mote_vec3 place_of(const mote_moving_leaf *leaf, double part)
{
    mote_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < MOTE_CERT_LEAF_VERTICES; i += 4)
        sum = mote_add(
            sum, mote_add_scaled(vertex_of(leaf->p, i), 0.5 * part, vertex_of(leaf->d, i)));
    return mote_scale(sum, 4.0 / MOTE_CERT_LEAF_VERTICES);
}

/* Whether the leaves are apart along the line between their places; not where these are one. */
static bool apart_by_places(const mote_moving_leaf *first, const mote_moving_leaf *second,
                            double part, double need)
{
    const mote_vec3 u = mote_sub(place_of(second, part), place_of(first, part));
    double reach[MOTE_CERT_LEAF_VERTICES];
    const double sum = reach_along(first, u, part, reach) +
                       reach_along(second, mote_scale(u, -1), part, reach);
    return sum + need * (mote_length(u) + 0x1p-500) < 0;
}

double mote_moving_leaves(const mote_moving_leaf *first, const mote_moving_leaf *second,
                          mote_leaf_question *q, double part, uint64_t *tests)
{
    /* lengths of directions are rounded by less than the noise in the tolerance */
    const double need = q->tolerance + q->bend * part * part;
    if (first->reach + second->reach + need < 0 || apart_by_places(first, second, part, need))
        return part;
    for (uint32_t a = 0; a < first->triangles; ++a) {
        if (first->along[a] + second->reach + need < 0)
            continue;
        uint32_t near = near_triangles(first, a, second, part, need);
        mote_moving_triangle t[2];
        if (near)
            load_triangle(first, a, &t[0]);
        for (; near && part > 0; near &= near - 1) {
            load_triangle(second, (uint32_t)__builtin_ctz(near), &t[1]);
            part = mote_moving_triangles(&t[0], &t[1], q, part, tests);
        }
    }
    return part;
}
