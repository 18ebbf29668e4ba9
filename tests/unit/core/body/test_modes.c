/* Linear modes against explicit sums, closed forms and linear maps. */
#include "core/body/field.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

/* Weights in the three padded arrays. */
typedef struct weight_set {
    double x[MOTE_FIELD_SUMMED], y[MOTE_FIELD_SUMMED], z[MOTE_FIELD_SUMMED];
    mote_weights weights;
} weight_set;

TEST(modes_displacement_reproduces_scaled_columns)
{
    uint64_t seed = 5;
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
    enum { COUNT = 5 };
    mote_vec3 *modes = malloc((size_t)COUNT * mesh->vertex_count * sizeof *modes);
    assert_non_null(modes);
    for (size_t i = 0; i < (size_t)COUNT * mesh->vertex_count; ++i)
        modes[i] = random_vec3(&seed, 1);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_modes(modes, COUNT, mesh->vertex_count, &field),
                     MOTE_OK);
    assert_int_equal(field->count, 15);
    assert_int_equal(field->padded, 16);
    weight_set set;
    memset(&set, 0, sizeof set);
    set.weights = (mote_weights){set.x, set.y, set.z, field->count, field->padded};
    double s[COUNT];
    for (int m = 0; m < COUNT; ++m) {
        s[m] = random_between(&seed, -2, 2);
        set.x[3 * m] = set.y[3 * m + 1] = set.z[3 * m + 2] = s[m];
    }
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        long double x = 0;
        long double y = 0;
        long double z = 0;
        for (int m = 0; m < COUNT; ++m) {
            const mote_vec3 u = modes[(size_t)m * mesh->vertex_count + v];
            x += (long double)s[m] * u.x;
            y += (long double)s[m] * u.y;
            z += (long double)s[m] * u.z;
        }
        const mote_vec3 d = mote_field_displacement(field, mesh, v, &set.weights);
        assert_close(d.x, x, 4e-15);
        assert_close(d.y, y, 4e-15);
        assert_close(d.z, z, 4e-15);
    }
    free(modes);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

/* A single mode of weight s moves vertex x exactly to x + s u. */
TEST(modes_with_one_mode_is_exact)
{
    uint64_t seed = 6;
    mote_mesh *mesh = solid_to_mesh(solid_grid(4, 3));
    mote_vec3 modes[20];
    for (int i = 0; i < 20; ++i)
        modes[i] = random_vec3(&seed, 1);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_modes(modes, 1, 20, &field), MOTE_OK);
    double x[8] = {0.7};
    double y[8] = {0, 0.7};
    double z[8] = {0, 0, 0.7};
    const mote_weights weights = {x, y, z, 3, 8};
    for (uint32_t v = 0; v < 20; ++v) {
        const mote_vec3 d = mote_field_displacement(field, mesh, v, &weights);
        assert_true(d.x == 0.7 * modes[v].x && d.y == 0.7 * modes[v].y &&
                    d.z == 0.7 * modes[v].z);
    }
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

/* Displacements linear in the rest position have a known gradient: column c of basis 3 m + c
   has the gradient of that coordinate. In a flat ring only its in-plane part remains. */
TEST(modes_gradient_of_a_linear_map_is_the_map)
{
    uint64_t seed = 7;
    const double map[3][3] = {{0.3, -0.7, 0.2}, {1.1, 0.4, -0.5}, {-0.2, 0.6, 0.9}};
    for (int exponent = -300; exponent <= 300; exponent += 150) {
        solid s = solid_icosphere(1);
        for (size_t i = 0; i < 3 * s.vertex_count; ++i)
            s.xyz[i] = ldexp(s.xyz[i], exponent);
        mote_mesh *mesh = solid_to_mesh(s);
        mote_vec3 modes[42];
        for (uint32_t v = 0; v < 42; ++v) {
            const mote_vec3 p = mesh->positions[v];
            double u[3];
            for (int c = 0; c < 3; ++c)
                u[c] = map[c][0] * p.x + map[c][1] * p.y + map[c][2] * p.z + ldexp(c, exponent);
            modes[v] = mote_vec3_make(u[0], u[1], u[2]);
        }
        mote_field *field = NULL;
        assert_int_equal(mote_field_create_modes(modes, 1, 42, &field), MOTE_OK);
        const uint32_t v = (uint32_t)(random_bits(&seed) % 42);
        mote_vec3 gradient[8];
        field->kind->gradient(field, mesh, v, gradient);
        for (int c = 0; c < 8; ++c) {
            assert_close(gradient[c].x, c < 3 ? map[c][0] : 0, 1e-6);
            assert_close(gradient[c].y, c < 3 ? map[c][1] : 0, 1e-6);
            assert_close(gradient[c].z, c < 3 ? map[c][2] : 0, 1e-6);
        }
        mote_field_destroy(field);
        mote_mesh_destroy(mesh);
    }
}

TEST(modes_gradient_in_a_flat_ring_has_no_normal_part)
{
    mote_mesh *mesh = solid_to_mesh(solid_grid(2, 2));
    mote_vec3 modes[9];
    for (uint32_t v = 0; v < 9; ++v)
        modes[v] = mote_vec3_make(3 * mesh->positions[v].x - 2 * mesh->positions[v].y, 0, 1);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_modes(modes, 1, 9, &field), MOTE_OK);
    for (uint32_t v = 0; v < 9; ++v) {
        mote_vec3 gradient[8];
        field->kind->gradient(field, mesh, v, gradient);
        assert_close(gradient[0].x, 3, 1e-6);
        assert_close(gradient[0].y, -2, 1e-6);
        assert_close(gradient[0].z, 0, 1e-6);
        for (int c = 1; c < 8; ++c)
            assert_close(mote_length(gradient[c]), 0, 1e-12);
    }
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

/* A ring without extent determines no slope. */
TEST(modes_gradient_where_all_neighbours_coincide_is_zero)
{
    solid s = solid_triangle();
    for (size_t i = 0; i < 3; ++i)
        solid_set_vertex(&s, i, 2, 3, 4);
    mote_mesh *mesh = solid_to_mesh(solid_join(s, solid_tetrahedron(), 1));
    mote_vec3 modes[7];
    for (int i = 0; i < 7; ++i)
        modes[i] = mote_vec3_make(i, 1 - i, i * i);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_modes(modes, 1, 7, &field), MOTE_OK);
    mote_vec3 gradient[MOTE_FIELD_SUMMED];
    field->kind->gradient(field, mesh, 1, gradient);
    for (uint32_t j = 0; j < field->padded; ++j)
        assert_true(gradient[j].x == 0 && gradient[j].y == 0 && gradient[j].z == 0);
    field->kind->gradient(field, mesh, 4, gradient);
    assert_true(mote_length(gradient[0]) > 0);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

TEST(create_modes_with_bad_input_says_what)
{
    mote_vec3 modes[6] = {{0, 0, 0}};
    mote_field mark;
    mote_field *field = &mark;
    assert_int_equal(mote_field_create_modes(modes, 0, 3, &field), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "a field has 1 to 21842 linear modes, not 0");
    assert_int_equal(mote_field_create_modes(modes, 21843, 3, &field), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "a field has 1 to 21842 linear modes, not 21843");
    const mote_vec3 bad[3] = {{nan(""), 0, 0}, {0, -HUGE_VAL, 0}, {0, 0, HUGE_VAL}};
    for (int c = 0; c < 3; ++c) {
        modes[4] = bad[c];
        assert_int_equal(mote_field_create_modes(modes, 2, 3, &field), MOTE_EINVAL);
        assert_string_equal(mote_error_text(), "mode 1 is not finite at vertex 1");
    }
    assert_ptr_equal(field, &mark);
}
