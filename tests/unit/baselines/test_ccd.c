/* Convex parts with libccd against brute force, and our GJK. */
#include "baselines/gjk.h"
#include "datasets/letter.h"
#include "tests/support/shapes.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

/* An ellipsoid with half axes size * (1, 0.7, 0.5), of 2 * slices * (rings - 1) triangles. */
static mote_mesh *make_ellipsoid(uint32_t slices, uint32_t rings, double size)
{
    uint32_t vertices = slices * (rings - 1) + 2, n = 0;
    double *xyz = malloc(3 * vertices * sizeof *xyz);
    uint32_t(*faces)[3] = malloc(2 * slices * rings * sizeof *faces);
    assert_true(xyz && faces);
    for (uint32_t v = 0; v < vertices; ++v) {
        uint32_t ring = v == 0 ? 0 : (v - 1) / slices + 1, slice = v ? (v - 1) % slices : 0;
        double t = 3.141592653589793 * ring / rings, u = 6.283185307179586 * slice / slices;
        xyz[3 * v] = size * sin(t) * cos(u);
        xyz[3 * v + 1] = 0.7 * size * sin(t) * sin(u);
        xyz[3 * v + 2] = 0.5 * size * cos(t);
    }
    for (uint32_t ring = 0; ring < rings; ++ring) {
        for (uint32_t i = 0; i < slices; ++i) {
            uint32_t j = (i + 1) % slices, up = 1 + (ring - 1) * slices, down = up + slices;
            uint32_t a = ring ? up + i : 0, b = ring ? up + j : 0;
            uint32_t c = ring + 1 < rings ? (ring ? down : 1) + i : vertices - 1;
            uint32_t d = ring + 1 < rings ? (ring ? down : 1) + j : vertices - 1;
            if (c != d)
                memcpy(faces[n++], (uint32_t[3]){a, c, d}, sizeof *faces);
            if (a != b)
                memcpy(faces[n++], (uint32_t[3]){a, d, b}, sizeof *faces);
        }
    }
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(xyz, vertices, &faces[0][0], n, &mesh), MOTE_OK);
    assert_int_equal(mote_mesh_euler(mesh), 2);
    free(xyz);
    free(faces);
    return mesh;
}

static void *create(const char *options, const scene *s, mote_ask ask, double tolerance)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = method_with("ccd-convex", options, values);
    mote_setup setup = scene_setup(s, ask, tolerance, values);
    void *state = NULL;
    assert_int_equal(m->create(&setup, &state), MOTE_OK);
    return state;
}

static mote_answer answer(void *state, const mote_frame *frame)
{
    return method_answer(mote_method_find("ccd-convex"), state, frame);
}

static void destroy(void *state)
{
    mote_method_find("ccd-convex")->destroy(state);
}

TEST(query_on_convex_bodies_equals_brute_force)
{
    static const char *options[] = {"", "support=scan"};
    for (int e = -40; e <= 40; e += 40) {
        scene s;
        scene_init_meshes(&s, make_ellipsoid(14, 9, ldexp(1, e)),
                          make_ellipsoid(12, 7, ldexp(0.8, e)), false);
        void *state[2];
        for (int i = 0; i < 2; ++i)
            state[i] = create(options[i], &s, MOTE_ASK_DISTANCE, 0);
        int contacts = 0;
        for (int f = 0; f < 80; ++f) {
            const mote_frame *frame = scene_next(&s, 1.2, false);
            double expected = scene_truth(&s);
            bool inside =
                expected > 0 && mote_length(frame->body[1].pose.translation) < 0.55 * s.length;
            contacts += expected == 0;
            for (int i = 0; i < 2; ++i) {
                mote_answer a = answer(state[i], frame);
                assert_true(a.has_distance && a.has_contact);
                /* A hull is solid: a body inside the other is a contact, too. */
                if (!inside || a.distance > 0)
                    assert_true(fabs(a.distance - expected) <= 1e-12 * s.length);
                assert_int_equal(a.has_witness, a.distance > 0);
                for (int b = 0; b < 2 && a.has_witness; ++b)
                    assert_true(scene_point_distance(&s, b, a.witness[b]) <= 1e-12 * s.length);
            }
        }
        assert_in_range(contacts, 10, 70);
        for (int i = 0; i < 2; ++i)
            destroy(state[i]);
        scene_free(&s);
    }
}

TEST(query_on_letters_is_near_and_misses_no_contact)
{
    mote_mesh *letter[2] = {NULL, NULL};
    assert_int_equal(mote_letter_create('T', 400, &letter[0]), MOTE_OK);
    assert_int_equal(mote_letter_create('V', 400, &letter[1]), MOTE_OK);
    scene s;
    scene_init_meshes(&s, letter[0], letter[1], true);
    void *distance = create("support=scan", &s, MOTE_ASK_DISTANCE, 0);
    void *contact = create("", &s, MOTE_ASK_CONTACT, 0);
    void *near = create("", &s, MOTE_ASK_CONTACT, 0.05 * s.length);
    double error = 0;
    int contacts = 0, frames = 40;
    for (int f = 0; f < frames; ++f) {
        const mote_frame *frame = scene_next(&s, 1.2, false);
        double expected = scene_truth(&s);
        mote_answer a = answer(distance, frame);
        /* The hulls of the parts cover the surfaces. */
        assert_true(a.distance <= expected + 1e-12 * s.length);
        error += (expected - a.distance) / s.length;
        contacts += expected == 0;
        if (expected == 0) {
            assert_true(answer(contact, frame).contact);
            assert_true(answer(near, frame).contact);
        }
        if (expected > 0.2 * s.length)
            assert_false(answer(near, frame).contact);
    }
    assert_true(contacts > 5 && contacts < frames - 5);
    assert_true(error / frames < 0.03);
    destroy(distance);
    destroy(contact);
    destroy(near);
    scene_free(&s);
}

/* The least overlap of the two vertex sets over many directions, an upper bound of the
   penetration. */
static double least_overlap(scene *s)
{
    double least = HUGE_VAL;
    for (int k = 0; k < 20000; ++k) {
        mote_vec3 n = mote_vec3_make(scene_random(s, -1, 1), scene_random(s, -1, 1),
                                     scene_random(s, -1, 1));
        double high = -HUGE_VAL, low = HUGE_VAL;
        for (uint32_t v = 0; v < s->mesh[0]->vertex_count; ++v)
            high = fmax(high, mote_dot(n, s->world[0][v]));
        for (uint32_t v = 0; v < s->mesh[1]->vertex_count; ++v)
            low = fmin(low, mote_dot(n, s->world[1][v]));
        least = fmin(least, (high - low) / mote_length(n));
    }
    return least;
}

TEST(query_measures_penetration_of_overlapping_bodies)
{
    scene s;
    scene_init_meshes(&s, make_ellipsoid(14, 9, 1), make_ellipsoid(12, 7, 1), false);
    void *state = create("penetration=yes", &s, MOTE_ASK_DISTANCE, 0);
    int found = 0;
    for (int f = 0; f < 30; ++f) {
        mote_answer a = answer(state, scene_next(&s, 0.8, false));
        if (a.distance > 0) {
            assert_false(a.has_penetration);
            continue;
        }
        double expected = least_overlap(&s);
        assert_true(a.has_penetration);
        assert_true(a.penetration <= expected + 1e-3);
        assert_true(a.penetration >= expected - 0.004);
        found++;
    }
    assert_in_range(found, 5, 29);
    destroy(state);
    scene_free(&s);
}

TEST(create_and_update_refuse_bad_input)
{
    scene s;
    scene_init(&s, 8, 5, 1, true);
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = method_with("ccd-convex", "", values);
    mote_setup setup = scene_setup(&s, MOTE_ASK_DISTANCE, 0, values);
    mote_mesh empty = *s.mesh[0];
    empty.triangle_count = 0;
    mote_body body = {.mesh = &empty, .field = s.field[0]};
    setup.body[0] = &body;
    void *state = NULL;
    assert_int_equal(m->create(&setup, &state), MOTE_EINVAL);
    assert_null(state);
    state = create("", &s, MOTE_ASK_DISTANCE, 0);
    mote_frame frame = *scene_next(&s, 1, false);
    s.world[1][3].y = (double)NAN;
    assert_int_equal(m->update(state, &frame), MOTE_EINVAL);
    frame.body[1].vertices = NULL;
    assert_int_equal(m->update(state, &frame), MOTE_EINVAL);
    destroy(state);
    scene_free(&s);
}

/* Support points of two segments with given ends. */
static mote_gjk_point segment_support(void *context, mote_vec3 direction)
{
    const mote_vec3(*ends)[2] = context;
    bool a = mote_dot(direction, mote_sub(ends[0][1], ends[0][0])) > 0;
    bool b = mote_dot(direction, mote_sub(ends[1][1], ends[1][0])) < 0;
    return (mote_gjk_point){ends[0][a], ends[1][b]};
}

TEST(gjk_distance_of_segments_equals_the_kernel)
{
    scene s = {.random = 3};
    for (int i = 0; i < 20000; ++i) {
        mote_vec3 ends[2][2];
        for (int k = 0; k < 4; ++k)
            ends[k / 2][k % 2] =
                mote_vec3_make(scene_random(&s, -1, 1), scene_random(&s, -1, 1),
                               i % 3 ? scene_random(&s, -1, 1) : 0);
        if (i % 7 == 0)
            ends[1][1] = ends[1][0];
        double expected = sqrt(mote_segment_segment(ends[0], ends[1], NULL, NULL));
        mote_gjk_result r =
            mote_gjk_distance(segment_support, ends,
                              mote_vec3_make(scene_random(&s, -1, 1), 1, 0), HUGE_VAL, 100);
        assert_true(fabs(r.distance - expected) <= 1e-12);
        assert_true(r.lower <= r.distance);
        mote_gjk_result early =
            mote_gjk_distance(segment_support, ends, mote_vec3_make(1, 0, 0), 0.5, 100);
        assert_true(early.lower <= expected + 1e-15);
        assert_true(early.distance >= expected - 1e-12);
        if (expected < 0.5)
            assert_true(fabs(early.distance - expected) <= 1e-12);
    }
}
