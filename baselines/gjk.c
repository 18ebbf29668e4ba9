#include "baselines/gjk.h"

#include <stdbool.h>

/* A simplex: up to four points of the difference of the sets, and the point of their hull
   nearest to the origin as their weighted sum. */
typedef struct simplex {
    mote_gjk_point point[4];
    mote_vec3 w[4]; /* a - b */
    double weight[4];
    int count;
} simplex;

static mote_vec3 nearest_point(const simplex *s)
{
    mote_vec3 v = mote_scale(s->w[0], s->weight[0]);
    for (int k = 1; k < s->count; ++k)
        v = mote_add_scaled(v, s->weight[k], s->w[k]);
    return v;
}

static simplex keep(const simplex *s, const int *which, const double *weight, int count)
{
    simplex kept = {.count = count};
    for (int k = 0; k < count; ++k) {
        kept.point[k] = s->point[which[k]];
        kept.w[k] = s->w[which[k]];
        kept.weight[k] = weight[k];
    }
    return kept;
}

/* The part of a segment nearest to the origin. */
static simplex solve_segment(const simplex *s, int i, int j)
{
    mote_vec3 edge = mote_sub(s->w[j], s->w[i]);
    double along = -mote_dot(s->w[i], edge), squared = mote_length_squared(edge);
    if (along <= 0)
        return keep(s, &i, (const double[]){1}, 1);
    if (along >= squared)
        return keep(s, &j, (const double[]){1}, 1);
    double t = along / squared;
    return keep(s, (const int[]){i, j}, (const double[]){1 - t, t}, 2);
}

static bool is_nearer(const simplex *s, const simplex *than)
{
    return mote_length_squared(nearest_point(s)) < mote_length_squared(nearest_point(than));
}

/* The part of a triangle nearest to the origin: its inside where the origin projects there,
   else the best edge. */
static simplex solve_triangle(const simplex *s, int i, int j, int k)
{
    mote_vec3 p = s->w[i], q = s->w[j], r = s->w[k];
    mote_vec3 normal = mote_cross(mote_sub(q, p), mote_sub(r, p));
    double area = mote_length_squared(normal);
    double u = mote_dot(mote_cross(q, r), normal), v = mote_dot(mote_cross(r, p), normal);
    double w = mote_dot(mote_cross(p, q), normal);
    if (area > 0 && u > 0 && v > 0 && w > 0) {
        double sum = u + v + w;
        return keep(s, (const int[]){i, j, k}, (const double[]){u / sum, v / sum, w / sum}, 3);
    }
    simplex best = solve_segment(s, i, j);
    const simplex others[2] = {solve_segment(s, j, k), solve_segment(s, k, i)};
    for (int e = 0; e < 2; ++e) {
        if (is_nearer(&others[e], &best))
            best = others[e];
    }
    return best;
}

/* Whether the origin is on the inner side of face (i, j, k) of the tetrahedron with apex l, or
   on the face's plane. */
static bool is_inside(const simplex *s, int i, int j, int k, int l)
{
    mote_vec3 p = s->w[i];
    mote_vec3 normal = mote_cross(mote_sub(s->w[j], p), mote_sub(s->w[k], p));
    double apex = mote_dot(normal, mote_sub(s->w[l], p)), origin = -mote_dot(normal, p);
    return apex != 0 && (apex > 0 ? origin >= 0 : origin <= 0);
}

/* True where the tetrahedron holds the origin; else *s becomes its part nearest to it. */
static bool solve_tetrahedron(simplex *s)
{
    static const int face[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    simplex best = {.count = 0};
    bool inside = true;
    for (int f = 0; f < 4; ++f) {
        const int *v = face[f];
        if (is_inside(s, v[0], v[1], v[2], v[3]))
            continue;
        inside = false;
        simplex part = solve_triangle(s, v[0], v[1], v[2]);
        if (best.count == 0 || is_nearer(&part, &best))
            best = part;
    }
    if (!inside)
        *s = best;
    return inside;
}

static bool solve(simplex *s)
{
    if (s->count == 2)
        *s = solve_segment(s, 0, 1);
    else if (s->count == 3)
        *s = solve_triangle(s, 0, 1, 2);
    else if (s->count == 4)
        return solve_tetrahedron(s);
    return false;
}

static mote_gjk_result finish(const simplex *s, double distance, double lower,
                              unsigned iterations)
{
    mote_gjk_result result = {.distance = distance, .lower = lower, .iterations = iterations};
    for (int k = 0; k < s->count; ++k) {
        result.witness[0] = mote_add_scaled(result.witness[0], s->weight[k], s->point[k].a);
        result.witness[1] = mote_add_scaled(result.witness[1], s->weight[k], s->point[k].b);
    }
    return result;
}

static void add_point(simplex *s, mote_gjk_point point)
{
    s->point[s->count] = point;
    s->w[s->count] = mote_sub(point.a, point.b);
    s->weight[s->count] = s->count == 0;
    s->count++;
}

mote_gjk_result mote_gjk_distance(mote_gjk_support support, void *context, mote_vec3 start,
                                  double enough, unsigned max_iterations)
{
    simplex s = {.count = 0};
    add_point(&s, support(context, start));
    double lower = 0, size = mote_length(s.w[0]);
    for (unsigned i = 1; i <= max_iterations; ++i) {
        mote_vec3 v = nearest_point(&s);
        const double distance = mote_length(v);
        /* Below the rounding error of the coordinates, a distance cannot be distinguished from
         * 0. */
        if (distance <= 4e-16 * size)
            return finish(&s, 0, 0, i);
        simplex before = s;
        add_point(&s, support(context, mote_scale(v, -1)));
        mote_vec3 w = s.w[s.count - 1];
        size = fmax(size, mote_length(w));
        lower = fmax(lower, mote_dot(v, w) / distance);
        if (lower >= enough || distance - lower <= 1e-12 * distance)
            return finish(&before, distance, fmin(lower, distance), i);
        if (solve(&s))
            return finish(&before, 0, 0, i);
        /* No progress: rounding no longer distinguishes the support points. */
        if (mote_length(nearest_point(&s)) >= distance)
            return finish(&before, distance, fmin(lower, distance), i);
    }
    return finish(&s, mote_length(nearest_point(&s)), lower, max_iterations);
}
