/* Rigid parts against brute force where they are exact, and against closed forms where they are
   not. */
#include "core/skin/skin.h"
#include "tests/support/skin_scene.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

static const char *const searches[] = {"search=fcl", "search=certified", "search=fcl,seed=none",
                                       "search=certified,seed=none"};

/* The method, built for a setup; NULL when it refuses, with the reason in mote_error_text. */
static void *built(const char *search, mote_setup setup)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = method_with("posed-parts", search, values);
    setup.values = values;
    void *state = NULL;
    const mote_status status = mote_method_create(m, &setup, &state);
    assert_true(status == MOTE_OK || status == MOTE_EUNSUPPORTED);
    return state;
}

static mote_answer ask(void *state, const mote_frame *frame)
{
    const mote_answer answer = method_answer(mote_method_find("posed-parts"), state, frame);
    assert_false(answer.has_lower);
    return answer;
}

/* Gives all bones random rotations, times a size. */
static void turn_bones(skinned *k, double size)
{
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < k->bones; ++i) {
            const mote_mat3 turn = random_rotation(&k->s);
            for (int e = 0; e < 12; ++e)
                k->matrix[b][i][e / 4][e % 4] =
                    e % 4 < 3 ? size * turn.m[e / 4][e % 4] : scene_random(&k->s, -0.3, 0.3);
        }
    }
    skinned_deform(k);
}

TEST(posed_parts_of_one_bone_are_exact)
{
    for (size_t i = 0; i < ROWS_OF(searches); ++i) {
        skinned k;
        skinned_init(&k, 14, 9, (skin_plan){.bones = 1, .each = 1});
        void *state = built(searches[i], scene_setup(&k.s, MOTE_ASK_DISTANCE, 0, NULL));
        assert_non_null(state);
        int apart = 0;
        for (int f = 0; f < 40; ++f) {
            test_row("%s, frame %d", searches[i], f);
            next_pose(&k, 0.02, 1.3);
            turn_bones(&k, 1);
            const double expected = scene_truth(&k.s);
            const mote_answer a = ask(state, &k.s.frame);
            assert_true(a.has_distance && fabs(a.distance - expected) < 1e-13 * k.s.length);
            assert_int_equal(a.contact, expected <= 0);
            if (expected <= 0)
                continue;
            ++apart;
            assert_true(a.has_witness);
            const double length = mote_length(mote_sub(a.witness[0], a.witness[1]));
            assert_true(fabs(length - expected) < 1e-13 * k.s.length);
            for (int b = 0; b < 2; ++b)
                assert_true(scene_point_distance(&k.s, b, a.witness[b]) < 1e-13 * k.s.length);
        }
        assert_in_range(apart, 10, 39);
        mote_method_find("posed-parts")->destroy(state);
        skinned_free(&k);
    }
}

/* Doubles the size that bones give their parts, about the middles of these. */
static void double_bones(skinned *k)
{
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = k->s.mesh[b];
        const mote_vec3 middle = mote_scale(mote_add(mesh->low, mesh->high), 0.5);
        for (int r = 0; r < 3; ++r) {
            double *row = k->matrix[b][0][r];
            row[3] -= row[0] * middle.x + row[1] * middle.y + row[2] * middle.z;
            for (int c = 0; c < 3; ++c)
                row[c] *= 2;
        }
    }
    skinned_deform(k);
}

/* Bones that halve a body are followed by the certified search; FCL's trees keep their size. */
TEST(posed_parts_follow_scaled_bones_only_where_the_search_can)
{
    skinned k;
    skinned_init(&k, 14, 9, (skin_plan){.bones = 1, .each = 1});
    const mote_setup setup = scene_setup(&k.s, MOTE_ASK_DISTANCE, 0, NULL);
    void *fcl = built("search=fcl", setup), *certified = built("search=certified", setup);
    for (int f = 0; f < 10; ++f) {
        next_pose(&k, 0.02, 1);
        k.s.frame.body[1].pose.translation.x = 2 * k.s.length;
        turn_bones(&k, 0.5);
        const double expected = scene_truth(&k.s);
        const double exact = ask(certified, &k.s.frame).distance;
        assert_true(fabs(exact - expected) < 1e-13 * k.s.length);
        const double larger = ask(fcl, &k.s.frame).distance;
        double_bones(&k);
        assert_true(fabs(larger - scene_truth(&k.s)) < 1e-13 * k.s.length);
    }
    mote_method_find("posed-parts")->destroy(fcl);
    mote_method_find("posed-parts")->destroy(certified);
    skinned_free(&k);
}

TEST(posed_parts_for_contact_agree_with_the_tolerance)
{
    for (size_t i = 0; i < ROWS_OF(searches); ++i) {
        for (int t = 0; t < 3; ++t) {
            skinned k;
            skinned_init(&k, 12, 8, (skin_plan){.bones = 1, .each = 1});
            const double tolerance = 0.05 * t * k.s.length;
            void *state =
                built(searches[i], scene_setup(&k.s, MOTE_ASK_CONTACT, tolerance, NULL));
            int contacts = 0;
            for (int f = 0; f < 25; ++f) {
                next_pose(&k, 0.02, 1.3);
                turn_bones(&k, 1);
                const mote_answer a = ask(state, &k.s.frame);
                const bool contact = scene_truth(&k.s) <= tolerance;
                assert_true(a.has_contact && !a.has_distance);
                assert_int_equal(a.contact, contact);
                contacts += contact;
            }
            assert_in_range(contacts, 3, 23);
            mote_method_find("posed-parts")->destroy(state);
            skinned_free(&k);
        }
    }
}

/* A strip of two squares in x and y. Its left edge follows bone 0, its right edge bone 1, its
   middle both. It may have a morph target that lifts the middle by 1. */
typedef struct strip {
    mote_mesh *mesh, *triangle;
    mote_field *field, *rigid;
    mote_body body, probe;
    mote_frame frame;
    double weights[3][MOTE_FIELD_SUMMED];
} strip;

static void strip_init(strip *s, bool morphing, double height)
{
    const double xyz[] = {0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0};
    const uint32_t faces[] = {0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5};
    const double apex[] = {1, 0.5, height, 1.1, 0.5, height + 9, 0.9, 0.5, height + 9};
    const uint32_t face[] = {0, 1, 2};
    const uint32_t start[] = {0, 1, 2, 4, 6, 7, 8};
    const uint16_t bone[] = {0, 0, 0, 1, 0, 1, 1, 1};
    const double weight[] = {1, 1, 1, 1, 1, 1, 1, 1};
    const uint32_t target[] = {0, 2}, moved[] = {2, 3};
    const mote_vec3 move[] = {{0, 0, 1}, {0, 0, 1}};
    const mote_morph_targets targets = {1, target, moved, move};
    *s = (strip){0};
    assert_int_equal(mote_mesh_create(xyz, 6, faces, 4, &s->mesh), MOTE_OK);
    assert_int_equal(mote_mesh_create(apex, 3, face, 1, &s->triangle), MOTE_OK);
    assert_int_equal(
        morphing
            ? mote_field_create_morphs(s->mesh, 2, start, bone, weight, &targets, &s->field)
            : mote_field_create_skin(s->mesh, 2, start, bone, weight, &s->field),
        MOTE_OK);
    assert_int_equal(mote_field_create_static(&s->rigid), MOTE_OK);
    s->body = (mote_body){.mesh = s->mesh, .field = s->field};
    s->probe = (mote_body){.mesh = s->triangle, .field = s->rigid};
    for (int b = 0; b < 2; ++b) {
        s->frame.body[b].pose.rotation = (mote_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        s->frame.body[b].shape_changed = s->frame.body[b].pose_changed = true;
    }
}

static void strip_free(strip *s)
{
    mote_field_destroy(s->field);
    mote_field_destroy(s->rigid);
    mote_mesh_destroy(s->mesh);
    mote_mesh_destroy(s->triangle);
}

/* Bone 1 is lifted, and the middle by its morph target. */
static void strip_lift(strip *s, double bone, double middle)
{
    const double matrices[2][3][4] = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
                                      {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, bone}}};
    mote_body_state *state = &s->frame.body[0];
    double(*w)[MOTE_FIELD_SUMMED] = s->weights;
    ++s->frame.number;
    mote_morph_weights(s->field, matrices, &middle, &state->pose.rotation, w[0], w[1], w[2]);
    state->weights = (mote_weights){w[0], w[1], w[2], s->field->count, s->field->padded};
}

static double strip_distance(const strip *s, const char *search)
{
    const mote_setup setup = {.body = {&s->body, &s->probe}, .length = s->triangle->diagonal};
    void *state = built(search, setup);
    assert_non_null(state);
    const mote_answer a = ask(state, &s->frame);
    mote_method_find("posed-parts")->destroy(state);
    return a.distance;
}

/* Blending makes a ramp of the strip; its parts make a step, to whose edge the probe, above the
   middle, is nearer. */
TEST(posed_parts_of_two_bones_err_as_a_step_differs_from_a_ramp)
{
    for (size_t i = 0; i < ROWS_OF(searches); ++i) {
        strip s;
        strip_init(&s, false, 3);
        for (double h = 0; h < 1; h += 0.25) {
            test_row("%s, %g", searches[i], h);
            strip_lift(&s, h, 0);
            const mote_vec3 middle = mote_body_position(&s.body, &s.frame.body[0], 2);
            assert_true(fabs(middle.z - h / 2) < 1e-15);
            const double true_distance = (3 - h / 2) / sqrt(1 + h * h / 4);
            const double error = strip_distance(&s, searches[i]) - true_distance;
            assert_true(fabs(error - (3 - h - true_distance)) < 1e-12);
        }
        strip_free(&s);
    }
}

TEST(posed_parts_do_not_see_morph_targets)
{
    for (size_t i = 0; i < ROWS_OF(searches); ++i) {
        strip s;
        strip_init(&s, true, 3);
        strip_lift(&s, 0, 0.5);
        assert_true(fabs(mote_body_position(&s.body, &s.frame.body[0], 2).z - 0.5) < 1e-7);
        assert_true(fabs(strip_distance(&s, searches[i]) - 3) < 1e-12);
        strip_lift(&s, 0.5, 0.5);
        assert_true(fabs(strip_distance(&s, searches[i]) - 2.5) < 1e-12);
        strip_free(&s);
    }
}

/* Mirrored, flat and vanishing bones are answered, whatever the answer is; two bodies far from
   each other stay apart. */
TEST(posed_parts_of_any_matrix_answer)
{
    for (size_t i = 0; i < ROWS_OF(searches); ++i) {
        skinned k;
        skinned_init(&k, 14, 9, (skin_plan){.bones = 5, .each = 3, .targets = 2});
        void *state = built(searches[i], scene_setup(&k.s, MOTE_ASK_DISTANCE, 0, NULL));
        for (int f = 0; f < 60; ++f) {
            next_pose(&k, wildness[f % 4], 1);
            const double x = f % 2 ? 0 : 100 * k.s.length;
            k.s.frame.body[1].pose.translation.x = x;
            const mote_answer a = ask(state, &k.s.frame);
            assert_true(a.has_distance && isfinite(a.distance) && a.distance >= 0);
            assert_true(f % 2 || fabs(a.distance - x) < 50 * k.s.length);
        }
        mote_method_find("posed-parts")->destroy(state);
        skinned_free(&k);
    }
}

TEST(posed_parts_refuse_bones_that_are_not_finite)
{
    strip s;
    strip_init(&s, false, 3);
    strip_lift(&s, 0, 0);
    s.weights[1][4] = NAN;
    const mote_setup setup = {.body = {&s.body, &s.probe}, .length = s.triangle->diagonal};
    void *state = built("search=fcl", setup);
    const mote_method *m = mote_method_find("posed-parts");
    assert_int_equal(m->update(state, &s.frame), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "bone 1"));
    m->destroy(state);
    strip_free(&s);
}

TEST(posed_parts_want_bones)
{
    scene s;
    scene_init(&s, 9, 7, 1, true);
    assert_null(built("search=fcl", scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL)));
    assert_non_null(strstr(mote_error_text(), "has none"));
    scene_free(&s);
    scene_init(&s, 9, 7, 1, false); /* rigid bodies are a part each */
    void *state = built("search=fcl", scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL));
    assert_non_null(state);
    const mote_frame *frame = scene_next(&s, 1.3, true);
    assert_true(fabs(ask(state, frame).distance - scene_truth(&s)) < 1e-13 * s.length);
    mote_method_find("posed-parts")->destroy(state);
    scene_free(&s);
}
