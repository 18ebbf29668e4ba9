/* Certified mode against all pairs of triangles. */
#include <stddef.h>

#include "tests/support/certificate_scene.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

TEST(query_deforming_tori_equals_all_pairs)
{
    for (int deforming = 0; deforming < 2; ++deforming) {
        scene s;
        scene_init(&s, 22, 11, 2.5, deforming);
        mote_certificate *c = certificate_of(&s, NULL);
        int contacts = 0;
        for (int k = 0; k < 30; ++k) {
            scene_next(&s, k % 3 ? 1.3 : 0.6, false);
            const double truth = scene_truth(&s);
            contacts += !(truth > 0);
            check_exact(&s, c, truth);
        }
        assert_in_range(contacts, 2, 28);
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}

TEST(query_linear_modes_equals_all_pairs)
{
    scene s;
    scene_init(&s, 18, 10, 0.7, false);
    use_modes(&s);
    mote_certificate *c = certificate_of(&s, NULL);
    for (int k = 0; k < 40; ++k) {
        next_of_modes(&s, 1.2);
        check_exact(&s, c, scene_truth(&s));
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

TEST(query_without_a_step_equals_all_pairs)
{
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
        const double truth = scene_truth(&s);
        for (int i = 0; i < 9; ++i)
            check_exact(&s, c[i], truth);
    }
    for (int i = 0; i < 9; ++i)
        mote_certificate_destroy(c[i]);
    scene_free(&s);
}

/* Trees that two threads build give the same answers to the last bit, as many bytes and counts
   included. */
TEST(create_by_two_threads_gives_the_same_bits)
{
    scene s;
    scene_init(&s, 24, 10, 3, true);
    mote_certificate_options options = mote_default_certificate_options(s.length);
    mote_certificate *one = certificate_of(&s, &options);
    options.threads = 2;
    mote_certificate *two = certificate_of(&s, &options);
    assert_int_equal(mote_certificate_bytes(one), mote_certificate_bytes(two));
    for (int k = 0; k < 40; ++k) {
        mote_certificate_answer a, b;
        scene_next(&s, 1.2, false);
        mote_certificate_query(one, &s.frame, NULL, -1, &a);
        mote_certificate_query(two, &s.frame, NULL, -1, &b);
        assert_memory_equal(&a.distance, &b.distance, sizeof a.distance);
        assert_memory_equal(&a.lower, &b.lower, sizeof a.lower);
        assert_memory_equal(a.witness, b.witness, sizeof a.witness);
        assert_memory_equal(&a.counters, &b.counters, sizeof a.counters);
    }
    mote_certificate_destroy(one);
    mote_certificate_destroy(two);
    scene_free(&s);
}

/* What one of the two threads finds wrong is said by the caller's. */
TEST(create_by_two_threads_says_what_is_wrong)
{
    scene s;
    scene_init(&s, 8, 6, 4, true);
    mote_certificate_options options = mote_default_certificate_options(s.length);
    options.threads = 2;
    mote_field *given = NULL;
    assert_int_equal(mote_field_create_given(&given), MOTE_OK);
    for (int b = 0; b < 2; ++b) {
        const mote_body bad = {.mesh = s.body[b].mesh, .field = given};
        const mote_body *const bodies[2] = {b == 0 ? &bad : &s.body[0],
                                            b == 1 ? &bad : &s.body[1]};
        mote_certificate *c = NULL;
        assert_int_equal(mote_certificate_create(bodies, &options, &c), MOTE_EUNSUPPORTED);
        assert_null(c);
        assert_non_null(strstr(mote_error_text(), "the certified query needs a field"));
    }
    mote_field_destroy(given);
    scene_free(&s);
}

/* A mesh of separate triangles in a plane row: no two share a vertex, so no leaf can be as
   large as the tree prefers. */
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

/* Replaces body 0 of a scene. */
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

TEST(query_separate_triangles_equals_all_pairs)
{
    for (uint32_t count = 1; count < 40; count = 2 * count + 1) {
        scene s;
        scene_init(&s, 12, 8, 1, true);
        use_mesh(&s, make_shards(count));
        mote_certificate *c = certificate_of(&s, NULL);
        for (int k = 0; k < 15; ++k) {
            scene_next(&s, 1, false);
            check_exact(&s, c, scene_truth(&s));
        }
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}

static mote_mesh *make_cube(void)
{
    static const uint32_t faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                          {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                          {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    double corners[24];
    for (int i = 0; i < 24; ++i)
        corners[i] = i / 3 >> i % 3 & 1;
    mote_mesh *mesh = NULL;
    need(mote_mesh_create(corners, 8, faces[0], 12, &mesh) == MOTE_OK);
    return mesh;
}

/* Corners, edges and faces that touch exactly: hulls for which the search for a direction finds
   none. Queried cold, and warm after another place. */
TEST(query_cubes_of_whole_numbers_equals_the_closed_form)
{
    mote_mesh *mesh = make_cube();
    mote_field *field = NULL;
    need(mote_field_create_static(&field) == MOTE_OK);
    const mote_body body = {.mesh = mesh, .field = field};
    const mote_body *const bodies[2] = {&body, &body};
    const mote_certificate_options options = mote_default_certificate_options(mesh->diagonal);
    mote_certificate *c[2] = {NULL, NULL};
    assert_int_equal(mote_certificate_create(bodies, &options, &c[1]), MOTE_OK);
    mote_frame frame = {0};
    for (int b = 0; b < 2; ++b) {
        for (int r = 0; r < 3; ++r)
            frame.body[b].pose.rotation.m[r][r] = 1;
        frame.body[b].pose_changed = frame.body[b].shape_changed = true;
    }
    for (int place = 0; place < 343; ++place) {
        const mote_vec3 t = {place % 7 * 0.5 - 1.5, place / 7 % 7 * 0.5 - 1.5,
                             place / 49 * 0.5 - 1.5};
        const mote_vec3 gap = {fmax(0, fabs(t.x) - 1), fmax(0, fabs(t.y) - 1),
                               fmax(0, fabs(t.z) - 1)};
        ++frame.number;
        frame.body[1].pose.translation = t;
        assert_int_equal(mote_certificate_create(bodies, &options, &c[0]), MOTE_OK);
        for (int i = 0; i < 2; ++i) {
            mote_certificate_answer a;
            mote_certificate_query(c[i], &frame, NULL, -1, &a);
            assert_true(fabs(a.distance - mote_length(gap)) <= 1e-15);
            assert_true(a.lower <= mote_length(gap) && a.lower >= mote_length(gap) - 1e-12);
        }
        mote_certificate_destroy(c[0]);
    }
    mote_certificate_destroy(c[1]);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

TEST(query_after_another_history_gives_the_same_distance)
{
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
        if (k % 7 == 0) /* has seen an earlier frame only */
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

TEST(query_contact_agrees_with_the_distance)
{
    scene s;
    scene_init(&s, 18, 9, 1, true);
    mote_certificate *c = certificate_of(&s, NULL);
    int found[2] = {0, 0};
    for (int k = 0; k < 30; ++k) {
        scene_next(&s, 1.2, false);
        const double truth = scene_truth(&s);
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

TEST(query_scaled_by_powers_of_two_gives_the_same_bits)
{
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
