#include "datasets/polygonise.h"

#include <math.h>
#include <stdlib.h>

/* The letter is symmetric in z, and each of its columns is in one piece. So one number
   describes the inside samples of a grid column, its half height r: levels -r .. r - 1, where
   level k is at z = (k + 1/2) * cell. Cell k of a column of cells lies between levels k and k
   + 1. */
typedef struct grid {
    const mote_glyph *glyph;
    double cell;
    double x0, y0;          /* of column (0, 0) */
    size_t nx, ny;          /* columns; those at the rim are empty */
    int32_t *half_height;   /* [ny * nx] */
    uint32_t *first_vertex; /* [(ny - 1) * (nx - 1)], of the column of cells at (i, j) */
    size_t vertex_count;
    size_t quad_count;
} grid;

static int32_t smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t larger(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static void grid_clear(grid *g)
{
    free(g->half_height);
    free(g->first_vertex);
    g->half_height = 0;
    g->first_vertex = 0;
}

/* Where, at one level, two columns on a diagonal are inside and the two on the other diagonal
   are outside, four sheets would meet in a vertex or an edge. Raising the higher of the outside
   columns avoids that. Returns whether anything changed. */
static bool fill_diagonals(grid *g)
{
    bool changed = false;
    for (size_t j = 0; j + 1 < g->ny; j++) {
        for (size_t i = 0; i + 1 < g->nx; i++) {
            int32_t *a = &g->half_height[j * g->nx + i];
            int32_t *b = a + 1;
            int32_t *c = a + g->nx;
            int32_t *d = c + 1;
            const int32_t rising = smaller(*a, *d);
            const int32_t falling = smaller(*b, *c);
            if (rising > larger(*b, *c))
                *(*b >= *c ? b : c) = rising;
            else if (falling > larger(*a, *d))
                *(*a >= *d ? a : d) = falling;
            else
                continue;
            changed = true;
        }
    }
    return changed;
}

/* Samples the columns at the given cell size and counts the quads. */
static mote_status grid_sample(grid *g, double cell)
{
    const mote_glyph *glyph = g->glyph;
    const double margin = glyph->blend + 2 * cell;
    grid_clear(g);
    g->cell = cell;
    g->nx = (size_t)((glyph->high.x - glyph->low.x + 2 * margin) / cell) + 2;
    g->ny = (size_t)((glyph->high.y - glyph->low.y + 2 * margin) / cell) + 2;
    g->x0 = glyph->low.x - margin;
    g->y0 = glyph->low.y - margin;
    g->half_height = malloc(g->nx * g->ny * sizeof *g->half_height);
    if (!g->half_height)
        return mote_fail(MOTE_ENOMEM, "letter: no memory for a grid of %zu x %zu", g->nx,
                         g->ny);
    for (size_t j = 0; j < g->ny; j++) {
        for (size_t i = 0; i < g->nx; i++) {
            const double x = g->x0 + (double)i * cell;
            const double y = g->y0 + (double)j * cell;
            g->half_height[j * g->nx + i] =
                (int32_t)(mote_glyph_half_height(glyph, x, y) / cell + 0.5);
        }
    }
    while (fill_diagonals(g))
        continue;
    g->quad_count = 0;
    for (size_t j = 0; j + 1 < g->ny; j++) {
        for (size_t i = 0; i + 1 < g->nx; i++) {
            const int32_t *r = &g->half_height[j * g->nx + i];
            g->quad_count +=
                2 * (size_t)(abs(r[0] - r[1]) + abs(r[0] - r[g->nx])) + (r[0] > 0 ? 2 : 0);
        }
    }
    if (g->quad_count == 0)
        return mote_fail(MOTE_ENUMERIC, "letter: a grid of %zu x %zu misses it", g->nx, g->ny);
    return MOTE_OK;
}

/* The smallest and the largest half height of the four columns around a column of cells. */
static void cell_range(const grid *g, size_t i, size_t j, int32_t *low, int32_t *high)
{
    const int32_t *r = &g->half_height[j * g->nx + i];
    const int32_t *s = r + g->nx;
    *low = smaller(smaller(r[0], r[1]), smaller(s[0], s[1]));
    *high = larger(larger(r[0], r[1]), larger(s[0], s[1]));
}

/* Crossed cells of a column are low - 1 .. high - 1, and their mirror images -2 - k. */
static uint32_t cell_vertex(const grid *g, size_t i, size_t j, int32_t k)
{
    int32_t low;
    int32_t high;
    cell_range(g, i, j, &low, &high);
    const uint32_t first = g->first_vertex[j * (g->nx - 1) + i];
    if (k >= low - 1)
        return first + (uint32_t)(k - (low - 1));
    const int32_t above = high - low + 1;
    const int32_t lowest_mirrored = low == 0 ? 0 : low - 1; /* cell -1 is its own image */
    return first + (uint32_t)(above + (-2 - k - lowest_mirrored));
}

static bool inside(int32_t half_height, int32_t level)
{
    return level >= -half_height && level < half_height;
}

/* The mean of the midpoints of the crossed edges of cell k, moved onto the surface. */
static mote_vec3 cell_point(const grid *g, size_t i, size_t j, int32_t k)
{
    bool corner[8];
    for (size_t n = 0; n < 8; n++) {
        const int32_t half_height = g->half_height[(j + n / 2 % 2) * g->nx + i + n % 2];
        corner[n] = inside(half_height, k + (int32_t)(n / 4));
    }
    double sum[3] = {0, 0, 0};
    double crossed = 0;
    for (size_t n = 0; n < 8; n++) {
        for (size_t axis = 0; axis < 3; axis++) {
            const size_t bit = (size_t)1 << axis;
            if ((n & bit) || corner[n] == corner[n | bit])
                continue;
            for (size_t m = 0; m < 3; m++)
                sum[m] += m == axis ? 0.5 : (double)(n >> m & 1);
            crossed += 1;
        }
    }
    const mote_vec3 p = {g->x0 + ((double)i + sum[0] / crossed) * g->cell,
                         g->y0 + ((double)j + sum[1] / crossed) * g->cell,
                         ((double)k + 0.5 + sum[2] / crossed) * g->cell};
    mote_vec3 gradient;
    return mote_glyph_project(g->glyph, p, 4, &gradient);
}

static void number_vertices(grid *g)
{
    g->vertex_count = 0;
    for (size_t j = 0; j + 1 < g->ny; j++) {
        for (size_t i = 0; i + 1 < g->nx; i++) {
            int32_t low;
            int32_t high;
            cell_range(g, i, j, &low, &high);
            g->first_vertex[j * (g->nx - 1) + i] = (uint32_t)g->vertex_count;
            if (high > 0)
                g->vertex_count += 2 * (size_t)(high - low + 1) - (low == 0 ? 1 : 0);
        }
    }
}

static void place_vertices(const grid *g, mote_vec3 *positions)
{
    for (size_t j = 0; j + 1 < g->ny; j++) {
        for (size_t i = 0; i + 1 < g->nx; i++) {
            int32_t low;
            int32_t high;
            cell_range(g, i, j, &low, &high);
            mote_vec3 *out = positions + g->first_vertex[j * (g->nx - 1) + i];
            for (int32_t k = low - 1; high > 0 && k < high; k++)
                *out++ = cell_point(g, i, j, k);
            for (int32_t k = low == 0 ? 0 : low - 1; k < high; k++)
                *out++ = cell_point(g, i, j, -2 - k);
        }
    }
}

/* Appends quad a b c d, counter-clockwise from outside, cut along its shorter diagonal. */
static uint32_t *quad(const mote_vec3 *p, uint32_t *out, const uint32_t q[4], bool reversed)
{
    const uint32_t a = q[0];
    const uint32_t b = reversed ? q[3] : q[1];
    const uint32_t c = q[2];
    const uint32_t d = reversed ? q[1] : q[3];
    const bool ac = mote_distance_squared(p[a], p[c]) <= mote_distance_squared(p[b], p[d]);
    const uint32_t cut[6] = {a, b, ac ? c : d, ac ? a : b, c, d};
    for (size_t k = 0; k < 6; k++)
        *out++ = cut[k];
    return out;
}

/* Quads of the edges along x from column (i, j); they face the column of smaller half height.
 */
static uint32_t *quads_x(const grid *g, const mote_vec3 *p, uint32_t *out, size_t i, size_t j)
{
    const int32_t *r = &g->half_height[j * g->nx + i];
    for (int32_t n = smaller(r[0], r[1]); n < larger(r[0], r[1]); n++) {
        for (int32_t mirrored = 0; mirrored < 2; mirrored++) {
            const int32_t k = mirrored ? -1 - n : n;
            const uint32_t q[4] = {cell_vertex(g, i, j - 1, k - 1), cell_vertex(g, i, j, k - 1),
                                   cell_vertex(g, i, j, k), cell_vertex(g, i, j - 1, k)};
            out = quad(p, out, q, r[1] > r[0]);
        }
    }
    return out;
}

static uint32_t *quads_y(const grid *g, const mote_vec3 *p, uint32_t *out, size_t i, size_t j)
{
    const int32_t here = g->half_height[j * g->nx + i];
    const int32_t there = g->half_height[(j + 1) * g->nx + i];
    for (int32_t n = smaller(here, there); n < larger(here, there); n++) {
        for (int32_t mirrored = 0; mirrored < 2; mirrored++) {
            const int32_t k = mirrored ? -1 - n : n;
            const uint32_t q[4] = {cell_vertex(g, i - 1, j, k - 1), cell_vertex(g, i - 1, j, k),
                                   cell_vertex(g, i, j, k), cell_vertex(g, i, j, k - 1)};
            out = quad(p, out, q, there > here);
        }
    }
    return out;
}

static uint32_t *quads_z(const grid *g, const mote_vec3 *p, uint32_t *out, size_t i, size_t j)
{
    const int32_t r = g->half_height[j * g->nx + i];
    for (int32_t mirrored = 0; r > 0 && mirrored < 2; mirrored++) {
        const int32_t k = mirrored ? -1 - r : r - 1;
        const uint32_t q[4] = {cell_vertex(g, i - 1, j - 1, k), cell_vertex(g, i, j - 1, k),
                               cell_vertex(g, i, j, k), cell_vertex(g, i - 1, j, k)};
        out = quad(p, out, q, mirrored != 0);
    }
    return out;
}

static void make_quads(const grid *g, const mote_vec3 *positions, uint32_t *out)
{
    /* The margin keeps the columns at the rim empty, so none of them has a crossed edge. */
    for (size_t j = 1; j + 1 < g->ny; j++) {
        for (size_t i = 1; i + 1 < g->nx; i++) {
            out = quads_x(g, positions, out, i, j);
            out = quads_y(g, positions, out, i, j);
            out = quads_z(g, positions, out, i, j);
        }
    }
}

/* The number of quads grows with the inverse square of the cell size. */
static mote_status choose_cell(grid *g, size_t triangle_count)
{
    const double coarsest = g->glyph->half_width / 3;
    double cell = coarsest;
    mote_status status = grid_sample(g, cell);
    while (status == MOTE_OK && 2 * g->quad_count < triangle_count) {
        const double share = (double)(2 * g->quad_count) / (double)triangle_count;
        cell *= 0.998 * sqrt(share);
        status = grid_sample(g, cell);
    }
    return status;
}

mote_status mote_polygonise(const mote_glyph *glyph, size_t triangle_count,
                            mote_surface *surface)
{
    grid g = {.glyph = glyph};
    const mote_status status = choose_cell(&g, triangle_count);
    if (status != MOTE_OK) {
        grid_clear(&g);
        return status;
    }
    g.first_vertex = calloc((g.nx - 1) * (g.ny - 1) + 1, sizeof *g.first_vertex);
    uint32_t *vertex = malloc((6 * g.quad_count + 1) * sizeof *vertex);
    if (!g.first_vertex || !vertex)
        goto no_memory;
    number_vertices(&g);
    mote_vec3 *positions = malloc((g.vertex_count + 1) * sizeof *positions);
    if (!positions)
        goto no_memory;
    place_vertices(&g, positions);
    make_quads(&g, positions, vertex);
    const size_t vertex_count = g.vertex_count;
    const size_t made = 2 * g.quad_count;
    grid_clear(&g);
    return mote_surface_link(positions, vertex_count, vertex, made, surface);
no_memory:
    grid_clear(&g);
    free(vertex);
    return mote_fail(MOTE_ENOMEM, "letter: no memory for %zu triangles", 2 * g.quad_count);
}
