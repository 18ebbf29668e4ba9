/* The FCL adapters against brute force with our own triangle distance. */
#include "core/method/impact_method.h"
#include "harness/base/heap_count.h"
#include "tests/support/shapes.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

#include <stdio.h>

/* A method with parameters as text. */
typedef struct variant {
    const char *method, *options;
} variant;

static void *create(const variant *v, const scene *s, mote_ask ask, double tolerance)
{
    static double values[MOTE_PARAMETERS_MAX];
    const mote_method *method = method_with(v->method, v->options, values);
    mote_setup setup = scene_setup(s, ask, tolerance, values);
    void *state = NULL;
    mote_status status = method->create(&setup, &state);
    if (status != MOTE_OK)
        print_error("%s:%s: %s\n", v->method, v->options, mote_error_text());
    assert_int_equal(status, MOTE_OK);
    return state;
}

static mote_status try_create(const variant *v, const mote_setup *setup_without_values)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *method = method_with(v->method, v->options, values);
    mote_setup setup = *setup_without_values;
    setup.values = values;
    void *state = NULL;
    mote_status status = method->create(&setup, &state);
    if (status != MOTE_OK)
        assert_null(state);
    method->destroy(state);
    return status;
}

static mote_answer answer(const variant *v, void *state, const mote_frame *frame)
{
    return method_answer(mote_method_find(v->method), state, frame);
}

static const variant distance_variants[] = {
    {"fcl-aabb", ""},
    {"fcl-aabb", "queue=64"},
    {"fcl-aabb", "seed=previous"},
    {"fcl-aabb", "seed=previous,queue=64"},
    {"fcl-aabb", "call=api"},
    {"fcl-aabb", "call=api,seed=previous,positions=given"},
    {"fcl-aabb", "update=refit-top-down"},
    {"fcl-aabb", "update=rebuild"},
    {"fcl-aabb", "build=samples"},
    {"fcl-obbrss", "build=samples,seed=previous"},
    {"fcl-obbrss", ""},
    {"fcl-obbrss", "queue=64"},
    {"fcl-obbrss", "seed=previous"},
    {"fcl-obbrss", "seed=previous,queue=64"},
    {"fcl-obbrss", "call=api,seed=previous"},
    {"fcl-obbrss", "update=rebuild"},
    {"fcl-obb", ""},
    {"fcl-obb", "queue=64,seed=previous"},
    {"fcl-rss", ""},
    {"fcl-rss", "queue=64,seed=previous"},
    {"fcl-rss", "call=api"},
    {"fcl-kios", ""},
    {"fcl-kios", "queue=64,seed=previous"},
    {"fcl-kios", "call=api"},
    {"hybrid-fcl", ""},
    {"hybrid-fcl", "n=3,refine=no,queue=64,positions=given"},
};

enum { DISTANCE_VARIANTS = sizeof distance_variants / sizeof *distance_variants };

static const variant contact_variants[] = {
    {"fcl-rss", ""},
    {"fcl-rss", "call=api"},
    {"fcl-kios", ""},
    {"fcl-kios", "call=api"},
    {"hybrid-fcl", ""},
    {"fcl-kdop18", ""},
    {"fcl-kdop18", "call=api"},
    {"fcl-kdop18", "update=rebuild"},
    {"fcl-kdop18", "build=samples"},
    {"fcl-kdop18", "update=refit-top-down"},
    {"fcl-aabb", ""},
    {"fcl-aabb", "call=api"},
    {"fcl-obb", ""},
    {"fcl-obb", "call=api"},
    {"fcl-obb", "update=rebuild"},
    {"fcl-obbrss", ""},
    {"fcl-obbrss", "call=api"},
};

enum { CONTACT_VARIANTS = sizeof contact_variants / sizeof *contact_variants };

static void check_distance(const variant *v, const scene *s, const mote_answer *a,
                           double expected)
{
    double limit = 1e-12 * s->length;
    assert_true(a->has_distance && a->has_contact && !a->has_lower);
    if (!(fabs(a->distance - expected) <= limit))
        fail_msg("%s:%s frame %u: %.17g, brute force %.17g", v->method, v->options,
                 (unsigned)s->frame.number, a->distance, expected);
    assert_int_equal(a->contact, a->distance <= 0);
    assert_true(a->has_witness || a->distance == 0);
    if (!a->has_witness)
        return;
    assert_true(fabs(sqrt(mote_distance_squared(a->witness[0], a->witness[1])) - expected) <=
                limit);
    for (int b = 0; b < 2; ++b)
        assert_true(scene_point_distance(s, b, a->witness[b]) <= limit);
}

/* Every variant answers every frame; counts the frames in contact. */
static int run_distance(scene *s, const variant *variants, int count, int frames, double reach,
                        bool pose_only)
{
    void *state[32];
    for (int i = 0; i < count; ++i)
        state[i] = create(&variants[i], s, MOTE_ASK_DISTANCE, 0);
    int contacts = 0;
    for (int f = 0; f < frames; ++f) {
        const mote_frame *frame = scene_next(s, reach, pose_only && f % 3);
        double expected = scene_truth(s);
        contacts += expected == 0;
        for (int i = 0; i < count; ++i) {
            mote_answer a = answer(&variants[i], state[i], frame);
            check_distance(&variants[i], s, &a, expected);
        }
    }
    for (int i = 0; i < count; ++i)
        mote_method_find(variants[i].method)->destroy(state[i]);
    return contacts;
}

TEST(query_on_deforming_bodies_equals_brute_force)
{
    scene s;
    scene_init(&s, 14, 9, 1, true);
    int contacts = run_distance(&s, distance_variants, DISTANCE_VARIANTS, 60, 1.3, false);
    assert_in_range(contacts, 10, 50);
    scene_free(&s);
}

TEST(query_when_weights_stay_equals_brute_force)
{
    scene s;
    scene_init(&s, 10, 6, 1, true);
    run_distance(&s, distance_variants, DISTANCE_VARIANTS, 30, 1.3, true);
    scene_free(&s);
}

TEST(query_on_rigid_bodies_without_vertices_equals_brute_force)
{
    static const variant rigid[] = {{"fcl-obbrss", "update=none"},
                                    {"fcl-obbrss", "update=none,seed=previous,queue=64"},
                                    {"fcl-obbrss", "update=none,call=api"},
                                    {"fcl-obb", "update=none"},
                                    {"fcl-rss", "update=none,seed=previous"},
                                    {"fcl-kios", "update=none"}};
    scene s;
    scene_init(&s, 10, 6, 1, false);
    void *state[6];
    for (int i = 0; i < 6; ++i)
        state[i] = create(&rigid[i], &s, MOTE_ASK_DISTANCE, 0);
    for (int f = 0; f < 30; ++f) {
        mote_frame frame = *scene_next(&s, 1.3, false);
        frame.body[0].vertices = frame.body[1].vertices = NULL;
        double expected = scene_truth(&s);
        for (int i = 0; i < 6; ++i) {
            mote_answer a = answer(&rigid[i], state[i], &frame);
            check_distance(&rigid[i], &s, &a, expected);
        }
    }
    for (int i = 0; i < 6; ++i)
        mote_method_find(rigid[i].method)->destroy(state[i]);
    scene_free(&s);
}

/* Contact at a tolerance; frames within 1e-9 L of the tolerance are not checked. */
static void run_contact(const variant *variants, int count, double tolerance)
{
    scene s;
    scene_init(&s, 14, 9, 1, true);
    tolerance *= s.length;
    void *state[32];
    for (int i = 0; i < count; ++i)
        state[i] = create(&variants[i], &s, MOTE_ASK_CONTACT, tolerance);
    int contacts = 0, frames = 60;
    for (int f = 0; f < frames; ++f) {
        const mote_frame *frame = scene_next(&s, 1.3, false);
        double expected = scene_truth(&s);
        if (fabs(expected - tolerance) < 1e-9 * s.length && expected > 0)
            continue;
        contacts += expected <= tolerance;
        for (int i = 0; i < count; ++i) {
            mote_answer a = answer(&variants[i], state[i], frame);
            assert_true(a.has_contact && !a.has_distance);
            if (a.contact != (expected <= tolerance))
                fail_msg("%s:%s says %d at distance %g", variants[i].method,
                         variants[i].options, a.contact, expected);
        }
    }
    assert_in_range(contacts, 10, frames - 10);
    for (int i = 0; i < count; ++i)
        mote_method_find(variants[i].method)->destroy(state[i]);
    scene_free(&s);
}

TEST(query_asked_for_contact_agrees_with_brute_force)
{
    run_contact(contact_variants, CONTACT_VARIANTS, 0);
}

TEST(query_asked_for_contact_within_tolerance_agrees_with_brute_force)
{
    run_contact(distance_variants, DISTANCE_VARIANTS, 0.05);
}

TEST(query_asked_for_contact_stops_early)
{
    static const variant v = {"fcl-aabb", ""};
    scene s;
    scene_init(&s, 40, 24, 1, true);
    const mote_frame *frame = scene_next(&s, 0, false);
    const mote_ask asks[] = {MOTE_ASK_CONTACT, MOTE_ASK_CONTACT, MOTE_ASK_DISTANCE};
    const double tolerances[] = {0, 0.05, 0};
    uint64_t tests[3];
    for (int i = 0; i < 3; ++i) {
        void *state = create(&v, &s, asks[i], tolerances[i] * s.length);
        mote_answer a = answer(&v, state, frame);
        assert_true(a.contact);
        tests[i] = a.counters.triangle_tests;
        mote_method_find(v.method)->destroy(state);
    }
    assert_true(tests[0] > 0 && tests[1] > 0);
    assert_true(tests[0] <= tests[2] && tests[1] < tests[2]);
    scene_free(&s);
}

TEST(query_from_a_seed_makes_fewer_tests)
{
    static const variant v[2] = {{"fcl-aabb", ""}, {"fcl-aabb", "seed=previous"}};
    scene s;
    scene_init(&s, 40, 24, 1, true);
    const mote_frame *frame;
    do
        frame = scene_next(&s, 1.3, false);
    while (scene_truth(&s) == 0);
    uint64_t tests[2];
    double distance[2];
    for (int i = 0; i < 2; ++i) {
        void *state = create(&v[i], &s, MOTE_ASK_DISTANCE, 0);
        answer(&v[i], state, frame);
        mote_answer a = answer(&v[i], state, frame);
        assert_true(a.has_witness);
        tests[i] = a.counters.box_tests + a.counters.triangle_tests;
        distance[i] = a.distance;
        mote_method_find(v[i].method)->destroy(state);
    }
    assert_true(distance[0] == distance[1]);
    assert_true(tests[1] < tests[0]);
    scene_free(&s);
}

TEST(query_scaled_by_a_power_of_two_gives_the_same_bits)
{
    static const int exponents[] = {0, -40, -20, 13, 40};
    double first[DISTANCE_VARIANTS][6];
    for (int e = 0; e < 5; ++e) {
        scene s;
        scene_init(&s, 10, 6, ldexp(1, exponents[e]), true);
        void *state[DISTANCE_VARIANTS];
        for (int i = 0; i < DISTANCE_VARIANTS; ++i)
            state[i] = create(&distance_variants[i], &s, MOTE_ASK_DISTANCE, 0);
        for (int f = 0; f < 6; ++f) {
            const mote_frame *frame = scene_next(&s, 1.3, false);
            for (int i = 0; i < DISTANCE_VARIANTS; ++i) {
                mote_answer a = answer(&distance_variants[i], state[i], frame);
                double unscaled = ldexp(a.distance, -exponents[e]);
                if (e == 0)
                    first[i][f] = unscaled;
                assert_true(first[i][f] == unscaled);
            }
        }
        for (int i = 0; i < DISTANCE_VARIANTS; ++i)
            mote_method_find(distance_variants[i].method)->destroy(state[i]);
        scene_free(&s);
    }
}

TEST(create_of_what_fcl_lacks_is_unsupported)
{
    static const variant lacking[] = {
        {"fcl-obb", "call=api"},         {"fcl-kdop18", ""},
        {"fcl-kdop18", "seed=previous"}, {"fcl-obb", "update=none"},
        {"fcl-aabb", "update=none"},     {"fcl-aabb", "call=api,queue=64"},
        {"fcl-obbrss", "update=none"},   {"fcl-aabb", "build=samples,update=rebuild"}};
    scene s;
    scene_init(&s, 6, 4, 1, true);
    mote_setup setup = scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL);
    for (size_t i = 0; i < sizeof lacking / sizeof *lacking; ++i) {
        assert_int_equal(try_create(&lacking[i], &setup), MOTE_EUNSUPPORTED);
        assert_true(strlen(mote_error_text()) > 20);
    }
    scene_free(&s);
}

TEST(create_with_a_bad_mesh_is_refused)
{
    scene s;
    scene_init(&s, 6, 4, 1, true);
    for (const mote_method *const *m = mote_methods; *m; ++m) {
        const mote_impact_method *impact = mote_impact_method_find((*m)->name);
        if (!strstr((*m)->name, "fcl") || (impact && impact->alone)) /* another question */
            continue;
        variant v = {(*m)->name, ""};
        for (int fault = 0; fault < 8; ++fault) {
            mote_mesh mesh = *s.mesh[1];
            mote_body body = {.mesh = &mesh, .field = s.field[1]};
            mote_setup setup = scene_setup(&s, MOTE_ASK_CONTACT, 0, NULL);
            setup.body[1] = &body;
            mote_vec3 saved = mesh.positions[5];
            uint32_t index = mesh.triangles[3][1];
            if (fault == 0)
                mesh.triangle_count = 0;
            else if (fault == 1)
                mesh.vertex_count = 1;
            else if (fault == 2)
                mesh.triangles[3][1] = mesh.vertex_count;
            else if (fault == 3)
                mesh.triangles[3][1] = mesh.triangles[3][0];
            else if (fault == 4)
                mesh.positions[5].y = (double)NAN;
            else if (fault == 5)
                mesh.positions[5].z = HUGE_VAL;
            else if (fault == 6)
                setup.length = (double)NAN;
            else
                setup.tolerance = -1;
            assert_int_equal(try_create(&v, &setup), MOTE_EINVAL);
            mesh.positions[5] = saved;
            mesh.triangles[3][1] = index;
        }
    }
    scene_free(&s);
}

TEST(update_with_a_bad_frame_is_refused_and_the_next_good)
{
    scene s;
    scene_init(&s, 8, 5, 1, true);
    for (int i = 0; i < DISTANCE_VARIANTS; ++i) {
        const variant *v = &distance_variants[i];
        const mote_method *method = mote_method_find(v->method);
        void *state = create(v, &s, MOTE_ASK_DISTANCE, 0);
        mote_frame bad = *scene_next(&s, 1.3, false);
        bad.body[1].vertices = NULL;
        assert_int_equal(method->update(state, &bad), MOTE_EINVAL);
        bad = *scene_next(&s, 1.3, false);
        s.world[0][7].x = -HUGE_VAL;
        assert_int_equal(method->update(state, &bad), MOTE_EINVAL);
        /* What was refused is no known shape: that it did not change helps nothing. */
        bad.body[0].shape_changed = bad.body[0].pose_changed = false;
        assert_int_equal(method->update(state, &bad), MOTE_EINVAL);
        bad = *scene_next(&s, 1.3, false);
        bad.body[0].pose.translation.y = (double)NAN;
        assert_int_equal(method->update(state, &bad), MOTE_EINVAL);
        mote_answer a = answer(v, state, scene_next(&s, 1.3, false));
        check_distance(v, &s, &a, scene_truth(&s));
        method->destroy(state);
    }
    scene_free(&s);
}

/* Bytes a triangle, from the sizes of FCL's structures: 2 nodes, 2 node indices, 1 triangle of
   3 indices, half a vertex. */
TEST(create_takes_the_memory_that_fcl_needs)
{
    if (!mote_heap_read().counted)
        skip();
    static const struct {
        const char *name;
        double bytes;
    } cases[] = {{"fcl-aabb", 172},   {"fcl-obb", 316},  {"fcl-rss", 316},
                 {"fcl-obbrss", 556}, {"fcl-kios", 652}, {"fcl-kdop18", 364}};
    scene s;
    scene_init(&s, 60, 40, 1, true);
    double triangles = s.mesh[0]->triangle_count + s.mesh[1]->triangle_count;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const variant v = {cases[i].name, ""};
        int64_t before = mote_heap_read().live_bytes;
        void *state = create(&v, &s, MOTE_ASK_CONTACT, 0);
        double bytes = (double)(mote_heap_read().live_bytes - before) / triangles;
        if (!(fabs(bytes - cases[i].bytes) <= 0.02 * cases[i].bytes))
            fail_msg("%s: %.1f bytes a triangle, expected %g", v.method, bytes, cases[i].bytes);
        mote_method_find(v.method)->destroy(state);
    }
    scene_free(&s);
}

/* count tetrahedra in a row along x, from height z on. */
static mote_mesh *make_row(uint32_t count, double z)
{
    static const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const uint32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    double xyz[16 * 4][3];
    uint32_t faces[16 * 4][3];
    need(count <= 16);
    for (uint32_t i = 0; i < 4 * count; ++i) {
        const double *c = corner[i % 4];
        const double place[3] = {c[0] + 2 * (i / 4), c[1], c[2] + z};
        memcpy(xyz[i], place, sizeof place);
        for (int k = 0; k < 3; ++k)
            faces[i][k] = face[i % 4][k] + 4 * (i / 4);
    }
    mote_mesh *mesh = NULL;
    need(mote_mesh_create(&xyz[0][0], 4 * count, &faces[0][0], 4 * count, &mesh) == MOTE_OK);
    return mesh;
}

/* Sixteen components or one, 1.5 apart. Sixteen are more than the default number of particles;
   one has only four vertices, which limit that number. */
TEST(hybrid_on_more_components_than_particles_raises_their_number)
{
    static const variant variants[] = {{"hybrid-fcl", ""}, {"hybrid-fcl", "n=1"}};
    for (int v = 0; v < 4; ++v) {
        scene s;
        scene_init_meshes(&s, make_row(v < 2 ? 16 : 1, 0), make_row(v < 2 ? 16 : 1, 2.5),
                          false);
        const mote_pose still = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}};
        for (int b = 0; b < 2; ++b) {
            s.frame.body[b] =
                (mote_body_state){.pose = still, .shape_changed = true, .pose_changed = true};
            mote_deform_all(s.deform[b], &s.frame.body[b], s.world[b]);
            s.frame.body[b].vertices = s.world[b];
        }
        void *state = create(&variants[v % 2], &s, MOTE_ASK_DISTANCE, 0);
        const mote_answer found = answer(&variants[v % 2], state, &s.frame);
        assert_true(found.has_distance);
        assert_true(found.distance == 1.5);
        mote_method_find("hybrid-fcl")->destroy(state);
        scene_free(&s);
    }
}

/* Sixteen components or one of four vertices: no n can be right for both bodies. Neither the
   automatic n nor a valid one is refused as if the user had written another; an n that is more
   than the vertices of a body is an error. */
TEST(particles_on_more_components_than_the_other_body_has_vertices_are_unsupported)
{
    static const struct {
        variant v;
        mote_status status;
        const char *says;
    } rows[] = {
        {{"hybrid-fcl", ""}, MOTE_EUNSUPPORTED, "4 particles on a body of 16 connected"},
        {{"hybrid-fcl", "n=2"}, MOTE_EUNSUPPORTED, "2 particles on a body of 16 connected"},
        {{"hybrid-fcl", "n=8"}, MOTE_EINVAL, "n=8 is not valid; body 1 has 4 vertices, so n"},
        {{"particle", "forces=on"}, MOTE_EUNSUPPORTED, "4 particles on a body of 16 connected"},
        {{"particle", ""}, MOTE_OK, ""},
        {{"particle-paper", ""}, MOTE_EUNSUPPORTED, "4 particles on a body of 16 connected"},
        {{"particle-paper", "n=8"}, MOTE_EINVAL, "n=8 is not valid; body 1 has 4 vertices"},
    };
    scene s;
    scene_init_meshes(&s, make_row(16, 0), make_row(1, 2.5), false);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        double values[MOTE_PARAMETERS_MAX];
        const mote_method *method = method_with(rows[i].v.method, rows[i].v.options, values);
        const mote_setup setup = scene_setup(&s, MOTE_ASK_DISTANCE, 0, values);
        void *state = NULL;
        test_row("%s:%s", rows[i].v.method, rows[i].v.options);
        const mote_status status = method->create(&setup, &state);
        assert_int_equal(status, rows[i].status);
        if (status == MOTE_OK)
            method->destroy(state);
        else
            assert_non_null(strstr(mote_error_text(), rows[i].says));
    }
    scene_free(&s);
}

TEST(traits_follow_the_parameters)
{
    static const struct {
        variant v;
        bool needs, given, state, exact;
    } cases[] = {
        {{"fcl-aabb", ""}, true, false, false, true},
        {{"fcl-aabb", "seed=previous"}, true, false, true, true},
        {{"fcl-aabb", "positions=given"}, false, true, false, true},
        {{"fcl-obbrss", "update=none"}, false, false, false, true},
        {{"fcl-obbrss", "update=refit-bottom-up"}, true, false, false, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        double values[MOTE_PARAMETERS_MAX];
        const mote_method *method = method_with(cases[i].v.method, cases[i].v.options, values);
        mote_traits traits = method->traits(values);
        assert_int_equal(traits.needs_vertices, cases[i].needs);
        assert_int_equal(traits.given_vertices, cases[i].given);
        assert_int_equal(traits.keeps_state, cases[i].state);
        assert_int_equal(traits.exact, cases[i].exact);
    }
}

TEST(destroy_of_nothing_does_nothing)
{
    for (const mote_method *const *m = mote_methods; *m; ++m)
        (*m)->destroy(NULL);
}
