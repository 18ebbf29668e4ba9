/* Skinned tori, with and without morph targets: the answers of random affine bones of all sorts
   against all pairs of triangles. */
#include <stddef.h>

#include "core/certificate/certificate_shared.h"
#include "core/certificate/scene.h"
#include "core/certificate/certificate_state.h"
#include "tests/support/certificate_scene.h"
#include "tests/support/skin_scene.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

/* Bones, bones a vertex, targets. */
static const skin_plan plans[] = {{1, 1, 0}, {5, 2, 0},  {12, 4, 0}, {40, 9, 0},
                                  {0, 0, 1}, {0, 0, 12}, {12, 4, 6}, {300, 5, 40}};

/* Makes the second body `part` times as large as the first: units that are the skin's, the
   body's and the pair's are no longer the same. */
static void shrink_second(skinned *k, double part, skin_plan plan)
{
    scene *s = &k->s;
    mote_mesh *before = s->mesh[1];
    s->mesh[1] = make_torus(23, 10, 2.5 * part);
    s->body[1].mesh = s->mesh[1];
    use_field(s, 1, skin_of_torus(s->mesh[1], &plan));
    mote_mesh_destroy(before);
}

static void check_queries(skinned *k, size_t plan, int *contacts, int *apart)
{
    mote_certificate *c = certificate_of(&k->s, NULL);
    for (int frame = 0; frame < 40; ++frame) {
        next_pose(k, wildness[frame % 4], frame % 3 ? 2.5 : 1.2);
        const double truth = scene_truth(&k->s);
        mote_certificate_answer a;
        mote_certificate_query(c, &k->s.frame, NULL, -1, &a);
        test_row("plan %zu, frame %d", plan, frame);
        assert_true(fabs(a.distance - truth) <= 1e-12 * k->s.length);
        assert_true(a.lower <= truth);
        assert_true(a.lower >= truth - 1e-12 * largest_term(k) * k->s.length);
        *contacts += !(truth > 0);
        *apart += truth > 0;
    }
    mote_certificate_destroy(c);
}

TEST(query_of_random_affine_bones_equals_all_pairs)
{
    int contacts = 0, apart = 0;
    for (size_t i = 0; i < ROWS_OF(plans); ++i) {
        skinned k;
        skinned_init(&k, 22, 10, plans[i]);
        check_queries(&k, i, &contacts, &apart);
        skinned_free(&k);
    }
    assert_true(contacts > 40);
    assert_true(apart > 100);
}

TEST(query_of_bodies_of_unlike_sizes_equals_all_pairs)
{
    static const skin_plan all[] = {{5, 2, 0}, {0, 0, 3}, {12, 4, 6}};
    int contacts = 0, apart = 0;
    for (size_t i = 0; i < ROWS_OF(all); ++i) {
        skinned k;
        skinned_init(&k, 22, 10, all[i]);
        shrink_second(&k, i == 0 ? 0.003 : 0.1, all[i]);
        check_queries(&k, i, &contacts, &apart);
        skinned_free(&k);
    }
    assert_true(contacts > 0);
    assert_true(apart > 60);
}

/* Many bodies: the box of a tree's root holds every vertex. */
TEST(broad_phase_boxes_hold_every_vertex)
{
    skinned k;
    skinned_init(&k, 30, 14, (skin_plan){9, 3, 5});
    const mote_certificate_options options = mote_default_certificate_options(k.s.length);
    const mote_cert_tree_options plan = {
        .length = k.s.length, .width = options.width, .linear_fits = true};
    mote_cert_tree *tree = NULL;
    mote_certificate *workspace = NULL;
    assert_int_equal(mote_cert_tree_create(&k.s.body[0], &plan, &tree), MOTE_OK);
    assert_int_equal(mote_cert_workspace_create(&tree, 1, &options, &workspace), MOTE_OK);
    for (int frame = 0; frame < 40; ++frame) {
        next_pose(&k, wildness[frame % 4], 2);
        mote_vec3 low, high;
        mote_cert_workspace_bounds(workspace, tree, &k.s.frame.body[0], &low, &high);
        for (uint32_t v = 0; v < k.s.mesh[0]->vertex_count; ++v) {
            const mote_vec3 p = k.s.world[0][v];
            assert_true(p.x >= low.x && p.y >= low.y && p.z >= low.z);
            assert_true(p.x <= high.x && p.y <= high.y && p.z <= high.z);
        }
    }
    k.weights[0][5] = HUGE_VAL; /* appears in the bounds, not hidden by a comparison */
    mote_vec3 low, high;
    mote_cert_workspace_bounds(workspace, tree, &k.s.frame.body[0], &low, &high);
    const double sum = low.x + high.x + low.y + high.y + low.z + high.z;
    assert_true(!(fabs(sum) < HUGE_VAL));
    mote_cert_workspace_destroy(workspace);
    mote_cert_tree_destroy(tree);
    skinned_free(&k);
}

TEST(skin_of_65535_bones_equals_all_pairs)
{
    skinned k;
    skinned_init(&k, 22, 10, (skin_plan){65535, 2, 0});
    mote_certificate *c = certificate_of(&k.s, NULL);
    for (int frame = 0; frame < 4; ++frame) {
        next_pose(&k, 0.02, 1.6);
        mote_certificate_answer a;
        mote_certificate_query(c, &k.s.frame, NULL, -1, &a);
        assert_true(fabs(a.distance - scene_truth(&k.s)) <= 1e-12 * k.s.length);
    }
    mote_certificate_destroy(c);
    skinned_free(&k);
}

/* The weights of some poses decide how the tree is split, and change no answer. */
TEST(sample_poses_change_no_answer)
{
    skinned k;
    skinned_init(&k, 22, 10, (skin_plan){12, 3, 4});
    mote_certificate *c[2];
    c[0] = certificate_of(&k.s, NULL);
    next_pose(&k, 1, 2);
    /* in the body's axes, that is, without rotation */
    const mote_mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    mote_weights samples[2];
    double *at[2];
    for (int b = 0; b < 2; ++b) {
        at[b] = calloc((size_t)3 * k.s.field[b]->padded, sizeof(double));
        need(at[b]);
        samples[b] = skinned_weights(&k, b, &identity, at[b]);
        k.s.body[b].samples = &samples[b];
        k.s.body[b].sample_count = 1;
    }
    c[1] = certificate_of(&k.s, NULL);
    assert_true(memcmp(c[0]->side[0].tree->leaf_vertices, c[1]->side[0].tree->leaf_vertices,
                       c[0]->side[0].tree->leaf_vertex_count * sizeof(uint32_t)) != 0);
    for (int frame = 0; frame < 40; ++frame) {
        next_pose(&k, wildness[frame % 4], 2);
        const double truth = scene_truth(&k.s);
        for (int i = 0; i < 2; ++i) {
            mote_certificate_answer a;
            mote_certificate_query(c[i], &k.s.frame, NULL, -1, &a);
            assert_true(fabs(a.distance - truth) <= 1e-12 * k.s.length);
        }
    }
    for (int b = 0; b < 2; ++b) {
        mote_certificate_destroy(c[b]);
        free(at[b]);
    }
    skinned_free(&k);
}

/* Methods that read vertices one by one, all at once, or through trees of their own. */
TEST(other_methods_answer_for_skins)
{
    static const char *const names[] = {"particle", "particle-paper", "aabb-tree"};
    skinned k;
    skinned_init(&k, 30, 14, (skin_plan){9, 3, 5});
    void *state[3];
    double values[3][MOTE_PARAMETERS_MAX];
    for (int i = 0; i < 3; ++i) {
        const mote_method *method = method_with(names[i], "", values[i]);
        const mote_setup setup = {.body = {&k.s.body[0], &k.s.body[1]},
                                  .length = k.s.length,
                                  .ask = MOTE_ASK_DISTANCE,
                                  .seed = 1,
                                  .values = values[i]};
        assert_int_equal(mote_method_create(method, &setup, &state[i]), MOTE_OK);
    }
    int exact = 0;
    for (int frame = 0; frame < 20; ++frame) {
        next_pose(&k, 0.1, 2);
        const double truth = scene_truth(&k.s);
        for (int i = 0; i < 3; ++i) {
            const mote_method *method = mote_method_find(names[i]);
            mote_frame frame_of = k.s.frame;
            for (int b = 0; b < 2; ++b)
                frame_of.body[b].vertices = k.s.world[b];
            mote_answer a = {.has_distance = false};
            if (method->update)
                assert_int_equal(method->update(state[i], &frame_of), MOTE_OK);
            assert_int_equal(method->query(state[i], &frame_of, &a), MOTE_OK);
            assert_true(a.has_distance);
            assert_true(a.distance >= truth - 1e-12 * k.s.length);
            const bool same = a.distance <= truth + 1e-12 * k.s.length;
            assert_true(same || i < 2);
            exact += same && i == 0;
        }
    }
    assert_true(exact >= 15);
    for (int i = 0; i < 3; ++i)
        mote_method_destroy(mote_method_find(names[i]), state[i]);
    skinned_free(&k);
}

/* A scene of bodies with two skins: each pair has the answer of all pairs of triangles. */
TEST(scene_of_skins_equals_all_pairs)
{
    skinned k;
    skinned_init(&k, 22, 11, (skin_plan){9, 3, 5});
    const mote_body *const shapes[2] = {&k.s.body[0], &k.s.body[1]};
    const uint32_t shape_of[2] = {0, 1};
    const uint32_t pairs[1][2] = {{0, 1}};
    const mote_scene_options options = {.threads = 1, .ask = MOTE_ASK_DISTANCE, .tolerance = 0};
    mote_scene *many = NULL;
    assert_int_equal(mote_scene_create(shapes, 2, shape_of, 2, &options, &many), MOTE_OK);
    for (int frame = 0; frame < 20; ++frame) {
        next_pose(&k, wildness[frame % 4], 2);
        assert_int_equal(mote_scene_query(many, k.s.frame.body, pairs, 1), MOTE_OK);
        size_t count = 0;
        const mote_scene_pair *pair = mote_scene_pairs(many, &count);
        assert_int_equal(count, 1);
        assert_true(fabs(pair->distance - scene_truth(&k.s)) <= 1e-12 * k.s.length);
    }
    mote_scene_destroy(many);
    skinned_free(&k);
}
