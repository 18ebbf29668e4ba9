/* Full deformation against single positions, and both against the definition. */
#include "core/body/deform.h"

#include "core/body/lazy.h"

#include "tests/support/bodies.h"
#include "tests/support/test.h"

/* J, or minus the number of modes. */
static const int field_sizes[] = {0, 1, 7, 8, 9, 14, 16, 17, 256, -1, -2, -3, -5, -6, -85};
enum { FIELD_SIZES = sizeof field_sizes / sizeof *field_sizes };

static mote_deform *deform_of(const mote_body *body)
{
    mote_deform *deform = NULL;
    if (mote_deform_create(body, &deform) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return deform;
}

TEST(all_single_and_lazy_positions_are_the_same_bits)
{
    uint64_t seed = 1;
    const uint32_t vertex_counts[] = {3, 4, 7, 8, 9, 15, 16, 17, 63, 100, 257};
    for (size_t n = 0; n < sizeof vertex_counts / sizeof *vertex_counts; ++n) {
        for (int k = 0; k < FIELD_SIZES; ++k) {
            test_body b;
            mote_mesh *mesh = solid_to_mesh(solid_fan(vertex_counts[n], 0));
            test_body_init(&b, mesh, field_sizes[k], &seed);
            const mote_body_state state = test_body_state(&b, 1, &seed);
            mote_vec3 world[257 + 1];
            memset(world, 0xa5, sizeof world);
            mote_deform *deform = deform_of(&b.body);
            mote_deform_all(deform, &state, world);
            mote_lazy lazy;
            assert_int_equal(mote_lazy_init(&lazy, &b.body, 4), MOTE_OK);
            mote_lazy_begin(&lazy, &state, false);
            for (uint32_t v = 0; v < vertex_counts[n]; ++v) {
                const mote_vec3 one = mote_body_position(&b.body, &state, v);
                const mote_vec3 visited = mote_lazy_position(&lazy, v);
                assert_memory_equal(&world[v], &one, sizeof one);
                assert_memory_equal(&visited, &one, sizeof one);
            }
            /* nothing is written after the last vertex */
            const unsigned char *behind = (const unsigned char *)&world[vertex_counts[n]];
            for (size_t i = 0; i < sizeof *world; ++i)
                assert_int_equal(behind[i], 0xa5);
            mote_lazy_free(&lazy);
            mote_deform_destroy(deform);
            test_body_free(&b);
        }
    }
}

/* R x + t + sum_j phi_j w_j in long double. */
TEST(all_matches_the_definition)
{
    uint64_t seed = 2;
    for (int k = 0; k < FIELD_SIZES; ++k) {
        test_body b;
        test_body_init(&b, solid_to_mesh(solid_icosphere(2)), field_sizes[k], &seed);
        const mote_body_state state = test_body_state(&b, 0.2, &seed);
        mote_vec3 *world = malloc(b.mesh->vertex_count * sizeof *world);
        assert_non_null(world);
        mote_deform *deform = deform_of(&b.body);
        mote_deform_all(deform, &state, world);
        for (uint32_t v = 0; v < b.mesh->vertex_count; ++v) {
            double phi[MOTE_FIELD_SUMMED] = {0};
            b.field->kind->basis(b.field, b.mesh, v, phi);
            const mote_vec3 rest = b.mesh->positions[v];
            const double got[3] = {world[v].x, world[v].y, world[v].z};
            const double move[3] = {state.pose.translation.x, state.pose.translation.y,
                                    state.pose.translation.z};
            for (int c = 0; c < 3; ++c) {
                const double *row = state.pose.rotation.m[c];
                long double sum = (long double)row[0] * rest.x + (long double)row[1] * rest.y +
                                  (long double)row[2] * rest.z + move[c];
                for (uint32_t j = 0; j < b.field->count; ++j)
                    sum += (long double)phi[j] * b.weights[c][j];
                assert_close(got[c], sum, 2e-14);
            }
        }
        free(world);
        mote_deform_destroy(deform);
        test_body_free(&b);
    }
}

/* A translated pose translates each vertex. A mode of a linear field does not rotate with the
   body, because weights are in world axes. */
TEST(all_adds_weights_in_world_axes)
{
    const mote_vec3 mode[3] = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    mote_mesh *mesh = solid_to_mesh(solid_triangle());
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_modes(mode, 1, 3, &field), MOTE_OK);
    const mote_body body = {.mesh = mesh, .field = field};
    double x[8] = {5};
    double y[8] = {0, 6};
    double z[8] = {0, 0, 7};
    const mote_body_state state = {.pose = {{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, {10, 20, 30}},
                                   .weights = {x, y, z, 3, 8}};
    mote_deform *deform = deform_of(&body);
    mote_vec3 world[3];
    mote_deform_all(deform, &state, world);
    const mote_vec3 expected[3] = {{15, 26, 37}, {15, 29, 37}, {11, 26, 37}};
    assert_memory_equal(world, expected, sizeof world);
    mote_deform_destroy(deform);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

TEST(all_scaled_by_powers_of_two_keeps_its_bits)
{
    for (int k = -40; k <= 40; k += 20) {
        mote_vec3 world[2][42];
        for (int i = 0; i < 2; ++i) {
            uint64_t seed = 3;
            const double scale = i ? ldexp(1, k) : 1;
            solid s = solid_icosphere(1);
            for (size_t c = 0; c < 3 * s.vertex_count; ++c)
                s.xyz[c] *= scale;
            test_body b;
            mote_mesh *mesh = solid_to_mesh(s);
            test_body_init(&b, mesh, 14, &seed);
            mote_body_state state = test_body_state(&b, scale, &seed);
            mote_deform *deform = deform_of(&b.body);
            mote_deform_all(deform, &state, world[i]);
            mote_deform_destroy(deform);
            test_body_free(&b);
        }
        for (int v = 0; v < 42; ++v) {
            const mote_vec3 back = mote_scale(world[1][v], ldexp(1, -k));
            assert_memory_equal(&back, &world[0][v], sizeof back);
        }
    }
}

TEST(bytes_grow_by_the_table)
{
    uint64_t seed = 4;
    size_t bytes[2];
    for (int i = 0; i < 2; ++i) {
        test_body b;
        test_body_init(&b, solid_to_mesh(solid_fan(17, 0)), i ? 9 : 8, &seed);
        mote_deform *deform = deform_of(&b.body);
        bytes[i] = mote_deform_bytes(deform);
        mote_deform_destroy(deform);
        test_body_free(&b);
    }
    assert_int_equal(bytes[1] - bytes[0], 24 * 8 * sizeof(double));
    assert_in_range(bytes[0], 24 * 11 * sizeof(double), 24 * 11 * sizeof(double) + 128);
    mote_deform_destroy(NULL);
}
