/* Several bodies: bounds against all vertices, answers against all pairs of triangles. */
#include "core/certificate/certificate_shared.h"
#include "core/certificate/scene.h"

#include "harness/base/heap_count.h"
#include "tests/support/crowd.h"
#include "tests/support/test.h"

static void check_contained(const crowd *c, const mote_scene_box *boxes)
{
    for (uint32_t i = 0; i < c->count; ++i) {
        mote_vec3 *world = crowd_vertices(c, i);
        for (uint32_t v = 0; v < c->shape[c->shape_of[i]]->mesh->vertex_count; ++v) {
            assert_true(world[v].x >= boxes[i].low.x && world[v].x <= boxes[i].high.x);
            assert_true(world[v].y >= boxes[i].low.y && world[v].y <= boxes[i].high.y);
            assert_true(world[v].z >= boxes[i].low.z && world[v].z <= boxes[i].high.z);
        }
        free(world);
    }
}

TEST(mote_scene_bounds_random_states_contain_every_vertex)
{
    /* From the origin to where the last bit of a coordinate is a fraction of a triangle. */
    static const double sides[] = {3, 1e3, 1e7, 1e12};
    static crowd c;
    const mote_scene_options options = mote_default_scene_options();
    for (size_t k = 0; k < sizeof sides / sizeof sides[0]; ++k) {
        crowd_init(&c, 18, 400, sides[k]);
        mote_scene *scene = crowd_scene(&c, &options);
        for (int step = 0; step < 3; ++step) {
            mote_scene_box boxes[CROWD_MAX];
            assert_int_equal(mote_scene_bounds(scene, c.states, boxes), MOTE_OK);
            check_contained(&c, boxes);
            crowd_move(&c, 0.3);
        }
        mote_scene_destroy(scene);
        crowd_free(&c);
    }
}

TEST(mote_scene_bounds_large_and_tiny_weights_contain_every_vertex)
{
    static const double factors[] = {0, 1e-12, 1e-3, 10, 1e4};
    static crowd c;
    mote_scene *scene = crowd_open(&c, 30, 800, 3);
    for (size_t k = 0; k < sizeof factors / sizeof factors[0]; ++k) {
        for (uint32_t i = 0; i < c.count; ++i) {
            for (uint32_t j = 0; j < c.states[i].weights.count; ++j) {
                for (int axis = 0; axis < 3; ++axis)
                    c.weights[i][axis][j] = factors[k] * random_between(&c.random, -1, 1);
            }
        }
        mote_scene_box boxes[CROWD_MAX];
        assert_int_equal(mote_scene_bounds(scene, c.states, boxes), MOTE_OK);
        check_contained(&c, boxes);
    }
    crowd_close(&c, scene);
}

/* Tightness must be tested, too: infinite bounds would contain everything. */
TEST(mote_scene_bounds_gentle_deformation_are_tight)
{
    static crowd c;
    mote_scene *scene = crowd_open(&c, 30, 2000, 3);
    mote_scene_box boxes[CROWD_MAX];
    assert_int_equal(mote_scene_bounds(scene, c.states, boxes), MOTE_OK);
    double sum = 0;
    for (uint32_t i = 0; i < c.count; ++i) {
        mote_vec3 *world = crowd_vertices(&c, i);
        double low = world[0].x, high = low;
        for (uint32_t v = 0; v < c.shape[c.shape_of[i]]->mesh->vertex_count; ++v) {
            low = fmin(low, world[v].x);
            high = fmax(high, world[v].x);
        }
        const double ratio = (boxes[i].high.x - boxes[i].low.x) / (high - low);
        assert_true(ratio < 1.6);
        sum += ratio / c.count;
        free(world);
    }
    assert_true(sum < 1.25);
    crowd_close(&c, scene);
}

TEST(mote_scene_bounds_not_finite_names_the_body)
{
    static crowd c;
    mote_scene *scene = crowd_open(&c, 6, 400, 3);
    mote_scene_box boxes[CROWD_MAX];
    c.weights[3][1][2] = NAN;
    assert_int_equal(mote_scene_bounds(scene, c.states, boxes), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 3"));
    c.weights[3][1][2] = 0;
    c.states[5].pose.rotation.m[1][2] = INFINITY;
    assert_int_equal(mote_scene_bounds(scene, c.states, boxes), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 5"));
    crowd_close(&c, scene);
}

/* A function whose centre is far from the mesh moves no vertex, and is in no box of the tree.
 */
TEST(mote_scene_bounds_not_finite_weight_of_a_function_that_reaches_nothing)
{
    static const double bad[] = {NAN, HUGE_VAL, -HUGE_VAL};
    const mote_vec3 centres[2] = {{0, 0, 1}, {100, 0, 0}};
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_csrbf(centres, 2, 2, &field), MOTE_OK);
    const mote_body body = {.mesh = mesh, .field = field};
    const mote_body *shapes[1] = {&body};
    const uint32_t shape_of[2] = {0, 0};
    const mote_scene_options options = mote_default_scene_options();
    mote_scene *scene = NULL;
    assert_int_equal(mote_scene_create(shapes, 1, shape_of, 2, &options, &scene), MOTE_OK);
    double weights[3][8] = {{0}};
    const mote_body_state rest = {
        .pose = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}},
        .weights = {weights[0], weights[1], weights[2], field->count, field->padded}};
    const mote_body_state states[2] = {rest, rest};
    mote_scene_box boxes[2];
    assert_int_equal(mote_scene_bounds(scene, states, boxes), MOTE_OK);
    for (size_t i = 0; i < 3 * ROWS_OF(bad); ++i) {
        weights[i % 3][1] = bad[i / 3];
        assert_int_equal(mote_scene_bounds(scene, states, boxes), MOTE_EINVAL);
        weights[i % 3][1] = 0;
    }
    mote_scene_destroy(scene);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

TEST(mote_scene_query_all_pairs_equals_brute_force)
{
    static crowd c;
    mote_scene_options options = mote_default_scene_options();
    options.tolerance = 0.02;
    crowd_init(&c, 5, 400, 1.3);
    mote_scene *scene = crowd_scene(&c, &options);
    const double length = mote_scene_length(scene);
    uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
    const size_t count = crowd_pairs(&c, pairs);
    size_t contacts = 0;
    for (int step = 0; step < 3; ++step) {
        assert_int_equal(mote_scene_query(scene, c.states, (const uint32_t(*)[2])pairs, count),
                         MOTE_OK);
        size_t answered = 0;
        const mote_scene_pair *answers = mote_scene_pairs(scene, &answered);
        assert_int_equal(answered, count);
        for (size_t k = 0; k < count; ++k) {
            const mote_scene_pair *a = &answers[k];
            crowd_expect(&c, a, options.tolerance, 1e-12 * length);
            assert_int_equal(a->steps, step + 1);
            contacts += a->contact;
        }
        crowd_move(&c, 0.02);
    }
    assert_true(contacts > 0 && contacts < 2 * count);
    crowd_close(&c, scene);
}

TEST(mote_scene_query_contact_question_says_the_same)
{
    static crowd c;
    mote_scene_options options = mote_default_scene_options();
    options.tolerance = 0.05;
    crowd_init(&c, 10, 400, 2);
    mote_scene *distance = crowd_scene(&c, &options);
    options.ask = MOTE_ASK_CONTACT;
    mote_scene *contact = crowd_scene(&c, &options);
    uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
    const size_t count = crowd_pairs(&c, pairs);
    size_t found[2] = {0, 0};
    for (int step = 0; step < 5; ++step) {
        size_t size;
        const uint32_t(*all)[2] = (const uint32_t(*)[2])pairs;
        assert_int_equal(mote_scene_query(distance, c.states, all, count), MOTE_OK);
        assert_int_equal(mote_scene_query(contact, c.states, all, count), MOTE_OK);
        const mote_scene_pair *a = mote_scene_pairs(distance, &size);
        const mote_scene_pair *b = mote_scene_pairs(contact, &size);
        for (size_t k = 0; k < count; ++k) {
            assert_int_equal(a[k].contact, b[k].contact);
            assert_true(b[k].lower <= a[k].distance);
            assert_true(b[k].distance >= a[k].distance - 1e-12);
            ++found[a[k].contact];
        }
        crowd_move(&c, 0.02);
    }
    assert_true(found[0] > 0 && found[1] > 0);
    mote_scene_destroy(distance);
    mote_scene_destroy(contact);
    crowd_free(&c);
}

static void check_same_pair(const mote_scene_pair *a, const mote_scene_pair *b)
{
    assert_memory_equal(a->body, b->body, sizeof a->body);
    assert_int_equal(a->steps, b->steps);
    assert_int_equal(a->contact, b->contact);
    assert_memory_equal(&a->distance, &b->distance, sizeof a->distance);
    assert_memory_equal(&a->lower, &b->lower, sizeof a->lower);
    assert_memory_equal(a->witness, b->witness, sizeof a->witness);
    assert_memory_equal(&a->counters, &b->counters, sizeof a->counters);
}

static void check_same_bits(const mote_scene *one, const mote_scene *many)
{
    size_t count, others;
    const mote_scene_pair *a = mote_scene_pairs(one, &count);
    const mote_scene_pair *b = mote_scene_pairs(many, &others);
    assert_int_equal(count, others);
    for (size_t k = 0; k < count; ++k)
        check_same_pair(&a[k], &b[k]);
}

/* Queries all pairs and a third of them in turn, so states come and go. */
TEST(mote_scene_query_more_threads_same_bits)
{
    static crowd c;
    mote_scene_options options = mote_default_scene_options();
    crowd_init(&c, 14, 400, 2.5);
    mote_scene *one = crowd_scene(&c, &options);
    mote_scene *many[2];
    for (int t = 0; t < 2; ++t) {
        options.threads = t ? 7 : 2;
        many[t] = crowd_scene(&c, &options);
    }
    uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
    const size_t count = crowd_pairs(&c, pairs);
    for (int step = 0; step < 6; ++step) {
        const uint32_t(*some)[2] = (const uint32_t(*)[2])pairs + (step % 2 ? 0 : count / 3);
        const size_t size = step % 2 ? count : count / 3;
        mote_scene_box boxes[3][CROWD_MAX];
        assert_int_equal(mote_scene_bounds(one, c.states, boxes[0]), MOTE_OK);
        assert_int_equal(mote_scene_query(one, c.states, some, size), MOTE_OK);
        for (int t = 0; t < 2; ++t) {
            assert_int_equal(mote_scene_bounds(many[t], c.states, boxes[t + 1]), MOTE_OK);
            assert_memory_equal(boxes[t + 1], boxes[0], c.count * sizeof boxes[0][0]);
            assert_int_equal(mote_scene_query(many[t], c.states, some, size), MOTE_OK);
            check_same_bits(one, many[t]);
        }
        crowd_move(&c, 0.02);
    }
    mote_scene_destroy(one);
    mote_scene_destroy(many[0]);
    mote_scene_destroy(many[1]);
    crowd_free(&c);
}

/* A workspace's earlier use must not show in an answer, so each pair also has a scene of its
   own. The meshes are large enough that remembered directions separate leaves. */
TEST(mote_scene_query_other_pairs_do_not_change_an_answer)
{
    static crowd c;
    mote_scene_options options = mote_default_scene_options();
    enum { PAIRS = 6 };
    crowd_init(&c, 4, 12000, 1.2);
    mote_scene *alone[PAIRS], *all[3];
    for (int k = 0; k < PAIRS; ++k)
        alone[k] = crowd_scene(&c, &options);
    for (int t = 0; t < 3; ++t) {
        options.threads = (uint32_t)t + 1;
        all[t] = crowd_scene(&c, &options);
    }
    uint32_t pairs[PAIRS][2];
    assert_int_equal(crowd_pairs(&c, pairs), PAIRS);
    const uint32_t(*every)[2] = (const uint32_t(*)[2])pairs;
    for (int step = 0; step < 5; ++step) {
        for (int t = 0; t < 3; ++t)
            assert_int_equal(mote_scene_query(all[t], c.states, every, PAIRS), MOTE_OK);
        for (int k = 0; k < PAIRS; ++k) {
            assert_int_equal(mote_scene_query(alone[k], c.states, every + k, 1), MOTE_OK);
            size_t size;
            for (int t = 0; t < 3; ++t)
                check_same_pair(mote_scene_pairs(alone[k], &size),
                                &mote_scene_pairs(all[t], &size)[k]);
        }
        crowd_move(&c, 0.02);
    }
    for (int k = 0; k < PAIRS; ++k)
        mote_scene_destroy(alone[k]);
    for (int t = 0; t < 3; ++t)
        mote_scene_destroy(all[t]);
    crowd_free(&c);
}

/* Queries pairs of a crowd through workspaces in turn, forwards or, if turned, from the last
   pair to the first. */
static void ask_pairs(const crowd *c, mote_cert_tree *const *trees, const uint32_t (*pairs)[2],
                      size_t count, bool turned, mote_certificate *const *workspaces,
                      size_t workspace_count, mote_cert_memory *memories,
                      mote_certificate_answer *answers)
{
    for (size_t i = 0; i < count; ++i) {
        const size_t k = turned ? count - 1 - i : i;
        const uint32_t *pair = pairs[k];
        mote_cert_tree *const both[2] = {trees[c->shape_of[pair[0]]],
                                         trees[c->shape_of[pair[1]]]};
        const mote_frame frame = {.number = 1,
                                  .body = {c->states[pair[0]], c->states[pair[1]]}};
        mote_cert_workspace_query(workspaces[i % workspace_count], both, &frame, -1,
                                  &memories[k], &answers[k]);
    }
}

TEST(mote_cert_workspace_query_any_order_and_workspace_same_bits)
{
    static crowd c;
    enum { PAIRS = 6, WORKSPACES = 3 };
    crowd_init(&c, 4, 12000, 1.2);
    uint32_t pairs[PAIRS][2];
    assert_int_equal(crowd_pairs(&c, pairs), PAIRS);
    const uint32_t(*every)[2] = (const uint32_t(*)[2])pairs;
    const mote_certificate_options options = mote_default_certificate_options(2);
    const mote_cert_tree_options tree = {
        .length = options.length, .width = options.width, .linear_fits = true};
    mote_cert_tree *trees[CROWD_SHAPES];
    mote_certificate *workspaces[WORKSPACES];
    for (int i = 0; i < CROWD_SHAPES; ++i)
        assert_int_equal(mote_cert_tree_create(c.shape[i], &tree, &trees[i]), MOTE_OK);
    for (int i = 0; i < WORKSPACES; ++i)
        assert_int_equal(
            mote_cert_workspace_create(trees, CROWD_SHAPES, &options, &workspaces[i]), MOTE_OK);
    mote_cert_memory memories[3][PAIRS] = {0};
    mote_certificate_answer answers[3][PAIRS] = {0};
    for (int step = 0; step < 5; ++step) {
        ask_pairs(&c, trees, every, PAIRS, false, workspaces, 1, memories[0], answers[0]);
        ask_pairs(&c, trees, every, PAIRS, true, workspaces, 1, memories[1], answers[1]);
        ask_pairs(&c, trees, every, PAIRS, step % 2, workspaces, WORKSPACES, memories[2],
                  answers[2]);
        assert_memory_equal(answers[1], answers[0], sizeof answers[0]);
        assert_memory_equal(answers[2], answers[0], sizeof answers[0]);
        crowd_move(&c, 0.02);
    }
    for (int i = 0; i < WORKSPACES; ++i)
        mote_cert_workspace_destroy(workspaces[i]);
    for (int i = 0; i < CROWD_SHAPES; ++i)
        mote_cert_tree_destroy(trees[i]);
    crowd_free(&c);
}

TEST(mote_scene_query_pair_state_lives_while_near)
{
    static crowd c;
    mote_scene *scene = crowd_open(&c, 4, 400, 3);
    static const uint32_t both[][2] = {{0, 1}, {2, 3}}, last[][2] = {{2, 3}};
    static const uint32_t expected[][2] = {{1, 1}, {2, 2}, {3, 0}, {4, 1}};
    for (int step = 0; step < 4; ++step) {
        size_t count;
        const bool gone = step == 2;
        assert_int_equal(mote_scene_query(scene, c.states, gone ? last : both, gone ? 1u : 2u),
                         MOTE_OK);
        const mote_scene_pair *pairs = mote_scene_pairs(scene, &count);
        assert_int_equal(count, gone ? 1 : 2);
        assert_int_equal(pairs[count - 1].steps, expected[step][0]);
        assert_int_equal(gone ? 0 : pairs[0].steps, expected[step][1]);
    }
    assert_int_equal(mote_scene_query(scene, c.states, both, 0), MOTE_OK);
    size_t count = 1;
    (void)mote_scene_pairs(scene, &count);
    assert_int_equal(count, 0);
    crowd_close(&c, scene);
}

TEST(mote_scene_query_bad_pairs_are_refused)
{
    static crowd c;
    mote_scene *scene = crowd_open(&c, 4, 400, 3);
    static const uint32_t same[][2] = {{1, 1}}, turned[][2] = {{2, 1}}, beyond[][2] = {{1, 4}};
    static const uint32_t twice[][2] = {{0, 1}, {0, 1}}, falling[][2] = {{1, 2}, {0, 3}};
    assert_int_equal(mote_scene_query(scene, c.states, same, 1), MOTE_EINVAL);
    assert_int_equal(mote_scene_query(scene, c.states, turned, 1), MOTE_EINVAL);
    assert_int_equal(mote_scene_query(scene, c.states, beyond, 1), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "below 4 bodies"));
    assert_int_equal(mote_scene_query(scene, c.states, twice, 2), MOTE_EINVAL);
    assert_int_equal(mote_scene_query(scene, c.states, falling, 2), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "ascending"));
    crowd_close(&c, scene);
}

static void check_refused(const crowd *c, uint32_t shapes, uint32_t bodies,
                          const mote_scene_options *options, const char *text)
{
    mote_scene *scene = NULL;
    assert_int_equal(mote_scene_create(c->shape, shapes, c->shape_of, bodies, options, &scene),
                     MOTE_EINVAL);
    assert_null(scene);
    assert_non_null(strstr(mote_error_text(), text));
}

TEST(mote_scene_create_bad_input_is_refused)
{
    static crowd c;
    mote_scene_options options = mote_default_scene_options();
    crowd_init(&c, 4, 400, 3);
    check_refused(&c, 3, 0, &options, "at least one");
    check_refused(&c, 0, 4, &options, "at least one");
    c.shape_of[2] = 3;
    check_refused(&c, 3, 4, &options, "body 2 has shape 3");
    c.shape_of[2] = 2;
    options.tolerance = NAN;
    check_refused(&c, 3, 4, &options, "tolerance");
    options.tolerance = HUGE_VAL;
    check_refused(&c, 3, 4, &options, "tolerance");
    options.tolerance = -1;
    check_refused(&c, 3, 4, &options, "tolerance");
    options.tolerance = 0;
    options.threads = 0;
    check_refused(&c, 3, 4, &options, "threads");
    options.threads = 257;
    check_refused(&c, 3, 4, &options, "threads");
    crowd_free(&c);
}

/* A query's buffers fit the widest tree, wherever it is in the list. */
TEST(mote_scene_create_shapes_in_any_order_same_bits)
{
    static const uint32_t pair[1][2] = {{0, 1}}, shape_of[2][2] = {{0, 1}, {1, 0}};
    uint64_t seed = 3;
    test_body b[2];
    test_body_init(&b[0], solid_to_mesh(solid_icosphere(1)), 4, &seed);
    test_body_init(&b[1], solid_to_mesh(solid_torus(60, 30)), 4, &seed);
    const mote_body *shapes[2][2] = {{&b[0].body, &b[1].body}, {&b[1].body, &b[0].body}};
    mote_body_state states[2] = {test_body_state(&b[0], 0.3, &seed),
                                 test_body_state(&b[1], 0.3, &seed)};
    states[0].pose.translation = mote_vec3_make(2, 1, 0.5);
    const mote_scene_options options = mote_default_scene_options();
    mote_scene *scenes[2];
    size_t count;
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(mote_scene_create(shapes[k], 2, shape_of[k], 2, &options, &scenes[k]),
                         MOTE_OK);
        assert_int_equal(mote_scene_query(scenes[k], states, pair, 1), MOTE_OK);
    }
    check_same_pair(mote_scene_pairs(scenes[0], &count), mote_scene_pairs(scenes[1], &count));
    assert_int_equal(mote_scene_bytes(scenes[0]), mote_scene_bytes(scenes[1]));
    for (int k = 0; k < 2; ++k) {
        mote_scene_destroy(scenes[k]);
        test_body_free(&b[k]);
    }
}

TEST(mote_scene_query_steady_state_allocates_nothing)
{
    static crowd c;
    mote_scene_options options = mote_default_scene_options();
    options.threads = 2;
    crowd_init(&c, 10, 400, 2);
    mote_scene *scene = crowd_scene(&c, &options);
    uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
    const size_t count = crowd_pairs(&c, pairs);
    mote_scene_box boxes[CROWD_MAX];
    mote_heap before = mote_heap_read();
    for (int step = 0; step < 6; ++step) {
        if (step == 2) /* both lists of pairs are allocated */
            before = mote_heap_read();
        assert_int_equal(mote_scene_bounds(scene, c.states, boxes), MOTE_OK);
        assert_int_equal(mote_scene_query(scene, c.states, (const uint32_t(*)[2])pairs, count),
                         MOTE_OK);
        crowd_move(&c, 0.02);
    }
    assert_int_equal(mote_heap_read().allocations, before.allocations);
    crowd_close(&c, scene);
}

/* Each body costs its shape's index, each pair its state; nothing grows with triangles. */
TEST(mote_scene_bytes_do_not_grow_with_bodies_times_triangles)
{
    static crowd c;
    const mote_scene_options options = mote_default_scene_options();
    crowd_init(&c, 3, 4000, 2);
    static uint32_t shape_of[100000];
    mote_scene *few = crowd_scene(&c, &options), *many = NULL;
    assert_int_equal(
        mote_scene_create(c.shape, CROWD_SHAPES, shape_of, 100000, &options, &many), MOTE_OK);
    assert_true(mote_scene_bytes(many) - mote_scene_bytes(few) <= 4 * 100000);
    mote_scene_destroy(few);
    mote_scene_destroy(many);
    crowd_free(&c);
}
