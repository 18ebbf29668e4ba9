#include "datasets/remesh.h"

#include <stdlib.h>
#include <string.h>

#define BUCKETS 64u

/* The edges that a round may collapse, sorted into buckets of squared length. */
typedef struct collapse_round {
    double limit;    /* squared length */
    uint32_t *edges; /* corners opposite, bucket after bucket, by rising index within one */
    size_t edge_count;
    uint8_t *locked; /* [vertex_slots]: changed in this round already */
} collapse_round;

static double edge_square(const mote_surface *s, uint32_t c)
{
    return mote_distance_squared(s->positions[s->vertex[mote_corner_next(c)]],
                                 s->positions[s->vertex[mote_corner_previous(c)]]);
}

/* The bucket of the edge opposite c, or BUCKETS if it is not a candidate. */
static uint32_t edge_bucket(const mote_surface *s, uint32_t c, double limit)
{
    if (s->vertex[c] == MOTE_NO_CORNER || s->opposite[c] < c)
        return BUCKETS;
    const double share = edge_square(s, c) / limit;
    return share < 1 ? (uint32_t)(share * BUCKETS) : BUCKETS;
}

static mote_status gather_edges(const mote_surface *s, collapse_round *r)
{
    size_t start[BUCKETS + 2] = {0};
    const uint32_t corners = (uint32_t)(3 * s->triangle_slots);
    for (uint32_t c = 0; c < corners; c++)
        start[edge_bucket(s, c, r->limit) + 1]++;
    for (uint32_t b = 0; b < BUCKETS; b++)
        start[b + 1] += start[b];
    r->edge_count = start[BUCKETS];
    free(r->edges);
    r->edges = malloc((r->edge_count + 1) * sizeof *r->edges);
    if (!r->edges)
        return mote_fail(MOTE_ENOMEM, "letter: no memory for %zu edges", r->edge_count);
    for (uint32_t c = 0; c < corners; c++) {
        const uint32_t b = edge_bucket(s, c, r->limit);
        if (b < BUCKETS)
            r->edges[start[b]++] = c;
    }
    return MOTE_OK;
}

/* Whether the triangles around u, except those with v, keep their orientation and a reasonable
   shape when u moves to p. */
static bool fan_stays_sound(const mote_surface *s, uint32_t u, uint32_t v, mote_vec3 p,
                            mote_vec3 outward, double limit)
{
    const uint32_t first = s->at_vertex[u];
    const double slant = 0.25 * mote_length_squared(outward);
    uint32_t c = first;
    do {
        const uint32_t n = s->vertex[mote_corner_next(c)];
        const uint32_t m = s->vertex[mote_corner_previous(c)];
        c = mote_corner_swing(s, c);
        if (n == v || m == v)
            continue;
        const mote_vec3 a = mote_sub(s->positions[n], p);
        const mote_vec3 b = mote_sub(s->positions[m], p);
        const mote_vec3 normal = mote_cross(a, b);
        const double side = mote_dot(normal, outward);
        if (side <= 0 || side * side < slant * mote_length_squared(normal))
            return false;
        if (mote_length_squared(a) > 4 * limit)
            return false;
        if (mote_triangle_quality(p, s->positions[n], s->positions[m]) < 0.05)
            return false;
    } while (c != first);
    return true;
}

/* Whether u and v have exactly two common neighbours, each of which keeps at least four
   neighbours. */
static bool may_merge(const mote_surface *s, uint32_t u, uint32_t v, uint8_t *locked)
{
    uint32_t ring_u[MOTE_MAX_VALENCE];
    uint32_t ring_v[MOTE_MAX_VALENCE];
    uint32_t ring_w[MOTE_MAX_VALENCE];
    const size_t count_u = mote_surface_ring(s, u, ring_u);
    const size_t count_v = mote_surface_ring(s, v, ring_v);
    if (count_u + count_v > 13)
        return false;
    size_t common = 0;
    for (size_t i = 0; i < count_u; i++) {
        if (locked[ring_u[i]])
            return false;
        for (size_t j = 0; j < count_v; j++) {
            if (ring_u[i] != ring_v[j])
                continue;
            if (++common > 2 || mote_surface_ring(s, ring_u[i], ring_w) < 5)
                return false;
        }
    }
    for (size_t j = 0; j < count_v; j++)
        if (locked[ring_v[j]])
            return false;
    return common == 2;
}

static bool try_collapse(const mote_glyph *glyph, mote_surface *s, collapse_round *r,
                         uint32_t c)
{
    if (s->vertex[c] == MOTE_NO_CORNER)
        return false;
    const uint32_t u = s->vertex[mote_corner_next(c)];
    const uint32_t v = s->vertex[mote_corner_previous(c)];
    if (r->locked[u] || r->locked[v] || !may_merge(s, u, v, r->locked))
        return false;
    const mote_vec3 middle = mote_scale(mote_add(s->positions[u], s->positions[v]), 0.5);
    mote_vec3 outward;
    const mote_vec3 p = mote_glyph_project(glyph, middle, 3, &outward);
    if (!fan_stays_sound(s, u, v, p, outward, r->limit) ||
        !fan_stays_sound(s, v, u, p, outward, r->limit))
        return false;
    mote_surface_collapse(s, c);
    s->positions[u] = p;
    r->locked[u] = 1;
    return true;
}

static double area(const mote_surface *s)
{
    double sum = 0;
    for (size_t t = 0; t < s->triangle_slots; t++)
        if (s->vertex[3 * t] != MOTE_NO_CORNER)
            sum += 0.5 * mote_length(mote_surface_normal(s, t));
    return sum;
}

static mote_status collapse_rounds(const mote_glyph *glyph, size_t triangle_count,
                                   mote_surface *s, collapse_round *r)
{
    /* The squared edge length of equilateral triangles of the same number and total area. */
    const double ideal = 4 / sqrt(3.0) * area(s) / (double)triangle_count;
    double share = 0.6;
    while (s->live_triangles > triangle_count) {
        const size_t before = s->live_triangles;
        r->limit = share * ideal;
        memset(r->locked, 0, s->vertex_slots);
        const mote_status status = gather_edges(s, r);
        if (status != MOTE_OK)
            return status;
        for (size_t e = 0; e < r->edge_count && s->live_triangles > triangle_count; e++)
            try_collapse(glyph, s, r, r->edges[e]);
        if (before - s->live_triangles < triangle_count / 20 + 2)
            share *= 1.15;
        if (share > 16)
            return mote_fail(
                MOTE_ENUMERIC,
                "letter: no edge can be collapsed below %zu triangles; %zu were asked for",
                s->live_triangles, triangle_count);
        mote_relax_flip(s);
        mote_relax_smooth(glyph, s);
    }
    return MOTE_OK;
}

mote_status mote_simplify(const mote_glyph *glyph, size_t triangle_count, mote_surface *surface)
{
    collapse_round r = {0, 0, 0, malloc(surface->vertex_slots)};
    mote_status status = r.locked ? collapse_rounds(glyph, triangle_count, surface, &r)
                                  : mote_fail(MOTE_ENOMEM, "letter: no memory to simplify");
    free(r.edges);
    free(r.locked);
    return status == MOTE_OK ? mote_surface_compact(surface) : status;
}
