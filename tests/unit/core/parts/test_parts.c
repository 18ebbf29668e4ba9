/* Convex parts of letters, combs and awkward meshes. */
#include "core/parts/parts.h"
#include "datasets/letter.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Up to 64 x 64 cells of size 1 in the plane. */
typedef struct cells {
    int width, height;
    bool filled[64][64];
} cells;

static bool is_filled(const cells *c, int i, int j)
{
    return i >= 0 && j >= 0 && i < c->width && j < c->height && c->filled[i][j];
}

typedef struct builder {
    double xyz[3 * 65 * 65 * 2];
    uint32_t faces[6 * 64 * 64 * 6];
    uint32_t number[65][65][2]; /* of a grid point, + 1 */
    uint32_t vertices, triangles;
} builder;

static uint32_t grid_vertex(builder *b, int i, int j, int k)
{
    uint32_t *number = &b->number[i][j][k];
    if (*number == 0) {
        double *p = b->xyz + 3 * b->vertices;
        p[0] = i, p[1] = j, p[2] = k;
        *number = ++b->vertices;
    }
    return *number - 1;
}

static void add_quad(builder *b, uint32_t p, uint32_t q, uint32_t r, uint32_t s)
{
    const uint32_t corners[6] = {p, q, r, p, r, s};
    memcpy(b->faces + 3 * b->triangles, corners, sizeof corners);
    b->triangles += 2;
}

static void add_walls(builder *b, const cells *c, int i, int j)
{
    static const int side[4][6] = {
        {0, -1, 0, 0, 1, 0}, {1, 0, 1, 0, 1, 1}, {0, 1, 1, 1, 0, 1}, {-1, 0, 0, 1, 0, 0}};
    for (int k = 0; k < 4; ++k) {
        const int *s = side[k];
        if (is_filled(c, i + s[0], j + s[1]))
            continue;
        uint32_t p = grid_vertex(b, i + s[2], j + s[3], 0);
        uint32_t q = grid_vertex(b, i + s[4], j + s[5], 0);
        add_quad(b, p, q, grid_vertex(b, i + s[4], j + s[5], 1),
                 grid_vertex(b, i + s[2], j + s[3], 1));
    }
}

/* The filled cells as a flat sheet, or as a closed slab of thickness 1. */
static mote_mesh *make_cells(const cells *c, bool slab)
{
    builder *b = calloc(1, sizeof *b);
    assert_non_null(b);
    for (int i = 0; i < c->width; ++i) {
        for (int j = 0; j < c->height; ++j) {
            if (!c->filled[i][j])
                continue;
            for (int k = 0; k <= slab; ++k)
                add_quad(b, grid_vertex(b, i, j, k), grid_vertex(b, i + k, j + !k, k),
                         grid_vertex(b, i + 1, j + 1, k), grid_vertex(b, i + !k, j + k, k));
            if (slab)
                add_walls(b, c, i, j);
        }
    }
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(b->xyz, b->vertices, b->faces, b->triangles, &mesh),
                     MOTE_OK);
    free(b);
    return mesh;
}

static mote_mesh *make_letter(char letter, size_t triangles)
{
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_letter_create(letter, triangles, &mesh), MOTE_OK);
    return mesh;
}

/* Checks that labels are in range and every part has a vertex. */
static mote_parts *checked_parts(const mote_mesh *mesh, const mote_vec3 *positions)
{
    mote_parts *parts = NULL;
    assert_int_equal(mote_parts_create(mesh, positions, &parts), MOTE_OK);
    assert_int_equal(parts->vertex_count, mesh->vertex_count);
    assert_true(parts->count >= mesh->component_count);
    bool *used = calloc(parts->count, sizeof *used);
    assert_non_null(used);
    for (uint32_t v = 0; v < parts->vertex_count; ++v) {
        assert_true(parts->label[v] < parts->count);
        used[parts->label[v]] = true;
    }
    for (uint32_t k = 0; k < parts->count; ++k)
        assert_true(used[k]);
    free(used);
    return parts;
}

TEST(parts_create_of_letters_finds_their_strokes)
{
    /* At least one part a stroke. HACD splits a stroke where the rounded joints make it
       concave, up to three times in the cases measured. */
    static const struct {
        char letter;
        size_t triangles;
        uint32_t low, high;
    } cases[] = {{'T', 1380, 2, 6}, {'V', 1764, 2, 6}, {'M', 2968, 4, 12}, {'W', 11920, 4, 12}};
    for (int i = 0; i < 4; ++i) {
        mote_mesh *mesh = make_letter(cases[i].letter, cases[i].triangles);
        mote_parts *parts = checked_parts(mesh, NULL);
        assert_in_range(parts->count, cases[i].low, cases[i].high);
        mote_parts_destroy(parts);
        mote_mesh_destroy(mesh);
    }
}

TEST(parts_create_of_v_separates_its_arms)
{
    mote_mesh *mesh = make_letter('V', 1764);
    mote_parts *parts = checked_parts(mesh, NULL);
    uint32_t left = 0, right = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        mote_vec3 p = mesh->positions[v], l = mesh->positions[left], r = mesh->positions[right];
        if (p.y - p.x > l.y - l.x)
            left = v;
        if (p.y + p.x > r.y + r.x)
            right = v;
    }
    assert_int_not_equal(parts->label[left], parts->label[right]);
    mote_parts_destroy(parts);
    mote_mesh_destroy(mesh);
}

TEST(parts_create_of_a_comb_counts_its_teeth)
{
    cells comb = {.width = 39, .height = 9};
    for (int i = 0; i < comb.width; ++i) {
        for (int j = 0; j < comb.height; ++j)
            comb.filled[i][j] = j == 0 || i % 2 == 0;
    }
    mote_mesh *mesh = make_cells(&comb, true);
    mote_parts *parts = checked_parts(mesh, NULL);
    assert_in_range(parts->count, 20, 28);
    mote_parts_destroy(parts);
    mote_mesh_destroy(mesh);
}

TEST(parts_create_gives_each_component_its_own_parts)
{
    cells islands = {.width = 64, .height = 60};
    for (int i = 0; i < islands.width; ++i) {
        for (int j = 0; j < islands.height; ++j)
            islands.filled[i][j] = i % 8 != 7 && j % 20 != 19;
    }
    mote_mesh *mesh = make_cells(&islands, false);
    assert_int_equal(mesh->component_count, 24);
    mote_parts *parts = checked_parts(mesh, NULL);
    assert_int_equal(parts->count, 24);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        for (uint32_t w = 0; w < v; w += 97)
            assert_int_equal(parts->label[v] == parts->label[w],
                             mesh->component[v] == mesh->component[w]);
    }
    mote_parts_destroy(parts);
    mote_mesh_destroy(mesh);
}

TEST(parts_create_of_a_mesh_that_cannot_be_simplified_succeeds)
{
    cells board = {.width = 60, .height = 60};
    for (int i = 0; i < board.width; ++i) {
        for (int j = 0; j < board.height; ++j)
            board.filled[i][j] = (i + j) % 2 == 0;
    }
    mote_mesh *mesh = make_cells(&board, false);
    mote_parts_destroy(checked_parts(mesh, NULL));
    mote_mesh_destroy(mesh);
}

/* Components so small that floats at the mesh's scale lose them entirely. */
TEST(parts_create_of_components_simplified_to_nothing_is_one_part_each)
{
    solid all = solid_icosphere(2);
    for (int k = 1; k < 16; ++k)
        all = solid_join(all, solid_icosphere(2), 0);
    const size_t each = all.vertex_count / 16;
    for (size_t i = 0; i < all.vertex_count; ++i) {
        const double *p = all.xyz + 3 * i;
        const size_t which = i / each;
        const double at = (double)which;
        solid_set_vertex(&all, i, 1e-12 * p[0] + at, 1e-12 * p[1] + at, 1e-12 * p[2] + at);
    }
    mote_mesh *mesh = solid_to_mesh(all);
    mote_parts *parts = checked_parts(mesh, NULL);
    /* All components but the first, which is the origin of the floats. */
    for (uint32_t v = (uint32_t)each; v < mesh->vertex_count; ++v)
        assert_int_equal(parts->label[v], parts->label[v / each * each]);
    mote_parts_destroy(parts);
    mote_mesh_destroy(mesh);
}

TEST(parts_create_of_the_smallest_meshes_is_one_part)
{
    static const double xyz[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0, 2, 0, 0}};
    static const uint32_t face[3] = {0, 1, 2};
    for (int i = 0; i < 2; ++i) {
        mote_mesh *mesh = NULL;
        assert_int_equal(mote_mesh_create(xyz[i], 3, face, 1, &mesh), MOTE_OK);
        mote_parts *parts = checked_parts(mesh, NULL);
        assert_int_equal(parts->count, 1);
        mote_parts_destroy(parts);
        mote_mesh_destroy(mesh);
    }
}

/* HACD makes three parts of some spheres, and takes seconds. */
TEST(parts_create_of_a_convex_solid_is_one_part_at_once)
{
    for (int level = 2; level < 5; ++level) {
        mote_mesh *mesh = solid_to_mesh(solid_icosphere(level));
        const clock_t start = clock();
        mote_parts *parts = checked_parts(mesh, NULL);
        assert_true(clock() - start < 5 * CLOCKS_PER_SEC); /* also under AddressSanitizer */
        assert_int_equal(parts->count, 1);
        mote_parts_destroy(parts);
        mote_mesh_destroy(mesh);
    }
    mote_mesh *mesh = solid_to_mesh(solid_torus(12, 12));
    mote_parts *parts = checked_parts(mesh, NULL);
    assert_in_range(parts->count, 2, 12);
    mote_parts_destroy(parts);
    mote_mesh_destroy(mesh);
}

/* HACD took 100 s for a grid of 28,000 triangles, simplified to 800. */
TEST(parts_create_of_a_flat_sheet_is_one_part_at_once)
{
    cells sheet = {.width = 60, .height = 60};
    for (int i = 0; i < sheet.width; ++i) {
        for (int j = 0; j < sheet.height; ++j)
            sheet.filled[i][j] = true;
    }
    mote_mesh *mesh = make_cells(&sheet, false);
    const clock_t start = clock();
    mote_parts *parts = checked_parts(mesh, NULL);
    assert_true(clock() - start < 5 * CLOCKS_PER_SEC);
    assert_int_equal(parts->count, 1);
    assert_int_equal(parts->without_hacd, 0);
    mote_parts_destroy(parts);
    mote_mesh_destroy(mesh);
}

TEST(parts_create_again_or_scaled_gives_the_same_labels)
{
    mote_mesh *mesh = make_letter('M', 2968);
    mote_parts *first = checked_parts(mesh, NULL);
    mote_mesh scaled = *mesh;
    mote_vec3 *positions = malloc(mesh->vertex_count * sizeof *positions);
    assert_non_null(positions);
    static const double scales[] = {1, 0x1p-40, 0x1p40, 0x1p-200, 0x1p-428, 0x1p200, 0x1p428};
    for (size_t i = 0; i < ROWS_OF(scales); ++i) {
        test_row("lengths times %g", scales[i]);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v)
            positions[v] = mote_scale(mesh->positions[v], scales[i]);
        scaled.diagonal = mesh->diagonal * scales[i];
        mote_parts *again = checked_parts(&scaled, positions);
        assert_int_equal(again->count, first->count);
        assert_memory_equal(again->label, first->label,
                            mesh->vertex_count * sizeof *first->label);
        mote_parts_destroy(again);
    }
    free(positions);
    mote_parts_destroy(first);
    mote_mesh_destroy(mesh);
}

TEST(parts_create_with_a_position_not_finite_is_refused)
{
    mote_mesh *mesh = make_letter('T', 400);
    const mote_vec3 good = mesh->positions[17];
    const mote_vec3 bad[3] = {
        {NAN, good.y, good.z}, {good.x, -HUGE_VAL, good.z}, {good.x, good.y, NAN}};
    mote_parts *parts = NULL;
    for (int k = 0; k < 3; ++k) {
        mesh->positions[17] = bad[k];
        assert_int_equal(mote_parts_create(mesh, NULL, &parts), MOTE_EINVAL);
        assert_null(parts);
        assert_non_null(strstr(mote_error_text(), "vertex 17"));
    }
    mote_parts_destroy(NULL);
    mote_mesh_destroy(mesh);
}
