/* The boxes of a pass against the extents of all vertices. */
#include "core/stream/stream_boxes.h"

#include "tests/support/stream_scene.h"

/* Layouts of positions: numbers from one vertex to the next, in double or single precision. */
static const struct layout {
    size_t stride;
    bool single;
} layouts[] = {{3, false}, {4, false}, {3, true}, {5, true}};

static void same_box(const float low[3], const float high[3], const double least[3],
                     const double most[3])
{
    for (int k = 0; k < 3; ++k) {
        const float expected[2] = {(float)least[k], (float)most[k]};
        assert_memory_equal(&low[k], &expected[0], sizeof low[k]);
        assert_memory_equal(&high[k], &expected[1], sizeof high[k]);
    }
}

/* Widens an extent by a vertex in the coordinates of the boxes. */
static void widen(const mote_stream_body *body, uint32_t vertex, double low[3], double high[3])
{
    const mote_vec3 p = mote_position_at(&body->positions, vertex);
    const double x[3] = {(p.x - body->origin.x) * body->scale,
                         (p.y - body->origin.y) * body->scale,
                         (p.z - body->origin.z) * body->scale};
    for (int k = 0; k < 3; ++k) {
        low[k] = fmin(low[k], x[k]);
        high[k] = fmax(high[k], x[k]);
    }
}

static void check_groups(const mote_stream_body *body)
{
    const mote_stream_tree *tree = body->tree;
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    double high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t v = 0; v < tree->mesh->vertex_count; ++v)
        widen(body, v, low, high);
    same_box(body->root.low, body->root.high, low, high);
    for (uint32_t group = 0; group < tree->groups; ++group) {
        const uint32_t end = 8 * group + 8 < tree->leaves ? 8 * group + 8 : tree->leaves;
        const mote_stream_box box = mote_stream_box_of(body, tree->height, group);
        for (int k = 0; k < 3; ++k) {
            low[k] = HUGE_VAL;
            high[k] = -HUGE_VAL;
        }
        for (size_t i = tree->leaf_start[8 * group]; i < tree->leaf_start[end]; ++i)
            widen(body, tree->leaf_vertices[i], low, high);
        same_box(box.low, box.high, low, high);
    }
}

/* The box of each node is that around its children's; a lane without a child is empty. */
static void check_level(const mote_stream_body *body, uint32_t level)
{
    const mote_stream_tree *tree = body->tree;
    const uint32_t nodes = tree->first_block[level + 1] - tree->first_block[level];
    const uint32_t below = level + 1 < tree->height
                               ? tree->first_block[level + 2] - tree->first_block[level + 1]
                               : tree->groups;
    for (uint32_t node = 0; node < nodes; ++node) {
        const mote_stream_block *children = mote_stream_children(body, level, node);
        double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
        double high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
        for (uint32_t l = 0; l < 8; ++l) {
            const bool child = 8 * node + l < below;
            for (int k = 0; k < 3; ++k) {
                assert_true(child ==
                            ((double)children->low[k][l] <= (double)children->high[k][l]));
                assert_true(child || (double)children->low[k][l] >= HUGE_VAL);
                assert_true(child || (double)children->high[k][l] <= -HUGE_VAL);
                low[k] = fmin(low[k], (double)children->low[k][l]);
                high[k] = fmax(high[k], (double)children->high[k][l]);
            }
        }
        const mote_stream_box box = mote_stream_box_of(body, level, node);
        same_box(box.low, box.high, low, high);
    }
}

static void check_pass(mote_stream_body *body, const scene *s, const struct layout *layout,
                       mote_vec3 origin, double scale)
{
    const uint32_t count = body->tree->mesh->vertex_count;
    const size_t size = layout->single ? sizeof(float) : sizeof(double);
    void *data = spread_out(s->world[0], count, layout->stride, layout->single);
    body->positions = (mote_positions){
        .data = data, .stride = layout->stride * size, .single = layout->single};
    assert_int_equal(mote_stream_pass(body, origin, scale, NULL, 0), MOTE_OK);
    assert_true(body->placed && body->checked);
    check_groups(body);
    for (uint32_t level = 0; level < body->tree->height; ++level)
        check_level(body, level);
    free(data);
}

/* One leaf, one group, one block, and 2, 8 (of 64 groups) and 9 blocks. */
TEST(pass_boxes_are_the_extents_of_their_vertices)
{
    static const uint32_t sizes[][2] = {{3, 3},   {9, 7},    {50, 17},
                                        {64, 33}, {128, 64}, {130, 64}};
    for (size_t i = 0; i < ROWS_OF(sizes); ++i) {
        scene s;
        mote_stream_tree *tree = NULL;
        mote_stream_body body;
        scene_init_meshes(&s, make_torus(sizes[i][0], sizes[i][1], 1), make_torus(3, 3, 1),
                          true);
        assert_int_equal(mote_stream_tree_create(&s.body[0], &tree), MOTE_OK);
        assert_int_equal(mote_stream_body_init(&body, tree), MOTE_OK);
        assert_int_equal(mote_stream_body_bytes(&body),
                         tree->first_block[tree->height] * sizeof(mote_stream_block));
        for (size_t k = 0; k < ROWS_OF(layouts); ++k) {
            scene_next(&s, 1.4, false);
            test_row("%u triangles, stride %zu, single %d", s.mesh[0]->triangle_count,
                     layouts[k].stride, layouts[k].single);
            check_pass(&body, &s, &layouts[k], mote_vec3_make(0.1, -7, 1e3), k % 2 ? 0.125 : 4);
        }
        mote_stream_body_free(&body);
        mote_stream_tree_destroy(tree);
        scene_free(&s);
    }
}
