/* Leaves of streamed queries: their points in the gap's axes, boxes, reaches and near faces,
   against sums in double precision and against each face. */
#include "core/stream/stream_beside.h"
#include "tests/support/own_stream.h"

/* What a float's rounding may change in coordinates below 4. */
#define ROUNDED 4e-6

/* Fills the part of the stack that the next calls use, so that nothing there is right by luck.
 */
static void __attribute__((noinline)) spoil_stack(void)
{
    volatile double room[4096];
    for (size_t i = 0; i < ROWS_OF(room); ++i)
        room[i] = 1e6 + (double)i;
}

/* A vertex in the query's coordinates. */
static mote_vec3 placed(const mote_stream_search *s, int side, uint32_t vertex)
{
    const mote_vec3 p = mote_position_at(&s->side[side].body->positions, vertex);
    return mote_scale(mote_sub(p, s->origin), s->scale);
}

/* The same in the gap's axes. */
static mote_vec3 turned(const mote_stream_search *s, mote_vec3 p)
{
    double x[3];
    for (int k = 0; k < 3; ++k)
        x[k] = p.x * (double)s->turn[k][0] + p.y * (double)s->turn[k][1] +
               p.z * (double)s->turn[k][2];
    return mote_vec3_make(x[0], x[1], x[2]);
}

static void check_points(mote_stream_search *s, int side, uint32_t leaf)
{
    const mote_stream_tree *tree = s->side[side].body->tree;
    const size_t first = tree->leaf_start[leaf], count = tree->leaf_start[leaf + 1] - first;
    float low[3] = {HUGE_VALF, HUGE_VALF, HUGE_VALF};
    float high[3] = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};
    double reach = -HUGE_VAL;
    spoil_stack();
    mote_stream_slot *slot = mote_stream_leaf(s, side, leaf);
    assert_int_equal(slot->leaf, leaf);
    assert_int_equal(slot->stamp, s->stamp);
    assert_int_equal(slot->groups, (count + 7) / 8);
    for (size_t i = 0; i < (count + 7) / 8 * 8; ++i) { /* filled up with the last */
        const size_t of = i < count ? i : count - 1;
        const mote_vec3 at = placed(s, side, tree->leaf_vertices[first + of]),
                        p = turned(s, at);
        const double x[3] = {p.x, p.y, p.z};
        for (int k = 0; k < 3; ++k) {
            assert_true(fabs((double)slot->x[k][i] - x[k]) < ROUNDED);
            low[k] = slot->x[k][i] < low[k] ? slot->x[k][i] : low[k];
            high[k] = slot->x[k][i] > high[k] ? slot->x[k][i] : high[k];
        }
        reach = fmax(reach, (side == 0 ? 1 : -1) * mote_dot(at, s->toward));
    }
    assert_memory_equal(slot->low, low, sizeof low);
    assert_memory_equal(slot->high, high, sizeof high);
    assert_true(fabs(mote_stream_reach(s, side, slot) - reach) < 1e-14);
    /* kept until the direction changes */
    slot->reach = 77;
    assert_true(mote_stream_reach(s, side, slot) > 76);
    ++s->aim;
    assert_true(fabs(mote_stream_reach(s, side, slot) - reach) < 1e-14);
    /* and the leaf until the next query */
    const float kept = slot->x[1][0];
    slot->x[1][0] = 77;
    assert_ptr_equal(mote_stream_leaf(s, side, leaf), slot);
    assert_true((double)slot->x[1][0] > 76);
    slot->x[1][0] = kept;
}

static void check_group(mote_stream_search *s, int side, uint32_t group)
{
    const mote_stream_tree *tree = s->side[side].body->tree;
    const uint64_t blocks = s->counters.blocks;
    s->side[side].opened[group] = 0;
    const mote_stream_block *block = mote_stream_open_group(s, side, group);
    assert_int_equal(s->counters.blocks, blocks + 1);
    assert_ptr_equal(mote_stream_open_group(s, side, group), block);
    assert_int_equal(s->counters.blocks, blocks + 1);
    float low[3] = {HUGE_VALF, HUGE_VALF, HUGE_VALF};
    float high[3] = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};
    for (uint32_t l = 0; l < 8; ++l) {
        const uint32_t leaf = 8 * group + l;
        const mote_stream_slot *slot =
            leaf < tree->leaves ? mote_stream_leaf(s, side, leaf) : NULL;
        for (int k = 0; k < 3; ++k) {
            const float expected[2] = {slot ? slot->low[k] : HUGE_VALF,
                                       slot ? slot->high[k] : -HUGE_VALF};
            assert_memory_equal(&block->low[k][l], &expected[0], sizeof(float));
            assert_memory_equal(&block->high[k][l], &expected[1], sizeof(float));
            low[k] = expected[0] < low[k] ? expected[0] : low[k];
            high[k] = expected[1] > high[k] ? expected[1] : high[k];
        }
    }
    assert_memory_equal(s->side[side].groups[group].low, low, sizeof low);
    assert_memory_equal(s->side[side].groups[group].high, high, sizeof high);
}

/* The box of a face, from its corners. */
static mote_stream_box box_of(const mote_stream_tree *tree, const mote_stream_slot *slot,
                              uint32_t face)
{
    const uint8_t *corner = tree->corners[slot->leaf * MOTE_STREAM_LEAF + face];
    mote_stream_box box;
    for (int k = 0; k < 3; ++k) {
        const float *x = slot->x[k];
        const float a = x[corner[0]], b = x[corner[1]], c = x[corner[2]];
        box.low[k] = fminf(a, fminf(b, c));
        box.high[k] = fmaxf(a, fmaxf(b, c));
    }
    return box;
}

static double squared_distance(const float low[3], const float high[3],
                               const mote_stream_box *other)
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double gap = fmax((double)low[k] - (double)other->high[k],
                                (double)other->low[k] - (double)high[k]);
        sum += gap > 0 ? gap * gap : 0;
    }
    return sum;
}

/* Of two leaves, faces are near that are near the other leaf's box and each other. Distances
   that rounding might put on either side count as neither. Adds up the pairs that are near. */
static void check_near_faces(mote_stream_search *s, const uint32_t leaf[2],
                             uint64_t *near_pairs)
{
    mote_stream_slot *slot[2];
    const mote_stream_tree *tree[2];
    for (int b = 0; b < 2; ++b) {
        slot[b] = mote_stream_leaf(s, b, leaf[b]);
        tree[b] = s->side[b].body->tree;
        memset(slot[b]->face_low, 0, sizeof slot[b]->face_low);
        memset(slot[b]->face_high, 0, sizeof slot[b]->face_high);
        slot[b]->boxed = false;
    }
    mote_cert_near near;
    memset(&near, 0, sizeof near);
    spoil_stack();
    const uint32_t count = mote_stream_near_faces(s, slot, &near);
    assert_true(slot[0]->boxed && slot[1]->boxed);
    uint32_t found = 0;
    for (uint32_t i = 0; i < MOTE_STREAM_LEAF; ++i) {
        const uint32_t bits = near.used >> i & 1 ? near.undecided[i] : 0;
        assert_int_equal(near.used >> i & 1, bits != 0);
        for (uint32_t j = 0; j < MOTE_STREAM_LEAF; ++j) {
            const bool is_near = bits >> j & 1;
            found += is_near;
            if (i >= mote_stream_leaf_faces(tree[0], leaf[0]) ||
                j >= mote_stream_leaf_faces(tree[1], leaf[1])) {
                assert_false(is_near);
                continue;
            }
            const mote_stream_box a = box_of(tree[0], slot[0], i),
                                  b = box_of(tree[1], slot[1], j);
            const double nearest =
                fmax(squared_distance(a.low, a.high, &b),
                     fmax(squared_distance(slot[1]->low, slot[1]->high, &a),
                          squared_distance(slot[0]->low, slot[0]->high, &b)));
            if (fabs(nearest - (double)s->squared) > 1e-5 * (double)s->squared)
                assert_int_equal(is_near, nearest < (double)s->squared);
        }
    }
    assert_int_equal(count, found);
    *near_pairs += found;
}

/* Gives both bodies the scene's positions in single precision, which the scene then has too.
   The caller frees data. */
static void give_floats(own_query *own, scene *s, size_t stride, void *data[2])
{
    for (int b = 0; b < 2; ++b) {
        for (uint32_t v = 0; v < s->mesh[b]->vertex_count; ++v)
            s->world[b][v] = mote_as_floats(s->world[b][v]);
        data[b] = spread_out(s->world[b], s->mesh[b]->vertex_count, stride, true);
        own->body[b].positions =
            (mote_positions){.data = data[b], .stride = stride * sizeof(float), .single = true};
    }
}

TEST(leaf_groups_and_near_faces_are_those_of_the_positions)
{
    static const size_t strides[] = {0, 3, 5}; /* 0: double precision */
    uint64_t near_pairs = 0, all_pairs = 0;
    scene s;
    scene_init(&s, 25, 11, 1, true);
    for (size_t k = 0; k < 4 * ROWS_OF(strides); ++k) {
        static own_query own;
        const size_t stride = strides[k / 4];
        void *data[2] = {NULL, NULL};
        own_init(&own, &s);
        do /* bodies that touch at once have no axes */
            scene_next(&s, 1.4, false);
        while (!(own_ask(&own, &s).distance > 0));
        if (stride > 0)
            give_floats(&own, &s, stride, data);
        ++own.search.stamp; /* nothing is kept */
        test_row("frame %zu, stride %zu", k, stride);
        for (int b = 0; b < 2; ++b) {
            for (uint32_t leaf = 0; leaf < own.tree[b]->leaves; ++leaf)
                check_points(&own.search, b, leaf);
            for (uint32_t group = 0; group < own.tree[b]->groups; ++group)
                check_group(&own.search, b, group);
        }
        own.search.squared = 0.04F;
        for (uint32_t i = 0; i < own.tree[0]->leaves; ++i) {
            for (uint32_t j = 0; j < own.tree[1]->leaves; ++j) {
                const uint32_t leaf[2] = {i, j};
                check_near_faces(&own.search, leaf, &near_pairs);
                all_pairs += MOTE_STREAM_LEAF * MOTE_STREAM_LEAF;
            }
        }
        free(data[0]);
        free(data[1]);
        own_free(&own);
    }
    assert_true(near_pairs > 1000 && near_pairs < all_pairs / 4);
    scene_free(&s);
}

/* Positions that a query reads before it opens a group are counted, of both bodies. */
TEST(query_counts_the_positions_that_it_evaluates)
{
    scene s;
    int touching = 0;
    scene_init(&s, 25, 11, 1, true);
    for (int k = 0; k < 12; ++k) {
        static own_query own;
        void *data[2];
        own_init(&own, &s);
        scene_next(&s, 0.4, false);
        give_floats(&own, &s, 4, data);
        const mote_certificate_answer a = own_ask_again(&own);
        const uint64_t of[2] = {own.search.side[0].lazy.evaluated,
                                own.search.side[1].lazy.evaluated};
        assert_true(a.counters.positions >= of[0] + of[1]);
        if (a.counters.blocks == 0) {
            assert_int_equal(a.counters.positions, of[0] + of[1]);
            touching += of[0] > 3 && of[1] > 3;
        }
        free(data[0]);
        free(data[1]);
        own_free(&own);
    }
    assert_true(touching > 3);
    scene_free(&s);
}

TEST(search_bytes_are_those_of_its_arrays)
{
    scene s;
    scene_init(&s, 90, 50, 1, true);
    static own_query own;
    own_init(&own, &s);
    size_t expected = 0;
    for (int b = 0; b < 2; ++b) {
        const mote_stream_side *side = &own.search.side[b];
        const size_t each =
            sizeof(mote_stream_block) + sizeof(mote_stream_box) + sizeof(uint32_t);
        assert_int_equal(side->room, own.tree[b]->groups);
        expected += (size_t)side->room * each;
        expected += MOTE_STREAM_SLOTS * sizeof(mote_stream_slot);
        expected += ((size_t)side->lazy.mask + 1) * sizeof(mote_lazy_slot);
    }
    assert_int_equal(mote_stream_search_bytes(&own.search), expected);
    own_free(&own);
    scene_free(&s);
}

/* The bytes of a query beyond its trees, boxes and search. */
static size_t other_bytes(const scene *s, bool borrowed)
{
    static own_query own;
    mote_stream *owner = stream_of(s, NULL), *beside = NULL;
    own_init(&own, s);
    assert_int_equal(mote_stream_create_beside(owner, &beside), MOTE_OK);
    size_t bytes = mote_stream_bytes(borrowed ? beside : owner);
    size_t parts = mote_stream_search_bytes(&own.search);
    for (int b = 0; b < 2; ++b) {
        parts += mote_stream_body_bytes(&own.body[b]);
        parts += borrowed ? 0 : mote_stream_tree_bytes(own.tree[b]);
    }
    assert_true(bytes > parts);
    mote_stream_destroy(beside);
    mote_stream_destroy(owner);
    own_free(&own);
    return bytes - parts;
}

TEST(bytes_are_those_of_the_parts_whatever_their_size)
{
    static const uint32_t sizes[][2] = {{3, 90}, {90, 3}, {40, 30}};
    size_t expected = 0;
    for (size_t i = 0; i < ROWS_OF(sizes); ++i) {
        scene s;
        scene_init_meshes(&s, make_torus(sizes[i][0], 30, 1), make_torus(sizes[i][1], 30, 1),
                          false);
        if (i == 0)
            expected = other_bytes(&s, false);
        assert_true(expected >= sizeof(mote_stream_search));
        assert_int_equal(other_bytes(&s, false), expected);
        assert_int_equal(other_bytes(&s, true), expected);
        scene_free(&s);
    }
}
