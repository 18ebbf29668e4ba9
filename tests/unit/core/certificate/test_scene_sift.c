/* Which pairs of bodies may be near: outlines against all vertices, pairs left out against the
   exact distance. */
#include "core/certificate/certificate_outline.h"
#include "core/certificate/certificate_tree.h"

#include "harness/base/heap_count.h"
#include "tests/support/crowd.h"
#include "tests/support/test.h"

/* Whether a point of the world is in one of the boxes that an outline does not open. */
static bool holds(const mote_cert_outline *outline, double scale, mote_vec3 point)
{
    const mote_vec3 p = mote_scale(mote_sub(point, outline->origin), scale);
    const double at[3] = {p.x, p.y, p.z};
    uint32_t rows = 1;
    for (uint32_t i = 0; i < rows; ++i) {
        const mote_cert_outline_row *row = &outline->rows[i];
        for (size_t l = 0; l < row->children; ++l) {
            bool inside = row->below[l] == 0;
            rows += row->below[l] > 0;
            for (int r = 0; r < 3; ++r)
                inside = inside && at[r] >= (double)row->low[r][l] &&
                         at[r] <= (double)row->high[r][l];
            if (inside)
                return true;
        }
    }
    return false;
}

/* From the origin to where the last bit of a coordinate is a fraction of a triangle. */
TEST(mote_cert_workspace_outline_random_states_holds_every_vertex)
{
    static const double sides[] = {3, 1e3, 1e7, 1e12};
    static crowd c;
    const mote_certificate_options options = mote_default_certificate_options(2);
    const mote_cert_tree_options plan = {
        .length = options.length, .width = options.width, .linear_fits = true};
    for (size_t k = 0; k < sizeof sides / sizeof sides[0]; ++k) {
        crowd_init(&c, 18, 1400, sides[k]);
        mote_cert_tree *trees[CROWD_SHAPES];
        mote_certificate *workspace = NULL;
        for (int s = 0; s < CROWD_SHAPES; ++s)
            assert_int_equal(mote_cert_tree_create(c.shape[s], &plan, &trees[s]), MOTE_OK);
        assert_int_equal(mote_cert_workspace_create(trees, CROWD_SHAPES, &options, &workspace),
                         MOTE_OK);
        for (uint32_t i = 0; i < c.count; ++i) {
            mote_cert_outline outline;
            mote_cert_workspace_outline(workspace, trees[c.shape_of[i]], &c.states[i],
                                        &outline);
            mote_vec3 *world = crowd_vertices(&c, i);
            for (uint32_t v = 0; v < c.shape[c.shape_of[i]]->mesh->vertex_count; ++v)
                assert_true(holds(&outline, trees[0]->scale, world[v]));
            free(world);
        }
        mote_cert_workspace_destroy(workspace);
        for (int s = 0; s < CROWD_SHAPES; ++s)
            mote_cert_tree_destroy(trees[s]);
        crowd_free(&c);
    }
}

static bool is_among(const uint32_t pair[2], const uint32_t (*pairs)[2], size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (mote_pair_order(pairs[k], pair) == 0)
            return true;
    }
    return false;
}

/* Moves all bodies of a crowd far away. */
static void move_away(crowd *c, double distance)
{
    for (uint32_t i = 0; i < c->count; ++i) {
        mote_vec3 *t = &c->states[i].pose.translation;
        *t = mote_add(*t, mote_vec3_make(distance, -distance, 0.3 * distance));
    }
}

/* The distances come from the certified query, which test_scene checks against brute force; the
   nearest pair left out is checked against brute force here. */
static void check_left_out(crowd *c, mote_scene *scene, double near, size_t found[2])
{
    static uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
    const size_t count = crowd_pairs(c, pairs);
    const uint32_t(*all)[2] = (const uint32_t(*)[2])pairs;
    const uint32_t(*kept)[2];
    size_t kept_count, answered;
    const mote_scene_pair *nearest = NULL;
    assert_int_equal(mote_scene_query(scene, c->states, all, count), MOTE_OK);
    assert_int_equal(mote_scene_sift(scene, c->states, near, all, count, &kept, &kept_count),
                     MOTE_OK);
    const mote_scene_pair *answers = mote_scene_pairs(scene, &answered);
    for (size_t k = 1; k < kept_count; ++k)
        assert_true(mote_pair_order(kept[k - 1], kept[k]) < 0);
    for (size_t k = 0; k < count; ++k) {
        const mote_scene_pair *a = &answers[k];
        if (is_among(a->body, kept, kept_count)) {
            found[0] += a->distance > near;
            continue;
        }
        ++found[1];
        assert_true(a->distance > near);
        nearest = !nearest || a->distance < nearest->distance ? a : nearest;
    }
    if (nearest)
        assert_true(crowd_distance(c, nearest->body[0], nearest->body[1]) > near);
}

TEST(mote_scene_sift_leaves_out_only_pairs_that_are_farther_apart)
{
    static const double nears[] = {0, 0.01, 0.1, 0.7}, places[] = {0, 1e7};
    static crowd c;
    size_t found[2] = {0, 0}; /* kept though farther apart; left out */
    for (size_t p = 0; p < 2; ++p) {
        mote_scene *scene = crowd_open(&c, 16, 1400, 3);
        move_away(&c, places[p]);
        for (size_t k = 0; k < sizeof nears / sizeof nears[0]; ++k) {
            check_left_out(&c, scene, nears[k], found);
            crowd_move(&c, 0.02);
        }
        crowd_close(&c, scene);
    }
    /* It must leave out most of them: keeping all would be right too. */
    assert_true(found[1] > 2 * found[0]);
}

/* Bodies that are exactly `near` apart, by the exact distance in double precision. */
TEST(mote_scene_sift_keeps_pairs_exactly_as_far_apart)
{
    static const uint32_t pair[1][2] = {{0, 1}}, shape_of[2] = {0, 0};
    uint64_t seed = 5;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_torus(40, 20)), 4, &seed);
    const mote_body *shape = &b.body;
    mote_body_state states[2] = {test_body_state(&b, 0.1, &seed),
                                 test_body_state(&b, 0.1, &seed)};
    const mote_scene_options options = mote_default_scene_options();
    mote_scene *scene = NULL;
    assert_int_equal(mote_scene_create(&shape, 1, shape_of, 2, &options, &scene), MOTE_OK);
    for (int k = 0; k < 50; ++k) {
        const uint32_t(*kept)[2];
        size_t count;
        states[1].pose.translation = mote_scale(random_vec3(&seed, 1), 0.2 * k);
        assert_int_equal(mote_scene_query(scene, states, pair, 1), MOTE_OK);
        const double distance = mote_scene_pairs(scene, &count)->distance;
        assert_int_equal(mote_scene_sift(scene, states, distance, pair, 1, &kept, &count),
                         MOTE_OK);
        assert_int_equal(count, 1);
    }
    mote_scene_destroy(scene);
    test_body_free(&b);
}

TEST(mote_scene_sift_infinity_keeps_all_and_bad_input_is_refused)
{
    static crowd c;
    mote_scene *scene = crowd_open(&c, 4, 400, 3);
    static const uint32_t good[][2] = {{0, 1}, {2, 3}}, turned[][2] = {{2, 1}};
    static const double bad[] = {-1, NAN};
    const uint32_t(*kept)[2] = NULL;
    size_t count = 0;
    const size_t bytes = mote_scene_bytes(scene);
    assert_int_equal(mote_scene_sift(scene, c.states, HUGE_VAL, good, 2, &kept, &count),
                     MOTE_OK);
    assert_int_equal(mote_scene_bytes(scene), bytes); /* nothing is looked at */
    assert_int_equal(count, 2);
    assert_memory_equal(kept, good, sizeof good);
    assert_int_equal(mote_scene_sift(scene, c.states, 1, good, 0, &kept, &count), MOTE_OK);
    assert_int_equal(count, 0);
    assert_true(mote_scene_bytes(scene) >= bytes + 4 * sizeof(uint32_t));
    assert_int_equal(mote_scene_sift(scene, c.states, 1, turned, 1, &kept, &count),
                     MOTE_EINVAL);
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(mote_scene_sift(scene, c.states, bad[k], good, 2, &kept, &count),
                         MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "near"));
    }
    crowd_close(&c, scene);
}

TEST(mote_scene_sift_more_threads_keep_the_same_and_allocate_once)
{
    static crowd c;
    static uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
    mote_scene_options options = mote_default_scene_options();
    crowd_init(&c, 40, 400, 4);
    const size_t count = crowd_pairs(&c, pairs);
    mote_scene *scenes[2];
    const uint32_t(*kept[2])[2];
    size_t kept_count[2];
    for (int t = 0; t < 2; ++t) {
        options.threads = t ? 3 : 1;
        scenes[t] = crowd_scene(&c, &options);
    }
    for (int step = 0; step < 4; ++step) {
        const mote_heap before = mote_heap_read();
        for (int t = 0; t < 2; ++t)
            assert_int_equal(mote_scene_sift(scenes[t], c.states, 0.1,
                                             (const uint32_t(*)[2])pairs, count, &kept[t],
                                             &kept_count[t]),
                             MOTE_OK);
        if (step > 0)
            assert_int_equal(mote_heap_read().allocations, before.allocations);
        assert_int_equal(kept_count[1], kept_count[0]);
        assert_memory_equal(kept[1], kept[0], kept_count[0] * sizeof kept[0][0]);
        assert_true(kept_count[0] > 0 && kept_count[0] < count / 2);
        crowd_move(&c, 0.02);
    }
    mote_scene_destroy(scenes[0]);
    mote_scene_destroy(scenes[1]);
    crowd_free(&c);
}
