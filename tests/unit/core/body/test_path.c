/* Paths: poses and weights between two moments. */
#include "core/body/path.h"
#include "core/body/path_place.h"

#include "tests/support/bodies.h"

static const mote_quaternion none = {1, 0, 0, 0};

TEST(mote_path_line_constant_speed)
{
    const mote_vec3 a = {1, 2, 3}, b = {-2, 0, 7};
    mote_path_piece piece = {.turn = {none, none, none, none}};
    mote_path_line(a, b, piece.centre);
    const mote_path path = {.pieces = &piece, .count = 1};
    uint64_t seed = 1;
    test_body body;
    test_body_init(&body, solid_to_mesh(solid_tetrahedron()), 0, &seed);
    for (int i = 0; i <= 8; ++i) {
        mote_body_state state;
        mote_path_state(&path, &body.body, i / 8.0, NULL, &state);
        const mote_vec3 at = mote_add_scaled(a, i / 8.0, mote_sub(b, a));
        assert_close(mote_length(mote_sub(state.pose.translation, at)), 0, 1e-14);
        assert_true(state.shape_changed && state.pose_changed && !state.vertices);
    }
    test_body_free(&body);
}

TEST(mote_path_hermite_ends_and_derivatives)
{
    const mote_vec3 a = {1, 2, 3}, da = {3, -6, 9}, b = {0, 5, 1}, db = {-3, 0, 6};
    mote_vec3 c[4];
    mote_path_hermite(a, da, b, db, c);
    assert_close(mote_length(mote_sub(c[0], a)), 0, 0);
    assert_close(mote_length(mote_sub(c[3], b)), 0, 0);
    assert_close(mote_length(mote_sub(mote_scale(mote_sub(c[1], c[0]), 3), da)), 0, 1e-14);
    assert_close(mote_length(mote_sub(mote_scale(mote_sub(c[3], c[2]), 3), db)), 0, 1e-14);
}

/* A quarter turn a piece about z: after two pieces half a turn, about the pivot. */
TEST(mote_path_state_spin_turns_about_the_pivot)
{
    const double half = sqrt(0.5);
    mote_path_piece pieces[2] = {{.spins = true, .turn = {none}},
                                 {.spins = true, .turn = {{half, 0, 0, half}}}};
    for (int k = 0; k < 2; ++k) {
        pieces[k].spin = mote_vec3_make(0, 0, 1.5707963267948966);
        for (int i = 0; i < 4; ++i)
            pieces[k].centre[i] = mote_vec3_make(5, 5, 5);
    }
    const mote_path path = {.pivot = {1, 0, 0}, .pieces = pieces, .count = 2};
    const mote_body body = {.field = &(mote_field){.count = 0}};
    for (int i = 0; i <= 16; ++i) {
        mote_body_state state;
        mote_path_state(&path, &body, i / 16.0, NULL, &state);
        const double angle = i / 16.0 * 3.141592653589793;
        const mote_vec3 x = mote_pose_apply(&state.pose, mote_vec3_make(3, 0, 0));
        assert_close(x.x, 5 + 2 * cos(angle), 1e-14);
        assert_close(x.y, 5 + 2 * sin(angle), 1e-14);
        assert_close(x.z, 5, 1e-14);
    }
}

/* Weights are given in the body's axes: they turn with it. */
TEST(mote_path_state_weights_turn_with_the_body)
{
    uint64_t seed = 3;
    test_body body;
    test_body_init(&body, solid_to_mesh(solid_icosphere(1)), 3, &seed);
    const size_t padded = body.field->padded;
    double *control = calloc(12 * padded, sizeof *control);
    double *weights = calloc(3 * padded, sizeof *weights);
    for (size_t i = 0; i < 4; ++i) /* linear in time: weight 1 goes from 0 to (3, 0, 0) */
        control[3 * i * padded + 1] = (double)i;
    const mote_path_piece piece = {
        .spins = true, .turn = {none}, .spin = {0, 0, 3.141592653589793}, .weights = control};
    const mote_path path = {.pieces = &piece, .count = 1};
    mote_body_state state;
    mote_path_state(&path, &body.body, 0.5, weights, &state);
    assert_close(state.weights.x[1], 0, 1e-14);
    assert_close(state.weights.y[1], 1.5, 1e-14);
    assert_close(state.weights.y[0], 0, 0);
    mote_path_state(&path, &body.body, 1, weights, &state);
    assert_close(state.weights.x[1], -3, 1e-14);
    const mote_path_piece still = {.spins = true, .turn = {none}};
    const mote_path bare = {.pieces = &still, .count = 1};
    mote_path_state(&bare, &body.body, 1, weights, &state);
    assert_close(state.weights.x[1], 0, 0);
    free(control);
    free(weights);
    test_body_free(&body);
}

/* Velocities against differences of positions, of a spin and of cubic quaternions. */
TEST(mote_path_velocity_is_the_derivative)
{
    uint64_t seed = 5;
    test_body body;
    test_body_init(&body, solid_to_mesh(solid_icosphere(1)), 3, &seed);
    const size_t padded = body.field->padded;
    double *numbers = calloc(15 * padded, sizeof *numbers), *control = numbers + 3 * padded;
    for (size_t i = 0; i < 12 * padded; ++i)
        control[i] = i % padded < 3 ? random_between(&seed, -1, 1) : 0;
    for (int spins = 0; spins < 2; ++spins) {
        mote_path_piece piece = {.spins = spins, .turn = {none}, .weights = control};
        for (int i = 0; i < 4; ++i) {
            piece.centre[i] = random_vec3(&seed, 1);
            piece.turn[i].x = 0.2 * i * (1 - spins);
            piece.turn[i].w = 1;
        }
        piece.spin = mote_vec3_make(1, -2, 3);
        const mote_path path = {.pivot = {0.3, 0, 0}, .pieces = &piece, .count = 1};
        for (int i = 1; i < 8; ++i) {
            const double u = i / 8.0, h = 1e-5;
            mote_body_state state;
            mote_path_velocity(&path, &body.body, (mote_place){0, u}, 0.5, numbers, &state);
            const mote_vec3 v = mote_body_position(&body.body, &state, 7);
            mote_path_state(&path, &body.body, u + h, numbers, &state);
            const mote_vec3 after = mote_body_position(&body.body, &state, 7);
            mote_path_state(&path, &body.body, u - h, numbers, &state);
            const mote_vec3 before = mote_body_position(&body.body, &state, 7);
            const mote_vec3 d = mote_scale(mote_sub(after, before), 0.5 / (2 * h));
            assert_close(mote_length(mote_sub(v, d)), 0, 1e-8);
        }
    }
    free(numbers);
    test_body_free(&body);
}

/* Without control points of weights a body moves as if it were rigid. */
TEST(mote_path_without_weights_is_rigid)
{
    uint64_t seed = 7;
    for (int morphs = 0; morphs < 2; ++morphs) {
        test_body body;
        mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
        if (morphs)
            skin_body_init(&body, mesh, 2, 3, &seed);
        else
            test_body_init(&body, mesh, 3, &seed);
        mote_path_piece piece = {.spins = true, .turn = {none}, .spin = {1, -2, 3}};
        for (int i = 0; i < 4; ++i)
            piece.centre[i] = random_vec3(&seed, 1);
        const mote_path path = {.pivot = {0.3, 0, 0}, .pieces = &piece, .count = 1};
        double numbers[3 * 64];
        assert_true(body.field->padded <= 64);
        for (size_t i = 0; i < ROWS_OF(numbers); ++i)
            numbers[i] = 1e9;
        mote_body_state state;
        mote_path_state(&path, &body.body, 0.3, numbers, &state);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            const mote_vec3 got = mote_body_position(&body.body, &state, v);
            const mote_vec3 rigid = mote_pose_apply(&state.pose, mesh->positions[v]);
            assert_close(mote_length(mote_sub(got, rigid)), 0, 1e-14);
        }
        const size_t padded = body.field->padded;
        double expected[3 * 64];
        if (morphs) { /* as written for no matrices and no amounts */
            mote_morph_weights(body.field, NULL, NULL, &state.pose.rotation, expected,
                               expected + padded, expected + 2 * padded);
            assert_memory_equal(numbers, expected, 3 * padded * sizeof *numbers);
        } else {
            mote_path_velocity(&path, &body.body, (mote_place){0, 0.3}, 1, numbers, &state);
            for (size_t i = 0; i < 3 * padded; ++i)
                assert_true(numbers[i] == 0);
        }
        test_body_free(&body);
    }
}
