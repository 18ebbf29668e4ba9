/* Trees of streamed queries against the lists that the header promises. */
#include "core/stream/stream_tree.h"

#include "core/stream/stream.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"

/* Bodies of one leaf, one group, and of 8, 9 and more blocks of groups; no two faces of
   `separate` share a vertex. */
static const struct shape {
    uint32_t across, around;
    bool separate;
} shapes[] = {{3, 3, false},   {4, 4, false},    {9, 7, false}, {25, 11, false},
              {64, 32, false}, {128, 64, false}, {9, 7, true},  {12, 11, true},
              {40, 30, true},  {130, 64, false}, {30, 20, true}};

static mote_mesh *make(const struct shape *shape)
{
    mote_mesh *torus = make_torus(shape->across, shape->around, 1);
    if (!shape->separate)
        return torus;
    const uint32_t count = 3 * torus->triangle_count;
    double *xyz = malloc(3 * count * sizeof *xyz);
    uint32_t *faces = malloc(count * sizeof *faces);
    need(xyz && faces);
    for (uint32_t i = 0; i < count; ++i) {
        /* every other face is far from its neighbours in the list */
        const uint32_t to = i % 2 ? i : (i + count / 2) / 2 * 2 % count;
        faces[i] = to;
        memcpy(xyz + 3 * (size_t)to, &torus->positions[torus->triangles[i / 3][i % 3]],
               3 * sizeof *xyz);
    }
    mote_mesh *mesh = NULL;
    need(mote_mesh_create(xyz, count, faces, torus->triangle_count, &mesh) == MOTE_OK);
    free(xyz);
    free(faces);
    mote_mesh_destroy(torus);
    return mesh;
}

static mote_stream_tree *tree_of(const mote_mesh *mesh)
{
    const mote_body body = {.mesh = mesh};
    mote_stream_tree *tree = NULL;
    need(mote_stream_tree_create(&body, &tree) == MOTE_OK);
    return tree;
}

/* The header's numbers: leaves of 32 triangles, groups of 8 leaves, nodes of 8 children. */
static void check_levels(const mote_stream_tree *tree)
{
    const uint32_t triangles = tree->mesh->triangle_count;
    assert_int_equal(tree->leaves, (triangles + 31) / 32);
    assert_int_equal(tree->groups, (tree->leaves + 7) / 8);
    assert_int_equal(tree->first_block[0], 0);
    assert_int_equal(tree->first_block[1], 1);
    uint32_t nodes = tree->groups;
    for (uint32_t level = tree->height; level > 0; --level) {
        nodes = (nodes + 7) / 8;
        assert_int_equal(tree->first_block[level] - tree->first_block[level - 1], nodes);
    }
    assert_int_equal(nodes, 1);
}

static bool is_in(const uint32_t *list, size_t count, uint32_t value)
{
    bool found = false;
    for (size_t i = 0; i < count; ++i)
        found = found || list[i] == value;
    return found;
}

/* Each triangle is in one leaf, and each leaf lists its corners once. */
static void check_leaves(const mote_stream_tree *tree)
{
    const mote_mesh *mesh = tree->mesh;
    bool *taken = calloc(mesh->triangle_count, sizeof *taken);
    need(taken);
    assert_int_equal(tree->leaf_start[0], 0);
    for (uint32_t leaf = 0; leaf < tree->leaves; ++leaf) {
        const uint32_t *list = tree->leaf_vertices + tree->leaf_start[leaf];
        const size_t count = tree->leaf_start[leaf + 1] - tree->leaf_start[leaf];
        bool used[3 * MOTE_STREAM_LEAF] = {false};
        assert_in_range(count, 3, 3 * MOTE_STREAM_LEAF);
        for (size_t i = 0; i < count; ++i)
            assert_false(is_in(list, i, list[i]));
        const size_t first = (size_t)leaf * MOTE_STREAM_LEAF;
        for (size_t i = first; i < first + mote_stream_leaf_faces(tree, leaf); ++i) {
            assert_in_range(tree->order[i], 0, mesh->triangle_count - 1);
            assert_false(taken[tree->order[i]]);
            taken[tree->order[i]] = true;
            for (int k = 0; k < 3; ++k) {
                assert_in_range(tree->corners[i][k], 0, count - 1);
                used[tree->corners[i][k]] = true;
                assert_int_equal(list[tree->corners[i][k]], mesh->triangles[tree->order[i]][k]);
            }
        }
        for (size_t i = 0; i < count; ++i)
            assert_true(used[i]);
    }
    free(taken);
}

/* Marks the vertices of a group's leaves; returns how many there are. */
static uint32_t mark_group(const mote_stream_tree *tree, uint32_t group, bool *of_group)
{
    const uint32_t end = 8 * group + 8 < tree->leaves ? 8 * group + 8 : tree->leaves;
    uint32_t count = 0;
    memset(of_group, 0, tree->mesh->vertex_count * sizeof *of_group);
    for (size_t i = tree->leaf_start[8 * group]; i < tree->leaf_start[end]; ++i) {
        count += !of_group[tree->leaf_vertices[i]];
        of_group[tree->leaf_vertices[i]] = true;
    }
    return count;
}

/* What the runs and singles of a group have to be: of each stretch of at least eight vertices
   in a row, as few runs as cover it; of shorter ones the vertices, without the mesh's last. */
static void expect_lists(const mote_stream_tree *tree, const bool *of_group, size_t *runs,
                         size_t *singles, bool *last)
{
    const uint32_t count = tree->mesh->vertex_count;
    *runs = *singles = 0;
    *last = false;
    for (uint32_t v = 0; v < count;) {
        uint32_t end = v;
        while (end < count && of_group[end])
            ++end;
        if (end - v >= MOTE_STREAM_RUN)
            *runs += (end - v + MOTE_STREAM_RUN - 1) / MOTE_STREAM_RUN;
        else if (end > v) {
            *last = end == count;
            *singles += end - v - *last;
        }
        v = end + 1;
    }
    *singles = (*singles + 3) / 4 * 4;
}

static void check_group(const mote_stream_tree *tree, uint32_t group, bool *of_group,
                        bool *seen)
{
    const uint32_t vertices = tree->mesh->vertex_count;
    const uint32_t count = mark_group(tree, group, of_group);
    size_t runs, singles;
    bool last;
    expect_lists(tree, of_group, &runs, &singles, &last);
    test_row("group %u", group);
    assert_int_equal(tree->run_start[group + 1] - tree->run_start[group], runs);
    assert_int_equal(tree->single_start[group + 1] - tree->single_start[group], singles);
    assert_int_equal(tree->last[group], last);
    memset(seen, 0, vertices * sizeof *seen);
    for (size_t r = tree->run_start[group]; r < tree->run_start[group + 1]; ++r) {
        for (uint32_t v = tree->runs[r]; v < tree->runs[r] + MOTE_STREAM_RUN; ++v) {
            assert_true(v < vertices && of_group[v]);
            seen[v] = true;
        }
    }
    for (size_t k = tree->single_start[group]; k < tree->single_start[group + 1]; ++k) {
        assert_true(tree->singles[k] < vertices - 1 && of_group[tree->singles[k]]);
        seen[tree->singles[k]] = true;
    }
    seen[vertices - 1] = seen[vertices - 1] || last;
    uint32_t found = 0;
    for (uint32_t v = 0; v < vertices; ++v)
        found += seen[v];
    assert_int_equal(found, count);
}

/* The sizes of the arrays in the header. */
static size_t bytes_of(const mote_stream_tree *tree)
{
    const size_t triangles = tree->mesh->triangle_count;
    size_t bytes = sizeof *tree + triangles * (sizeof(uint32_t) + 3 * sizeof(uint8_t));
    bytes += (tree->leaves + 1) * sizeof(size_t);
    bytes += tree->leaf_start[tree->leaves] * sizeof(uint32_t);
    bytes += 2 * (tree->groups + 1) * sizeof(size_t);
    bytes +=
        (tree->run_start[tree->groups] + tree->single_start[tree->groups]) * sizeof(uint32_t);
    return bytes + tree->groups * sizeof(bool);
}

TEST(create_lists_are_those_of_the_header)
{
    for (size_t i = 0; i < ROWS_OF(shapes); ++i) {
        mote_mesh *mesh = make(&shapes[i]);
        mote_stream_tree *tree = tree_of(mesh);
        bool *of_group = malloc(mesh->vertex_count), *seen = malloc(mesh->vertex_count);
        need(of_group && seen);
        test_row("%u triangles", mesh->triangle_count);
        assert_ptr_equal(tree->mesh, mesh);
        assert_ptr_equal(tree->body.mesh, mesh);
        check_levels(tree);
        check_leaves(tree);
        for (uint32_t group = 0; group < tree->groups; ++group)
            check_group(tree, group, of_group, seen);
        /* a byte more than the flags take is counted */
        assert_in_range(mote_stream_tree_bytes(tree), bytes_of(tree), bytes_of(tree) + 1);
        free(of_group);
        free(seen);
        mote_stream_tree_destroy(tree);
        mote_mesh_destroy(mesh);
    }
}

/* The order of a pass has each vertex once, also of a body that is one leaf. */
TEST(order_has_each_vertex_once)
{
    for (size_t i = 0; i < ROWS_OF(shapes); ++i) {
        mote_mesh *mesh = make(&shapes[i]);
        const mote_body body = {.mesh = mesh};
        uint32_t *order = malloc(mesh->vertex_count * sizeof *order);
        bool *taken = calloc(mesh->vertex_count, sizeof *taken);
        need(order && taken);
        memset(order, 0xff, mesh->vertex_count * sizeof *order);
        assert_int_equal(mote_stream_order(&body, order), MOTE_OK);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            assert_in_range(order[v], 0, mesh->vertex_count - 1);
            assert_false(taken[order[v]]);
            taken[order[v]] = true;
        }
        free(order);
        free(taken);
        mote_mesh_destroy(mesh);
    }
}
