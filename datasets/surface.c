#include "datasets/surface.h"

#include <stdlib.h>

/* Buckets the half-edges by their first vertex, then finds each one's partner in its bucket. */
static mote_status link_corners(mote_surface *s, uint32_t *start, uint32_t *bucket)
{
    const size_t corners = 3 * s->triangle_slots;
    for (size_t c = 0; c < corners; c++)
        start[s->vertex[c] + 1]++;
    for (size_t v = 0; v < s->vertex_slots; v++)
        start[v + 1] += start[v];
    for (uint32_t c = 0; c < corners; c++) {
        bucket[start[s->vertex[c]]++] = c;
        s->at_vertex[s->vertex[c]] = c;
    }
    /* start[v] is now the end of v's bucket, which is the start of the next one's. */
    for (uint32_t c = 0; c < corners; c++) {
        const uint32_t from = s->vertex[mote_corner_next(c)];
        const uint32_t to = s->vertex[mote_corner_previous(c)];
        uint32_t partner = MOTE_NO_CORNER;
        for (uint32_t k = to == 0 ? 0 : start[to - 1]; k < start[to]; k++) {
            if (s->vertex[mote_corner_next(bucket[k])] != from)
                continue;
            if (partner != MOTE_NO_CORNER)
                return mote_fail(MOTE_EINVAL, "surface: edge %u-%u is used twice", to, from);
            partner = mote_corner_previous(bucket[k]);
        }
        if (partner == MOTE_NO_CORNER)
            return mote_fail(MOTE_EINVAL, "surface: edge %u-%u is open", from, to);
        s->opposite[c] = partner;
    }
    return MOTE_OK;
}

mote_status mote_surface_link(mote_vec3 *positions, size_t vertex_count, uint32_t *vertex,
                              size_t triangle_count, mote_surface *surface)
{
    mote_surface s = {vertex_count, triangle_count, triangle_count, positions, vertex, 0, 0};
    const size_t corners = 3 * triangle_count;
    uint32_t *start = calloc(vertex_count + 1, sizeof *start);
    uint32_t *bucket = calloc(corners, sizeof *bucket);
    s.opposite = malloc(corners * sizeof *s.opposite);
    s.at_vertex = malloc(vertex_count * sizeof *s.at_vertex);
    mote_status status = MOTE_OK;
    if (!start || !bucket || !s.opposite || !s.at_vertex)
        status = mote_fail(MOTE_ENOMEM, "surface: no memory for %zu triangles", triangle_count);
    else
        status = link_corners(&s, start, bucket);
    free(start);
    free(bucket);
    if (status != MOTE_OK)
        mote_surface_clear(&s);
    else
        *surface = s;
    return status;
}

void mote_surface_clear(mote_surface *surface)
{
    free(surface->positions);
    free(surface->vertex);
    free(surface->opposite);
    free(surface->at_vertex);
    *surface = (mote_surface){0};
}

size_t mote_surface_ring(const mote_surface *surface, uint32_t v,
                         uint32_t ring[MOTE_MAX_VALENCE])
{
    const uint32_t first = surface->at_vertex[v];
    uint32_t c = first;
    size_t count = 0;
    do {
        if (count == MOTE_MAX_VALENCE)
            return MOTE_MAX_VALENCE + 1;
        ring[count++] = surface->vertex[mote_corner_next(c)];
        c = mote_corner_swing(surface, c);
    } while (c != first);
    return count;
}

bool mote_surface_adjacent(const mote_surface *surface, uint32_t u, uint32_t v)
{
    const uint32_t first = surface->at_vertex[u];
    uint32_t c = first;
    do {
        if (surface->vertex[mote_corner_next(c)] == v)
            return true;
        c = mote_corner_swing(surface, c);
    } while (c != first);
    return false;
}

static void join(mote_surface *s, uint32_t c, uint32_t d)
{
    s->opposite[c] = d;
    s->opposite[d] = c;
}

void mote_surface_flip(mote_surface *surface, uint32_t corner)
{
    /* Triangles (v, a, b) and (w, b, a) become (v, a, w) and (w, b, v). */
    mote_surface *s = surface;
    const uint32_t c = corner;
    const uint32_t cn = mote_corner_next(c);
    const uint32_t cp = mote_corner_previous(c);
    const uint32_t d = s->opposite[c];
    const uint32_t dn = mote_corner_next(d);
    const uint32_t dp = mote_corner_previous(d);
    const uint32_t across_bv = s->opposite[cn];
    const uint32_t across_aw = s->opposite[dn];
    s->vertex[cp] = s->vertex[d];
    s->vertex[dp] = s->vertex[c];
    join(s, c, across_aw);
    join(s, d, across_bv);
    join(s, cn, dn);
    s->at_vertex[s->vertex[c]] = c;
    s->at_vertex[s->vertex[cn]] = cn;
    s->at_vertex[s->vertex[d]] = d;
    s->at_vertex[s->vertex[dn]] = dn;
}

void mote_surface_collapse(mote_surface *surface, uint32_t corner)
{
    /* Triangles (v, a, b) and (w, b, a) are removed; b becomes a. */
    mote_surface *s = surface;
    const uint32_t d = s->opposite[corner];
    const uint32_t a = s->vertex[mote_corner_next(corner)];
    const uint32_t b = s->vertex[mote_corner_previous(corner)];
    const uint32_t first = mote_corner_previous(corner);
    uint32_t c = first;
    do {
        s->vertex[c] = a;
        c = mote_corner_swing(s, c);
    } while (c != first);
    const uint32_t across_va = s->opposite[mote_corner_previous(corner)];
    const uint32_t across_bv = s->opposite[mote_corner_next(corner)];
    const uint32_t across_wb = s->opposite[mote_corner_previous(d)];
    const uint32_t across_aw = s->opposite[mote_corner_next(d)];
    s->at_vertex[a] = mote_corner_next(across_va);
    s->at_vertex[s->vertex[corner]] = mote_corner_previous(across_va);
    s->at_vertex[s->vertex[d]] = mote_corner_next(across_aw);
    s->at_vertex[b] = MOTE_NO_CORNER;
    join(s, across_va, across_bv);
    join(s, across_wb, across_aw);
    for (uint32_t k = 0; k < 3; k++) {
        s->vertex[corner - corner % 3 + k] = MOTE_NO_CORNER;
        s->vertex[d - d % 3 + k] = MOTE_NO_CORNER;
    }
    s->live_triangles -= 2;
}

static void compact_vertices(mote_surface *s, uint32_t *moved)
{
    uint32_t count = 0;
    for (size_t v = 0; v < s->vertex_slots; v++) {
        if (s->at_vertex[v] == MOTE_NO_CORNER)
            continue;
        s->positions[count] = s->positions[v];
        moved[v] = count++;
    }
    s->vertex_slots = count;
    for (size_t c = 0; c < 3 * s->triangle_slots; c++)
        if (s->vertex[c] != MOTE_NO_CORNER)
            s->vertex[c] = moved[s->vertex[c]];
}

static void compact_triangles(mote_surface *s, uint32_t *moved)
{
    uint32_t count = 0;
    for (size_t t = 0; t < s->triangle_slots; t++)
        moved[t] = s->vertex[3 * t] == MOTE_NO_CORNER ? MOTE_NO_CORNER : count++;
    for (size_t t = 0; t < s->triangle_slots; t++) {
        if (moved[t] == MOTE_NO_CORNER)
            continue;
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t across = s->opposite[3 * t + k];
            const uint32_t corner = 3 * moved[t] + k;
            s->vertex[corner] = s->vertex[3 * t + k];
            s->opposite[corner] = 3 * moved[across / 3] + across % 3;
            s->at_vertex[s->vertex[corner]] = corner;
        }
    }
    s->triangle_slots = count;
}

mote_status mote_surface_compact(mote_surface *surface)
{
    const size_t slots = surface->vertex_slots > surface->triangle_slots
                             ? surface->vertex_slots
                             : surface->triangle_slots;
    uint32_t *moved = malloc(slots * sizeof *moved);
    if (!moved)
        return mote_fail(MOTE_ENOMEM, "surface: no memory to compact %zu slots", slots);
    compact_vertices(surface, moved);
    compact_triangles(surface, moved);
    free(moved);
    return MOTE_OK;
}

mote_vec3 mote_surface_normal(const mote_surface *surface, size_t t)
{
    const mote_vec3 a = surface->positions[surface->vertex[3 * t]];
    const mote_vec3 b = surface->positions[surface->vertex[3 * t + 1]];
    const mote_vec3 c = surface->positions[surface->vertex[3 * t + 2]];
    return mote_cross(mote_sub(b, a), mote_sub(c, a));
}

double mote_triangle_quality(mote_vec3 a, mote_vec3 b, mote_vec3 c)
{
    const mote_vec3 ab = mote_sub(b, a);
    const mote_vec3 ac = mote_sub(c, a);
    const double area = mote_length_squared(mote_cross(ab, ac));
    const double x = mote_length_squared(ab);
    const double y = mote_length_squared(ac);
    const double z = mote_distance_squared(b, c);
    const double yz = y > z ? y : z;
    const double least = x < y ? (x < z ? x : z) : (y < z ? y : z);
    const double most = x > yz ? x : yz;
    const double middle = x + y + z - least - most;
    return area > 0 ? area / (middle * most) : 0;
}
