/* Several bodies known by positions only: bounds against all vertices, answers against all
   pairs of triangles. */
#include "core/stream/stream_scene.h"

#include "harness/base/heap_count.h"
#include "core/stream/stream_state.h"
#include "tests/support/crowd.h"
#include "tests/support/test.h"

#include <stdio.h>

typedef struct placed {
    crowd c;
    mote_vec3 *world[CROWD_MAX];
    mote_positions positions[CROWD_MAX];
} placed;

static void place(placed *p)
{
    for (uint32_t i = 0; i < p->c.count; ++i) {
        free(p->world[i]);
        p->world[i] = crowd_vertices(&p->c, i);
        p->positions[i] = mote_positions_of(p->world[i]);
    }
}

static void placed_init(placed *p, uint32_t count, size_t triangles, double side)
{
    memset(p, 0, sizeof *p);
    crowd_init(&p->c, count, triangles, side);
    place(p);
}

static void placed_free(placed *p)
{
    for (uint32_t i = 0; i < p->c.count; ++i)
        free(p->world[i]);
    crowd_free(&p->c);
}

static mote_stream_scene *scene_of(const placed *p, const mote_scene_options *options)
{
    mote_stream_scene *scene = NULL;
    if (mote_stream_scene_create(p->c.shape, CROWD_SHAPES, p->c.shape_of, p->c.count, options,
                                 &scene) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return scene;
}

TEST(bounds_contain_every_vertex_and_are_tight)
{
    static const double sides[] = {3, 1e3, 1e7, 1e12};
    static placed p;
    const mote_scene_options options = mote_default_scene_options();
    for (size_t k = 0; k < ROWS_OF(sides); ++k) {
        placed_init(&p, 18, 400, sides[k]);
        mote_stream_scene *scene = scene_of(&p, &options);
        mote_scene_box boxes[CROWD_MAX];
        assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes), MOTE_OK);
        for (uint32_t i = 0; i < p.c.count; ++i) {
            double high = -HUGE_VAL;
            for (uint32_t v = 0; v < p.c.shape[p.c.shape_of[i]]->mesh->vertex_count; ++v) {
                const mote_vec3 x = p.world[i][v];
                assert_true(x.x >= boxes[i].low.x && x.x <= boxes[i].high.x);
                assert_true(x.y >= boxes[i].low.y && x.y <= boxes[i].high.y);
                assert_true(x.z >= boxes[i].low.z && x.z <= boxes[i].high.z);
                high = fmax(high, x.y);
            }
            assert_true(boxes[i].high.y - high < 1e-5 + 1e-14 * sides[k]);
        }
        mote_stream_scene_destroy(scene);
        placed_free(&p);
    }
    mote_stream_scene_destroy(NULL);
}

TEST(query_all_pairs_equals_brute_force)
{
    static placed p;
    mote_scene_options options = mote_default_scene_options();
    options.tolerance = 0.02;
    placed_init(&p, 6, 700, 1.3);
    mote_stream_scene *distance = scene_of(&p, &options);
    options.ask = MOTE_ASK_CONTACT;
    mote_stream_scene *contact = scene_of(&p, &options);
    uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
    const size_t count = crowd_pairs(&p.c, pairs);
    const uint32_t(*all)[2] = (const uint32_t(*)[2])pairs;
    bool unchanged[CROWD_MAX] = {false};
    size_t contacts = 0;
    for (int step = 0; step < 4; ++step) {
        mote_scene_box boxes[CROWD_MAX];
        assert_int_equal(mote_stream_scene_bounds(distance, p.positions, unchanged, boxes),
                         MOTE_OK);
        assert_int_equal(mote_stream_scene_bounds(contact, p.positions, unchanged, boxes),
                         MOTE_OK);
        assert_int_equal(mote_stream_scene_query(distance, all, count), MOTE_OK);
        assert_int_equal(mote_stream_scene_query(contact, all, count), MOTE_OK);
        size_t answered = 0;
        const mote_scene_pair *a = mote_stream_scene_pairs(distance, &answered);
        const mote_scene_pair *b = mote_stream_scene_pairs(contact, &answered);
        assert_int_equal(answered, count);
        for (size_t k = 0; k < count; ++k) {
            crowd_expect(&p.c, &a[k], options.tolerance, 1e-12);
            assert_int_equal(b[k].contact, a[k].contact);
            assert_true(b[k].contact || b[k].lower > options.tolerance);
            assert_int_equal(a[k].steps, step + 1);
            contacts += a[k].contact;
        }
        for (uint32_t i = 0; i < p.c.count; ++i) /* nothing moves in every other step */
            unchanged[i] = step % 2 == 0;
        if (step % 2)
            crowd_move(&p.c, 0.02);
        if (step % 2)
            place(&p);
    }
    assert_true(contacts > 0 && contacts < 4 * count);
    mote_stream_scene_destroy(distance);
    mote_stream_scene_destroy(contact);
    placed_free(&p);
}

TEST(query_any_number_of_threads_gives_the_same_bits_and_never_allocates)
{
    static placed p;
    static mote_scene_pair expected[3][CROWD_MAX * CROWD_MAX];
    placed_init(&p, 24, 700, 3);
    uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
    const size_t count = crowd_pairs(&p.c, pairs);
    for (uint32_t threads = 1; threads <= 5; threads += 2) {
        mote_scene_options options = mote_default_scene_options();
        options.threads = threads;
        mote_stream_scene *scene = scene_of(&p, &options);
        for (int step = 0; step < 3; ++step) {
            mote_scene_box boxes[CROWD_MAX];
            const uint64_t before = mote_heap_read().allocations;
            assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes),
                             MOTE_OK);
            assert_int_equal(mote_stream_scene_query(scene, (const uint32_t(*)[2])pairs, count),
                             MOTE_OK);
            assert_true(step < 2 || mote_heap_read().allocations == before);
            size_t answered = 0;
            const mote_scene_pair *a = mote_stream_scene_pairs(scene, &answered);
            if (threads == 1)
                memcpy(expected[step], a, count * sizeof *a);
            assert_memory_equal(expected[step], a, count * sizeof *a);
        }
        mote_stream_scene_destroy(scene);
    }
    placed_free(&p);
}

TEST(bytes_are_those_of_the_heap)
{
    static placed p;
    placed_init(&p, 9, 700, 3);
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        mote_scene_options options = mote_default_scene_options();
        options.threads = threads;
        const int64_t before = mote_heap_read().live_bytes;
        mote_stream_scene *scene = scene_of(&p, &options);
        mote_scene_box boxes[CROWD_MAX];
        uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
        const size_t count = crowd_pairs(&p.c, pairs), made = mote_stream_scene_bytes(scene);
        assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes), MOTE_OK);
        assert_int_equal(mote_stream_scene_query(scene, (const uint32_t(*)[2])pairs, count),
                         MOTE_OK);
        assert_true(mote_stream_scene_bytes(scene) >= made + count * sizeof(mote_scene_pair));
        const double held = (double)(mote_heap_read().live_bytes - before);
        if (mote_heap_read().counted) /* a sanitizer counts no heap */
            assert_close((double)mote_stream_scene_bytes(scene), held, 0.05 * held);
        mote_stream_scene_destroy(scene);
    }
    placed_free(&p);
}

static size_t bytes_of_scene(const placed *p, uint32_t shapes, uint32_t bodies,
                             uint32_t threads)
{
    static const uint32_t first[CROWD_MAX] = {0};
    mote_scene_options options = mote_default_scene_options();
    mote_stream_scene *scene = NULL;
    options.threads = threads;
    assert_int_equal(
        mote_stream_scene_create(p->c.shape, shapes, first, bodies, &options, &scene), MOTE_OK);
    const size_t bytes = mote_stream_scene_bytes(scene);
    mote_stream_scene_destroy(scene);
    return bytes;
}

/* What a shape, a body and a thread add is what the tree, the boxes and the search of each
   take. The search has room for the largest shape. */
TEST(bytes_add_up)
{
    static placed p;
    placed_init(&p, 3, 700, 3);
    mote_stream_tree *tree[2];
    for (int k = 0; k < 2; ++k)
        assert_int_equal(mote_stream_tree_create(p.c.shape[k], &tree[k]), MOTE_OK);
    mote_stream_body body;
    assert_int_equal(mote_stream_body_init(&body, tree[0]), MOTE_OK);
    const mote_stream_options options = mote_default_stream_options(1);
    const mote_body *const largest[2] = {p.c.shape[0], p.c.shape[0]};
    const uint32_t room[2] = {tree[0]->groups, tree[0]->groups};
    static mote_stream_search search;
    assert_int_equal(mote_stream_search_init(&search, &options, largest, room), MOTE_OK);

    const size_t one = bytes_of_scene(&p, 1, 1, 1);
    assert_int_equal(bytes_of_scene(&p, 2, 1, 1) - one, mote_stream_tree_bytes(tree[1]));
    assert_int_equal(bytes_of_scene(&p, 1, 4, 1) - one,
                     3 * (sizeof body + mote_stream_body_bytes(&body)));
    assert_int_equal(bytes_of_scene(&p, 1, 1, 3) - one,
                     2 * (sizeof search + mote_stream_search_bytes(&search)));
    assert_true(one > mote_stream_tree_bytes(tree[0]) + sizeof body +
                          mote_stream_body_bytes(&body) + sizeof search +
                          mote_stream_search_bytes(&search));
    mote_stream_search_free(&search);
    mote_stream_body_free(&body);
    mote_stream_tree_destroy(tree[0]);
    mote_stream_tree_destroy(tree[1]);
    placed_free(&p);
}

/* Bodies that are pressed flat onto a line, and exactly as far apart as the tolerance: they
 * touch. */
TEST(query_distance_that_is_the_tolerance_is_contact)
{
    static placed p;
    placed_init(&p, 2, 400, 3);
    const mote_mesh *mesh = p.c.shape[0]->mesh;
    const uint32_t both[2] = {0, 0}, pairs[1][2] = {{0, 1}};
    double low = HUGE_VAL, high = -HUGE_VAL;
    mote_vec3 *world[2];
    for (int b = 0; b < 2; ++b) {
        world[b] = malloc(mesh->vertex_count * sizeof *world[b]);
        assert_non_null(world[b]);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) { /* multiples of 2^-10: no rounding */
        const mote_vec3 x = mesh->positions[v];
        world[0][v] = mote_vec3_make(round(x.x * 1024) / 1024, 0, 0);
        low = fmin(low, world[0][v].x);
        high = fmax(high, world[0][v].x);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        world[1][v] = mote_vec3_make(world[0][v].x + (high - low) + 0.25, 0, 0);
    const mote_positions at[2] = {mote_positions_of(world[0]), mote_positions_of(world[1])};
    for (int ask = 0; ask < 2; ++ask) {
        for (int k = -1; k <= 1; ++k) {
            mote_scene_options options = mote_default_scene_options();
            mote_stream_scene *scene = NULL;
            mote_scene_box boxes[2];
            size_t count;
            options.ask = ask ? MOTE_ASK_CONTACT : MOTE_ASK_DISTANCE;
            options.tolerance = 0.25 + k * 0x1p-40;
            assert_int_equal(mote_stream_scene_create(p.c.shape, 1, both, 2, &options, &scene),
                             MOTE_OK);
            assert_int_equal(mote_stream_scene_bounds(scene, at, NULL, boxes), MOTE_OK);
            assert_int_equal(mote_stream_scene_query(scene, pairs, 1), MOTE_OK);
            const mote_scene_pair *pair = mote_stream_scene_pairs(scene, &count);
            assert_int_equal(pair->contact, k >= 0);
            mote_stream_scene_destroy(scene);
        }
    }
    free(world[0]);
    free(world[1]);
    placed_free(&p);
}

/* After bounds that failed, a body of which no box was made is named, whichever it is. */
TEST(query_after_bounds_that_failed_is_refused)
{
    static placed p;
    placed_init(&p, 6, 400, 3);
    const mote_scene_options options = mote_default_scene_options();
    mote_stream_scene *scene = scene_of(&p, &options);
    mote_scene_box boxes[CROWD_MAX];
    const uint32_t pairs[1][2] = {{0, 1}};
    for (uint32_t i = 0; i < p.c.count; ++i) {
        const mote_vec3 kept = p.world[i][3];
        char expected[64];
        p.world[i][3].x = NAN;
        assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes),
                         MOTE_EINVAL);
        p.world[i][3] = kept;
        (void)snprintf(expected, sizeof expected, "body %u has no boxes", i);
        assert_int_equal(mote_stream_scene_query(scene, pairs, 1), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), expected));
    }
    mote_stream_scene_destroy(scene);
    placed_free(&p);
}

TEST(bounds_and_query_bad_input_is_refused)
{
    static placed p;
    placed_init(&p, 6, 400, 3);
    const mote_scene_options options = mote_default_scene_options();
    mote_stream_scene *scene = scene_of(&p, &options);
    mote_scene_box boxes[CROWD_MAX];
    const uint32_t pairs[1][2] = {{1, 4}}, wrong[1][2] = {{5, 2}};
    assert_int_equal(mote_stream_scene_query(scene, pairs, 1), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "call mote_stream_scene_bounds"));
    const mote_positions good = p.positions[3];
    p.positions[3].stride = 20;
    assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 3 has a stride of 20 bytes"));
    p.positions[3].data = NULL;
    assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 3 has no positions"));
    p.positions[3] = good;
    const mote_vec3 kept = p.world[4][7];
    p.world[4][7].z = NAN;
    assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 4: vertex 7"));
    p.world[4][7] = kept;
    assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes), MOTE_OK);
    assert_int_equal(mote_stream_scene_query(scene, wrong, 1), MOTE_EINVAL);
    assert_int_equal(mote_stream_scene_query(scene, pairs, 1), MOTE_OK);
    p.world[4][7].z = 1e30;
    assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes), MOTE_OK);
    assert_int_equal(mote_stream_scene_query(scene, pairs, 1), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "bodies 1 and 4"));
    for (uint32_t v = 0; v < p.c.shape[p.c.shape_of[4]]->mesh->vertex_count; ++v)
        p.world[4][v].z = 1e200; /* its square is no number */
    assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes), MOTE_OK);
    assert_int_equal(mote_stream_scene_query(scene, pairs, 1), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "bodies 1 and 4"));
    place(&p);
    assert_int_equal(mote_stream_scene_bounds(scene, p.positions, NULL, boxes), MOTE_OK);
    assert_int_equal(mote_stream_scene_query(scene, pairs, 1), MOTE_OK);
    mote_stream_scene_destroy(scene);
    mote_stream_scene *none = NULL;
    const uint32_t bad_shape[1] = {9};
    assert_int_equal(mote_stream_scene_create(p.c.shape, 1, bad_shape, 1, &options, &none),
                     MOTE_EINVAL);
    assert_null(none);
    placed_free(&p);
}
