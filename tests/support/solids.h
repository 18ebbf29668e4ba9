/* Meshes from formulas, as plain arrays, and random numbers from a fixed sequence, for tests.
 */
#ifndef MOTE_TESTS_SOLIDS_H
#define MOTE_TESTS_SOLIDS_H

#include "core/body/mesh.h"
#include "tests/support/test.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* References are computed in long double; clang would warn about each conversion. */
#pragma GCC diagnostic ignored "-Wdouble-promotion"

/* cmocka's own assert_float_equal compares floats. Also fails when either is NaN. */
#define assert_close(a, b, tolerance) assert_close_at(a, b, tolerance, __FILE__, __LINE__)

static inline void assert_close_at(long double a, long double b, long double tolerance,
                                   const char *file, int line)
{
    if (fabsl(a - b) <= tolerance)
        return;
    print_error("%.20Lg and %.20Lg differ by %.3Lg, more than %.3Lg\n", a, b, fabsl(a - b),
                tolerance);
    _fail(file, line);
}

typedef struct solid {
    size_t vertex_count, triangle_count;
    double *xyz;     /* [3 * vertex_count] */
    uint32_t *faces; /* [3 * triangle_count] */
} solid;

/* splitmix64 */
static inline uint64_t random_bits(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static inline double random_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * ((double)(random_bits(state) >> 11) * 0x1p-53);
}

static inline mote_vec3 random_vec3(uint64_t *state, double size)
{
    const double x = random_between(state, -size, size);
    const double y = random_between(state, -size, size);
    return mote_vec3_make(x, y, random_between(state, -size, size));
}

/* A rotation from a random quaternion. */
static inline mote_mat3 random_rotation_matrix(uint64_t *state)
{
    double q[4];
    double square = 0;
    do {
        square = 0;
        for (int k = 0; k < 4; ++k) {
            q[k] = random_between(state, -1, 1);
            square += q[k] * q[k];
        }
    } while (square > 1 || square < 0.01);
    const double s = 2 / square;
    const double w = q[0];
    const double x = q[1];
    const double y = q[2];
    const double z = q[3];
    return (mote_mat3){{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                        {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                        {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
}

static inline solid solid_allocate(size_t vertex_count, size_t triangle_count)
{
    solid s = {vertex_count, triangle_count, malloc(3 * vertex_count * sizeof(double)),
               malloc(3 * triangle_count * sizeof(uint32_t))};
    assert_non_null(s.xyz);
    assert_non_null(s.faces);
    return s;
}

static inline void solid_free(solid *s)
{
    free(s->xyz);
    free(s->faces);
}

static inline void solid_set_vertex(solid *s, size_t i, double x, double y, double z)
{
    s->xyz[3 * i] = x;
    s->xyz[3 * i + 1] = y;
    s->xyz[3 * i + 2] = z;
}

static inline void solid_set_face(solid *s, size_t f, uint32_t a, uint32_t b, uint32_t c)
{
    s->faces[3 * f] = a;
    s->faces[3 * f + 1] = b;
    s->faces[3 * f + 2] = c;
}

/* Regular, edge 2 sqrt 2, wound outwards. */
static inline solid solid_tetrahedron(void)
{
    solid s = solid_allocate(4, 4);
    solid_set_vertex(&s, 0, 1, 1, 1);
    solid_set_vertex(&s, 1, 1, -1, -1);
    solid_set_vertex(&s, 2, -1, 1, -1);
    solid_set_vertex(&s, 3, -1, -1, 1);
    solid_set_face(&s, 0, 0, 1, 2);
    solid_set_face(&s, 1, 0, 2, 3);
    solid_set_face(&s, 2, 0, 3, 1);
    solid_set_face(&s, 3, 1, 3, 2);
    return s;
}

static inline solid solid_triangle(void)
{
    solid s = solid_allocate(3, 1);
    solid_set_vertex(&s, 0, 0, 0, 0);
    solid_set_vertex(&s, 1, 3, 0, 0);
    solid_set_vertex(&s, 2, 0, 4, 0);
    solid_set_face(&s, 0, 0, 1, 2);
    return s;
}

static inline solid solid_icosahedron(void)
{
    static const uint32_t face[20][3] = {
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    const double g = (1 + sqrt(5.0)) / 2;
    const double corner[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                  {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                  {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    solid s = solid_allocate(12, 20);
    memcpy(s.xyz, corner, sizeof corner);
    memcpy(s.faces, face, sizeof face);
    return s;
}

/* The vertex in the middle of edge a-b, added if it is new. middle holds its index at a * n + b
   with a < b, or 0. */
static inline uint32_t solid_middle(solid *s, uint32_t *middle, size_t n, uint32_t a,
                                    uint32_t b)
{
    uint32_t *found = &middle[a < b ? a * n + b : b * n + a];
    if (*found == 0) {
        const double *p = s->xyz + 3 * (size_t)a;
        const double *q = s->xyz + 3 * (size_t)b;
        *found = (uint32_t)s->vertex_count++;
        solid_set_vertex(s, *found, (p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2);
    }
    return *found;
}

/* Unit sphere of 20 * 4^level triangles and 10 * 4^level + 2 vertices. */
static inline solid solid_icosphere(int level)
{
    solid s = solid_icosahedron();
    for (int k = 0; k < level; ++k) {
        const size_t n = s.vertex_count;
        solid next = solid_allocate(n + 3 * s.triangle_count / 2, 4 * s.triangle_count);
        memcpy(next.xyz, s.xyz, 3 * n * sizeof(double));
        next.vertex_count = n;
        uint32_t *middle = calloc(n * n, sizeof *middle);
        assert_non_null(middle);
        for (size_t f = 0; f < s.triangle_count; ++f) {
            const uint32_t *t = s.faces + 3 * f;
            const uint32_t a = solid_middle(&next, middle, n, t[0], t[1]);
            const uint32_t b = solid_middle(&next, middle, n, t[1], t[2]);
            const uint32_t c = solid_middle(&next, middle, n, t[2], t[0]);
            solid_set_face(&next, 4 * f, t[0], a, c);
            solid_set_face(&next, 4 * f + 1, t[1], b, a);
            solid_set_face(&next, 4 * f + 2, t[2], c, b);
            solid_set_face(&next, 4 * f + 3, a, b, c);
        }
        free(middle);
        solid_free(&s);
        s = next;
    }
    for (size_t i = 0; i < s.vertex_count; ++i) {
        double *p = s.xyz + 3 * i;
        const double r = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        solid_set_vertex(&s, i, p[0] / r, p[1] / r, p[2] / r);
    }
    return s;
}

/* Closed, one handle: 2 * across * around triangles, across * around vertices. */
static inline solid solid_torus(uint32_t across, uint32_t around)
{
    solid s = solid_allocate((size_t)across * around, (size_t)2 * across * around);
    for (uint32_t i = 0; i < across; ++i) {
        for (uint32_t j = 0; j < around; ++j) {
            const double u = 6.283185307179586 * i / across;
            const double v = 6.283185307179586 * j / around;
            const uint32_t a = i * around + j;
            const uint32_t b = (i + 1) % across * around + j;
            const uint32_t c = i * around + (j + 1) % around;
            const uint32_t d = (i + 1) % across * around + (j + 1) % around;
            const double radius = 1 + 0.3 * cos(v);
            solid_set_vertex(&s, a, radius * cos(u), radius * sin(u), 0.3 * sin(v));
            solid_set_face(&s, (size_t)2 * a, a, b, d);
            solid_set_face(&s, (size_t)2 * a + 1, a, d, c);
        }
    }
    return s;
}

/* An open sheet of columns x rows unit squares in the plane z = 0, two triangles each. */
static inline solid solid_grid(uint32_t columns, uint32_t rows)
{
    solid s = solid_allocate((size_t)(columns + 1) * (rows + 1), (size_t)2 * columns * rows);
    for (uint32_t i = 0; i <= columns; ++i) {
        for (uint32_t j = 0; j <= rows; ++j)
            solid_set_vertex(&s, (size_t)i * (rows + 1) + j, i, j, 0);
    }
    size_t f = 0;
    for (uint32_t i = 0; i < columns; ++i) {
        for (uint32_t j = 0; j < rows; ++j) {
            const uint32_t a = i * (rows + 1) + j;
            const uint32_t b = a + rows + 1;
            solid_set_face(&s, f++, a, b, b + 1);
            solid_set_face(&s, f++, a, b + 1, a + 1);
        }
    }
    return s;
}

/* Vertex 0 and a chain of vertex_count - 1 others around it (>= 2, a wavy circle); if closed,
   the chain is a ring (then >= 3). */
static inline solid solid_fan(uint32_t vertex_count, int closed)
{
    const uint32_t rim = vertex_count - 1;
    const uint32_t faces = closed ? rim : rim - 1;
    solid s = solid_allocate(vertex_count, faces);
    solid_set_vertex(&s, 0, 0, 0, 0.5);
    for (uint32_t i = 0; i < rim; ++i) {
        const double u = 6.283185307179586 * i / rim;
        solid_set_vertex(&s, i + 1, cos(u), sin(u), 0.1 * sin(3 * u));
    }
    for (uint32_t i = 0; i < faces; ++i)
        solid_set_face(&s, i, 0, i + 1, (i + 1) % rim + 1);
    return s;
}

/* Puts a and b side by side, b moved by (dx, 0, 0); frees both. */
static inline solid solid_join(solid a, solid b, double dx)
{
    solid s =
        solid_allocate(a.vertex_count + b.vertex_count, a.triangle_count + b.triangle_count);
    memcpy(s.xyz, a.xyz, 3 * a.vertex_count * sizeof(double));
    memcpy(s.faces, a.faces, 3 * a.triangle_count * sizeof(uint32_t));
    for (size_t i = 0; i < b.vertex_count; ++i)
        solid_set_vertex(&s, a.vertex_count + i, b.xyz[3 * i] + dx, b.xyz[3 * i + 1],
                         b.xyz[3 * i + 2]);
    for (size_t k = 0; k < 3 * b.triangle_count; ++k)
        s.faces[3 * a.triangle_count + k] = b.faces[k] + (uint32_t)a.vertex_count;
    solid_free(&a);
    solid_free(&b);
    return s;
}

/* Redirects the faces of vertex `from` to vertex `to` and removes `from`: the last vertex takes
   its number. With from == to, which no face may use, the vertex is only removed. */
static inline void solid_weld(solid *s, uint32_t from, uint32_t to)
{
    const uint32_t last = (uint32_t)--s->vertex_count;
    memmove(s->xyz + (size_t)3 * from, s->xyz + (size_t)3 * last, 3 * sizeof(double));
    for (size_t k = 0; k < 3 * s->triangle_count; ++k) {
        if (s->faces[k] == from)
            s->faces[k] = to;
        else if (s->faces[k] == last)
            s->faces[k] = from;
    }
}

/* The mesh of s, which is freed. */
static inline mote_mesh *solid_to_mesh(solid s)
{
    mote_mesh *mesh = NULL;
    const mote_status status =
        mote_mesh_create(s.xyz, s.vertex_count, s.faces, s.triangle_count, &mesh);
    if (status != MOTE_OK)
        fail_msg("mote_mesh_create: %s", mote_error_text());
    solid_free(&s);
    return mesh;
}

#endif
