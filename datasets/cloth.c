/* Square cloths: one that falls over a letter and onto the floor around it, where it comes to
   rest at its thickness from the letter everywhere, and a banner that is held along one edge
   and blown over the letter, which it touches with a few folds only.

   Position-based dynamics (Mueller et al., 2007) on a grid: distances along the edges, across
   the squares, and, weakly, to the next but one vertex, which resists bending. The cloth
   collides with the letter, an implicit surface that does not move, with friction. It does not
   collide with itself.

   The grid that is simulated has at most GRID squares an edge: a finer one would need more
   iterations to be as stiff. Larger cloths are refined from it by cubic curves (Catmull and
   Rom) in both directions, and their vertices then kept off the letter one by one. */
#include "datasets/glyph.h"
#include "datasets/simulated.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GRID 77 /* 11,858 triangles */
#define EDGE 1.1
#define HEIGHT 0.3     /* of the middle at frame 1 */
#define GRAVITY 3e-4   /* L a frame, a frame */
#define SUBSTEPS 8     /* a frame */
#define ITERATIONS 3   /* a substep */
#define KEPT 0.999     /* of the velocity, a substep */
#define BENDING 0.02   /* of a correction; 1 elsewhere */
#define SHEARING 0.5   /* likewise */
#define SETTLED 0.0068 /* about the least distance from the letter: half of a thickness */
#define BLOWN 0.03     /* of the banner: as solvers keep it, against folds that pass through */
#define FRICTION 0.4   /* of the way along the surface, a substep */
#define FLOOR (-0.25)  /* height */
#define AIR 0.4        /* of the wind's velocity across the banner, a frame */
#define GUST 60        /* frames from one to the next */

typedef struct cloth {
    mote_glyph letter;
    bool blown;              /* the banner */
    double margin;           /* between the cloth and the letter's surface */
    uint64_t substeps;       /* so far */
    uint32_t n;              /* simulated vertices along an edge */
    uint32_t fine;           /* vertices of the mesh along an edge */
    double spacing;          /* of the simulated grid */
    mote_vec3 *now, *before; /* [n * n] */
    mote_vec3 *rows;         /* [fine * n]: refined along one direction; NULL where fine is n */
} cloth;

/* A point of the cloth at frame 1, by its place in -1/2 .. 1/2: flat, tilted by the angle of a
   triangle with sides 20, 99 and 101, so that an edge lands first, and turned against the
   letter by that of 7, 24 and 25. */
static mote_vec3 at_rest(double u, double v)
{
    const double x = EDGE * u, y = EDGE * v * (99.0 / 101), z = EDGE * v * (20.0 / 101);
    return mote_vec3_make(0.96 * x - 0.28 * y, 0.28 * x + 0.96 * y, HEIGHT + z);
}

/* The same of the banner: level, its held edge to one side of the letter and above it. */
static mote_vec3 unrolled(double u, double v)
{
    return mote_vec3_make(EDGE * u - 0.2, 0.9 * EDGE * v, HEIGHT - 0.1);
}

/* Vertex j of row i at frame 1. */
static mote_vec3 place(const cloth *c, size_t i, size_t j)
{
    const double u = (double)i / (c->n - 1) - 0.5, v = (double)j / (c->n - 1) - 0.5;
    return c->blown ? unrolled(u, v) : at_rest(u, v);
}

/* Moves a pair towards its distance, by a share of the way. */
static inline void hold(mote_vec3 *a, mote_vec3 *b, double length, double share)
{
    const mote_vec3 d = mote_sub(*b, *a);
    const double now = sqrt(mote_length_squared(d));
    const double way = now > 0 ? 0.5 * share * (now - length) / now : 0;
    *a = mote_add_scaled(*a, way, d);
    *b = mote_add_scaled(*b, -way, d);
}

/* Only resists being pushed together, as the two sides of a fold do: bending. */
static inline void hold_apart(mote_vec3 *a, mote_vec3 *b, double length, double share)
{
    if (mote_distance_squared(*a, *b) < length * length)
        hold(a, b, length, share);
}

static void hold_all(cloth *c)
{
    const uint32_t n = c->n;
    const double edge = c->spacing, diagonal = c->spacing * sqrt(2);
    for (uint32_t i = 0; i < n; ++i) {
        for (uint32_t j = 0; j < n; ++j) {
            mote_vec3 *p = c->now + (size_t)i * n + j;
            if (j + 1 < n)
                hold(p, p + 1, edge, 1);
            if (i + 1 < n)
                hold(p, p + n, edge, 1);
            if (i + 1 < n && j + 1 < n) {
                hold(p, p + n + 1, diagonal, SHEARING);
                hold(p + 1, p + n, diagonal, SHEARING);
            }
            if (j + 2 < n)
                hold_apart(p, p + 2, 2 * edge, BENDING);
            if (i + 2 < n)
                hold_apart(p, p + (size_t)2 * n, 2 * edge, BENDING);
        }
    }
}

/* Moves a point out of the letter and the floor; whether it was in either, and their normal. */
static bool push_out(const cloth *c, mote_vec3 *p, mote_vec3 *normal)
{
    const mote_glyph *letter = &c->letter;
    const double margin = c->margin;
    bool touched = false;
    if (p->z < FLOOR + margin) {
        p->z = FLOOR + margin;
        *normal = mote_vec3_make(0, 0, 1);
        touched = true;
    }
    if (p->z > letter->high.z + margin || p->z < letter->low.z - margin)
        return touched;
    mote_vec3 gradient;
    const double depth = margin - mote_glyph_field(letter, *p, &gradient);
    const double slope = sqrt(mote_length_squared(gradient));
    if (!(depth > 0) || !(slope > 0))
        return touched;
    *normal = mote_scale(gradient, 1 / slope);
    *p = mote_add_scaled(*p, depth, *normal);
    return true;
}

/* One edge of the banner is held where it was. */
static void hold_edge(cloth *c)
{
    for (size_t j = 0; c->blown && j < c->n; ++j)
        c->now[j] = c->before[j] = place(c, 0, j);
}

/* A wave of period 1 between -1 and 1, of two parabolas. */
static double wave(double x)
{
    const double part = x - floor(x);
    return part < 0.5 ? 16 * part * (0.5 - part) : -16 * (part - 0.5) * (1 - part);
}

/* The wind, L a frame: gusts that travel along the banner, and tilt as they go. */
static mote_vec3 wind_at(mote_vec3 p, double frame)
{
    const double gust = wave(frame / GUST - 0.8 * p.x + 0.3 * p.y);
    return mote_vec3_make(0.03 + 0.01 * gust, 0.004 * wave(frame / (0.7 * GUST)),
                          0.006 + 0.009 * gust);
}

/* Takes the banner along with the part of the wind that is across it. */
static void blow(cloth *c)
{
    const size_t n = c->n;
    const double frame = (double)c->substeps++ / SUBSTEPS;
    for (size_t k = n; c->blown && k < n * n; ++k) {
        const size_t i = k / n, j = k % n;
        const mote_vec3 along = mote_sub(c->now[k + (i + 1 < n ? n : 0)], c->now[k - n]);
        const mote_vec3 side = mote_sub(c->now[k + (j + 1 < n)], c->now[k - (j > 0)]);
        const mote_vec3 normal = mote_cross(along, side);
        const mote_vec3 velocity = mote_scale(mote_sub(c->now[k], c->before[k]), SUBSTEPS);
        const mote_vec3 against = mote_sub(wind_at(c->now[k], frame), velocity);
        const double squared = mote_length_squared(normal);
        if (squared > 0)
            c->now[k] = mote_add_scaled(
                c->now[k], AIR / (SUBSTEPS * SUBSTEPS) * mote_dot(against, normal) / squared,
                normal);
    }
}

static void substep(cloth *c)
{
    const size_t count = (size_t)c->n * c->n;
    const double pull = GRAVITY / (SUBSTEPS * SUBSTEPS);
    for (size_t k = 0; k < count; ++k) {
        const mote_vec3 old = c->now[k];
        c->now[k] = mote_add_scaled(old, KEPT, mote_sub(old, c->before[k]));
        c->now[k].z -= pull;
        c->before[k] = old;
    }
    blow(c);
    for (int i = 0; i < ITERATIONS; ++i) {
        hold_all(c);
        hold_edge(c);
    }
    for (size_t k = 0; k < count; ++k) {
        mote_vec3 normal = {0, 0, 0};
        if (!push_out(c, &c->now[k], &normal))
            continue;
        /* Friction takes back a part of the motion along the surface. */
        const mote_vec3 way = mote_sub(c->now[k], c->before[k]);
        const mote_vec3 along = mote_add_scaled(way, -mote_dot(way, normal), normal);
        c->now[k] = mote_add_scaled(c->now[k], -FRICTION, along);
    }
}

/* The cubic through four values, between the middle two. */
static mote_vec3 between(const mote_vec3 p[4], double t)
{
    const double a = t * (-0.5 + t * (1 - 0.5 * t)), b = 1 + t * t * (-2.5 + 1.5 * t);
    const double c = t * (0.5 + t * (2 - 1.5 * t)), d = t * t * (-0.5 + 0.5 * t);
    return mote_add(mote_add(mote_scale(p[0], a), mote_scale(p[1], b)),
                    mote_add(mote_scale(p[2], c), mote_scale(p[3], d)));
}

/* A row of n values, `stride` apart, at place k of `fine`. Beyond its ends it goes on straight.
 */
static mote_vec3 refine(const mote_vec3 *row, size_t stride, uint32_t n, uint32_t k,
                        uint32_t fine)
{
    const double place = (double)k * (n - 1) / (fine - 1);
    const uint32_t i = place < n - 1 ? (uint32_t)place : n - 2;
    const mote_vec3 p1 = row[i * stride], p2 = row[(i + 1) * stride];
    const mote_vec3 p[4] = {
        i > 0 ? row[(i - 1) * stride] : mote_sub(mote_scale(p1, 2), p2), p1, p2,
        i + 2 < n ? row[(i + 2) * stride] : mote_sub(mote_scale(p2, 2), p1)};
    return between(p, place - i);
}

static void show(cloth *c, mote_vec3 *positions)
{
    const uint32_t n = c->n, fine = c->fine;
    if (!c->rows) {
        memcpy(positions, c->now, (size_t)n * n * sizeof *positions);
        return;
    }
    for (uint32_t i = 0; i < n; ++i) {
        for (uint32_t k = 0; k < fine; ++k)
            c->rows[(size_t)k * n + i] = refine(c->now + (size_t)i * n, 1, n, k, fine);
    }
    for (uint32_t l = 0; l < fine; ++l) {
        for (uint32_t k = 0; k < fine; ++k) {
            mote_vec3 normal = {0, 0, 0};
            mote_vec3 *p = &positions[(size_t)l * fine + k];
            *p = refine(c->rows + (size_t)k * n, 1, n, l, fine);
            (void)push_out(c, p, &normal);
        }
    }
}

static void step(void *state, mote_vec3 *positions)
{
    cloth *c = state;
    for (int i = 0; i < SUBSTEPS; ++i)
        substep(c);
    show(c, positions);
}

static void destroy(void *state)
{
    cloth *c = state;
    if (!c)
        return;
    free(c->now);
    free(c->before);
    free(c->rows);
    free(c);
}

static void put_square(uint32_t *at, uint32_t a, uint32_t edge)
{
    const uint32_t corner[6] = {a, a + 1, a + edge, a + 1, a + edge + 1, a + edge};
    memcpy(at, corner, sizeof corner);
}

static mote_status make_mesh(cloth *c, mote_mesh **mesh)
{
    const size_t fine = c->fine, squares = (fine - 1) * (fine - 1);
    mote_vec3 *positions = malloc(fine * fine * sizeof *positions);
    uint32_t *triangles = malloc(6 * squares * sizeof *triangles);
    mote_status status = MOTE_OK;
    if (!positions || !triangles) {
        status = mote_fail(MOTE_ENOMEM, "cloth: no memory for %zu triangles", 2 * squares);
    } else {
        show(c, positions);
        for (size_t s = 0; s < squares; ++s)
            put_square(triangles + 6 * s, (uint32_t)(s / (fine - 1) * fine + s % (fine - 1)),
                       c->fine);
        status = mote_mesh_create(&positions[0].x, fine * fine, triangles, 2 * squares, mesh);
    }
    free(positions);
    free(triangles);
    return status;
}

static mote_status make_grid(cloth *c)
{
    const size_t count = (size_t)c->n * c->n;
    c->now = malloc(count * sizeof *c->now);
    c->before = malloc(count * sizeof *c->before);
    c->rows = c->fine > c->n ? malloc((size_t)c->fine * c->n * sizeof *c->rows) : NULL;
    if (!c->now || !c->before || (c->fine > c->n && !c->rows))
        return mote_fail(MOTE_ENOMEM, "cloth: no memory");
    for (size_t k = 0; k < count; ++k)
        c->now[k] = c->before[k] = place(c, k / c->n, k % c->n);
    c->spacing = sqrt(mote_distance_squared(c->now[0], c->now[1]));
    return MOTE_OK;
}

static mote_status create(const mote_simulated_body *kind, size_t triangle_count,
                          mote_mesh **mesh, void **state)
{
    mote_status status = mote_simulated_check(kind, triangle_count);
    if (status != MOTE_OK)
        return status;
    cloth *c = calloc(1, sizeof *c);
    if (!c)
        return mote_fail(MOTE_ENOMEM, "cloth: no memory");
    c->blown = kind == &mote_simulated_banner;
    c->margin = c->blown ? BLOWN : SETTLED;
    const uint32_t squares = (uint32_t)(sqrt((double)triangle_count / 2) + 0.5);
    c->fine = squares + 1;
    c->n = squares < GRID ? squares + 1 : GRID + 1;
    status = mote_glyph_make(MOTE_SIMULATED_LETTER, &c->letter);
    if (status == MOTE_OK)
        status = make_grid(c);
    if (status == MOTE_OK)
        status = make_mesh(c, mesh);
    if (status == MOTE_OK)
        *state = c;
    else
        destroy(c);
    return status;
}

static mote_status create_cloth(size_t triangle_count, mote_mesh **mesh, void **state)
{
    return create(&mote_simulated_cloth, triangle_count, mesh, state);
}

static mote_status create_banner(size_t triangle_count, mote_mesh **mesh, void **state)
{
    return create(&mote_simulated_banner, triangle_count, mesh, state);
}

const mote_simulated_body mote_simulated_cloth = {
    "cloth", "a square cloth that falls over a letter and onto the floor (position-based)",
    create_cloth, destroy, step};

const mote_simulated_body mote_simulated_banner = {
    "banner", "a cloth held along one edge that wind blows over a letter (position-based)",
    create_banner, destroy, step};
