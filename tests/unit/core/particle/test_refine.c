/* The local search against all pairs of faces, over random poses and deformations. */
#include "core/particle/refine.h"

#include "core/body/triangle.h"
#include "datasets/letter.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define CENTRES 6

typedef struct scene {
    mote_mesh *mesh[2];
    mote_field *field[2];
    mote_body body[2];
    mote_body_state state[2];
    double weights[2][3][MOTE_LANES];
    mote_vec3 *world[2];
    mote_lazy lazy[2];
    uint64_t random;
} scene;

static double draw(scene *s, double low, double high)
{
    s->random = s->random * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(s->random >> 11) * 0x1p-53;
}

static uint32_t draw_vertex(scene *s, int side)
{
    return (uint32_t)draw(s, 0, s->mesh[side]->vertex_count);
}

static mote_mat3 turn(double about_x, double about_z)
{
    const double a = cos(about_x), b = sin(about_x), c = cos(about_z), d = sin(about_z);
    return (mote_mat3){{{c, -d, 0}, {a * d, a * c, -b}, {b * d, b * c, a}}};
}

static mote_mesh *mesh_of(const double *xyz, size_t vertices, const uint32_t *faces,
                          size_t triangles)
{
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(xyz, vertices, faces, triangles, &mesh), MOTE_OK);
    return mesh;
}

static mote_mesh *letter_mesh(char letter, size_t triangles)
{
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_letter_create(letter, triangles, &mesh), MOTE_OK);
    return mesh;
}

/* An open sheet of n by n squares over [-0.5, 0.5]^2, bent to z = height x^2 + y^2 / 3. */
static mote_mesh *sheet_mesh(uint32_t n, double height)
{
    const uint32_t m = n + 1;
    double *xyz = malloc((size_t)3 * m * m * sizeof *xyz);
    uint32_t *faces = malloc((size_t)6 * n * n * sizeof *faces);
    assert_non_null(xyz);
    assert_non_null(faces);
    size_t f = 0;
    for (uint32_t i = 0; i < m; ++i) {
        for (uint32_t j = 0; j < m; ++j) {
            const double x = i / (double)n - 0.5;
            const double y = j / (double)n - 0.5;
            const double p[3] = {x, y, height * x * x + y * y / 3};
            memcpy(xyz + (size_t)3 * (i * m + j), p, sizeof p);
            if (i == n || j == n)
                continue;
            const uint32_t a = i * m + j;
            const uint32_t two[6] = {a, a + m, a + m + 1, a, a + m + 1, a + 1};
            memcpy(faces + f, two, sizeof two);
            f += 6;
        }
    }
    mote_mesh *mesh = mesh_of(xyz, (size_t)m * m, faces, f / 3);
    free(xyz);
    free(faces);
    return mesh;
}

/* Two cones of n faces each with one apex between them: a vertex with a ring of 2 n neighbours
   in two closed fans, or two open ones. */
static mote_mesh *double_cone_mesh(uint32_t n, bool open)
{
    const size_t vertices = 1 + 2 * (size_t)n;
    double *xyz = calloc(3 * vertices, sizeof *xyz);
    uint32_t *faces = malloc(6 * (size_t)n * sizeof *faces);
    assert_non_null(xyz);
    assert_non_null(faces);
    size_t f = 0;
    for (uint32_t cone = 0; cone < 2; ++cone) {
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t here = 1 + cone * n + i;
            const uint32_t next = 1 + cone * n + (i + 1) % n;
            const double angle = 6.283185307179586 * i / n;
            xyz[3 * here] = cos(angle);
            xyz[3 * here + 1] = sin(angle);
            xyz[3 * here + 2] = (cone == 0 ? 0.4 : -0.4) + 0.1 * sin(5 * angle);
            if (open && i + 1 == n)
                continue;
            const uint32_t face[3] = {0, here, next};
            memcpy(faces + f, face, sizeof face);
            f += 3;
        }
    }
    mote_mesh *mesh = mesh_of(xyz, vertices, faces, f / 3);
    free(xyz);
    free(faces);
    return mesh;
}

/* Takes ownership of the meshes. */
static scene *scene_of(mote_mesh *mesh0, mote_mesh *mesh1, uint64_t seed)
{
    scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->random = seed;
    s->mesh[0] = mesh0;
    s->mesh[1] = mesh1;
    for (int side = 0; side < 2; ++side) {
        const mote_mesh *mesh = s->mesh[side];
        mote_vec3 centre[CENTRES];
        for (int j = 0; j < CENTRES; ++j)
            centre[j] = mesh->positions[draw_vertex(s, side)];
        assert_int_equal(
            mote_field_create_csrbf(centre, CENTRES, 0.4 * mesh->diagonal, &s->field[side]),
            MOTE_OK);
        s->body[side] = (mote_body){.mesh = mesh, .field = s->field[side]};
        s->world[side] = malloc(mesh->vertex_count * sizeof *s->world[side]);
        assert_non_null(s->world[side]);
        assert_int_equal(mote_lazy_init(&s->lazy[side], &s->body[side], 64), MOTE_OK);
    }
    return s;
}

/* Sets a new pose and shape of both bodies, about `apart` diagonals from each other. */
static void scene_move(scene *s, double apart, bool given)
{
    for (int side = 0; side < 2; ++side) {
        const double size = s->mesh[side]->diagonal;
        for (int axis = 0; axis < 3; ++axis) {
            for (int j = 0; j < CENTRES; ++j)
                s->weights[side][axis][j] = draw(s, -0.05, 0.05) * size;
        }
        s->state[side] = (mote_body_state){
            .pose = {turn(draw(s, 0, 6), draw(s, 0, 6)),
                     mote_vec3_make(side * apart * size, draw(s, -0.1, 0.1) * size, 0)},
            .weights = {s->weights[side][0], s->weights[side][1], s->weights[side][2], CENTRES,
                        MOTE_LANES},
            .vertices = s->world[side]};
        for (uint32_t i = 0; i < s->mesh[side]->vertex_count; ++i)
            s->world[side][i] = mote_body_position(&s->body[side], &s->state[side], i);
        mote_lazy_begin(&s->lazy[side], &s->state[side], given);
    }
}

static void scene_free(scene *s)
{
    for (int side = 0; side < 2; ++side) {
        mote_lazy_free(&s->lazy[side]);
        mote_field_destroy(s->field[side]);
        mote_mesh_destroy(s->mesh[side]);
        free(s->world[side]);
    }
    free(s);
}

static mote_refined refine(scene *s, uint32_t a, uint32_t b)
{
    mote_lazy *const lazy[2] = {&s->lazy[0], &s->lazy[1]};
    mote_refined result;
    mote_refine_vertices(lazy, (uint32_t[2]){a, b}, 0, &result);
    return result;
}

static void corners_of(const scene *s, int side, const uint32_t vertex[3], mote_vec3 corner[3])
{
    for (int i = 0; i < 3; ++i)
        corner[i] = s->world[side][vertex[i]];
}

/* The number of vertices that the two faces share. */
static int shared(const uint32_t f[3], const uint32_t g[3])
{
    int count = 0;
    for (int i = 0; i < 9; ++i)
        count += f[i / 3] == g[i % 3];
    return count;
}

/* The least squared distance over all pairs of faces, or over those that touch the result's
   faces. */
static double brute_force(const scene *s, const mote_refined *around)
{
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < s->mesh[0]->triangle_count; ++i) {
        const uint32_t *f = s->mesh[0]->triangles[i];
        mote_vec3 p[3];
        if (around && !shared(f, around->triangle[0]))
            continue;
        corners_of(s, 0, f, p);
        for (uint32_t j = 0; j < s->mesh[1]->triangle_count; ++j) {
            const uint32_t *g = s->mesh[1]->triangles[j];
            mote_vec3 q[3];
            if (around && !shared(g, around->triangle[1]))
                continue;
            corners_of(s, 1, g, q);
            least = fmin(least, mote_triangle_triangle(p, q, NULL, NULL));
        }
    }
    return least;
}

static bool is_face(const mote_mesh *mesh, const uint32_t vertex[3])
{
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        if (shared(mesh->triangles[i], vertex) == 3)
            return true;
    }
    return false;
}

/* Checks that the result has two faces with their witnesses, no farther apart than vertices a
   and b. */
static void assert_measured(const scene *s, const mote_refined *r, uint32_t a, uint32_t b)
{
    const double size = s->mesh[0]->diagonal;
    const double apart = mote_length(mote_sub(r->witness[1], r->witness[0]));
    assert_true(r->squared <= mote_distance_squared(s->world[0][a], s->world[1][b]));
    assert_true(fabs(sqrt(r->squared) - apart) <= 1e-13 * size);
    for (int side = 0; side < 2; ++side) {
        mote_vec3 corner[3];
        corners_of(s, side, r->triangle[side], corner);
        assert_true(is_face(s->mesh[side], r->triangle[side]));
        assert_true(mote_point_triangle(r->witness[side], corner, NULL) <= 1e-26 * size * size);
        for (int i = 0; i < 3; ++i) {
            const mote_vec3 nearest = s->world[side][r->vertex[side]];
            assert_true(mote_distance_squared(nearest, r->witness[side]) <=
                        mote_distance_squared(corner[i], r->witness[side]));
        }
    }
}

/* Checks everything that a result promises. */
static void assert_result(scene *s, const mote_refined *r, uint32_t a, uint32_t b)
{
    assert_measured(s, r, a, b);
    assert_true(sqrt(r->squared) <= sqrt(brute_force(s, r)) + 1e-11 * s->mesh[0]->diagonal);
}

TEST(vertices_random_starts_local_minimum)
{
    scene *s = scene_of(letter_mesh('W', 600), letter_mesh('M', 500), 1);
    for (int frame = 0; frame < 20; ++frame) {
        scene_move(s, 0.3 + 0.05 * frame, false);
        for (int trial = 0; trial < 20; ++trial) {
            const uint32_t a = draw_vertex(s, 0);
            const uint32_t b = draw_vertex(s, 1);
            const mote_refined r = refine(s, a, b);
            assert_result(s, &r, a, b);
        }
    }
    scene_free(s);
}

TEST(vertices_all_starts_global_minimum)
{
    scene *s = scene_of(letter_mesh('T', 400), letter_mesh('V', 400), 2);
    for (int frame = 0; frame < 3; ++frame) {
        scene_move(s, 0.7, false);
        const double least = brute_force(s, NULL);
        double found = HUGE_VAL;
        for (uint32_t a = 0; a < s->mesh[0]->vertex_count; a += 7) {
            for (uint32_t b = 0; b < s->mesh[1]->vertex_count; b += 7)
                found = fmin(found, refine(s, a, b).squared);
        }
        assert_true(fabs(sqrt(found) - sqrt(least)) <= 1e-12);
    }
    scene_free(s);
}

TEST(vertices_open_sheets_local_minimum)
{
    scene *s = scene_of(sheet_mesh(12, -0.5), sheet_mesh(9, 0.7), 3);
    for (int frame = 0; frame < 40; ++frame) {
        scene_move(s, 0.4, false);
        for (int trial = 0; trial < 10; ++trial) {
            const uint32_t a = draw_vertex(s, 0);
            const uint32_t b = draw_vertex(s, 1);
            const mote_refined r = refine(s, a, b);
            assert_result(s, &r, a, b);
        }
    }
    scene_free(s);
}

static void check_cones(uint32_t n, bool open, uint64_t seed)
{
    scene *s = scene_of(double_cone_mesh(n, open), double_cone_mesh(n, !open), seed);
    for (int frame = 0; frame < 6; ++frame) {
        scene_move(s, frame < 3 ? 0.8 : 0.5, false);
        const mote_refined r = refine(s, 0, 0);
        assert_result(s, &r, 0, 0);
        const double least = brute_force(s, NULL);
        /* Every face shares its apex with every other, so a local minimum is global. */
        assert_true(fabs(sqrt(r.squared) - sqrt(least)) <= 1e-11);
    }
    scene_free(s);
}

TEST(vertices_several_fans_global_minimum)
{
    check_cones(7, false, 4);
    check_cones(7, true, 5);
}

TEST(vertices_ring_of_thousands_local_minimum)
{
    check_cones(150, false, 6);
    scene *s = scene_of(double_cone_mesh(5000, false), letter_mesh('T', 400), 7);
    for (int frame = 0; frame < 3; ++frame) {
        scene_move(s, 0.6, false);
        const mote_refined r = refine(s, 0, 17);
        assert_result(s, &r, 0, 17);
    }
    scene_free(s);
}

TEST(vertices_intersecting_zero_at_one_point)
{
    scene *s = scene_of(letter_mesh('W', 600), letter_mesh('W', 600), 8);
    int contacts = 0;
    for (int frame = 0; frame < 100; ++frame) {
        scene_move(s, 0.1, false);
        const mote_refined r = refine(s, draw_vertex(s, 0), draw_vertex(s, 1));
        if (r.squared > 0)
            continue;
        ++contacts;
        assert_true(memcmp(&r.witness[0], &r.witness[1], sizeof r.witness[0]) == 0);
    }
    assert_true(contacts > 20);
    scene_free(s);
}

/* Alternating projection may end on a line where faces cross, some rounding apart. */
TEST(vertices_crossing_exactly_zero)
{
    scene *s = scene_of(letter_mesh('W', 2000), letter_mesh('W', 2000), 14);
    int contacts = 0;
    for (int frame = 0; frame < 300; ++frame) {
        scene_move(s, 0.4, false);
        for (int trial = 0; trial < 20; ++trial) {
            const mote_refined r = refine(s, draw_vertex(s, 0), draw_vertex(s, 1));
            contacts += r.squared == 0;
            assert_true(r.squared == 0 || sqrt(r.squared) > 1e-12);
        }
    }
    assert_true(contacts > 500);
    scene_free(s);
}

TEST(vertices_enough_stops_early)
{
    scene *s = scene_of(letter_mesh('W', 2000), letter_mesh('W', 2000), 9);
    mote_lazy *const lazy[2] = {&s->lazy[0], &s->lazy[1]};
    int stopped = 0;
    for (int frame = 0; frame < 40; ++frame) {
        scene_move(s, 0.9, false);
        const uint32_t start[2] = {draw_vertex(s, 0), draw_vertex(s, 1)};
        const mote_refined full = refine(s, start[0], start[1]);
        const double enough = 4 * full.squared;
        mote_refined r;
        mote_refine_vertices(lazy, start, enough, &r);
        assert_true(r.squared <= enough);
        assert_true(r.rings <= full.rings);
        stopped += r.rings < full.rings;
    }
    assert_true(stopped > 20);
    scene_free(s);
}

/* Above `worth` the search may end early; below it, it finds what the full search finds. */
TEST(below_finds_what_is_worth_finding)
{
    scene *s = scene_of(letter_mesh('W', 2000), letter_mesh('W', 2000), 15);
    mote_lazy *const lazy[2] = {&s->lazy[0], &s->lazy[1]};
    uint32_t tests[2] = {0};
    int found = 0;
    for (int frame = 0; frame < 200; ++frame) {
        scene_move(s, 0.9, false);
        const uint32_t start[2] = {draw_vertex(s, 0), draw_vertex(s, 1)};
        const mote_refined full = refine(s, start[0], start[1]);
        mote_refined r;
        mote_refine_below(lazy, start, HUGE_VAL, 0, &r);
        assert_memory_equal(&r, &full, sizeof r);
        mote_refine_below(lazy, full.vertex, 0.25 * full.squared, 0, &r);
        assert_true(r.squared >= 0.25 * full.squared);
        assert_true(fabs(mote_length(mote_sub(r.witness[1], r.witness[0])) - sqrt(r.squared)) <=
                    1e-13);
        tests[0] += refine(s, full.vertex[0], full.vertex[1]).triangle_tests;
        tests[1] += r.triangle_tests;
        mote_refine_below(lazy, full.vertex, 1.1 * full.squared, 0, &r);
        found += r.squared <= full.squared * (1 + 1e-9);
    }
    assert_true(found >= 190);
    assert_true(2 * tests[1] < tests[0]);
    scene_free(s);
}

TEST(vertices_positions_given_same_bits)
{
    scene *lazy = scene_of(letter_mesh('M', 600), letter_mesh('V', 400), 10);
    scene *given = scene_of(letter_mesh('M', 600), letter_mesh('V', 400), 10);
    for (int frame = 0; frame < 20; ++frame) {
        scene_move(lazy, 0.6, false);
        scene_move(given, 0.6, true);
        const uint32_t a = draw_vertex(lazy, 0);
        const uint32_t b = draw_vertex(lazy, 1);
        const mote_refined r0 = refine(lazy, a, b);
        const mote_refined r1 = refine(given, a, b);
        assert_memory_equal(&r0, &r1, sizeof r0);
        given->random = lazy->random;
    }
    assert_true(given->lazy[0].evaluated == 0);
    scene_free(lazy);
    scene_free(given);
}

/* Copies a scene with all lengths multiplied by factor. */
static void scene_scale(scene *s, const scene *from, double factor)
{
    for (int side = 0; side < 2; ++side) {
        mote_body_state *state = &s->state[side];
        *state = from->state[side];
        state->pose.translation = mote_scale(state->pose.translation, factor);
        for (uint32_t i = 0; i < s->mesh[side]->vertex_count; ++i)
            s->world[side][i] = mote_scale(from->world[side][i], factor);
        state->vertices = s->world[side];
        mote_lazy_begin(&s->lazy[side], state, true);
    }
}

TEST(vertices_scaled_by_powers_of_two_same_bits)
{
    const int exponent[] = {-100, -40, -1, 7, 90};
    scene *s = scene_of(letter_mesh('M', 600), letter_mesh('V', 400), 11);
    scene *scaled = scene_of(letter_mesh('M', 600), letter_mesh('V', 400), 11);
    for (int frame = 0; frame < 40; ++frame) {
        scene_move(s, 0.2 + 0.02 * frame, true);
        const uint32_t a = draw_vertex(s, 0);
        const uint32_t b = draw_vertex(s, 1);
        const mote_refined r = refine(s, a, b);
        for (size_t e = 0; e < sizeof exponent / sizeof exponent[0]; ++e) {
            const double factor = ldexp(1, exponent[e]);
            scene_scale(scaled, s, factor);
            mote_refined t = refine(scaled, a, b);
            t.squared = t.squared / factor / factor;
            for (int side = 0; side < 2; ++side)
                t.witness[side] = mote_scale(t.witness[side], 1 / factor);
            assert_memory_equal(&t, &r, sizeof r);
        }
    }
    scene_free(s);
    scene_free(scaled);
}

TEST(triangles_random_starts_local_minimum)
{
    scene *s = scene_of(letter_mesh('W', 600), sheet_mesh(12, 0.5), 12);
    mote_lazy *const lazy[2] = {&s->lazy[0], &s->lazy[1]};
    for (int frame = 0; frame < 100; ++frame) {
        scene_move(s, 0.6, false);
        uint32_t start[2][3];
        mote_vec3 corner[2][3];
        for (int side = 0; side < 2; ++side) {
            const uint32_t face = (uint32_t)draw(s, 0, s->mesh[side]->triangle_count);
            memcpy(start[side], s->mesh[side]->triangles[face], sizeof start[side]);
            corners_of(s, side, start[side], corner[side]);
        }
        mote_refined r;
        mote_refine_triangles(lazy, start[0], start[1], 0, &r);
        assert_result(s, &r, start[0][1], start[1][1]);
        assert_true(r.squared <= mote_triangle_triangle(corner[0], corner[1], NULL, NULL));
    }
    scene_free(s);
}

TEST(triangles_from_own_result_unchanged)
{
    scene *s = scene_of(letter_mesh('W', 2000), letter_mesh('W', 2000), 13);
    mote_lazy *const lazy[2] = {&s->lazy[0], &s->lazy[1]};
    for (int frame = 0; frame < 50; ++frame) {
        scene_move(s, 0.9, false);
        const mote_refined r = refine(s, draw_vertex(s, 0), draw_vertex(s, 1));
        mote_refined again;
        mote_refine_triangles(lazy, r.triangle[0], r.triangle[1], 0, &again);
        assert_true(fabs(sqrt(r.squared) - sqrt(again.squared)) <= 1e-12);
        assert_true(again.rings <= 14);
    }
    scene_free(s);
}

TEST(slide_from_random_faces_ends_at_a_nearer_pair)
{
    scene *s = scene_of(letter_mesh('W', 600), sheet_mesh(12, 0.5), 14);
    mote_lazy *const lazy[2] = {&s->lazy[0], &s->lazy[1]};
    uint64_t tests[2] = {0, 0};
    int minima = 0;
    for (int frame = 0; frame < 100; ++frame) {
        scene_move(s, 0.6, false);
        mote_refined r = {.squared = 0}, full;
        mote_vec3 corner[2][3];
        for (int side = 0; side < 2; ++side) {
            const uint32_t face = (uint32_t)draw(s, 0, s->mesh[side]->triangle_count);
            memcpy(r.triangle[side], s->mesh[side]->triangles[face], sizeof r.triangle[side]);
            corners_of(s, side, r.triangle[side], corner[side]);
        }
        r.squared = mote_triangle_triangle(corner[0], corner[1], &r.witness[0], &r.witness[1]);
        const double before = r.squared;
        mote_refine_triangles(lazy, (const uint32_t *)r.triangle[0], r.triangle[1], 0, &full);
        tests[1] += full.triangle_tests;
        mote_refine_slide(lazy, 0, &r);
        tests[0] += r.triangle_tests;
        assert_true(r.squared <= before);
        for (int side = 0; side < 2; ++side)
            corners_of(s, side, r.triangle[side], corner[side]);
        const double measured = mote_triangle_triangle(corner[0], corner[1], NULL, NULL);
        assert_true(fabs(sqrt(measured) - sqrt(r.squared)) <= 1e-15);
        assert_measured(s, &r, r.triangle[0][0], r.triangle[1][0]);
        mote_refine_triangles(lazy, (const uint32_t *)r.triangle[0], r.triangle[1], 0, &full);
        minima += sqrt(full.squared) > 0.999 * sqrt(r.squared);
    }
    assert_true(minima > 50);
    assert_true(3 * tests[0] < tests[1]);
    scene_free(s);
}
