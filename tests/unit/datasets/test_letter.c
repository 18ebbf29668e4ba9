/* Recomputes every property of a letter from its positions and indices alone. */
#include "datasets/letter.h"
#include "harness/base/hash.h"
#include "tests/support/test.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct half_edge {
    uint32_t from, to;
} half_edge;

static int compare_half_edges(const void *left, const void *right)
{
    const half_edge *a = left;
    const half_edge *b = right;
    if (a->from != b->from)
        return a->from < b->from ? -1 : 1;
    return (a->to > b->to) - (a->to < b->to);
}

static int compare_points(const void *left, const void *right)
{
    const mote_vec3 *a = left;
    const mote_vec3 *b = right;
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    if (a->y != b->y)
        return a->y < b->y ? -1 : 1;
    return (a->z > b->z) - (a->z < b->z);
}

static uint32_t find_root(uint32_t *parent, uint32_t v)
{
    while (parent[v] != v) {
        parent[v] = parent[parent[v]];
        v = parent[v];
    }
    return v;
}

/* Each directed edge occurs once, and so does its reverse: the mesh is closed, manifold along
   edges, and consistently wound. */
static void assert_edges_paired(const mote_mesh *mesh)
{
    const size_t count = 3 * (size_t)mesh->triangle_count;
    half_edge *edges = malloc(count * sizeof *edges);
    assert_non_null(edges);
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (size_t k = 0; k < 3; k++)
            edges[3 * t + k] =
                (half_edge){mesh->triangles[t][k], mesh->triangles[t][(k + 1) % 3]};
    qsort(edges, count, sizeof *edges, compare_half_edges);
    for (size_t e = 0; e < count; e++) {
        if (e > 0)
            assert_int_not_equal(compare_half_edges(&edges[e - 1], &edges[e]), 0);
        const half_edge reverse = {edges[e].to, edges[e].from};
        assert_non_null(bsearch(&reverse, edges, count, sizeof *edges, compare_half_edges));
    }
    free(edges);
}

/* The triangles around each vertex form one fan: uniting the two edges at each of its corners
   leaves one set of edges. */
static void assert_one_fan_each(const mote_mesh *mesh)
{
    const size_t count = 3 * (size_t)mesh->triangle_count;
    half_edge *edges = malloc(count * sizeof *edges);
    uint32_t *parent = malloc(count * sizeof *parent);
    uint32_t *sets = calloc(mesh->vertex_count, sizeof *sets);
    assert_true(edges && parent && sets);
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (size_t k = 0; k < 3; k++)
            edges[3 * t + k] =
                (half_edge){mesh->triangles[t][k], mesh->triangles[t][(k + 1) % 3]};
    qsort(edges, count, sizeof *edges, compare_half_edges);
    for (uint32_t e = 0; e < count; e++) {
        parent[e] = e;
        sets[edges[e].from]++;
    }
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        for (size_t k = 0; k < 3; k++) {
            const uint32_t v = mesh->triangles[t][k];
            const half_edge out = {v, mesh->triangles[t][(k + 1) % 3]};
            const half_edge in = {v, mesh->triangles[t][(k + 2) % 3]};
            const half_edge *p = bsearch(&out, edges, count, sizeof *edges, compare_half_edges);
            const half_edge *q = bsearch(&in, edges, count, sizeof *edges, compare_half_edges);
            assert_true(p && q);
            const uint32_t a = find_root(parent, (uint32_t)(p - edges));
            const uint32_t b = find_root(parent, (uint32_t)(q - edges));
            if (a != b) {
                parent[a] = b;
                sets[v]--;
            }
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        assert_int_equal(sets[v], 1);
    free(edges);
    free(parent);
    free(sets);
}

static uint32_t count_components(const mote_mesh *mesh)
{
    uint32_t *parent = malloc(mesh->vertex_count * sizeof *parent);
    assert_non_null(parent);
    uint32_t components = mesh->vertex_count;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        parent[v] = v;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        for (size_t k = 0; k < 3; k++) {
            const uint32_t a = find_root(parent, mesh->triangles[t][k]);
            const uint32_t b = find_root(parent, mesh->triangles[t][(k + 1) % 3]);
            components -= a != b;
            parent[a] = b;
        }
    }
    free(parent);
    return components;
}

static double angle_at(mote_vec3 a, mote_vec3 b, mote_vec3 c)
{
    const mote_vec3 u = mote_sub(b, a);
    const mote_vec3 v = mote_sub(c, a);
    return atan2(mote_length(mote_cross(u, v)), mote_dot(u, v)) * 180 / acos(-1.0);
}

static double smallest_angle(const mote_mesh *mesh)
{
    double least = 180;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        for (size_t k = 0; k < 3; k++) {
            const uint32_t *v = mesh->triangles[t];
            least = fmin(least, angle_at(mesh->positions[v[k]], mesh->positions[v[(k + 1) % 3]],
                                         mesh->positions[v[(k + 2) % 3]]));
        }
    }
    return least;
}

static double signed_volume(const mote_mesh *mesh)
{
    double sum = 0;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles[t];
        sum += mote_dot(mesh->positions[v[0]],
                        mote_cross(mesh->positions[v[1]], mesh->positions[v[2]]));
    }
    return sum / 6;
}

static void assert_no_duplicates(const mote_mesh *mesh)
{
    const size_t bytes = mesh->vertex_count * sizeof(mote_vec3);
    mote_vec3 *points = malloc(bytes);
    assert_non_null(points);
    memcpy(points, mesh->positions, bytes);
    qsort(points, mesh->vertex_count, sizeof *points, compare_points);
    for (uint32_t v = 1; v < mesh->vertex_count; v++)
        assert_int_not_equal(compare_points(&points[v - 1], &points[v]), 0);
    free(points);
}

static mote_mesh *letter(char character, size_t triangles)
{
    mote_mesh *mesh = NULL;
    if (mote_letter_create(character, triangles, &mesh) != MOTE_OK)
        fail_msg("%c %zu: %s", character, triangles, mote_error_text());
    return mesh;
}

/* The Euler characteristic is 2 for a letter without holes. */
static void assert_sound(char character, size_t triangles, int64_t euler)
{
    mote_mesh *mesh = letter(character, triangles);
    assert_int_equal(mesh->triangle_count, triangles);
    assert_edges_paired(mesh);
    assert_one_fan_each(mesh);
    assert_int_equal(count_components(mesh), 1);
    /* A closed surface has 3/2 edges a triangle. */
    assert_int_equal((int64_t)mesh->vertex_count - (int64_t)triangles / 2, euler);
    assert_no_duplicates(mesh);
    if (smallest_angle(mesh) < 10)
        fail_msg("%c %zu: an angle of %g degrees", character, triangles, smallest_angle(mesh));
    assert_true(signed_volume(mesh) > 0.01);
    mote_mesh_destroy(mesh);
}

TEST(create_papers_counts_sound)
{
    assert_sound('T', 1380, 2);
    assert_sound('V', 1764, 2);
    assert_sound('M', 2968, 2);
    assert_sound('W', 11920, 2);
}

TEST(create_scaling_counts_sound)
{
    assert_sound('W', 1000, 2);
    assert_sound('W', 10000, 2);
    assert_sound('W', 100000, 2);
}

TEST(create_any_even_count_sound)
{
    static const char letters[] = "TVMW";
    static const size_t counts[] = {400, 402, 404, 450, 500, 614, 778, 1000, 1234, 5000, 20002};
    for (size_t i = 0; letters[i]; i++)
        for (size_t j = 0; j < sizeof counts / sizeof counts[0]; j++)
            assert_sound(letters[i], counts[j], 2);
}

TEST(create_every_letter_sound)
{
    for (char c = 'A'; c <= 'Z'; c++) {
        const int64_t euler = c == 'B' ? -2 : strchr("ADOPQR", c) ? 0 : 2;
        assert_sound(c, 400, euler);
        assert_sound(c, 546, euler);
        assert_sound(c, 3002, euler);
    }
}

TEST(create_every_letter_upright_and_centred)
{
    for (char c = 'A'; c <= 'Z'; c++) {
        mote_mesh *mesh = letter(c, 1600);
        const mote_vec3 size = mote_sub(mesh->high, mesh->low);
        const mote_vec3 centre = mote_scale(mote_add(mesh->high, mesh->low), 0.5);
        assert_true(fabs(mesh->diagonal - 1) < 0.05);
        assert_true(mote_length(centre) < 0.03);
        assert_true(size.z > 0.09 && size.z < 0.2 && size.y > 0.5);
        assert_true(c == 'I' ? size.x < 0.2 : size.x > 0.4);
        mote_mesh_destroy(mesh);
    }
}

/* Whether the letter, seen along z, covers (x, y). */
static bool covers(const mote_mesh *mesh, double x, double y)
{
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const mote_vec3 a = mesh->positions[mesh->triangles[t][0]];
        const mote_vec3 b = mesh->positions[mesh->triangles[t][1]];
        const mote_vec3 c = mesh->positions[mesh->triangles[t][2]];
        const double u = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        const double v = (c.x - b.x) * (y - b.y) - (c.y - b.y) * (x - b.x);
        const double w = (a.x - c.x) * (y - c.y) - (a.y - c.y) * (x - c.x);
        if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))
            return true;
    }
    return false;
}

/* The number of pieces in which a horizontal line at a height (0 at the foot, 1 at the top)
   meets the letter; gaps below 5 % of the width are the outline's facets. */
static unsigned pieces_at_height(const mote_mesh *mesh, double height)
{
    const double y = mesh->low.y + height * (mesh->high.y - mesh->low.y);
    unsigned pieces = 0;
    int gap = 10;
    for (int i = 0; i <= 200; i++) {
        const double x = mesh->low.x + i / 200.0 * (mesh->high.x - mesh->low.x);
        if (!covers(mesh, x, y)) {
            gap++;
            continue;
        }
        pieces += gap >= 10;
        gap = 0;
    }
    return pieces;
}

/* The letter as a reader sees it: the number of pieces on lines near its foot and its top. */
TEST(create_each_letter_has_its_shape)
{
    static const struct {
        char character;
        unsigned low, high;
    } cases[] = {{'A', 2, 1}, {'C', 1, 1}, {'F', 1, 1}, {'G', 1, 1}, {'H', 2, 2},
                 {'I', 1, 1}, {'J', 1, 1}, {'K', 2, 2}, {'L', 1, 1}, {'M', 2, 2},
                 {'N', 2, 2}, {'P', 1, 1}, {'R', 2, 1}, {'T', 1, 1}, {'U', 1, 2},
                 {'V', 1, 2}, {'W', 2, 3}, {'X', 2, 2}, {'Y', 1, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mote_mesh *mesh = letter(cases[i].character, 3000);
        const unsigned low = pieces_at_height(mesh, 0.12);
        const unsigned high = pieces_at_height(mesh, 0.83);
        if (low != cases[i].low || high != cases[i].high)
            fail_msg("%c has %u pieces at the foot and %u at the top", cases[i].character, low,
                     high);
        mote_mesh_destroy(mesh);
    }
}

TEST(create_twice_same_bits)
{
    mote_mesh *first = letter('M', 2968);
    mote_mesh *second = letter('M', 2968);
    assert_int_equal(first->vertex_count, second->vertex_count);
    assert_memory_equal(first->positions, second->positions,
                        first->vertex_count * sizeof *first->positions);
    assert_memory_equal(first->triangles, second->triangles,
                        first->triangle_count * sizeof *first->triangles);
    mote_mesh_destroy(first);
    mote_mesh_destroy(second);
}

/* FNV-1a of positions and triangles: the same on every compiler and optimisation level. */
TEST(create_papers_w_known_bits)
{
    mote_mesh *mesh = letter('W', 11920);
    uint64_t hash = MOTE_HASH_START;
    hash = mote_hash_bytes(hash, mesh->positions, mesh->vertex_count * sizeof *mesh->positions);
    hash =
        mote_hash_bytes(hash, mesh->triangles, mesh->triangle_count * sizeof *mesh->triangles);
    assert_int_equal(hash, 0x16e8cc3a702b1bc4u);
    mote_mesh_destroy(mesh);
}

static void assert_refused(char character, size_t triangles, const char *part)
{
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_letter_create(character, triangles, &mesh), MOTE_EINVAL);
    assert_null(mesh);
    if (!strstr(mote_error_text(), part))
        fail_msg("\"%s\" does not say \"%s\"", mote_error_text(), part);
}

TEST(create_bad_count_says_what_is_right)
{
    assert_refused('W', 11921, "use 11920 or 11922");
    assert_refused('W', 398, "an even number from 400");
    assert_refused('W', 0, "an even number from 400");
    assert_refused('W', MOTE_LETTER_MAX_TRIANGLES + 2, "to 20000000");
    assert_refused('W', SIZE_MAX - 1, "to 20000000");
}

TEST(create_unknown_letter_says_what_is_right)
{
    assert_refused('?', 1000, "A to Z");
    assert_refused('w', 1000, "A to Z");
    assert_refused('\0', 1000, "A to Z");
    assert_refused((char)-61, 1000, "A to Z");
}
