/* The float bounds of certified mode against the vertices and faces themselves. */
#include "core/certificate/certificate_state.h"
#include "core/body/triangle.h"

#include <stddef.h>

#include "tests/support/certificate_scene.h"
#include "tests/support/test.h"

/* The largest coordinate along side s's facing of the vertices below a block or leaf. */
static double exact_reach(const scene *s, const mote_certificate *c, int b, int32_t node)
{
    const mote_cert_tree *tree = c->side[b].tree;
    double most = -HUGE_VAL;
    if (node < 0) {
        const mote_cert_leaf *leaf = &tree->leaves[~node];
        for (uint32_t i = 0; i < leaf->vertex_count; ++i) {
            const mote_vec3 x = s->world[b][tree->leaf_vertices[leaf->first_vertex + i]];
            const double p = mote_dot(mote_sub(x, c->origin), c->side[b].facing) * tree->scale;
            most = p > most ? p : most;
        }
        return most;
    }
    const mote_cert_block *block = &tree->blocks[node];
    for (size_t l = 0; l < MOTE_CERT_WIDTH && block->mask >> l; ++l) {
        const double p = exact_reach(s, c, b, block->child[l]);
        most = p > most ? p : most;
    }
    return most;
}

/* Every box below a node reaches at least as far as its vertices. Returns how many boxes. */
static int check_boxes(const scene *s, mote_certificate *c, int b, mote_cert_node *node,
                       double *excess)
{
    int count = 0;
    for (size_t l = 0; l < MOTE_CERT_WIDTH && node->block->mask >> l; ++l) {
        const int32_t child = node->block->child[l];
        const double exact = exact_reach(s, c, b, child);
        assert_true((double)node->reach[l] >= exact);
        *excess += (double)node->reach[l] - exact;
        ++count;
        if (child >= 0)
            count += check_boxes(s, c, b, mote_cert_child(c, b, node, l, 0), excess);
    }
    return count;
}

TEST(deformed_boxes_enclose_their_vertices)
{
    scene s;
    scene_init(&s, 30, 14, 1, true);
    mote_certificate *c = certificate_of(&s, NULL);
    for (int k = 0; k < 40; ++k) {
        /* from nearby to so far that a float keeps three digits of the size */
        scene_next(&s, pow(10, k % 5), false);
        c->origin = s.frame.body[0].pose.translation;
        ++c->generation;
        for (int b = 0; b < 2; ++b) {
            const mote_mat3 r = random_rotation(&s);
            mote_cert_side_begin(&c->side[b], &s.frame.body[b], c->origin);
            mote_cert_side_face(&c->side[b], mote_vec3_make(r.m[0][0], r.m[0][1], r.m[0][2]),
                                0);
            double excess = 0;
            const int boxes = check_boxes(&s, c, b, mote_cert_root(c, b), &excess);
            assert_in_range(boxes, 30, 1000);
            if (k % 5 == 0) /* and not much farther */
                assert_true(excess / boxes < 0.1 * s.length * c->scale);
        }
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* Every vertex of a leaf is where its hull says, to within the hull's width. */
static double check_hull(const scene *s, const mote_certificate *c, const mote_cert_hull *hull)
{
    const mote_cert_tree *tree = c->side[0].tree;
    const mote_cert_leaf *leaf = hull->leaf;
    double most = 0;
    for (uint32_t i = 0; i < hull->groups * MOTE_CERT_WIDTH; ++i) {
        const uint32_t k = i < leaf->vertex_count ? i : leaf->vertex_count - 1u;
        const mote_vec3 world = s->world[0][tree->leaf_vertices[leaf->first_vertex + k]];
        const mote_vec3 x = mote_scale(mote_sub(world, c->origin), tree->scale);
        const double off[3] = {x.x - (double)hull->x[0][i], x.y - (double)hull->x[1][i],
                               x.z - (double)hull->x[2][i]};
        for (int r = 0; r < 3; ++r) {
            assert_true(fabs(off[r]) <= (double)hull->width[r]);
            most = fmax(most, fabs(off[r]));
        }
    }
    return most;
}

/* No vertex of a leaf of body 0 reaches farther along a direction than its hull plus its
   width. */
static void check_reach(const scene *s, mote_certificate *c, const mote_cert_node *node,
                        size_t lane, const mote_cert_hull *hull, mote_vec3 direction)
{
    static uint32_t stamp = 0;
    const mote_cert_tree *tree = c->side[0].tree;
    const float d[3] = {(float)direction.x, (float)direction.y, (float)direction.z};
    const mote_vec3 rounded = {(double)d[0], (double)d[1], (double)d[2]};
    double reach = -HUGE_VAL;
    double wide = 0;
    for (uint32_t i = 0; i < hull->leaf->vertex_count; ++i) {
        const uint32_t v = tree->leaf_vertices[hull->leaf->first_vertex + i];
        const mote_vec3 x = mote_scale(mote_sub(s->world[0][v], c->origin), tree->scale);
        reach = fmax(reach, mote_dot(x, rounded));
    }
    for (int r = 0; r < 3; ++r)
        wide += (double)hull->width[r] * fabs((double)d[r]);
    const double bound =
        (double)mote_cert_leaf_reach(&c->side[0], node, lane, d, ++stamp) + wide;
    assert_true(bound >= reach);
    assert_true(bound - 2 * wide <= reach);
}

/* Checks all leaves below a node. off: the largest distances of vertices from their places in
   the hull, with the linear part of the field only and with the field evaluated. */
static void check_hulls(const scene *s, mote_certificate *c, mote_cert_node *node,
                        double off[2])
{
    mote_cert_make_boxes(c, 0, node);
    for (size_t l = 0; l < MOTE_CERT_WIDTH && node->block->mask >> l; ++l) {
        if (node->block->child[l] >= 0) {
            check_hulls(s, c, mote_cert_child(c, 0, node, l, 0), off);
            continue;
        }
        mote_cert_hull hull;
        mote_cert_leaf_hull(&c->side[0], node, l, &hull);
        off[0] = fmax(off[0], check_hull(s, c, &hull));
        check_reach(s, c, node, l, &hull, c->side[0].facing);
        check_reach(s, c, node, l, &hull, mote_vec3_make(0.3, -1.9, 0.01 * (double)l));
        const mote_cert_hull *near = mote_cert_leaf_near_hull(&c->side[0], node, l);
        if (near)
            off[1] = fmax(off[1], check_hull(s, c, near));
        double reach;
        const bool clear = mote_cert_leaf_clear(c, 0, node, l, &reach);
        const double exact = exact_reach(s, c, 0, node->block->child[l]);
        assert_true(reach >= exact - c->noise);
        assert_int_equal(clear, exact <= c->side[0].threshold + c->noise);
    }
}

TEST(hulls_of_leaves_are_where_their_vertices_are)
{
    for (int kind = 0; kind < 3; ++kind) {
        scene s;
        scene_init(&s, 30, 14, 1, kind == 1);
        if (kind == 2)
            use_modes(&s);
        mote_certificate *c = certificate_of(&s, NULL);
        for (int k = 0; k < 30; ++k) {
            /* from nearby to so far that a float keeps three digits of the size */
            const double reach = pow(10, k % 5);
            if (kind == 2)
                next_of_modes(&s, reach);
            else
                scene_next(&s, reach, false);
            c->origin = s.frame.body[0].pose.translation;
            c->noise = 1e-12;
            ++c->generation;
            mote_lazy_begin(&c->side[0].lazy, &s.frame.body[0], false);
            mote_cert_side_begin(&c->side[0], &s.frame.body[0], c->origin);
            const mote_mat3 r = random_rotation(&s);
            mote_cert_side_face(&c->side[0], mote_vec3_make(r.m[0][0], r.m[0][1], r.m[0][2]),
                                scene_random(&s, -0.2, 0.2));
            double off[2] = {0, 0};
            check_hulls(&s, c, mote_cert_root(c, 0), off);
            if (k % 5 == 0) /* evaluating the field pays off */
                assert_true(off[1] < 1e-6 && (kind != 1 || off[1] < 0.01 * off[0]));
        }
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}

/* Two triangles apart along x. Where squares leave the range of floats, nothing is ruled out.
 */
TEST(hulls_are_apart_along_a_direction_within_the_range_of_floats)
{
    static const struct {
        float apart, need;
        bool is_apart;
    } rows[] = {{3, 2, true}, {3, 4, false}, {1e18F, 2, true}, {1e20F, 2, false}};
    static const uint8_t corners[1][3] = {{0, 1, 2}};
    static const float along[3] = {1, 0, 0};
    /* the other way round, none, and one so short that its square loses bits */
    static const float others[3][3] = {{-1, 0, 0}, {0, 0, 0}, {1e-16F, 0, 0}};
    for (size_t k = 0; k < ROWS_OF(rows); ++k) {
        float x[2][3][MOTE_CERT_WIDTH] = {{{0}}};
        mote_cert_hulls pair = {.leaf = {{.groups = 1, .corners = corners, .faces = 1},
                                         {.groups = 1, .corners = corners, .faces = 1}}};
        for (int s = 0; s < 2; ++s) {
            for (size_t l = 0; l < MOTE_CERT_WIDTH; ++l) {
                x[s][0][l] = s ? rows[k].apart : 0;
                x[s][1][l] = l == 1;
                x[s][2][l] = l == 2;
            }
            for (int r = 0; r < 3; ++r)
                pair.leaf[s].x[r] = x[s][r];
        }
        test_row("%g apart, %g needed", (double)rows[k].apart, (double)rows[k].need);
        assert_int_equal(mote_cert_hulls_along(&pair, along, rows[k].need), rows[k].is_apart);
        for (size_t i = 0; i < ROWS_OF(others); ++i)
            assert_false(mote_cert_hulls_along(&pair, others[i], rows[k].need));
    }
}

/* A triangle in a cube of the given size about a centre. */
static void random_corners(scene *s, double size, double centre,
                           float corner[3][3][MOTE_CERT_FACE_LANES], uint32_t lane)
{
    for (int k = 0; k < 3; ++k) {
        for (int r = 0; r < 3; ++r)
            corner[k][r][lane] = (float)(scene_random(s, -size, size) + (r == 0 ? centre : 0));
    }
}

/* The distance of two triangles, and with the second one moved towards the first by `loose` in
   each coordinate. */
static void exact_distances(const mote_cert_face_lanes *s, const mote_cert_face_lanes *t,
                            uint32_t lane, const float loose[3], double *as_given,
                            double *moved)
{
    mote_vec3 a[3], b[3], p, q;
    for (int k = 0; k < 3; ++k) {
        a[k] = mote_vec3_make((double)s->corner[k][0][lane], (double)s->corner[k][1][lane],
                              (double)s->corner[k][2][lane]);
        b[k] = mote_vec3_make((double)t->corner[k][0][lane], (double)t->corner[k][1][lane],
                              (double)t->corner[k][2][lane]);
    }
    *as_given = sqrt(mote_triangle_triangle(a, b, &p, &q));
    const mote_vec3 towards = mote_vec3_make(copysign((double)loose[0], p.x - q.x),
                                             copysign((double)loose[1], p.y - q.y),
                                             copysign((double)loose[2], p.z - q.z));
    for (int k = 0; k < 3; ++k)
        b[k] = mote_add(b[k], towards);
    *moved = sqrt(mote_triangle_triangle(a, b, NULL, NULL));
}

TEST(near_pairs_has_every_pair_below_the_limit_and_few_others)
{
    scene s = {.random = 3};
    int below = 0, far = 0, kept = 0;
    for (int k = 0; k < 1500; ++k) {
        mote_cert_face_lanes first = {{{{0}}}}, second = {{{{0}}}};
        const uint32_t count = 1 + (uint32_t)k % MOTE_CERT_FACE_LANES;
        const double apart = scene_random(&s, 0, 0.6);
        for (uint32_t l = 0; l < count; ++l) {
            random_corners(&s, 0.2, 0, first.corner, l);
            random_corners(&s, 0.2, apart, second.corner, l);
        }
        const double need = scene_random(&s, 0.01, 0.3);
        const float slack = k % 2 ? 0.01F : 1e-6F; /* along each axis in turn, and along all */
        const int axis = k / 2 % 4;
        const float other = axis < 3 ? 0.1F * slack : slack;
        const float loose[3] = {axis == 0 ? slack : other, axis == 1 ? slack : other,
                                axis == 2 ? slack : other};
        const uint32_t near =
            mote_cert_near_pairs(&first, &second, (1u << count) - 1, (float)need, loose);
        assert_int_equal(near >> count, 0);
        for (uint32_t l = 0; l < count; ++l) {
            double distance, least;
            exact_distances(&first, &second, l, loose, &distance, &least);
            /* corners may be off by up to `other` in every direction */
            const bool must = fmin(distance - (double)other, least) < need;
            below += must;
            if (must)
                assert_true(near >> l & 1);
            if (distance > 1.1 * need + 2 * (double)slack) {
                ++far;
                kept += (near >> l & 1) != 0;
            }
        }
    }
    assert_in_range(below, 2000, 12000);
    assert_in_range(far, 800, 12000);
    assert_true(kept < far / 4);
}
