/* Our own baselines against a plain double loop over all pairs of triangles. */
#include "tests/support/shapes.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

/* A method with parameters as text. */
typedef struct variant {
    const char *method, *options;
} variant;

static const variant variants[] = {
    {"brute-force", ""},
    {"brute-force", "positions=given"},
    {"aabb-tree", ""},
    {"aabb-tree", "seed=none"},
    {"aabb-tree", "positions=given"},
    {"aabb-tree", "arithmetic=wide"},
    {"aabb-tree", "build=samples"},
};

enum { VARIANTS = sizeof variants / sizeof *variants };

/* A variant that was built for a scene. */
typedef struct instance {
    const mote_method *method;
    void *state;
} instance;

static mote_status try_create(const variant *v, mote_setup setup, instance *made)
{
    double values[MOTE_PARAMETERS_MAX];
    made->method = method_with(v->method, v->options, values);
    made->state = NULL;
    setup.values = values;
    return made->method->create(&setup, &made->state);
}

static instance create(const variant *v, mote_setup setup)
{
    instance made;
    assert_int_equal(try_create(v, setup, &made), MOTE_OK);
    return made;
}

static mote_answer ask(const instance *i, const mote_frame *frame)
{
    return method_answer(i->method, i->state, frame);
}

static void check_distance(const variant *v, const scene *s, const mote_answer *a,
                           double expected)
{
    double limit = 2e-15 * (s->length + expected); /* the extent of the coordinates */
    assert_true(a->has_distance && a->has_contact && a->has_witness);
    if (!(fabs(a->distance - expected) <= limit))
        fail_msg("%s:%s frame %u: %.17g instead of %.17g", v->method, v->options,
                 (unsigned)s->frame.number, a->distance, expected);
    assert_int_equal(a->contact, expected <= 0);
    assert_true(a->counters.triangle_tests <=
                1 + (uint64_t)s->mesh[0]->triangle_count * s->mesh[1]->triangle_count);
    double apart = mote_length(mote_sub(a->witness[0], a->witness[1]));
    assert_true(fabs(apart - expected) <= limit);
    for (int b = 0; b < 2; b++)
        assert_true(scene_point_distance(s, b, a->witness[b]) <= limit);
}

/* Every variant answers every frame of a scene; returns the number of frames in contact. */
static int run_distance(scene *s, int frames, double reach, bool pose_only)
{
    instance made[VARIANTS];
    for (int i = 0; i < VARIANTS; i++)
        made[i] = create(&variants[i], scene_setup(s, MOTE_ASK_DISTANCE, 0, NULL));
    int contacts = 0;
    for (int f = 0; f < frames; f++) {
        const mote_frame *frame = scene_next(s, reach, pose_only && f % 3);
        double expected = scene_truth(s);
        contacts += expected == 0;
        for (int i = 0; i < VARIANTS; i++) {
            mote_answer a = ask(&made[i], frame);
            check_distance(&variants[i], s, &a, expected);
        }
    }
    for (int i = 0; i < VARIANTS; i++)
        made[i].method->destroy(made[i].state);
    return contacts;
}

TEST(query_on_deforming_bodies_equals_all_pairs)
{
    scene s;
    scene_init(&s, 14, 9, 1, true);
    assert_in_range(run_distance(&s, 60, 1.3, false), 10, 50);
    scene_free(&s);
}

TEST(query_on_rigid_bodies_equals_all_pairs)
{
    scene s;
    scene_init(&s, 9, 7, 1, false);
    assert_in_range(run_distance(&s, 40, 1.3, true), 5, 35);
    scene_free(&s);
}

TEST(query_far_apart_equals_all_pairs)
{
    scene s;
    scene_init(&s, 11, 8, 1, true);
    run_distance(&s, 20, 40, false);
    scene_free(&s);
}

/* So far that floats cannot hold the square of the distance. (140 triangles of body 1 do not
   fill brute-force's last block of boxes.) */
TEST(query_beyond_the_range_of_floats_equals_all_pairs)
{
    scene s;
    scene_init(&s, 9, 7, 1, true);
    run_distance(&s, 6, 1e21, false);
    scene_free(&s);
}

TEST(query_for_contact_within_a_huge_tolerance_finds_it)
{
    scene s;
    scene_init(&s, 9, 7, 1, true);
    for (int i = 0; i < VARIANTS; i++) {
        const double tolerance = 1e21 * s.length;
        instance made =
            create(&variants[i], scene_setup(&s, MOTE_ASK_CONTACT, tolerance, NULL));
        for (int f = 0; f < 6; f++) {
            const mote_answer a = ask(&made, scene_next(&s, 2e21, false));
            test_row("%s:%s frame %d", variants[i].method, variants[i].options, f);
            assert_int_equal(a.contact, scene_truth(&s) <= tolerance);
        }
        made.method->destroy(made.state);
    }
    scene_free(&s);
}

TEST(query_at_any_scale_equals_all_pairs)
{
    const double sizes[] = {1e-12, 1e-5, 1e6, 1e12};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        scene s;
        scene_init(&s, 9, 7, sizes[i], true);
        run_distance(&s, 8, 1.3, false);
        scene_free(&s);
    }
}

TEST(query_for_contact_agrees_with_the_tolerance)
{
    scene s;
    scene_init(&s, 12, 8, 1, true);
    for (int i = 0; i < VARIANTS; i++) {
        for (int t = 0; t < 3; t++) {
            double tolerance = 0.05 * t * s.length;
            instance made =
                create(&variants[i], scene_setup(&s, MOTE_ASK_CONTACT, tolerance, NULL));
            for (int f = 0; f < 20; f++) {
                const mote_frame *frame = scene_next(&s, 1.3, false);
                mote_answer a = ask(&made, frame);
                assert_true(a.has_contact);
                assert_int_equal(a.contact, scene_truth(&s) <= tolerance);
            }
            made.method->destroy(made.state);
        }
    }
    scene_free(&s);
}

TEST(create_bad_mesh_invalid)
{
    scene s;
    scene_init(&s, 6, 5, 1, false);
    for (int i = 0; i < VARIANTS; i++) {
        for (int fault = 0; fault < 4; fault++) {
            mote_mesh mesh = *s.mesh[1];
            mote_body body = {.mesh = &mesh, .field = s.field[1]};
            mote_setup setup = scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL);
            uint32_t kept = mesh.triangles[3][1];
            mote_vec3 kept_position = mesh.positions[4];
            setup.body[1] = &body;
            if (fault == 0)
                mesh.triangle_count = 0;
            else if (fault == 1)
                mesh.triangles[3][1] = mesh.vertex_count;
            else if (fault == 2)
                mesh.positions[4].y = (double)NAN;
            else
                mesh.vertex_count = 1;
            instance made;
            assert_int_equal(try_create(&variants[i], setup, &made), MOTE_EINVAL);
            assert_null(made.state);
            mesh.triangles[3][1] = kept;
            mesh.positions[4] = kept_position;
        }
    }
    scene_free(&s);
}

TEST(update_bad_vertices_invalid)
{
    scene s;
    scene_init(&s, 6, 5, 1, false);
    for (int i = 0; i < VARIANTS; i++) {
        instance made = create(&variants[i], scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL));
        mote_frame frame = *scene_next(&s, 1.3, false);
        s.world[0][7].z = (double)INFINITY;
        assert_int_equal(made.method->update(made.state, &frame), MOTE_EINVAL);
        frame.body[0].vertices = NULL;
        assert_int_equal(made.method->update(made.state, &frame), MOTE_EINVAL);
        made.method->destroy(made.state);
        made.method->destroy(NULL);
    }
    scene_free(&s);
}
