/* Skinned tori: random affine bones of every sort against all pairs of triangles, and every
   bound against every vertex. */
#include <stddef.h>

#include "core/certificate/certificate_shared.h"
#include "core/certificate/scene.h"
#include "core/certificate/certificate_state.h"
#include "core/skin/skin.h"
#include "core/body/field_kinds.h"
#include "core/body/lazy.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"

/* A skinned pair and its bones' matrices. */
typedef struct skinned {
    scene s;
    uint32_t bones;
    double (*matrix[2])[3][4];
    double *weights[2]; /* x, y, z */
} skinned;

/* Weights of a vertex: bones along the torus' angle, blended where they meet, `each` at most.
 */
static void weigh(const mote_mesh *mesh, uint32_t vertex, uint32_t bones, uint32_t each,
                  uint16_t *bone, double *weight)
{
    const mote_vec3 x = mesh->positions[vertex];
    const double turn = (atan2(x.y, x.x) / 6.283185307179586 + 0.5) * bones;
    const uint32_t first = (uint32_t)turn;
    for (uint32_t k = 0; k < each; ++k) {
        bone[k] = (uint16_t)((first + k) % bones);
        const double d = 1 - fabs(turn - first - k + 0.3) / each;
        weight[k] = d > 0 ? d * d : 0;
    }
    weight[0] += 1e-3;
    if (vertex % 7 == 0) /* rigid ones too */
        for (uint32_t k = 1; k < each; ++k)
            weight[k] = 0;
}

static mote_field *skin_of_torus(const mote_mesh *mesh, uint32_t bones, uint32_t each)
{
    const uint32_t n = mesh->vertex_count;
    uint32_t *start = malloc((n + 1) * sizeof *start);
    uint16_t *bone = malloc(n * each * sizeof *bone);
    double *weight = malloc(n * each * sizeof *weight);
    need(start && bone && weight);
    for (uint32_t v = 0; v <= n; ++v)
        start[v] = v * each;
    for (uint32_t v = 0; v < n; ++v)
        weigh(mesh, v, bones, each, bone + v * each, weight + v * each);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_skin(mesh, bones, start, bone, weight, &field), MOTE_OK);
    free(start);
    free(bone);
    free(weight);
    return field;
}

static void skinned_init(skinned *k, uint32_t across, uint32_t around, uint32_t bones,
                         uint32_t each)
{
    scene_init(&k->s, across, around, 2.5, false);
    k->bones = bones;
    for (int b = 0; b < 2; ++b) {
        mote_deform_destroy(k->s.deform[b]);
        mote_field_destroy(k->s.field[b]);
        k->s.field[b] = skin_of_torus(k->s.mesh[b], bones, each);
        k->s.body[b].field = k->s.field[b];
        need(mote_deform_create(&k->s.body[b], &k->s.deform[b]) == MOTE_OK);
        k->matrix[b] = calloc(bones, sizeof *k->matrix[b]);
        k->weights[b] = calloc((size_t)3 * k->s.field[b]->padded, sizeof(double));
        need(k->matrix[b] && k->weights[b]);
    }
}

static void skinned_free(skinned *k)
{
    for (int b = 0; b < 2; ++b) {
        free(k->matrix[b]);
        free(k->weights[b]);
    }
    scene_free(&k->s);
}

/* Any affine matrix: near the identity, scaled, sheared, mirrored, singular, or all zero. */
static void random_bone(scene *s, double wild, double m[3][4])
{
    const int sort = (int)scene_random(s, 0, 8);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            m[r][c] = (r == c ? 1 : 0) + scene_random(s, -wild, wild);
        m[r][3] = scene_random(s, -0.3, 0.3) * wild * s->length;
    }
    for (int c = 0; c < 4 && wild > 0.1; ++c) {
        if (sort == 0)
            m[0][c] = -m[0][c]; /* mirrored */
        else if (sort == 1)
            m[2][c] = m[1][c] + m[0][c]; /* flat */
        else if (sort == 2)
            m[0][c] = m[1][c] = m[2][c] = 0; /* a point */
        else if (sort == 3)
            m[1][c] *= 3; /* stretched */
    }
}

static void next_pose(skinned *k, double wild, double reach)
{
    scene *s = &k->s;
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &s->frame.body[b];
        const uint32_t padded = s->field[b]->padded;
        double *w = k->weights[b];
        state->shape_changed = state->pose_changed = true;
        state->pose.rotation = random_rotation(s);
        state->pose.translation =
            mote_vec3_make(b * scene_random(s, 0.1, reach) * s->length,
                           scene_random(s, -0.2, 0.2), scene_random(s, -0.2, 0.2));
        for (uint32_t i = 0; i < k->bones; ++i)
            random_bone(s, wild, k->matrix[b][i]);
        mote_skin_weights(s->field[b], (const double(*)[3][4])k->matrix[b],
                          &state->pose.rotation, w, w + padded, w + 2 * padded);
        state->weights =
            (mote_weights){w, w + padded, w + 2 * padded, s->field[b]->count, padded};
        mote_deform_all(s->deform[b], state, s->world[b]);
    }
    ++s->frame.number;
}

static mote_certificate *certificate_of(const scene *s)
{
    const mote_body *const bodies[2] = {&s->body[0], &s->body[1]};
    const mote_certificate_options plain = mote_default_certificate_options(s->length);
    mote_certificate *c = NULL;
    assert_int_equal(mote_certificate_create(bodies, &plain, &c), MOTE_OK);
    return c;
}

static const double wildness[4] = {0.02, 0.3, 1, 3};

TEST(query_of_random_affine_bones_equals_all_pairs)
{
    static const uint32_t shapes[4][2] = {{1, 1}, {5, 2}, {12, 4}, {40, 9}};
    int contacts = 0, apart = 0;
    for (int i = 0; i < 4; ++i) {
        skinned k;
        skinned_init(&k, 30, 14, shapes[i][0], shapes[i][1]);
        mote_certificate *c = certificate_of(&k.s);
        for (int frame = 0; frame < 60; ++frame) {
            next_pose(&k, wildness[frame % 4], frame % 3 ? 2.5 : 1.2);
            const double truth = scene_distance(&k.s);
            mote_certificate_answer a;
            mote_certificate_query(c, &k.s.frame, NULL, -1, &a);
            assert_true(fabs(a.distance - truth) <= 1e-12 * k.s.length);
            assert_true(a.lower <= truth);
            assert_true(a.lower >= truth - 1e-12 * k.s.length);
            contacts += !(truth > 0);
            apart += truth > 0;
        }
        mote_certificate_destroy(c);
        skinned_free(&k);
    }
    assert_true(contacts > 20);
    assert_true(apart > 60);
}

static mote_vec3 relative(const mote_certificate *c, mote_vec3 world)
{
    return mote_scale(mote_sub(world, c->origin), c->scale);
}

/* A point is in a box: by the gap along any of some directions. */
static void check_in_box(scene *s, const mote_cert_node *node, size_t l, mote_vec3 p)
{
    for (int i = 0; i < 3; ++i) {
        const mote_mat3 turn = random_rotation(s);
        const double *d = turn.m[0];
        double at = 0, half = 0;
        for (int r = 0; r < 3; ++r) {
            at += (double)node->centre[r][l] * d[r];
            half += (double)node->width[r][l] * fabs(d[r]);
        }
        for (int a = 0; a < 3; ++a) {
            double along = 0;
            for (int r = 0; r < 3; ++r)
                along += (double)node->axis[a][r][l] * d[r];
            half += fabs(along);
        }
        const double x = p.x * d[0] + p.y * d[1] + p.z * d[2];
        assert_true(x >= at - half && x <= at + half);
    }
}

static void check_vertex(scene *s, mote_certificate *c, int b, const mote_cert_node *node,
                         size_t l, uint32_t vertex)
{
    const mote_vec3 p = relative(c, s->world[b][vertex]);
    assert_true(mote_dot(p, c->side[b].facing) <= (double)node->reach[l]);
    check_in_box(s, node, l, p);
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
        const mote_vec3 p = relative(c, s->world[b][v]);
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

TEST(boxes_and_hulls_enclose_their_vertices)
{
    int boxes = 0, narrowed = 0;
    for (uint32_t each = 1; each <= 5; each += 2) {
        skinned k;
        skinned_init(&k, 60, 24, 4 * each, each);
        mote_certificate *c = certificate_of(&k.s);
        for (int frame = 0; frame < 16; ++frame) {
            next_pose(&k, wildness[frame % 4], 2);
            /* from nearby to so far that a float holds three digits of the size */
            c->origin = mote_vec3_make(pow(10, frame % 5), 0, 0);
            ++c->generation;
            for (int b = 0; b < 2; ++b) {
                const mote_mat3 r = random_rotation(&k.s);
                mote_lazy_begin(&c->side[b].lazy, &k.s.frame.body[b], false);
                mote_cert_side_begin(&c->side[b], &k.s.frame.body[b], c->origin);
                mote_cert_side_face(&c->side[b],
                                    mote_vec3_make(r.m[0][0], r.m[0][1], r.m[0][2]), 0);
                boxes += check_node(&k.s, c, b, mote_cert_root(c, b), &narrowed);
            }
        }
        mote_certificate_destroy(c);
        skinned_free(&k);
    }
    assert_true(boxes > 10000);
    assert_true(narrowed > 1000);
}

/* The formula, written down: sum of w_b M_b x, then the pose. */
TEST(positions_are_blended_matrices)
{
    skinned k;
    skinned_init(&k, 20, 9, 6, 3);
    next_pose(&k, 1, 2);
    const mote_skin *skin = mote_field_skin(k.s.field[0]);
    const mote_pose *pose = &k.s.frame.body[0].pose;
    for (uint32_t v = 0; v < k.s.mesh[0]->vertex_count; ++v) {
        const mote_vec3 x = k.s.mesh[0]->positions[v];
        double p[3] = {0, 0, 0}, sum = 0;
        for (uint32_t i = skin->start[v]; i < skin->start[v + 1]; ++i) {
            const double(*m)[4] = (const double(*)[4])k.matrix[0][skin->bone[i]];
            sum += (double)skin->weight[i];
            for (int r = 0; r < 3; ++r)
                p[r] += (double)skin->weight[i] *
                        (m[r][0] * x.x + m[r][1] * x.y + m[r][2] * x.z + m[r][3]);
        }
        assert_true(sum == 1.0);
        const mote_vec3 expected = mote_pose_apply(pose, mote_vec3_make(p[0], p[1], p[2]));
        assert_true(mote_length(mote_sub(expected, k.s.world[0][v])) <= 1e-14 * k.s.length);
    }
    skinned_free(&k);
}

/* One vertex, eight at once, remembered, summed over the basis and in single precision. */
TEST(all_roads_to_a_position_give_the_same_bits)
{
    skinned k;
    skinned_init(&k, 20, 9, 11, 4);
    next_pose(&k, 1, 2);
    const mote_field *field = k.s.field[0];
    const mote_mesh *mesh = k.s.mesh[0];
    const mote_body_state *state = &k.s.frame.body[0];
    mote_lazy lazy;
    need(mote_lazy_init(&lazy, &k.s.body[0], 64) == MOTE_OK);
    mote_lazy_begin(&lazy, state, false);
    double *phi = calloc(field->padded, sizeof *phi);
    float *single = calloc((size_t)3 * field->padded, sizeof *single);
    need(phi && single);
    for (uint32_t j = 0; j < 3 * field->padded; ++j)
        single[j] = (float)k.weights[0][j];
    const mote_weights_single rounded = {single, single + field->padded,
                                         single + 2 * field->padded, field->padded};
    for (uint32_t v = 0; v < mesh->vertex_count; v += MOTE_LANES) {
        uint32_t vertices[MOTE_LANES];
        for (uint32_t l = 0; l < MOTE_LANES; ++l)
            vertices[l] = v + l < mesh->vertex_count ? v + l : 0;
        mote_lazy_fetch(&lazy, vertices, MOTE_LANES);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const mote_vec3 p = mote_body_position(&k.s.body[0], state, v);
        const mote_vec3 q = mote_lazy_position(&lazy, v);
        assert_memory_equal(&p, &q, sizeof p);
        assert_memory_equal(&p, &k.s.world[0][v], sizeof p);
        field->kind->basis(field, mesh, v, phi);
        const mote_vec3 d = mote_field_displacement(field, mesh, v, &state->weights);
        const mote_vec3 e = mote_weighted_sum(phi, &state->weights, field->padded);
        assert_memory_equal(&d, &e, sizeof d);
        float f[3], g[3];
        mote_field_displacement_single(field, mesh, v, &rounded, f);
        mote_weighted_sum_single(phi, &rounded, field->padded, g);
        assert_memory_equal(f, g, sizeof f);
    }
    free(phi);
    free(single);
    mote_lazy_free(&lazy);
    skinned_free(&k);
}

/* Many bodies: the box of a tree's root holds every vertex. */
TEST(broad_phase_boxes_hold_every_vertex)
{
    skinned k;
    skinned_init(&k, 30, 14, 9, 3);
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
    k.weights[0][5] = HUGE_VAL; /* is seen in the bounds, not hidden by a comparison */
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
    skinned_init(&k, 30, 14, 65535, 2);
    mote_certificate *c = certificate_of(&k.s);
    for (int frame = 0; frame < 4; ++frame) {
        next_pose(&k, 0.02, 1.6);
        mote_certificate_answer a;
        mote_certificate_query(c, &k.s.frame, NULL, -1, &a);
        assert_true(fabs(a.distance - scene_distance(&k.s)) <= 1e-12 * k.s.length);
    }
    mote_certificate_destroy(c);
    skinned_free(&k);
}

/* Weights of some poses decide how the tree is split, and change no answer. */
TEST(sample_poses_change_no_answer)
{
    skinned k;
    skinned_init(&k, 30, 14, 12, 3);
    mote_certificate *c[2];
    c[0] = certificate_of(&k.s);
    next_pose(&k, 1, 2);
    /* in the body's axes, as if it were not rotated */
    const mote_mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    mote_weights samples[2];
    double *at[2];
    for (int b = 0; b < 2; ++b) {
        const uint32_t padded = k.s.field[b]->padded;
        at[b] = calloc((size_t)3 * padded, sizeof(double));
        need(at[b]);
        mote_skin_weights(k.s.field[b], (const double(*)[3][4])k.matrix[b], &identity, at[b],
                          at[b] + padded, at[b] + 2 * padded);
        samples[b] = (mote_weights){at[b], at[b] + padded, at[b] + 2 * padded,
                                    k.s.field[b]->count, padded};
        k.s.body[b].samples = &samples[b];
        k.s.body[b].sample_count = 1;
    }
    c[1] = certificate_of(&k.s);
    assert_true(memcmp(c[0]->side[0].tree->leaf_vertices, c[1]->side[0].tree->leaf_vertices,
                       c[0]->side[0].tree->leaf_vertex_count * sizeof(uint32_t)) != 0);
    for (int frame = 0; frame < 40; ++frame) {
        next_pose(&k, wildness[frame % 4], 2);
        const double truth = scene_distance(&k.s);
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

/* The methods that look at vertices one by one, all at once, or through trees of their own. */
TEST(other_methods_answer_for_skins)
{
    static const char *const names[] = {"particle", "particle-paper", "aabb-tree"};
    skinned k;
    skinned_init(&k, 30, 14, 9, 3);
    void *state[3];
    double values[3][64];
    for (int i = 0; i < 3; ++i) {
        const mote_method *method = mote_method_find(names[i]);
        mote_parameters_default(method->parameters, method->parameter_count, values[i]);
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
        const double truth = scene_distance(&k.s);
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

/* A scene of bodies of two skins: each pair is answered as all pairs of triangles are. */
TEST(scene_of_skins_equals_all_pairs)
{
    skinned k;
    skinned_init(&k, 22, 11, 9, 3);
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
        assert_true(fabs(pair->distance - scene_distance(&k.s)) <= 1e-12 * k.s.length);
    }
    mote_scene_destroy(many);
    skinned_free(&k);
}

static void expect_error(const mote_mesh *mesh, uint32_t bones, const uint32_t *start,
                         const uint16_t *bone, const double *weight, const char *text)
{
    mote_field mark;
    mote_field *field = &mark;
    assert_int_equal(mote_field_create_skin(mesh, bones, start, bone, weight, &field),
                     MOTE_EINVAL);
    assert_string_equal(mote_error_text(), text);
    assert_ptr_equal(field, &mark);
}

TEST(create_skin_with_bad_input_says_what)
{
    mote_mesh *mesh = make_torus(3, 3, 1);
    uint32_t start[10];
    uint16_t bone[9] = {0, 1, 0, 1, 0, 1, 0, 1, 0};
    double weight[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    assert_int_equal(mesh->vertex_count, 9);
    for (uint32_t v = 0; v < 10; ++v)
        start[v] = v;
    expect_error(mesh, 0, start, bone, weight, "a skin has 1 to 65535 bones, not 0");
    expect_error(mesh, 65536, start, bone, weight, "a skin has 1 to 65535 bones, not 65536");
    expect_error(mesh, 1, start, bone, weight, "vertex 1 follows bone 1 of 1, counted from 0");
    weight[2] = -0.5;
    expect_error(mesh, 2, start, bone, weight,
                 "vertex 2 has the weight -0.5; it must be finite and not negative");
    weight[2] = HUGE_VAL;
    expect_error(mesh, 2, start, bone, weight,
                 "vertex 2 has the weight inf; it must be finite and not negative");
    weight[2] = 0;
    expect_error(mesh, 2, start, bone, weight,
                 "the weights of vertex 2 add up to 0; their sum must be positive and finite");
    weight[2] = 1;
    start[4] = 3;
    expect_error(mesh, 2, start, bone, weight, "vertex 3 has no bone; it needs at least one");
    start[4] = 4;
    start[0] = 1;
    expect_error(mesh, 2, start, bone, weight, "the weights of vertex 0 start at 1, not at 0");
    mote_mesh_destroy(mesh);
}

/* Several weights of a bone are added up, tiny ones dropped, and the sum is 1 exactly. */
TEST(weights_are_merged_and_normalised)
{
    mote_mesh *mesh = make_torus(3, 3, 1);
    uint32_t start[10];
    uint16_t bone[36];
    double weight[36];
    for (uint32_t v = 0; v < 9; ++v) {
        const uint16_t b[4] = {7, 2, 7, 5};
        const double w[4] = {0.2, 0.4, 0.3, 1e-9};
        start[v] = 4 * v;
        memcpy(bone + 4 * v, b, sizeof b);
        memcpy(weight + 4 * v, w, sizeof w);
    }
    start[9] = 36;
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_skin(mesh, 8, start, bone, weight, &field), MOTE_OK);
    const mote_skin *skin = mote_field_skin(field);
    assert_true(fabs(skin->off - 0.1) < 1e-8);
    assert_int_equal(skin->most, 2);
    assert_int_equal(skin->start[9], 18);
    assert_int_equal(skin->bone[16], 2);
    assert_int_equal(skin->bone[17], 7);
    assert_true(fabs((double)skin->weight[16] - 4 / 9.0) < 1e-6);
    assert_true((double)skin->weight[16] + (double)skin->weight[17] == 1.0);
    assert_int_equal(field->count, 32);
    assert_string_equal(field->kind->name, "skin");
    mote_field_destroy(field);
    mote_field *still = NULL;
    assert_int_equal(mote_field_create_static(&still), MOTE_OK);
    assert_null(mote_field_skin(still));
    mote_field_destroy(still);
    mote_mesh_destroy(mesh);
}
