/* Every bound of a skin against every vertex, for random affine bones of all sorts and morph
   targets. */
#include <stddef.h>

#include "core/certificate/certificate_shared.h"
#include "core/certificate/certificate_state.h"
#include "core/body/lazy.h"
#include "tests/support/certificate_scene.h"
#include "tests/support/skin_scene.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

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

static void check_frame(skinned *k, mote_certificate *c, int *boxes, int *narrowed)
{
    for (int b = 0; b < 2; ++b)
        *boxes += check_body(&k->s, c, b, narrowed);
}

/* Frames from nearby to so far that a float keeps three digits of the size. */
static void check_frames(skinned *k, mote_certificate *c, int *boxes, int *narrowed)
{
    for (int frame = 0; frame < 16; ++frame) {
        next_pose(k, wildness[frame % 4], 2);
        c->origin = mote_vec3_make(pow(10, frame % 5), 0, 0);
        check_frame(k, c, boxes, narrowed);
    }
}

static void check_plan(skin_plan plan, bool linear_fits, int *boxes, int *narrowed)
{
    skinned k;
    skinned_init(&k, 60, 24, plan);
    mote_certificate_options options = mote_default_certificate_options(k.s.length);
    options.linear_fits = linear_fits;
    mote_certificate *c = certificate_of(&k.s, &options);
    check_frames(&k, c, boxes, narrowed);
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
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_morphs(s.mesh[0], 0, NULL, NULL, NULL, &targets, &field),
                     MOTE_OK);
    use_field(&s, 0, field);
    mote_certificate *c = certificate_of(&s, NULL);
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

/* Replaces both skins by one in which vertex v follows bone step * v with `weight`, and with
   the rest the bone after that. */
static void use_bones(skinned *k, uint32_t step, double weight)
{
    for (int b = 0; b < 2; ++b) {
        const uint32_t n = k->s.mesh[b]->vertex_count;
        uint32_t *start = malloc((n + 1) * sizeof *start);
        uint16_t(*bone)[2] = malloc(n * sizeof *bone);
        double(*weights)[2] = malloc(n * sizeof *weights);
        need(start && bone && weights);
        for (uint32_t v = 0; v <= n; ++v)
            start[v] = 2 * v;
        for (uint32_t v = 0; v < n; ++v) {
            bone[v][0] = (uint16_t)(step * v % k->bones);
            bone[v][1] = (uint16_t)((step * v + 1) % k->bones);
            weights[v][0] = weight;
            weights[v][1] = 1 - weight;
        }
        mote_field *field = NULL;
        need(mote_field_create_skin(k->s.mesh[b], k->bones, start, bone[0], weights[0],
                                    &field) == MOTE_OK);
        use_field(&k->s, b, field);
        free(start);
        free(bone);
        free(weights);
    }
}

/* Bones that move a single vertex, or two, of a child; and bones whose weights are the same
   everywhere, so that nothing is left of a row but the rounding of its numbers. */
TEST(boxes_enclose_vertices_with_bones_of_their_own_and_with_equal_weights)
{
    static const struct {
        uint32_t bones, step;
        double weight;
    } all[] = {{3000, 2, 1}, {1500, 1, 0.6}, {2, 0, 0.75}, {2, 0, 0.5}};
    for (size_t i = 0; i < ROWS_OF(all); ++i) {
        skinned k;
        int boxes = 0, narrowed = 0;
        test_row("%u bones", all[i].bones);
        skinned_init(&k, 60, 24, (skin_plan){all[i].bones, 1, 0});
        use_bones(&k, all[i].step, all[i].weight);
        mote_certificate *c = certificate_of(&k.s, NULL);
        check_frames(&k, c, &boxes, &narrowed);
        assert_true(boxes > 1000);
        mote_certificate_destroy(c);
        skinned_free(&k);
    }
}

/* One column of all matrices, or their translation, is so large that what the others do is lost
   in its rounding: margins must be those of the largest. */
TEST(boxes_enclose_what_bones_stretch_along_one_axis)
{
    skinned k;
    int boxes = 0, narrowed = 0;
    skinned_init(&k, 30, 14, (skin_plan){12, 4, 0});
    mote_certificate *c = certificate_of(&k.s, NULL);
    for (int frame = 0; frame < 16; ++frame) {
        next_pose(&k, 0.3, 2);
        for (int b = 0; b < 2; ++b) {
            for (uint32_t i = 0; i < k.bones; ++i) {
                for (int r = 0; r < 3; ++r)
                    k.matrix[b][i][r][frame % 4] *= 1e6;
            }
        }
        skinned_deform(&k);
        check_frame(&k, c, &boxes, &narrowed);
    }
    assert_true(boxes > 1000);
    mote_certificate_destroy(c);
    skinned_free(&k);
}
