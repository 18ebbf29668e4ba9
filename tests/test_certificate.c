/* Certified mode against all pairs of triangles, and its boxes against the vertices inside. */
#include "core/certificate.h"

#include "core/certificate_state.h"
#include "harness/heap_count.h"
#include "tests/shapes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

static mote_certificate *certificate_of(const scene *s, const mote_certificate_options *options)
{
    const mote_body *const bodies[2] = {&s->body[0], &s->body[1]};
    const mote_certificate_options plain = mote_default_certificate_options(s->length);
    mote_certificate *c = NULL;
    assert_int_equal(mote_certificate_create(bodies, options ? options : &plain, &c), MOTE_OK);
    return c;
}

/* The answer's promises that need no truth. */
static void check_bracket(const scene *s, const mote_certificate_answer *a, double truth)
{
    assert_true(a->lower >= 0);
    assert_true(a->lower <= truth);
    assert_true(a->distance >= truth - 1e-15 * s->length);
    const double apart = sqrt(mote_distance_squared(a->witness[0], a->witness[1]));
    assert_true(fabs(apart - a->distance) <= 1e-14 * s->length);
    for (int b = 0; b < 2; ++b)
        assert_true(scene_point_distance(s, b, a->witness[b]) <= 1e-14 * s->length);
}

static void check_exact(const scene *s, mote_certificate *c, double truth)
{
    mote_certificate_answer a;
    mote_certificate_query(c, &s->frame, NULL, -1, &a);
    check_bracket(s, &a, truth);
    assert_true(a.distance <= truth + 1e-12 * s->length);
    assert_true(a.lower >= truth - 1e-12 * s->length);
    assert_true(truth > 0 || a.distance <= 0);
}

/* Replaces both fields by linear modes: a bend and a bulge. */
static void use_modes(scene *s)
{
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = s->mesh[b];
        mote_vec3 *modes = malloc(2 * mesh->vertex_count * sizeof *modes);
        need(modes);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            const mote_vec3 x = mote_scale(mesh->positions[v], 1 / s->length);
            modes[v] = mote_vec3_make(0, 40 * sin(9 * x.x), 25 * x.x * x.x);
            modes[mesh->vertex_count + v] = mote_scale(x, 1e3 * x.z);
        }
        mote_deform_destroy(s->deform[b]);
        mote_field_destroy(s->field[b]);
        need(mote_field_create_modes(modes, 2, mesh->vertex_count, &s->field[b]) == MOTE_OK);
        free(modes);
        s->body[b].field = s->field[b];
        need(mote_deform_create(&s->body[b], &s->deform[b]) == MOTE_OK);
    }
}

/* The next frame of linear modes: weights (s,0,0), (0,s,0), (0,0,s) for each mode. */
static void next_of_modes(scene *s, double reach)
{
    scene_next(s, reach, true);
    for (int b = 0; b < 2; ++b) {
        memset(s->weights[b], 0, sizeof s->weights[b]);
        for (int m = 0; m < 2; ++m) {
            const double amount = scene_random(s, -0.002, 0.002) * s->length;
            for (int k = 0; k < 3; ++k)
                s->weights[b][k][3 * m + k] = amount;
        }
        mote_deform_all(s->deform[b], &s->frame.body[b], s->world[b]);
    }
}

static void query_deforming_tori_equals_all_pairs(void **state)
{
    (void)state;
    for (int deforming = 0; deforming < 2; ++deforming) {
        scene s;
        scene_init(&s, 22, 11, 2.5, deforming);
        mote_certificate *c = certificate_of(&s, NULL);
        int contacts = 0;
        for (int k = 0; k < 30; ++k) {
            scene_next(&s, k % 3 ? 1.3 : 0.6, false);
            const double truth = scene_distance(&s);
            contacts += !(truth > 0);
            check_exact(&s, c, truth);
        }
        assert_in_range(contacts, 2, 28);
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}

static void query_linear_modes_equals_all_pairs(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, 18, 10, 0.7, false);
    use_modes(&s);
    mote_certificate *c = certificate_of(&s, NULL);
    for (int k = 0; k < 40; ++k) {
        next_of_modes(&s, 1.2);
        check_exact(&s, c, scene_distance(&s));
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

static void query_without_a_step_equals_all_pairs(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, 16, 9, 1, true);
    mote_certificate_options options[9];
    for (int i = 0; i < 9; ++i)
        options[i] = mote_default_certificate_options(s.length);
    options[0].seed = MOTE_CERT_SEED_NONE;
    options[1].seed = MOTE_CERT_SEED_PAIR;
    options[2].width = 2;
    options[3].width = 4;
    options[4].linear_fits = false;
    options[5].plane = false;
    options[6].directions = false;
    options[7].restarts = 0;
    options[8].restarts = 1;
    mote_certificate *c[9];
    for (int i = 0; i < 9; ++i)
        c[i] = certificate_of(&s, &options[i]);
    for (int k = 0; k < 20; ++k) {
        scene_next(&s, 1.2, false);
        const double truth = scene_distance(&s);
        for (int i = 0; i < 9; ++i)
            check_exact(&s, c[i], truth);
    }
    for (int i = 0; i < 9; ++i)
        mote_certificate_destroy(c[i]);
    scene_free(&s);
}

/* A mesh of separate triangles in one plane row: no two share a vertex, so that no leaf can be
   as large as the tree would like. */
static mote_mesh *make_shards(uint32_t count)
{
    double *xyz = malloc(9 * count * sizeof *xyz);
    uint32_t *faces = malloc(3 * count * sizeof *faces);
    need(xyz && faces);
    for (uint32_t t = 0; t < count; ++t) {
        for (uint32_t k = 0; k < 3; ++k) {
            double *p = xyz + 9 * t + 3 * k;
            p[0] = 0.1 * t + (k == 1 ? 0.07 : 0);
            p[1] = k == 2 ? 0.09 : 0;
            p[2] = sin(1.0 * t);
            faces[3 * t + k] = 3 * t + k;
        }
    }
    mote_mesh *mesh = NULL;
    need(mote_mesh_create(xyz, 3 * count, faces, count, &mesh) == MOTE_OK);
    free(xyz);
    free(faces);
    return mesh;
}

/* A scene whose body 0 is replaced. */
static void use_mesh(scene *s, mote_mesh *mesh)
{
    mote_deform_destroy(s->deform[0]);
    mote_mesh_destroy(s->mesh[0]);
    free(s->world[0]);
    s->mesh[0] = mesh;
    s->body[0].mesh = mesh;
    need(mote_deform_create(&s->body[0], &s->deform[0]) == MOTE_OK);
    s->world[0] = malloc(mesh->vertex_count * sizeof *s->world[0]);
    need(s->world[0]);
}

static void query_separate_triangles_equals_all_pairs(void **state)
{
    (void)state;
    for (uint32_t count = 1; count < 40; count = 2 * count + 1) {
        scene s;
        scene_init(&s, 12, 8, 1, true);
        use_mesh(&s, make_shards(count));
        mote_certificate *c = certificate_of(&s, NULL);
        for (int k = 0; k < 15; ++k) {
            scene_next(&s, 1, false);
            check_exact(&s, c, scene_distance(&s));
        }
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}

static void query_after_another_history_gives_the_same_distance(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, 20, 10, 1, true);
    mote_certificate_options none = mote_default_certificate_options(s.length);
    none.seed = MOTE_CERT_SEED_NONE;
    mote_certificate *warm = certificate_of(&s, NULL);
    mote_certificate *other = certificate_of(&s, NULL);
    mote_certificate *cold = certificate_of(&s, &none);
    for (int k = 0; k < 200; ++k) {
        scene_next(&s, 1.3, false);
        mote_certificate_answer a[3];
        mote_certificate_query(warm, &s.frame, NULL, -1, &a[0]);
        if (k % 7 == 0) /* knows an earlier frame only */
            mote_certificate_query(other, &s.frame, NULL, -1, &a[1]);
        mote_certificate_query(cold, &s.frame, NULL, -1, &a[2]);
        /* faces that share the nearest point differ in the last bits of its coordinates */
        assert_true(fabs(a[0].distance - a[2].distance) <= 1e-15 * s.length);
        assert_true(k % 7 || fabs(a[0].distance - a[1].distance) <= 1e-15 * s.length);
        assert_int_equal(a[0].distance > 0, a[2].distance > 0);
    }
    mote_certificate_destroy(warm);
    mote_certificate_destroy(other);
    mote_certificate_destroy(cold);
    scene_free(&s);
}

/* After a leap the search does not start from where the last faces are now. */
static void query_after_a_leap_costs_about_as_much_as_a_cold_one(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, 60, 30, 1, true);
    mote_certificate_options none = mote_default_certificate_options(s.length);
    none.seed = MOTE_CERT_SEED_NONE;
    mote_certificate *warm = certificate_of(&s, NULL);
    mote_certificate *cold = certificate_of(&s, &none);
    uint64_t positions[2] = {0, 0};
    for (int k = 0; k < 200; ++k) {
        scene_next(&s, 1.3, false);
        mote_certificate_answer a[2];
        mote_certificate_query(warm, &s.frame, NULL, -1, &a[0]);
        mote_certificate_query(cold, &s.frame, NULL, -1, &a[1]);
        assert_true(fabs(a[0].distance - a[1].distance) <= 1e-15 * s.length);
        for (int i = 0; i < 2; ++i)
            positions[i] += a[i].counters.positions;
    }
    assert_true((double)positions[0] < 2 * (double)positions[1]);
    mote_certificate_destroy(warm);
    mote_certificate_destroy(cold);
    scene_free(&s);
}

static void query_with_slack_returns_a_bracket(void **state)
{
    (void)state;
    const double slacks[3] = {1e-6, 1e-3, 0.2};
    scene s;
    scene_init(&s, 18, 9, 1, true);
    mote_certificate *c[3];
    for (int i = 0; i < 3; ++i) {
        mote_certificate_options options = mote_default_certificate_options(s.length);
        options.slack = slacks[i];
        c[i] = certificate_of(&s, &options);
    }
    for (int k = 0; k < 30; ++k) {
        scene_next(&s, 1.4, false);
        const double truth = scene_distance(&s);
        for (int i = 0; i < 3; ++i) {
            mote_certificate_answer a;
            mote_certificate_query(c[i], &s.frame, NULL, -1, &a);
            check_bracket(&s, &a, truth);
            assert_true(a.distance - a.lower <= (slacks[i] + 1e-12) * s.length);
        }
    }
    for (int i = 0; i < 3; ++i)
        mote_certificate_destroy(c[i]);
    scene_free(&s);
}

static void query_with_budget_returns_an_honest_bracket(void **state)
{
    (void)state;
    const uint64_t budgets[5] = {0, 8, 60, 400, 3000};
    scene s;
    scene_init(&s, 24, 12, 1, true);
    for (int i = 0; i < 5; ++i) {
        mote_certificate_options options = mote_default_certificate_options(s.length);
        options.seed = MOTE_CERT_SEED_NONE;
        options.budget = budgets[i];
        options.plane = i % 2;
        mote_certificate *c = certificate_of(&s, &options);
        int stopped = 0;
        for (int k = 0; k < 15; ++k) {
            scene_next(&s, 1.1, false);
            const double truth = scene_distance(&s);
            mote_certificate_answer a;
            mote_certificate_query(c, &s.frame, NULL, -1, &a);
            check_bracket(&s, &a, truth);
            stopped += a.stopped;
            assert_true(a.stopped || a.distance <= truth + 1e-12 * s.length);
        }
        if (budgets[i] <= 8)
            assert_true(stopped > 0);
        mote_certificate_destroy(c);
    }
    scene_free(&s);
}

static void query_contact_agrees_with_the_distance(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, 18, 9, 1, true);
    mote_certificate *c = certificate_of(&s, NULL);
    int found[2] = {0, 0};
    for (int k = 0; k < 30; ++k) {
        scene_next(&s, 1.2, false);
        const double truth = scene_distance(&s);
        const double tolerances[4] = {0, 0.05 * s.length, 0.5 * truth, 2 * truth};
        for (int i = 0; i < 4; ++i) {
            mote_certificate_answer a;
            mote_certificate_query(c, &s.frame, NULL, tolerances[i], &a);
            check_bracket(&s, &a, truth);
            const bool contact = truth <= tolerances[i];
            assert_int_equal(a.distance <= tolerances[i], contact);
            assert_true(contact || a.lower >= tolerances[i] - 1e-13 * s.length);
            ++found[contact];
        }
    }
    assert_in_range(found[0], 20, 115);
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* The frame of a scene with all lengths multiplied by 2^power. */
static void scale_frame(const scene *s, scene *scaled, int power)
{
    scaled->frame = s->frame;
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &scaled->frame.body[b];
        state->pose.translation = mote_scale(state->pose.translation, ldexp(1, power));
        for (int k = 0; k < 3; ++k) {
            for (uint32_t j = 0; j < s->field[b]->count; ++j)
                scaled->weights[b][k][j] = ldexp(s->weights[b][k][j], power);
        }
        state->weights.x = scaled->weights[b][0];
        state->weights.y = scaled->weights[b][1];
        state->weights.z = scaled->weights[b][2];
        state->vertices = NULL;
    }
}

static void query_scaled_by_powers_of_two_gives_the_same_bits(void **state)
{
    (void)state;
    const int powers[4] = {-40, -3, 1, 40};
    scene s;
    scene_init(&s, 20, 10, 1, true);
    mote_certificate *c = certificate_of(&s, NULL);
    scene scaled[4];
    mote_certificate *other[4];
    for (int i = 0; i < 4; ++i) {
        scene_init(&scaled[i], 20, 10, ldexp(1, powers[i]), true);
        other[i] = certificate_of(&scaled[i], NULL);
    }
    for (int k = 0; k < 50; ++k) {
        scene_next(&s, 1.2, false);
        mote_certificate_answer a, b;
        mote_certificate_query(c, &s.frame, NULL, -1, &a);
        for (int i = 0; i < 4; ++i) {
            scale_frame(&s, &scaled[i], powers[i]);
            mote_certificate_query(other[i], &scaled[i].frame, NULL, -1, &b);
            const double back = ldexp(1, -powers[i]);
            const double bits[4][2] = {{b.distance * back, a.distance},
                                       {b.lower * back, a.lower},
                                       {b.witness[0].x * back, a.witness[0].x},
                                       {b.witness[1].z * back, a.witness[1].z}};
            for (int n = 0; n < 4; ++n)
                assert_memory_equal(&bits[n][0], &bits[n][1], sizeof(double));
            assert_memory_equal(&a.counters, &b.counters, sizeof a.counters);
        }
    }
    for (int i = 0; i < 4; ++i) {
        mote_certificate_destroy(other[i]);
        scene_free(&scaled[i]);
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

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

static void deformed_boxes_enclose_their_vertices(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, 30, 14, 1, true);
    mote_certificate *c = certificate_of(&s, NULL);
    for (int k = 0; k < 40; ++k) {
        /* from nearby to so far that a float holds three digits of the size */
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
            if (k % 5 == 0) /* and they are not much larger */
                assert_true(excess / boxes < 0.1 * s.length * c->scale);
        }
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* Every vertex of a leaf is where its hull says, within the hull's width. */
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

/* Over all leaves below a node; the largest distances of vertices from their places by the
   linear part of the field, and with the field evaluated. */
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

static void hulls_of_leaves_are_where_their_vertices_are(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; ++kind) {
        scene s;
        scene_init(&s, 30, 14, 1, kind == 1);
        if (kind == 2)
            use_modes(&s);
        mote_certificate *c = certificate_of(&s, NULL);
        for (int k = 0; k < 30; ++k) {
            /* from nearby to so far that a float holds three digits of the size */
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
            if (k % 5 == 0) /* the field is worth its evaluation */
                assert_true(off[1] < 1e-6 && (kind != 1 || off[1] < 0.01 * off[0]));
        }
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}

/* A triangle in a cube of the given size about a centre. */
static void random_corners(scene *s, double size, double centre, float corner[3][3][8],
                           uint32_t lane)
{
    for (int k = 0; k < 3; ++k) {
        for (int r = 0; r < 3; ++r)
            corner[k][r][lane] = (float)(scene_random(s, -size, size) + (r == 0 ? centre : 0));
    }
}

static double exact_distance(const mote_cert_face_pairs *pairs, uint32_t lane)
{
    mote_vec3 a[3], b[3];
    for (int k = 0; k < 3; ++k) {
        a[k] = mote_vec3_make((double)pairs->s[k][0][lane], (double)pairs->s[k][1][lane],
                              (double)pairs->s[k][2][lane]);
        b[k] = mote_vec3_make((double)pairs->t[k][0][lane], (double)pairs->t[k][1][lane],
                              (double)pairs->t[k][2][lane]);
    }
    return sqrt(mote_triangle_triangle(a, b, NULL, NULL));
}

static void near_pairs_has_every_pair_below_the_limit_and_few_others(void **state)
{
    (void)state;
    scene s = {.random = 3};
    int below = 0, far = 0, kept = 0;
    for (int k = 0; k < 1500; ++k) {
        mote_cert_face_pairs pairs = {.count = 1 + (uint32_t)k % 8};
        const double apart = scene_random(&s, 0, 0.6);
        for (uint32_t l = 0; l < pairs.count; ++l) {
            random_corners(&s, 0.2, 0, pairs.s, l);
            random_corners(&s, 0.2, apart, pairs.t, l);
        }
        const double need = scene_random(&s, 0.01, 0.3);
        const double slack = k % 2 ? 0.01 : 1e-6;
        const float loose[3] = {(float)slack, (float)slack, (float)slack};
        const uint32_t near = mote_cert_near_pairs(&pairs, (float)need, loose);
        assert_int_equal(near >> pairs.count, 0);
        for (uint32_t l = 0; l < pairs.count; ++l) {
            const double distance = exact_distance(&pairs, l);
            /* corners may be off by as much as `loose`, in the worst direction */
            const bool must = distance - slack < need;
            below += must;
            if (must)
                assert_true(near >> l & 1);
            if (distance > 1.1 * need + 2 * slack) {
                ++far;
                kept += (near >> l & 1) != 0;
            }
        }
    }
    assert_in_range(below, 1000, 6500);
    assert_in_range(far, 400, 6500);
    assert_true(kept < far / 4);
}

static void query_when_its_rooms_are_full_gives_the_same(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, 40, 16, 1, true);
    mote_certificate *roomy = certificate_of(&s, NULL);
    mote_certificate *tight = certificate_of(&s, NULL);
    for (int b = 0; b < 2; ++b) {
        tight->side[b].node_room = 1;
        tight->side[b].lazy.limit = 0;
    }
    for (int k = 0; k < 40; ++k) {
        scene_next(&s, 1.1, false);
        mote_certificate_answer a, b;
        mote_certificate_query(roomy, &s.frame, NULL, -1, &a);
        mote_certificate_query(tight, &s.frame, NULL, -1, &b);
        assert_true(fabs(a.distance - b.distance) <= 1e-15 * s.length);
        assert_true(b.counters.blocks >= a.counters.blocks);
    }
    mote_certificate_destroy(roomy);
    mote_certificate_destroy(tight);
    scene_free(&s);
}

static void query_from_frame_fifty_on_does_not_allocate(void **state)
{
    (void)state;
    if (!mote_heap_read().counted)
        skip();
    scene s;
    scene_init(&s, 60, 30, 1, true);
    mote_certificate *c = certificate_of(&s, NULL);
    uint64_t before = 0;
    for (int k = 0; k < 400; ++k) {
        scene_next(&s, 1.3, false);
        if (k == 50)
            before = mote_heap_read().allocations;
        mote_certificate_answer a;
        mote_certificate_query(c, &s.frame, NULL, -1, &a);
    }
    assert_int_equal(mote_heap_read().allocations, before);
    mote_certificate_destroy(c);
    scene_free(&s);
}

static void bytes_of_a_large_pair_stay_below_180_a_vertex(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, 120, 50, 1, true);
    const int64_t before = mote_heap_read().live_bytes;
    mote_certificate *c = certificate_of(&s, NULL);
    const double vertices = s.mesh[0]->vertex_count + s.mesh[1]->vertex_count;
    const double bytes = (double)mote_certificate_bytes(c);
    assert_true(bytes < 180 * vertices);
    assert_true(bytes > 40 * vertices);
    if (mote_heap_read().counted) {
        const double live = (double)(mote_heap_read().live_bytes - before);
        assert_true(fabs(live - bytes) < 0.02 * bytes);
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(query_deforming_tori_equals_all_pairs),
        cmocka_unit_test(query_linear_modes_equals_all_pairs),
        cmocka_unit_test(query_without_a_step_equals_all_pairs),
        cmocka_unit_test(query_separate_triangles_equals_all_pairs),
        cmocka_unit_test(query_after_another_history_gives_the_same_distance),
        cmocka_unit_test(query_after_a_leap_costs_about_as_much_as_a_cold_one),
        cmocka_unit_test(query_with_slack_returns_a_bracket),
        cmocka_unit_test(query_with_budget_returns_an_honest_bracket),
        cmocka_unit_test(query_contact_agrees_with_the_distance),
        cmocka_unit_test(query_scaled_by_powers_of_two_gives_the_same_bits),
        cmocka_unit_test(deformed_boxes_enclose_their_vertices),
        cmocka_unit_test(hulls_of_leaves_are_where_their_vertices_are),
        cmocka_unit_test(near_pairs_has_every_pair_below_the_limit_and_few_others),
        cmocka_unit_test(query_when_its_rooms_are_full_gives_the_same),
        cmocka_unit_test(query_from_frame_fifty_on_does_not_allocate),
        cmocka_unit_test(bytes_of_a_large_pair_stay_below_180_a_vertex),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
