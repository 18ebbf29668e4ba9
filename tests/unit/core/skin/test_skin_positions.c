/* Positions of skinned and morphed vertices: against their formula, and all roads to them
   against each other. */
#include <stddef.h>

#include "core/body/field_kinds.h"
#include "core/body/lazy.h"
#include "tests/support/skin_scene.h"
#include "tests/support/test.h"

/* The morphed position of a vertex, from the original displacements. */
static mote_vec3 morphed(const skinned *k, const skin_plan *plan, int b, uint32_t vertex)
{
    mote_vec3 x = k->s.mesh[b]->positions[vertex];
    for (uint32_t j = 0; j < plan->targets; ++j)
        x = mote_add_scaled(x, k->amounts[b][j], target_move(k->s.mesh[b], plan, j, vertex));
    return x;
}

/* Against the formula: sum of w_b M_b (x + sum of m_k d_k), then the pose. Displacements are
   stored as floats. */
TEST(positions_are_blended_matrices_of_morphed_vertices)
{
    static const skin_plan all[] = {{6, 3, 0}, {0, 0, 4}, {6, 3, 8}};
    for (size_t i = 0; i < ROWS_OF(all); ++i) {
        skinned k;
        skinned_init(&k, 20, 9, all[i]);
        next_pose(&k, 1, 2);
        const double exact = all[i].targets ? 1e-6 * largest_term(&k) : 1e-14;
        const mote_skin *skin = mote_field_skin(k.s.field[0]);
        const mote_pose *pose = &k.s.frame.body[0].pose;
        for (uint32_t v = 0; v < k.s.mesh[0]->vertex_count; ++v) {
            const mote_vec3 x = morphed(&k, &all[i], 0, v);
            double p[3] = {0, 0, 0}, sum = 0;
            for (uint32_t e = skin->start[v]; e < skin->start[v + 1]; ++e) {
                const double(*m)[4] = (const double(*)[4])k.matrix[0][skin->bone[e]];
                sum += (double)skin->weight[e];
                for (int r = 0; r < 3; ++r)
                    p[r] += (double)skin->weight[e] *
                            (m[r][0] * x.x + m[r][1] * x.y + m[r][2] * x.z + m[r][3]);
            }
            assert_true(sum == 1.0);
            const mote_vec3 expected = mote_pose_apply(pose, mote_vec3_make(p[0], p[1], p[2]));
            assert_true(mote_length(mote_sub(expected, k.s.world[0][v])) <= exact * k.s.length);
        }
        skinned_free(&k);
    }
}

/* If a field has a basis, the sum over it gives the same bits. */
static void check_basis(const mote_field *field, const mote_mesh *mesh,
                        const mote_weights *weights, const mote_weights_single *rounded,
                        uint32_t v)
{
    double *phi = malloc(field->padded * sizeof *phi);
    need(phi);
    for (uint32_t j = 0; j < field->padded; ++j)
        phi[j] = (double)NAN; /* all are written */
    field->kind->basis(field, mesh, v, phi);
    const mote_vec3 d = mote_field_displacement(field, mesh, v, weights);
    const mote_vec3 e = mote_weighted_sum(phi, weights, field->padded);
    assert_memory_equal(&d, &e, sizeof d);
    float f[3], g[3];
    mote_field_displacement_single(field, mesh, v, rounded, f);
    mote_weighted_sum_single(phi, rounded, field->padded, g);
    assert_memory_equal(f, g, sizeof f);
    free(phi);
}

/* The weights of a body in single precision, by coordinate. */
static float *single_weights(const skinned *k, int b)
{
    const size_t count = (size_t)3 * k->s.field[b]->padded;
    float *single = calloc(count, sizeof *single);
    need(single);
    for (size_t j = 0; j < count; ++j)
        single[j] = (float)k->weights[b][j];
    return single;
}

static mote_weights_single weights_single(const float *single, uint32_t padded)
{
    return (mote_weights_single){single, single + padded, single + (size_t)2 * padded, padded};
}

/* How far a vertex's displacement in single precision is from that in double. */
static double single_error(const mote_field *field, const mote_mesh *mesh, uint32_t v,
                           const mote_weights *weights, const mote_weights_single *rounded)
{
    float f[3];
    const mote_vec3 d = mote_field_displacement(field, mesh, v, weights);
    mote_field_displacement_single(field, mesh, v, rounded, f);
    return fabs((double)f[0] - d.x) + fabs((double)f[1] - d.y) + fabs((double)f[2] - d.z);
}

/* Checks all ways to get positions: one vertex, eight at once, lazily, summed over the basis,
   and in single precision. */
static void check_roads(skinned *k, int b)
{
    const mote_field *field = k->s.field[b];
    const mote_mesh *mesh = k->s.mesh[b];
    const mote_body_state *state = &k->s.frame.body[b];
    mote_lazy lazy;
    need(mote_lazy_init(&lazy, &k->s.body[b], 64) == MOTE_OK);
    mote_lazy_begin(&lazy, state, false);
    float *single = single_weights(k, b);
    const mote_weights_single rounded = weights_single(single, field->padded);
    for (uint32_t v = 0; v < mesh->vertex_count; v += MOTE_LANES) {
        uint32_t vertices[MOTE_LANES];
        for (uint32_t l = 0; l < MOTE_LANES; ++l)
            vertices[l] = v + l < mesh->vertex_count ? v + l : 0;
        mote_lazy_fetch(&lazy, vertices, MOTE_LANES);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const mote_vec3 p = mote_body_position(&k->s.body[b], state, v);
        const mote_vec3 q = mote_lazy_position(&lazy, v);
        assert_memory_equal(&p, &q, sizeof p);
        assert_memory_equal(&p, &k->s.world[b][v], sizeof p);
        if (field->kind->basis)
            check_basis(field, mesh, &state->weights, &rounded, v);
        assert_true(single_error(field, mesh, v, &state->weights, &rounded) <=
                    1e-4 * largest_term(k) * k->s.length);
    }
    free(single);
    mote_lazy_free(&lazy);
}

TEST(all_roads_to_a_position_give_the_same_bits)
{
    static const skin_plan all[] = {{11, 4, 0}, {0, 0, 3}, {11, 4, 8}};
    for (size_t i = 0; i < ROWS_OF(all); ++i) {
        skinned k;
        skinned_init(&k, 20, 9, all[i]);
        next_pose(&k, 0.3, 2);
        for (int b = 0; b < 2; ++b)
            check_roads(&k, b);
        skinned_free(&k);
    }
}

/* The amounts are small, so that no rounding is magnified. */
TEST(positions_in_single_precision_are_near)
{
    static const skin_plan all[] = {{6, 3, 0}, {0, 0, 2}, {6, 3, 2}};
    for (size_t i = 0; i < ROWS_OF(all); ++i) {
        skinned k;
        skinned_init(&k, 20, 9, all[i]);
        next_pose(&k, 0.5, 2);
        const mote_field *field = k.s.field[0];
        for (uint32_t j = 0; j < k.targets; ++j)
            k.amounts[0][j] = 0.8 - 1.7 * j;
        skinned_deform(&k);
        float *single = single_weights(&k, 0);
        const mote_weights_single rounded = weights_single(single, field->padded);
        const mote_weights *weights = &k.s.frame.body[0].weights;
        for (uint32_t v = 0; v < k.s.mesh[0]->vertex_count; ++v)
            assert_true(single_error(field, k.s.mesh[0], v, weights, &rounded) <=
                        1e-5 * k.s.length);
        free(single);
        skinned_free(&k);
    }
}

/* Against the basis: the same functions in ascending order, all others 0. */
TEST(functions_at_a_vertex_are_those_that_are_not_zero)
{
    skinned k;
    skinned_init(&k, 20, 9, (skin_plan){11, 4, 0});
    const mote_field *field = k.s.field[0];
    const mote_mesh *mesh = k.s.mesh[0];
    uint32_t functions[64];
    double values[64], basis[64], listed[64];
    assert_true(field->padded <= ROWS_OF(basis) && 2 * field->most <= ROWS_OF(values));
    uint32_t most = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const uint32_t count = field->kind->sparse(field, mesh, v, functions, values);
        field->kind->basis(field, mesh, v, basis);
        memset(listed, 0, sizeof listed);
        for (uint32_t i = 0; i < count; ++i) {
            assert_true(i == 0 || functions[i] > functions[i - 1]);
            assert_true(functions[i] < field->count);
            listed[functions[i]] = values[i];
        }
        assert_memory_equal(listed, basis, field->padded * sizeof *basis);
        most = count > most ? count : most;
    }
    assert_int_equal(most, field->most);
    skinned_free(&k);
}
