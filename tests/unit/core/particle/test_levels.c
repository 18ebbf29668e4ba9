/* The levels of a mesh against their definition, checked edge by edge. */
#include "core/particle/levels.h"
#include "datasets/letter.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

/* The neighbours in the level below, as a plain range. */
typedef struct range {
    const uint32_t *at;
    uint32_t count;
} range;

static range below(const mote_mesh *mesh, const mote_levels *levels, uint32_t l, uint32_t node)
{
    const uint32_t *start = l == 0 ? mesh->ring_start : levels->level[l - 1].start;
    const uint32_t *all = l == 0 ? mesh->ring : levels->level[l - 1].neighbour;
    return (range){all + start[node], start[node + 1] - start[node]};
}

static uint32_t below_count(const mote_mesh *mesh, const mote_levels *levels, uint32_t l)
{
    return l == 0 ? mesh->vertex_count : levels->level[l - 1].count;
}

/* Which nodes of the level below are nodes of level l. */
static bool *chosen_below(const mote_mesh *mesh, const mote_levels *levels, uint32_t l)
{
    bool *chosen = calloc(below_count(mesh, levels, l), sizeof *chosen);
    assert_non_null(chosen);
    for (uint32_t i = 0; i < levels->level[l].count; ++i) {
        const uint32_t node = l == 0 ? levels->vertex[i] : i;
        assert_true(node < below_count(mesh, levels, l));
        assert_false(chosen[node]);
        chosen[node] = true;
    }
    return chosen;
}

/* No two nodes are neighbours in the level below, and every other node below has one as a
   neighbour. */
static void assert_independent_maximal(const mote_mesh *mesh, const mote_levels *levels,
                                       uint32_t l)
{
    bool *chosen = chosen_below(mesh, levels, l);
    for (uint32_t i = 0; i < below_count(mesh, levels, l); ++i) {
        const range r = below(mesh, levels, l, i);
        uint32_t count = 0;
        for (uint32_t k = 0; k < r.count; ++k)
            count += chosen[MOTE_RING_VERTEX(r.at[k])];
        assert_true(chosen[i] ? count == 0 : count > 0);
    }
    free(chosen);
}

static bool linked(const mote_level *level, uint32_t from, uint32_t to)
{
    for (uint32_t k = level->start[from]; k < level->start[from + 1]; ++k) {
        if (level->neighbour[k] == to)
            return true;
    }
    return false;
}

static void assert_graph(const mote_level *level)
{
    for (uint32_t i = 0; i < level->count; ++i) {
        for (uint32_t k = level->start[i]; k < level->start[i + 1]; ++k) {
            const uint32_t u = level->neighbour[k];
            assert_true(u < level->count && u != i);
            assert_true(linked(level, u, i));
            for (uint32_t j = level->start[i]; j < k; ++j)
                assert_int_not_equal(level->neighbour[j], u);
        }
    }
}

/* Checks that nodes connected with each other belong to one component of the mesh. */
static void assert_connected_alike(const mote_mesh *mesh, const mote_levels *levels, uint32_t l)
{
    const mote_level *level = &levels->level[l];
    uint32_t *label = malloc(level->count * sizeof *label);
    uint32_t *stack = malloc(level->count * sizeof *stack);
    assert_non_null(label);
    assert_non_null(stack);
    memset(label, 0xff, level->count * sizeof *label);
    uint32_t pieces = 0;
    for (uint32_t first = 0; first < level->count; ++first) {
        if (label[first] != UINT32_MAX)
            continue;
        ++pieces;
        uint32_t depth = 1;
        stack[0] = first;
        label[first] = first;
        while (depth > 0) {
            const uint32_t i = stack[--depth];
            assert_int_equal(mesh->component[levels->vertex[i]],
                             mesh->component[levels->vertex[first]]);
            for (uint32_t k = level->start[i]; k < level->start[i + 1]; ++k) {
                if (label[level->neighbour[k]] == UINT32_MAX) {
                    label[level->neighbour[k]] = first;
                    stack[depth++] = level->neighbour[k];
                }
            }
        }
    }
    assert_int_equal(pieces, mesh->component_count);
    free(label);
    free(stack);
}

static mote_levels *levels_of(const mote_mesh *mesh)
{
    mote_levels *levels = NULL;
    assert_int_equal(mote_levels_create(mesh, &levels), MOTE_OK);
    return levels;
}

/* Takes ownership of the mesh. */
static void check_levels(mote_mesh *mesh)
{
    mote_levels *levels = levels_of(mesh);
    assert_true(levels->depth >= 1);
    for (uint32_t l = 0; l < levels->depth; ++l) {
        assert_independent_maximal(mesh, levels, l);
        assert_graph(&levels->level[l]);
        assert_connected_alike(mesh, levels, l);
    }
    mote_levels_destroy(levels);
    mote_mesh_destroy(mesh);
}

static mote_mesh *letter(char name, size_t triangles)
{
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_letter_create(name, triangles, &mesh), MOTE_OK);
    return mesh;
}

TEST(create_closed_meshes_as_defined)
{
    check_levels(letter('W', 5000));
    check_levels(solid_to_mesh(solid_icosphere(3)));
    check_levels(solid_to_mesh(solid_torus(40, 15)));
}

TEST(create_open_and_tiny_meshes_as_defined)
{
    check_levels(solid_to_mesh(solid_grid(30, 20)));
    check_levels(solid_to_mesh(solid_triangle()));
    check_levels(solid_to_mesh(solid_tetrahedron()));
    check_levels(solid_to_mesh(solid_fan(3000, 1)));
}

/* The fourth powers of its edges overflow a double. */
TEST(create_mesh_as_large_as_may_be_as_defined)
{
    solid s = solid_torus(40, 15);
    for (size_t i = 0; i < 3 * s.vertex_count; ++i)
        s.xyz[i] *= 1e129;
    check_levels(solid_to_mesh(s));
}

/* A level of one node has no neighbours, the distance of which would say how near a descent
   from it can come. */
TEST(create_level_without_neighbours_has_the_spacing_of_the_body)
{
    mote_mesh *mesh = solid_to_mesh(solid_tetrahedron());
    mote_levels *levels = levels_of(mesh);
    assert_int_equal(levels->depth, 1);
    assert_int_equal(levels->level[0].count, 1);
    assert_true(levels->level[0].spacing == mesh->diagonal);
    mote_levels_destroy(levels);
    mote_mesh_destroy(mesh);
}

TEST(create_many_components_as_defined)
{
    solid s = solid_join(solid_torus(20, 9), solid_icosphere(2), 4);
    for (int i = 0; i < 60; ++i)
        s = solid_join(s, solid_tetrahedron(), 8 + 4 * i);
    check_levels(solid_to_mesh(s));
}

TEST(create_letter_lean_and_coarse)
{
    mote_mesh *mesh = letter('W', 40000);
    mote_levels *levels = levels_of(mesh);
    const uint32_t last = levels->level[levels->depth - 1].count;
    assert_true(last <= MOTE_LEVELS_COARSEST);
    assert_true(mote_levels_bytes(levels) <= 14 * (size_t)mesh->vertex_count);
    for (uint32_t l = 0; l < levels->depth; ++l)
        assert_true(3 * levels->level[l].count <= below_count(mesh, levels, l));
    mote_levels_destroy(levels);
    mote_mesh_destroy(mesh);
}

TEST(spread_farthest_is_farthest)
{
    mote_mesh *mesh = letter('M', 4000);
    mote_levels *levels = levels_of(mesh);
    uint32_t node[20];
    assert_int_equal(mote_levels_spread(levels, mesh, 0, 20, true, 5, node), MOTE_OK);
    for (int i = 1; i < 20; ++i) {
        double here = HUGE_VAL;
        double most = 0;
        for (uint32_t k = 0; k < levels->level[0].count; ++k) {
            double least = HUGE_VAL;
            for (int j = 0; j < i; ++j)
                least = fmin(least,
                             mote_distance_squared(mesh->positions[levels->vertex[k]],
                                                   mesh->positions[levels->vertex[node[j]]]));
            most = fmax(most, least);
            if (k == node[i])
                here = least;
        }
        assert_true(here == most);
    }
    mote_levels_destroy(levels);
    mote_mesh_destroy(mesh);
}

TEST(spread_covers_components_with_different_nodes)
{
    solid s = solid_join(solid_torus(20, 9), solid_icosphere(2), 4);
    for (int i = 0; i < 10; ++i)
        s = solid_join(s, solid_tetrahedron(), 8 + 4 * i);
    mote_mesh *mesh = solid_to_mesh(s);
    mote_levels *levels = levels_of(mesh);
    for (int farthest = 0; farthest < 2; ++farthest) {
        for (uint64_t seed = 0; seed < 20; ++seed) {
            uint32_t node[24], again[24];
            assert_int_equal(mote_levels_spread(levels, mesh, 0, 24, farthest != 0, seed, node),
                             MOTE_OK);
            assert_int_equal(
                mote_levels_spread(levels, mesh, 0, 24, farthest != 0, seed, again), MOTE_OK);
            assert_memory_equal(node, again, sizeof node);
            bool seen[12] = {false};
            for (int i = 0; i < 24; ++i) {
                if (i < 12)
                    seen[mesh->component[levels->vertex[node[i]]]] = true;
                for (int j = 0; j < i; ++j)
                    assert_int_not_equal(node[i], node[j]);
            }
            for (int c = 0; c < 12; ++c)
                assert_true(seen[c]);
            /* The first 12 are the same if only as many are wanted as there are components. */
            assert_int_equal(
                mote_levels_spread(levels, mesh, 0, 12, farthest != 0, seed, again), MOTE_OK);
            assert_memory_equal(node, again, 12 * sizeof *node);
        }
    }
    mote_levels_destroy(levels);
    mote_mesh_destroy(mesh);
}

/* Each vertex is a node or one edge farther from its home than some neighbour with that home,
   and no neighbour is two edges nearer to any node. */
TEST(home_letter_nearest_by_edges)
{
    mote_mesh *mesh = letter('V', 3000);
    mote_levels *levels = levels_of(mesh);
    const uint32_t l = 1;
    uint32_t *home = NULL;
    assert_int_equal(mote_levels_home(levels, mesh, l, &home), MOTE_OK);
    uint32_t *edges = malloc(mesh->vertex_count * sizeof *edges);
    assert_non_null(edges);
    memset(edges, 0xff, mesh->vertex_count * sizeof *edges);
    for (uint32_t i = 0; i < levels->level[l].count; ++i)
        edges[levels->vertex[i]] = 0;
    for (uint32_t pass = 0; pass < 50; ++pass) {
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            for (uint32_t k = mesh->ring_start[v]; k < mesh->ring_start[v + 1]; ++k) {
                const uint32_t from = edges[mesh->ring[k]];
                if (from != UINT32_MAX && from + 1 < edges[v])
                    edges[v] = from + 1;
            }
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        assert_true(home[v] < levels->level[l].count);
        bool passed_on = edges[v] == 0 && levels->vertex[home[v]] == v;
        for (uint32_t k = mesh->ring_start[v]; k < mesh->ring_start[v + 1]; ++k)
            passed_on = passed_on || (edges[mesh->ring[k]] + 1 == edges[v] &&
                                      home[mesh->ring[k]] == home[v]);
        assert_true(passed_on);
    }
    free(edges);
    free(home);
    mote_levels_destroy(levels);
    mote_mesh_destroy(mesh);
}

TEST(destroy_null_does_nothing)
{
    mote_levels_destroy(NULL);
}
