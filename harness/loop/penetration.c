#include "harness/loop/penetration.h"

#include "harness/base/memory.h"

#include "core/body/triangle.h"

#include <stdlib.h>
#include <string.h>

/* This many consecutive triangles of the mesh share a box: most of them are neighbours. */
#define BLOCK 32u

typedef struct box {
    mote_vec3 low, high;
} box;

/* Triangles that a ray from the overlap may hit, sorted into a grid perpendicular to the ray's
   direction, x: entries of cell c are entry[first[c]] .. entry[first[c + 1] - 1]. */
typedef struct shadow {
    const mote_mesh *mesh;
    const mote_vec3 *world;
    box bounds;    /* of the body, then clipped to the other body's: a vertex outside of it is
                      not inside the other body */
    uint32_t side; /* cells along y, and along z */
    uint32_t *met; /* [triangle_count]; the triangles that may be hit */
    uint32_t met_count;
    uint32_t *first; /* [most_side^2 + 1] */
    uint32_t *entry;
    size_t capacity;
    box *blocks;         /* [triangle_count / BLOCK, rounded up] */
    uint32_t deepest[2]; /* the last deepest vertex of the other body, and its nearest triangle:
                            trying these first lets most others be skipped early */
} shadow;

struct mote_penetration {
    shadow of[2];
};

/* For about two triangles per cell. */
static uint32_t side_for(uint32_t triangles)
{
    return 1 + (uint32_t)sqrt(triangles / 2.0);
}

mote_status mote_penetration_create(const mote_mesh *a, const mote_mesh *b,
                                    mote_penetration **penetration)
{
    const mote_mesh *const mesh[2] = {a, b};
    if (a->open_edge_count > 0 || b->open_edge_count > 0)
        return mote_fail(MOTE_EINVAL, "an open mesh has no inside; close it");
    mote_penetration *made = mote_allocate(1, sizeof *made);
    for (int i = 0; i < 2; ++i) {
        shadow *s = &made->of[i];
        s->mesh = mesh[i];
        const size_t side = side_for(mesh[i]->triangle_count);
        s->first = mote_allocate(side * side + 1, sizeof *s->first);
        s->met = mote_allocate(mesh[i]->triangle_count, sizeof *s->met);
        s->blocks = mote_allocate(mesh[i]->triangle_count / BLOCK + 1, sizeof *s->blocks);
    }
    *penetration = made;
    return MOTE_OK;
}

void mote_penetration_destroy(mote_penetration *penetration)
{
    if (!penetration)
        return;
    for (int i = 0; i < 2; ++i) {
        free(penetration->of[i].first);
        free(penetration->of[i].met);
        free(penetration->of[i].entry);
        free(penetration->of[i].blocks);
    }
    free(penetration);
}

static double less(double a, double b)
{
    return b < a ? b : a;
}

static double more(double a, double b)
{
    return b > a ? b : a;
}

static void set_bounds(shadow *s, const mote_vec3 *world)
{
    mote_vec3 low = world[0], high = world[0];
    for (uint32_t v = 1; v < s->mesh->vertex_count; ++v) {
        const mote_vec3 p = world[v];
        low = mote_vec3_make(less(low.x, p.x), less(low.y, p.y), less(low.z, p.z));
        high = mote_vec3_make(more(high.x, p.x), more(high.y, p.y), more(high.z, p.z));
    }
    s->world = world;
    s->bounds = (box){low, high};
}

static box overlap_of(const box *a, const box *b)
{
    return (box){
        {more(a->low.x, b->low.x), more(a->low.y, b->low.y), more(a->low.z, b->low.z)},
        {less(a->high.x, b->high.x), less(a->high.y, b->high.y), less(a->high.z, b->high.z)}};
}

/* Monotone in at, so a point's cell lies between those of its triangle's ends. */
static uint32_t cell_of(const shadow *s, double at, double low, double high)
{
    const double place = high > low ? (at - low) / (high - low) * s->side : 0;
    if (!(place > 0))
        return 0;
    return place >= s->side ? s->side - 1 : (uint32_t)place;
}

/* The bounding box of a triangle. */
static box span_of(const shadow *s, uint32_t triangle)
{
    const uint32_t *t = s->mesh->triangles[triangle];
    const mote_vec3 a = s->world[t[0]], b = s->world[t[1]], c = s->world[t[2]];
    return (box){
        {less(a.x, less(b.x, c.x)), less(a.y, less(b.y, c.y)), less(a.z, less(b.z, c.z))},
        {more(a.x, more(b.x, c.x)), more(a.y, more(b.y, c.y)), more(a.z, more(b.z, c.z))}};
}

static void set_blocks(shadow *s)
{
    for (uint32_t f = 0; f < s->mesh->triangle_count; ++f) {
        const box span = span_of(s, f);
        box *block = &s->blocks[f / BLOCK];
        if (f % BLOCK == 0)
            *block = span;
        block->low =
            mote_vec3_make(less(block->low.x, span.low.x), less(block->low.y, span.low.y),
                           less(block->low.z, span.low.z));
        block->high =
            mote_vec3_make(more(block->high.x, span.high.x), more(block->high.y, span.high.y),
                           more(block->high.z, span.high.z));
    }
}

/* Lists the triangles that rays towards +x from points of the box may hit. */
static void find_met(shadow *s)
{
    const box *within = &s->bounds;
    s->met_count = 0;
    for (uint32_t f = 0; f < s->mesh->triangle_count; ++f) {
        const box span = span_of(s, f);
        if (span.high.x >= within->low.x && span.high.y >= within->low.y &&
            span.low.y <= within->high.y && span.high.z >= within->low.z &&
            span.low.z <= within->high.z)
            s->met[s->met_count++] = f;
    }
    s->side = side_for(s->met_count);
}

typedef struct cell_range {
    uint32_t y0, y1, z0, z1;
} cell_range;

static cell_range cells_of(const shadow *s, uint32_t triangle)
{
    const box *within = &s->bounds, span = span_of(s, triangle);
    return (cell_range){cell_of(s, span.low.y, within->low.y, within->high.y),
                        cell_of(s, span.high.y, within->low.y, within->high.y),
                        cell_of(s, span.low.z, within->low.z, within->high.z),
                        cell_of(s, span.high.z, within->low.z, within->high.z)};
}

/* Counting sort of these triangles into the cells that they may cover. */
static void fill(shadow *s)
{
    const size_t cells = (size_t)s->side * s->side;
    memset(s->first, 0, (cells + 1) * sizeof *s->first);
    for (uint32_t i = 0; i < s->met_count; ++i) {
        const cell_range r = cells_of(s, s->met[i]);
        for (uint32_t y = r.y0; y <= r.y1; ++y) {
            for (uint32_t z = r.z0; z <= r.z1; ++z)
                ++s->first[(size_t)y * s->side + z];
        }
    }
    uint32_t sum = 0;
    for (size_t c = 0; c <= cells; ++c) {
        sum += s->first[c];
        s->first[c] = sum; /* the cell's end: entries are filled in backwards */
    }
    if (sum > s->capacity) {
        s->entry = mote_resize(s->entry, sum, sizeof *s->entry);
        s->capacity = sum;
    }
    for (uint32_t i = 0; i < s->met_count; ++i) {
        const cell_range r = cells_of(s, s->met[i]);
        for (uint32_t y = r.y0; y <= r.y1; ++y) {
            for (uint32_t z = r.z0; z <= r.z1; ++z)
                s->entry[--s->first[(size_t)y * s->side + z]] = s->met[i];
        }
    }
}

/* Whether the edge from a to b crosses the half line from p in +z, seen along x: 1 towards +y,
   -1 towards -y, otherwise 0. The side is computed from the lower vertex number to the higher,
   so both faces of the edge get the same answer. */
static int crossing(const shadow *s, uint32_t a, uint32_t b, mote_vec3 p)
{
    const bool swap = a > b;
    const mote_vec3 u = s->world[swap ? b : a], v = s->world[swap ? a : b];
    if ((u.y <= p.y) == (v.y <= p.y))
        return 0;
    const double area = (v.y - u.y) * (p.z - u.z) - (v.z - u.z) * (p.y - u.y);
    const bool rising = v.y > u.y;
    const bool above = rising ? area < 0 : area > 0; /* the edge is above p in z */
    if (!above)
        return 0;
    return rising == swap ? -1 : 1;
}

/* Whether the triangle, known to be crossed by p's line, is ahead of p. */
static bool is_ahead(const mote_vec3 t[3], mote_vec3 p)
{
    if (t[0].x > p.x && t[1].x > p.x && t[2].x > p.x)
        return true;
    if (t[0].x <= p.x && t[1].x <= p.x && t[2].x <= p.x)
        return false;
    const mote_vec3 normal = mote_cross(mote_sub(t[1], t[0]), mote_sub(t[2], t[0]));
    /* Plane's x on the ray minus p.x, times normal.x. */
    const double offset = mote_dot(normal, mote_sub(t[0], p));
    return normal.x > 0 ? offset > 0 : offset < 0;
}

/* Whether the winding number of the surface around p is not 0. */
static bool is_inside(const shadow *s, mote_vec3 p)
{
    const uint32_t y = cell_of(s, p.y, s->bounds.low.y, s->bounds.high.y);
    const uint32_t z = cell_of(s, p.z, s->bounds.low.z, s->bounds.high.z);
    const size_t cell = (size_t)y * s->side + z;
    int winding = 0;
    for (uint32_t e = s->first[cell]; e < s->first[cell + 1]; ++e) {
        const uint32_t *t = s->mesh->triangles[s->entry[e]];
        const int around = crossing(s, t[0], t[1], p) + crossing(s, t[1], t[2], p) +
                           crossing(s, t[2], t[0], p);
        if (around == 0)
            continue;
        const mote_vec3 corner[3] = {s->world[t[0]], s->world[t[1]], s->world[t[2]]};
        if (is_ahead(corner, p))
            winding += around;
    }
    return winding != 0;
}

/* Squared distance of p from a box, rounded down: a lower bound for everything in it. */
static double box_distance_squared(const box *b, mote_vec3 p)
{
    const mote_vec3 out = mote_vec3_make(more(0, more(b->low.x - p.x, p.x - b->high.x)),
                                         more(0, more(b->low.y - p.y, p.y - b->high.y)),
                                         more(0, more(b->low.z - p.z, p.z - b->high.z)));
    return mote_dot(out, out) * (1 - 1e-12);
}

/* Lowers *best to the squared distance of p from a triangle of a block if that is smaller. */
static void near_block(const shadow *s, uint32_t block, mote_vec3 p, double *best,
                       uint32_t *nearest)
{
    if (box_distance_squared(&s->blocks[block], p) >= *best)
        return;
    const uint32_t count = s->mesh->triangle_count, first = block * BLOCK;
    for (uint32_t f = first; f < first + BLOCK && f < count; ++f) {
        const uint32_t *t = s->mesh->triangles[f];
        const mote_vec3 corner[3] = {s->world[t[0]], s->world[t[1]], s->world[t[2]]};
        const double squared = mote_point_triangle(p, corner, NULL);
        if (squared < *best) {
            *best = squared;
            *nearest = f;
        }
    }
}

/* Squared distance of p from the surface, or anything up to `bound`. *nearest: in: the triangle
   to try first; out: the nearest one. */
static double distance_above(const shadow *s, mote_vec3 p, double bound, uint32_t *nearest)
{
    double best = HUGE_VAL;
    const uint32_t count = (s->mesh->triangle_count + BLOCK - 1) / BLOCK;
    const uint32_t from = *nearest / BLOCK;
    for (uint32_t i = 0; i < count && best > bound; ++i)
        near_block(s, from + i < count ? from + i : from + i - count, p, &best, nearest);
    return best;
}

static bool in_box(const box *within, mote_vec3 p)
{
    return p.x >= within->low.x && p.x <= within->high.x && p.y >= within->low.y &&
           p.y <= within->high.y && p.z >= within->low.z && p.z <= within->high.z;
}

/* Updates the depth with one vertex of the other body. */
static void deepen_by(shadow *s, const shadow *other, uint32_t vertex, uint32_t *nearest,
                      double *squared)
{
    const mote_vec3 p = other->world[vertex];
    if (!in_box(&s->bounds, p) || !is_inside(s, p))
        return;
    const double depth = distance_above(s, p, *squared, nearest);
    if (depth > *squared) {
        *squared = depth;
        s->deepest[0] = vertex;
        s->deepest[1] = *nearest;
    }
}

/* Raises *squared to the squared depth of the deepest vertex of `other` inside s if that is
   deeper. */
static void deepen(shadow *s, const shadow *other, double *squared)
{
    uint32_t v = 0;
    while (v < other->mesh->vertex_count && !in_box(&s->bounds, other->world[v]))
        ++v;
    if (v == other->mesh->vertex_count)
        return;
    find_met(s);
    fill(s);
    set_blocks(s);
    uint32_t nearest = s->deepest[1];
    deepen_by(s, other, s->deepest[0], &nearest, squared);
    for (; v < other->mesh->vertex_count; ++v)
        deepen_by(s, other, v, &nearest, squared);
}

double mote_penetration_depth(mote_penetration *penetration, const mote_vec3 *world_a,
                              const mote_vec3 *world_b, double above)
{
    shadow *a = &penetration->of[0], *b = &penetration->of[1];
    set_bounds(a, world_a);
    set_bounds(b, world_b);
    a->bounds = b->bounds = overlap_of(&a->bounds, &b->bounds);
    double squared = above * above;
    deepen(a, b, &squared);
    deepen(b, a, &squared);
    return squared > above * above ? sqrt(squared) : above;
}
