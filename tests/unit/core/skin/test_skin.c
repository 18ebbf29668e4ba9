/* Skinned tori, with and without morph targets: random affine bones of all sorts against all
   pairs of triangles, and every bound against every vertex. */
#include <stddef.h>

#include "core/certificate/certificate_shared.h"
#include "core/certificate/scene.h"
#include "core/certificate/certificate_state.h"
#include "core/body/field_kinds.h"
#include "core/body/lazy.h"
#include "tests/support/skin_scene.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

static mote_certificate *certificate_by(const scene *s, bool linear_fits)
{
    const mote_body *const bodies[2] = {&s->body[0], &s->body[1]};
    mote_certificate_options options = mote_default_certificate_options(s->length);
    mote_certificate *c = NULL;
    options.linear_fits = linear_fits;
    assert_int_equal(mote_certificate_create(bodies, &options, &c), MOTE_OK);
    return c;
}

static mote_certificate *certificate_of(const scene *s)
{
    return certificate_by(s, true);
}

/* Bones, bones a vertex, targets. */
static const skin_plan plans[] = {{1, 1, 0}, {5, 2, 0},  {12, 4, 0}, {40, 9, 0},
                                  {0, 0, 1}, {0, 0, 12}, {12, 4, 6}, {300, 5, 40}};

TEST(query_of_random_affine_bones_equals_all_pairs)
{
    int contacts = 0, apart = 0;
    for (size_t i = 0; i < ROWS_OF(plans); ++i) {
        skinned k;
        skinned_init(&k, 22, 10, plans[i]);
        mote_certificate *c = certificate_of(&k.s);
        for (int frame = 0; frame < 40; ++frame) {
            next_pose(&k, wildness[frame % 4], frame % 3 ? 2.5 : 1.2);
            const double truth = scene_truth(&k.s);
            mote_certificate_answer a;
            mote_certificate_query(c, &k.s.frame, NULL, -1, &a);
            test_row("plan %zu, frame %d", i, frame);
            assert_true(fabs(a.distance - truth) <= 1e-12 * k.s.length);
            assert_true(a.lower <= truth);
            assert_true(a.lower >= truth - 1e-12 * largest_term(&k) * k.s.length);
            contacts += !(truth > 0);
            apart += truth > 0;
        }
        mote_certificate_destroy(c);
        skinned_free(&k);
    }
    assert_true(contacts > 40);
    assert_true(apart > 100);
}

static void check_vertex(scene *s, mote_certificate *c, int b, const mote_cert_node *node,
                         size_t l, uint32_t vertex)
{
    assert_true(in_reach(s, c, b, node, l, vertex));
    assert_true(in_box(s, c, b, node, l, vertex));
    assert_true(node->spans && in_ends(s, c, b, node, l, vertex));
}

/* Calls check_vertex for all vertices below a node's child. */
static void check_below(scene *s, mote_certificate *c, int b, const mote_cert_node *node,
                        size_t l, int32_t child)
{
    const mote_cert_tree *tree = c->side[b].tree;
    if (child < 0) {
        const mote_cert_leaf *leaf = &tree->leaves[~child];
        for (uint32_t i = 0; i < leaf->vertex_count; ++i)
            check_vertex(s, c, b, node, l, tree->leaf_vertices[leaf->first_vertex + i]);
        return;
    }
    const mote_cert_block *block = &tree->blocks[child];
    for (size_t k = 0; k < block->children; ++k)
        check_below(s, c, b, node, l, block->child[k]);
}

static void check_hull(const scene *s, const mote_certificate *c, int b,
                       const mote_cert_hull *hull)
{
    const mote_cert_tree *tree = c->side[b].tree;
    for (uint32_t i = 0; i < hull->leaf->vertex_count; ++i) {
        const uint32_t v = tree->leaf_vertices[hull->leaf->first_vertex + i];
        const mote_vec3 p = certificate_point(c, s->world[b][v]);
        const double at[3] = {p.x, p.y, p.z};
        for (int r = 0; r < 3; ++r)
            assert_true(fabs(at[r] - (double)hull->x[r][i]) <= (double)hull->width[r]);
    }
}

static void check_leaf(scene *s, mote_certificate *c, int b, mote_cert_node *node, size_t l,
                       int *narrowed)
{
    mote_cert_side *side = &c->side[b];
    mote_cert_hull hull;
    mote_cert_leaf_hull(side, node, l, &hull);
    check_hull(s, c, b, &hull);
    const mote_cert_hull *near = mote_cert_leaf_near_hull(side, node, l);
    assert_non_null(near);
    check_hull(s, c, b, near);
    *narrowed += mote_cert_narrow(side, node, l);
    mote_cert_leaf_hull(side, node, l, &hull);
    check_hull(s, c, b, &hull);
}

static int check_node(scene *s, mote_certificate *c, int b, mote_cert_node *node, int *narrowed)
{
    int boxes = 0;
    mote_cert_make_boxes(c, b, node);
    for (size_t l = 0; l < node->block->children; ++l, ++boxes) {
        const int32_t child = node->block->child[l];
        check_below(s, c, b, node, l, child);
        if (child >= 0) {
            boxes += check_node(s, c, b, mote_cert_child(c, b, node, l, 0), narrowed);
            continue;
        }
        check_leaf(s, c, b, node, l, narrowed);
        check_below(s, c, b, node, l, child);
    }
    return boxes;
}

/* Checks all boxes of body b along a random direction; returns how many there are. */
static int check_body(scene *s, mote_certificate *c, int b, int *narrowed)
{
    const mote_mat3 r = random_rotation(s);
    ++c->generation;
    mote_lazy_begin(&c->side[b].lazy, &s->frame.body[b], false);
    mote_cert_side_begin(&c->side[b], &s->frame.body[b], c->origin);
    mote_cert_side_face(&c->side[b], mote_vec3_make(r.m[0][0], r.m[0][1], r.m[0][2]), 0);
    return check_node(s, c, b, mote_cert_root(c, b), narrowed);
}

static void check_plan(skin_plan plan, bool linear_fits, int *boxes, int *narrowed)
{
    skinned k;
    skinned_init(&k, 60, 24, plan);
    mote_certificate *c = certificate_by(&k.s, linear_fits);
    for (int frame = 0; frame < 16; ++frame) {
        next_pose(&k, wildness[frame % 4], 2);
        /* from nearby to so far that a float keeps three digits of the size */
        c->origin = mote_vec3_make(pow(10, frame % 5), 0, 0);
        for (int b = 0; b < 2; ++b)
            *boxes += check_body(&k.s, c, b, narrowed);
    }
    mote_certificate_destroy(c);
    skinned_free(&k);
}

TEST(boxes_and_hulls_enclose_their_vertices)
{
    int boxes = 0, narrowed = 0;
    static const skin_plan few[] = {{4, 1, 0}, {12, 3, 0}, {20, 5, 0}, {0, 0, 7}, {16, 4, 9}};
    for (size_t i = 0; i < ROWS_OF(few); ++i)
        check_plan(few[i], true, &boxes, &narrowed);
    assert_true(boxes > 10000);
    assert_true(narrowed > 1000);
    check_plan(few[4], false, &boxes, &narrowed);
}

/* Vertices near the middle of a bar of separate triangles, and one at each end. */
static mote_mesh *make_bar(void)
{
    enum { TRIANGLES = 13, POINTS = 3 * TRIANGLES };
    double xyz[POINTS][3];
    uint32_t faces[TRIANGLES][3];
    for (uint32_t v = 0; v < POINTS; ++v) {
        const bool end = v == 0 || v == POINTS - 1;
        xyz[v][0] = (v < POINTS / 2 ? -1 : 1) * (end ? 1 : 0.232);
        xyz[v][1] = end ? 0 : 0.1 * cos(2.0 * v);
        xyz[v][2] = end ? 0 : 0.05 * sin(2.0 * v);
        faces[v / 3][v % 3] = v;
    }
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(xyz[0], POINTS, faces[0], TRIANGLES, &mesh), MOTE_OK);
    return mesh;
}

/* A target that moves the left and the right of the middle apart, and the ends not at all, is
   steeper than slopes are kept. */
TEST(boxes_enclose_what_steep_targets_move)
{
    scene s;
    scene_init_meshes(&s, make_bar(), make_torus(9, 6, 1), false);
    const uint32_t n = s.mesh[0]->vertex_count;
    uint32_t start[2] = {0, n}, vertex[64];
    mote_vec3 move[64];
    assert_true(n <= ROWS_OF(vertex));
    for (uint32_t v = 0; v < n; ++v) {
        vertex[v] = v;
        move[v] = mote_vec3_make(0, v == 0 || v == n - 1 ? 0 : v < n / 2 ? -1.99 : 1.99, 0);
    }
    const mote_morph_targets targets = {1, start, vertex, move};
    mote_deform_destroy(s.deform[0]);
    mote_field_destroy(s.field[0]);
    assert_int_equal(
        mote_field_create_morphs(s.mesh[0], 0, NULL, NULL, NULL, &targets, &s.field[0]),
        MOTE_OK);
    s.body[0].field = s.field[0];
    assert_int_equal(mote_deform_create(&s.body[0], &s.deform[0]), MOTE_OK);
    mote_certificate *c = certificate_of(&s);
    int narrowed = 0;
    for (int frame = 0; frame < 12; ++frame) {
        scene_next(&s, 1.5, false);
        const double amount = scene_random(&s, -1, 1);
        mote_morph_weights(s.field[0], NULL, &amount, &s.frame.body[0].pose.rotation,
                           s.weights[0][0], s.weights[0][1], s.weights[0][2]);
        mote_deform_all(s.deform[0], &s.frame.body[0], s.world[0]);
        assert_true(check_body(&s, c, 0, &narrowed) > 0);
        mote_certificate_answer a;
        mote_certificate_query(c, &s.frame, NULL, -1, &a);
        assert_true(fabs(a.distance - scene_truth(&s)) <= 1e-12 * s.length);
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* The morphed position of a vertex, from the original displacements. */
static mote_vec3 morphed(const skinned *k, const skin_plan *plan, int b, uint32_t vertex)
{
    mote_vec3 x = k->s.mesh[b]->positions[vertex];
    for (uint32_t j = 0; j < plan->targets; ++j)
        x = mote_add_scaled(x, k->amounts[b][j], target_move(k->s.mesh[b], plan, j, vertex));
    return x;
}

/* Against the formula: sum of w_b M_b (x + sum of m_k d_k), then the pose. Displacements are
   stored as floats. */
TEST(positions_are_blended_matrices_of_morphed_vertices)
{
    static const skin_plan all[] = {{6, 3, 0}, {0, 0, 4}, {6, 3, 8}};
    for (size_t i = 0; i < ROWS_OF(all); ++i) {
        skinned k;
        skinned_init(&k, 20, 9, all[i]);
        next_pose(&k, 1, 2);
        const double exact = all[i].targets ? 1e-6 * largest_term(&k) : 1e-14;
        const mote_skin *skin = mote_field_skin(k.s.field[0]);
        const mote_pose *pose = &k.s.frame.body[0].pose;
        for (uint32_t v = 0; v < k.s.mesh[0]->vertex_count; ++v) {
            const mote_vec3 x = morphed(&k, &all[i], 0, v);
            double p[3] = {0, 0, 0}, sum = 0;
            for (uint32_t e = skin->start[v]; e < skin->start[v + 1]; ++e) {
                const double(*m)[4] = (const double(*)[4])k.matrix[0][skin->bone[e]];
                sum += (double)skin->weight[e];
                for (int r = 0; r < 3; ++r)
                    p[r] += (double)skin->weight[e] *
                            (m[r][0] * x.x + m[r][1] * x.y + m[r][2] * x.z + m[r][3]);
            }
            assert_true(sum == 1.0);
            const mote_vec3 expected = mote_pose_apply(pose, mote_vec3_make(p[0], p[1], p[2]));
            assert_true(mote_length(mote_sub(expected, k.s.world[0][v])) <= exact * k.s.length);
        }
        skinned_free(&k);
    }
}

/* If a field has a basis, the sum over it gives the same bits. */
static void check_basis(const mote_field *field, const mote_mesh *mesh,
                        const mote_weights *weights, const mote_weights_single *rounded,
                        uint32_t v)
{
    double *phi = calloc(field->padded, sizeof *phi);
    need(phi);
    field->kind->basis(field, mesh, v, phi);
    const mote_vec3 d = mote_field_displacement(field, mesh, v, weights);
    const mote_vec3 e = mote_weighted_sum(phi, weights, field->padded);
    assert_memory_equal(&d, &e, sizeof d);
    float f[3], g[3];
    mote_field_displacement_single(field, mesh, v, rounded, f);
    mote_weighted_sum_single(phi, rounded, field->padded, g);
    assert_memory_equal(f, g, sizeof f);
    free(phi);
}

/* Checks all ways to get positions: one vertex, eight at once, lazily, summed over the basis,
   and in single precision. */
static void check_roads(skinned *k, int b)
{
    const mote_field *field = k->s.field[b];
    const mote_mesh *mesh = k->s.mesh[b];
    const mote_body_state *state = &k->s.frame.body[b];
    mote_lazy lazy;
    need(mote_lazy_init(&lazy, &k->s.body[b], 64) == MOTE_OK);
    mote_lazy_begin(&lazy, state, false);
    float *single = calloc((size_t)3 * field->padded, sizeof *single);
    need(single);
    for (uint32_t j = 0; j < 3 * field->padded; ++j)
        single[j] = (float)k->weights[b][j];
    const mote_weights_single rounded = {single, single + field->padded,
                                         single + 2 * field->padded, field->padded};
    for (uint32_t v = 0; v < mesh->vertex_count; v += MOTE_LANES) {
        uint32_t vertices[MOTE_LANES];
        for (uint32_t l = 0; l < MOTE_LANES; ++l)
            vertices[l] = v + l < mesh->vertex_count ? v + l : 0;
        mote_lazy_fetch(&lazy, vertices, MOTE_LANES);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const mote_vec3 p = mote_body_position(&k->s.body[b], state, v);
        const mote_vec3 q = mote_lazy_position(&lazy, v);
        assert_memory_equal(&p, &q, sizeof p);
        assert_memory_equal(&p, &k->s.world[b][v], sizeof p);
        if (field->kind->basis)
            check_basis(field, mesh, &state->weights, &rounded, v);
        float f[3];
        const mote_vec3 d = mote_field_displacement(field, mesh, v, &state->weights);
        mote_field_displacement_single(field, mesh, v, &rounded, f);
        assert_true(fabs((double)f[0] - d.x) + fabs((double)f[1] - d.y) +
                        fabs((double)f[2] - d.z) <=
                    1e-4 * largest_term(k) * k->s.length);
    }
    free(single);
    mote_lazy_free(&lazy);
}

TEST(all_roads_to_a_position_give_the_same_bits)
{
    static const skin_plan all[] = {{11, 4, 0}, {0, 0, 3}, {11, 4, 8}};
    for (size_t i = 0; i < ROWS_OF(all); ++i) {
        skinned k;
        skinned_init(&k, 20, 9, all[i]);
        next_pose(&k, 0.3, 2);
        for (int b = 0; b < 2; ++b)
            check_roads(&k, b);
        skinned_free(&k);
    }
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
    mote_certificate *c = certificate_of(&k.s);
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
    c[0] = certificate_of(&k.s);
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
    c[1] = certificate_of(&k.s);
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
