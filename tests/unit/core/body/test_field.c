/* Fields of the three kinds against closed forms, finite differences and explicit sums. */
#include "core/body/field.h"

#include "tests/support/bodies.h"
#include "tests/support/test.h"

/* Weights in the three padded arrays. */
typedef struct weight_set {
    double x[MOTE_FIELD_SUMMED], y[MOTE_FIELD_SUMMED], z[MOTE_FIELD_SUMMED];
    mote_weights weights;
} weight_set;

static void draw_weights(weight_set *set, const mote_field *field, uint64_t *seed)
{
    memset(set, 0, sizeof *set);
    for (uint32_t j = 0; j < field->count; ++j) {
        const mote_vec3 w = random_vec3(seed, 1);
        set->x[j] = w.x;
        set->y[j] = w.y;
        set->z[j] = w.z;
    }
    set->weights = (mote_weights){set->x, set->y, set->z, field->count, field->padded};
}

static mote_field *csrbf_field(const mote_vec3 *centres, uint32_t count, double support)
{
    mote_field *field = NULL;
    if (mote_field_create_csrbf(centres, count, support, &field) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return field;
}

/* count random centres in a cube of half side 1.2 around the unit sphere. */
static mote_field *random_csrbf(uint32_t count, double support, uint64_t *seed)
{
    mote_vec3 centres[MOTE_FIELD_SUMMED];
    for (uint32_t j = 0; j < count; ++j)
        centres[j] = random_vec3(seed, 1.2);
    return csrbf_field(centres, count, support);
}

static mote_field *random_modes(const mote_mesh *mesh, uint32_t count, uint64_t *seed)
{
    mote_vec3 *modes = malloc((size_t)count * mesh->vertex_count * sizeof *modes);
    assert_non_null(modes);
    for (size_t i = 0; i < (size_t)count * mesh->vertex_count; ++i)
        modes[i] = random_vec3(seed, 0.3);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_modes(modes, count, mesh->vertex_count, &field),
                     MOTE_OK);
    free(modes);
    return field;
}

/* (1 - r)^4 (4 r + 1) below 1, in long double. */
static long double wendland(const mote_field *field, uint32_t j, mote_vec3 p)
{
    const long double dx = (long double)p.x - field->centre_x[j];
    const long double dy = (long double)p.y - field->centre_y[j];
    const long double dz = (long double)p.z - field->centre_z[j];
    const long double r = sqrtl(dx * dx + dy * dy + dz * dz) / field->support;
    return r < 1 ? powl(1 - r, 4) * (4 * r + 1) : 0;
}

TEST(csrbf_basis_matches_wendlands_closed_form)
{
    uint64_t seed = 1;
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(2));
    const uint32_t counts[] = {1, 7, 8, 9, 14, 256};
    for (int c = 0; c < 6; ++c) {
        mote_field *field = random_csrbf(counts[c], 0.9, &seed);
        assert_int_equal(field->count, counts[c]);
        assert_int_equal(field->padded, (counts[c] + 7) / 8 * 8);
        int inside = 0;
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            double phi[MOTE_FIELD_SUMMED];
            field->kind->basis(field, mesh, v, phi);
            for (uint32_t j = 0; j < field->padded; ++j) {
                const long double expected =
                    j < field->count ? wendland(field, j, mesh->positions[v]) : 0;
                assert_close(phi[j], expected, 1e-15);
                inside += expected > 0;
            }
        }
        assert_true(inside > 0);
        mote_field_destroy(field);
    }
    mote_mesh_destroy(mesh);
}

/* At fractions of the support on an axis the values are rational: 1 at the centre, 3/16 half
   way out, and 0 at the rim and beyond. */
TEST(csrbf_basis_at_known_distances_is_exact)
{
    const double r[] = {0, 0.25, 0.5, 0.75, 1, 1.0000000000000002, 2, 1e100};
    const double value[] = {1, 81.0 / 128, 3.0 / 16, 1.0 / 64, 0, 0, 0, 0};
    solid s = solid_fan(8, 0);
    for (size_t i = 0; i < 8; ++i)
        solid_set_vertex(&s, i, 5 + 4 * r[i], 6, 7);
    mote_mesh *mesh = solid_to_mesh(s);
    const mote_vec3 centre = {5, 6, 7};
    mote_field *field = csrbf_field(&centre, 1, 4);
    for (uint32_t i = 0; i < 8; ++i) {
        double phi[8];
        mote_vec3 gradient[8];
        field->kind->basis(field, mesh, i, phi);
        field->kind->gradient(field, mesh, i, gradient);
        assert_true(phi[0] == value[i]);
        const double q = r[i] < 1 ? 1 - r[i] : 0;
        assert_close(gradient[0].x, -20 * r[i] * q * q * q / 4, 1e-15);
        assert_true(gradient[0].y == 0 && gradient[0].z == 0);
    }
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

TEST(csrbf_far_beyond_a_tiny_support_is_exactly_zero)
{
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
    uint64_t seed = 2;
    const double support[] = {1e-3, 1e-100, 1e-160, 1e-300, 1e-307};
    for (int k = 0; k < 5; ++k) {
        const mote_vec3 centre = {0, 0, 0};
        mote_field *field = csrbf_field(&centre, 1, support[k]);
        weight_set set;
        draw_weights(&set, field, &seed);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            double phi[8];
            mote_vec3 gradient[8];
            field->kind->basis(field, mesh, v, phi);
            field->kind->gradient(field, mesh, v, gradient);
            const mote_vec3 d = mote_field_displacement(field, mesh, v, &set.weights);
            assert_true(phi[0] == 0 && d.x == 0 && d.y == 0 && d.z == 0);
            const float one[8] = {1};
            const mote_weights_single weights = {one, one, one, 8};
            float single[3];
            mote_field_displacement_single(field, mesh, v, &weights, single);
            assert_true(single[0] == 0 && single[1] == 0 && single[2] == 0);
            assert_true(gradient[0].x == 0 && gradient[0].y == 0 && gradient[0].z == 0);
        }
        mote_field_destroy(field);
    }
    mote_mesh_destroy(mesh);
}

/* The mesh with vertex v moved by d. */
static mote_mesh *moved_vertex(const solid *s, uint32_t v, mote_vec3 d)
{
    solid copy = solid_allocate(s->vertex_count, s->triangle_count);
    memcpy(copy.xyz, s->xyz, 3 * s->vertex_count * sizeof(double));
    memcpy(copy.faces, s->faces, 3 * s->triangle_count * sizeof(uint32_t));
    const double *p = s->xyz + (size_t)3 * v;
    solid_set_vertex(&copy, v, p[0] + d.x, p[1] + d.y, p[2] + d.z);
    return solid_to_mesh(copy);
}

TEST(csrbf_gradient_matches_finite_differences)
{
    uint64_t seed = 3;
    solid s = solid_icosphere(0);
    mote_mesh *mesh = moved_vertex(&s, 0, mote_vec3_make(0, 0, 0));
    mote_field *field = random_csrbf(14, 1.1, &seed);
    const double h = 1e-5;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        mote_vec3 gradient[16];
        field->kind->gradient(field, mesh, v, gradient);
        for (int axis = 0; axis < 3; ++axis) {
            const mote_vec3 step = {axis == 0 ? h : 0, axis == 1 ? h : 0, axis == 2 ? h : 0};
            mote_mesh *up = moved_vertex(&s, v, step);
            mote_mesh *down = moved_vertex(&s, v, mote_scale(step, -1));
            double phi_up[16];
            double phi_down[16];
            field->kind->basis(field, up, v, phi_up);
            field->kind->basis(field, down, v, phi_down);
            for (uint32_t j = 0; j < 16; ++j) {
                const double g[3] = {gradient[j].x, gradient[j].y, gradient[j].z};
                assert_close(g[axis], (phi_up[j] - phi_down[j]) / (2 * h), 1e-8);
            }
            mote_mesh_destroy(up);
            mote_mesh_destroy(down);
        }
    }
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
    solid_free(&s);
}

/* Two mirrored centres give mirrored fields; a body translated with its centres keeps its
   values. */
TEST(csrbf_basis_is_symmetric_and_translates)
{
    const mote_vec3 pair[2] = {{0.5, 0.25, 1}, {-0.5, 0.25, 1}};
    mote_field *field = csrbf_field(pair, 2, 2);
    solid s = solid_fan(4, 0);
    solid_set_vertex(&s, 0, 0.125, 0.5, 0.75);
    solid_set_vertex(&s, 1, -0.125, 0.5, 0.75);
    solid_set_vertex(&s, 2, 0.125 + 8, 0.5 - 16, 0.75);
    mote_mesh *mesh = solid_to_mesh(s);
    const mote_vec3 moved[2] = {{8.5, -15.75, 1}, {7.5, -15.75, 1}};
    mote_field *far = csrbf_field(moved, 2, 2);
    double right[8];
    double left[8];
    double shifted[8];
    field->kind->basis(field, mesh, 0, right);
    field->kind->basis(field, mesh, 1, left);
    far->kind->basis(far, mesh, 2, shifted);
    assert_true(right[0] == left[1] && right[1] == left[0] && right[0] > right[1]);
    assert_true(right[0] == shifted[0] && right[1] == shifted[1]);
    mote_field_destroy(field);
    mote_field_destroy(far);
    mote_mesh_destroy(mesh);
}

TEST(csrbf_scaled_by_powers_of_two_keeps_its_bits)
{
    for (int k = -40; k <= 40; k += 8) {
        mote_mesh *mesh[2];
        mote_field *field[2];
        weight_set set[2];
        for (int i = 0; i < 2; ++i) {
            uint64_t seed = 4;
            const double scale = i ? ldexp(1, k) : 1;
            solid s = solid_icosphere(1);
            for (size_t c = 0; c < 3 * s.vertex_count; ++c)
                s.xyz[c] *= scale;
            mesh[i] = solid_to_mesh(s);
            mote_vec3 centres[14];
            for (int j = 0; j < 14; ++j)
                centres[j] = mote_scale(random_vec3(&seed, 1.2), scale);
            field[i] = csrbf_field(centres, 14, 0.9 * scale);
            draw_weights(&set[i], field[i], &seed);
            for (int j = 0; j < 14; ++j)
                set[i].x[j] *= scale, set[i].y[j] *= scale, set[i].z[j] *= scale;
        }
        for (uint32_t v = 0; v < mesh[0]->vertex_count; ++v) {
            const mote_vec3 a = mote_field_displacement(field[0], mesh[0], v, &set[0].weights);
            const mote_vec3 b = mote_field_displacement(field[1], mesh[1], v, &set[1].weights);
            assert_true(b.x == ldexp(a.x, k) && b.y == ldexp(a.y, k) && b.z == ldexp(a.z, k));
        }
        for (int i = 0; i < 2; ++i) {
            mote_field_destroy(field[i]);
            mote_mesh_destroy(mesh[i]);
        }
    }
}

/* The sum over basis() in eight lanes, added in the order specified in the header. */
static mote_vec3 sum_by_lanes(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                              const weight_set *set)
{
    double phi[MOTE_FIELD_SUMMED];
    double sum[3][8] = {{0}};
    const double *weight[3] = {set->x, set->y, set->z};
    double total[3];
    field->kind->basis(field, mesh, vertex, phi);
    for (int c = 0; c < 3; ++c) {
        for (uint32_t j = 0; j < field->padded; ++j)
            sum[c][j % 8] += phi[j] * weight[c][j];
        const double even = (sum[c][0] + sum[c][4]) + (sum[c][2] + sum[c][6]);
        const double odd = (sum[c][1] + sum[c][5]) + (sum[c][3] + sum[c][7]);
        total[c] = even + odd;
    }
    return mote_vec3_make(total[0], total[1], total[2]);
}

TEST(displacement_equals_lane_sum_over_basis_bit_for_bit)
{
    uint64_t seed = 8;
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(2));
    const uint32_t counts[] = {1, 7, 8, 9, 14, 16, 17, 256};
    const uint32_t mode_counts[] = {1, 2, 3, 5, 6, 85};
    for (int c = 0; c < 8 + 6; ++c) {
        mote_field *field = c < 8 ? random_csrbf(counts[c], 1.3, &seed)
                                  : random_modes(mesh, mode_counts[c - 8], &seed);
        weight_set set;
        draw_weights(&set, field, &seed);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            const mote_vec3 got = mote_field_displacement(field, mesh, v, &set.weights);
            const mote_vec3 expected = sum_by_lanes(field, mesh, v, &set);
            assert_memory_equal(&got, &expected, sizeof got);
        }
        mote_field_destroy(field);
    }
    mote_mesh_destroy(mesh);
}

/* Single precision may add only the rounding of positions (2^-24 of 1.2), of phi and of the
   sum. */
TEST(displacement_single_stays_near_double)
{
    uint64_t seed = 12;
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(2));
    mote_field *fields[] = {random_csrbf(14, 1.3, &seed), random_csrbf(256, 0.5, &seed),
                            random_modes(mesh, 5, &seed)};
    for (int c = 0; c < 3; ++c) {
        weight_set set;
        draw_weights(&set, fields[c], &seed);
        float single[3][MOTE_FIELD_SUMMED];
        for (int j = 0; j < MOTE_FIELD_SUMMED; ++j) {
            single[0][j] = (float)set.x[j];
            single[1][j] = (float)set.y[j];
            single[2][j] = (float)set.z[j];
        }
        const mote_weights_single weights = {single[0], single[1], single[2],
                                             fields[c]->padded};
        double furthest = 0;
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            const mote_vec3 d = mote_field_displacement(fields[c], mesh, v, &set.weights);
            float got[3];
            mote_field_displacement_single(fields[c], mesh, v, &weights, got);
            const mote_vec3 error =
                mote_sub(mote_vec3_make((double)got[0], (double)got[1], (double)got[2]), d);
            furthest = fmax(furthest, mote_length(error));
        }
        assert_true(furthest < 2e-5);
        assert_true(furthest > 0);
        mote_field_destroy(fields[c]);
    }
    mote_mesh_destroy(mesh);
}

/* The estimate stays within its promised error, also far from the origin, where floats are
   coarse. */
TEST(estimate_is_as_near_as_it_says)
{
    uint64_t seed = 21;
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(2));
    const uint32_t counts[3] = {1, 14, 256};
    for (int c = 0; c < 3; ++c) {
        mote_field *field = random_csrbf(counts[c], c == 2 ? 0.5 : 1.3, &seed);
        weight_set set;
        draw_weights(&set, field, &seed);
        float single[3][MOTE_FIELD_SUMMED];
        uint16_t functions[MOTE_FIELD_SUMMED];
        double sum[3] = {0, 0, 0};
        for (uint32_t j = 0; j < field->count; ++j) {
            functions[j] = (uint16_t)j;
            single[0][j] = (float)set.x[j];
            single[1][j] = (float)set.y[j];
            single[2][j] = (float)set.z[j];
            for (int r = 0; r < 3; ++r)
                sum[r] += fabs((double)single[r][j]);
        }
        const float *const by[3] = {single[0], single[1], single[2]};
        double most = 0;
        for (uint32_t first = 0; first + MOTE_LANES <= mesh->vertex_count; ++first) {
            uint32_t v[MOTE_LANES];
            for (uint32_t l = 0; l < MOTE_LANES; ++l)
                v[l] = first + l;
            float got[3][MOTE_LANES];
            const double factor =
                (double)field->kind->estimate(field, mesh, v, functions, field->count, by, got);
            assert_true(factor < 1e-4);
            for (uint32_t l = 0; l < MOTE_LANES; ++l) {
                const mote_vec3 d = mote_field_displacement(field, mesh, v[l], &set.weights);
                const double off[3] = {d.x - (double)got[0][l], d.y - (double)got[1][l],
                                       d.z - (double)got[2][l]};
                for (int r = 0; r < 3; ++r) {
                    /* the weights themselves were rounded */
                    assert_true(fabs(off[r]) <= (factor + 0x1p-24) * sum[r]);
                    most = fmax(most, fabs(off[r]));
                }
            }
        }
        assert_true(most > 0);
        mote_field_destroy(field);
    }
    mote_mesh_destroy(mesh);
}

/* A kind without a displacement of its own is summed over its basis. */
TEST(displacement_of_a_kind_without_one_sums_its_basis)
{
    uint64_t seed = 9;
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
    mote_field *field = random_csrbf(14, 1.3, &seed);
    mote_field_kind kind = *field->kind;
    kind.displacement = NULL;
    mote_field plain = *field;
    plain.kind = &kind;
    weight_set set;
    draw_weights(&set, field, &seed);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const mote_vec3 got = mote_field_displacement(&plain, mesh, v, &set.weights);
        const mote_vec3 expected = mote_field_displacement(field, mesh, v, &set.weights);
        assert_memory_equal(&got, &expected, sizeof got);
    }
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

/* Likewise in single precision, dense and sparse. */
TEST(displacement_single_of_a_kind_without_one_sums_its_basis)
{
    uint64_t seed = 10;
    test_body bodies[2];
    test_body_init(&bodies[0], solid_to_mesh(solid_icosphere(1)), 14, &seed);
    skin_body_init(&bodies[1], solid_to_mesh(solid_icosphere(1)), 5, 0, &seed);
    for (int b = 0; b < 2; ++b) {
        const mote_field *field = bodies[b].field;
        mote_field_kind kind = *field->kind;
        kind.displacement = NULL;
        kind.displacement_single = NULL;
        mote_field plain = *field;
        plain.kind = &kind;
        weight_set set;
        draw_weights(&set, field, &seed);
        float single[3][MOTE_FIELD_SUMMED];
        for (uint32_t j = 0; j < field->padded; ++j) {
            single[0][j] = (float)set.x[j];
            single[1][j] = (float)set.y[j];
            single[2][j] = (float)set.z[j];
        }
        const mote_weights_single weights = {single[0], single[1], single[2], field->padded};
        for (uint32_t v = 0; v < bodies[b].mesh->vertex_count; ++v) {
            const mote_vec3 expected =
                mote_field_displacement(field, bodies[b].mesh, v, &set.weights);
            const mote_vec3 sum =
                mote_field_displacement(&plain, bodies[b].mesh, v, &set.weights);
            float got[3];
            mote_field_displacement_single(&plain, bodies[b].mesh, v, &weights, got);
            assert_close(mote_length(mote_sub(sum, expected)), 0, 1e-14);
            const mote_vec3 rounded = {(double)got[0], (double)got[1], (double)got[2]};
            assert_close(mote_length(mote_sub(rounded, expected)), 0, 1e-5);
        }
        test_body_free(&bodies[b]);
    }
}

TEST(static_field_displaces_by_zero)
{
    mote_mesh *mesh = solid_to_mesh(solid_triangle());
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_static(&field), MOTE_OK);
    assert_string_equal(field->kind->name, "static");
    assert_int_equal(field->count, 0);
    assert_int_equal(field->padded, 0);
    const mote_weights weights = {NULL, NULL, NULL, 0, 0};
    const mote_vec3 d = mote_field_displacement(field, mesh, 1, &weights);
    assert_true(d.x == 0 && d.y == 0 && d.z == 0);
    mote_vec3 gradient = {1, 2, 3};
    field->kind->gradient(field, mesh, 1, &gradient);
    assert_true(gradient.x == 1 && gradient.y == 2 && gradient.z == 3);
    mote_field_destroy(field);
    mote_field_destroy(NULL);
    mote_mesh_destroy(mesh);
}

TEST(bytes_count_centres_and_modes)
{
    uint64_t seed = 10;
    mote_field *field = random_csrbf(9, 1, &seed);
    assert_int_equal(field->bytes, sizeof *field + 3 * 16 * (sizeof(double) + sizeof(float)));
    mote_field_destroy(field);
    mote_mesh *mesh = solid_to_mesh(solid_triangle());
    field = random_modes(mesh, 3, &seed);
    assert_in_range(field->bytes, sizeof *field + 3 * 16 * sizeof(double),
                    sizeof *field + 3 * 16 * sizeof(double) + 64);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

static void expect_csrbf_error(const mote_vec3 *centres, uint32_t count, double support,
                               const char *text)
{
    mote_field mark;
    mote_field *field = &mark;
    assert_int_equal(mote_field_create_csrbf(centres, count, support, &field), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), text);
    assert_ptr_equal(field, &mark);
}

TEST(create_csrbf_with_bad_input_says_what)
{
    mote_vec3 centre[2] = {{0, 0, 0}, {1, 0, 0}};
    expect_csrbf_error(centre, 0, 1, "a CSRBF field has 1 to 65528 centres, not 0");
    expect_csrbf_error(centre, 65529, 1, "a CSRBF field has 1 to 65528 centres, not 65529");
    expect_csrbf_error(
        centre, 2, 0, "the support radius is 0; it must be finite and above 2^-1024, 5.6e-309");
    expect_csrbf_error(
        centre, 2, -1,
        "the support radius is -1; it must be finite and above 2^-1024, 5.6e-309");
    expect_csrbf_error(
        centre, 2, HUGE_VAL,
        "the support radius is inf; it must be finite and above 2^-1024, 5.6e-309");
    expect_csrbf_error(
        centre, 2, 1e-310, /* its reciprocal overflows */
        "the support radius is 1e-310; it must be finite and above 2^-1024, 5.6e-309");
    expect_csrbf_error(
        centre, 2, nan(""),
        "the support radius is nan; it must be finite and above 2^-1024, 5.6e-309");
    centre[1].x = nan("");
    expect_csrbf_error(centre, 2, 1, "centre 1 is not finite");
    centre[1] = mote_vec3_make(0, nan(""), 0);
    expect_csrbf_error(centre, 2, 1, "centre 1 is not finite");
    centre[1] = mote_vec3_make(0, 0, -HUGE_VAL);
    expect_csrbf_error(centre, 2, 1, "centre 1 is not finite");
}
