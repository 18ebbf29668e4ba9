/* The fit of CSRBF weights against interpolation, an explicit inverse, and symmetry. */
#include "core/body/csrbf_fit.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

enum { MOST = 64 };

static mote_field *csrbf_field(const mote_vec3 *centres, uint32_t count, double support)
{
    mote_field *field = NULL;
    if (mote_field_create_csrbf(centres, count, support, &field) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return field;
}

/* Points in a cube of half side 1, no two closer than `apart`. */
static void spread_points(mote_vec3 *points, uint32_t count, double apart, uint64_t *seed)
{
    for (uint32_t i = 0; i < count;) {
        points[i] = random_vec3(seed, 1);
        uint32_t j = 0;
        while (j < i && mote_distance_squared(points[i], points[j]) >= apart * apart)
            ++j;
        i += j == i;
    }
}

/* A fan of faces over the points, to evaluate the field there. */
static mote_mesh *mesh_of_points(const mote_vec3 *points, uint32_t count)
{
    solid s = solid_fan(count, 0);
    memcpy(s.xyz, points, count * sizeof *points);
    return solid_to_mesh(s);
}

/* The largest error of the field with these weights against the wanted displacements. */
static double interpolation_error(const mote_field *field, const mote_vec3 *centres,
                                  const mote_vec3 *weights, const mote_vec3 *wanted)
{
    double x[MOST + 8] = {0};
    double y[MOST + 8] = {0};
    double z[MOST + 8] = {0};
    for (uint32_t j = 0; j < field->count; ++j) {
        x[j] = weights[j].x;
        y[j] = weights[j].y;
        z[j] = weights[j].z;
    }
    const mote_weights set = {x, y, z, field->count, field->padded};
    mote_mesh *mesh = mesh_of_points(centres, field->count);
    double furthest = 0;
    for (uint32_t i = 0; i < field->count; ++i) {
        const mote_vec3 d = mote_field_displacement(field, mesh, i, &set);
        furthest = fmax(furthest, mote_length(mote_sub(d, wanted[i])));
    }
    mote_mesh_destroy(mesh);
    return furthest;
}

static mote_csrbf_fit *fit_of(const mote_field *field, double *reciprocal)
{
    mote_csrbf_fit *fit = NULL;
    if (mote_csrbf_fit_create(field, &fit, reciprocal) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return fit;
}

TEST(solve_reproduces_control_vectors_to_1e_10)
{
    uint64_t seed = 1;
    const uint32_t counts[] = {3, 12, 14, 64};
    const double supports[] = {0.5, 1.5, 4};
    for (int c = 0; c < 4; ++c) {
        for (int k = 0; k < 3; ++k) {
            mote_vec3 centres[MOST];
            mote_vec3 wanted[MOST];
            mote_vec3 weights[MOST];
            spread_points(centres, counts[c], 0.2, &seed);
            for (uint32_t i = 0; i < counts[c]; ++i)
                wanted[i] = random_vec3(&seed, 1);
            mote_field *field = csrbf_field(centres, counts[c], supports[k]);
            mote_csrbf_fit *fit = fit_of(field, NULL);
            assert_int_equal(mote_csrbf_fit_solve(fit, wanted, weights), MOTE_OK);
            assert_true(interpolation_error(field, centres, weights, wanted) <= 1e-10);
            mote_csrbf_fit_destroy(fit);
            mote_field_destroy(field);
        }
    }
}

static long double wendland_between(mote_vec3 a, mote_vec3 b, double support)
{
    const long double dx = (long double)a.x - b.x;
    const long double dy = (long double)a.y - b.y;
    const long double dz = (long double)a.z - b.z;
    const long double r = sqrtl(dx * dx + dy * dy + dz * dz) / support;
    return r < 1 ? powl(1 - r, 4) * (4 * r + 1) : 0;
}

/* The largest sum of absolute values of a column. */
static long double one_norm(long double m[][2 * MOST], uint32_t first, uint32_t count)
{
    long double most = 0;
    for (uint32_t j = first; j < first + count; ++j) {
        long double sum = 0;
        for (uint32_t i = 0; i < count; ++i)
            sum += fabsl(m[i][j]);
        most = fmaxl(most, sum);
    }
    return most;
}

/* 1 / (|A| |A^-1|) in the 1-norm, by Gauss-Jordan elimination of [A | I] in long double. */
static long double reciprocal_condition(const mote_vec3 *centres, uint32_t count,
                                        double support)
{
    static long double m[MOST][2 * MOST];
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t j = 0; j < count; ++j) {
            m[i][j] = wendland_between(centres[i], centres[j], support);
            m[i][count + j] = i == j;
        }
    }
    const long double norm = one_norm(m, 0, count);
    for (uint32_t k = 0; k < count; ++k) {
        const long double pivot = m[k][k]; /* positive definite: no exchange is needed */
        for (uint32_t j = 0; j < 2 * count; ++j)
            m[k][j] /= pivot;
        for (uint32_t i = 0; i < count; ++i) {
            const long double factor = m[i][k];
            for (uint32_t j = 0; j < 2 * count && i != k; ++j)
                m[i][j] -= factor * m[k][j];
        }
    }
    return 1 / (norm * one_norm(m, count, count));
}

/* The estimate of |A^-1| is a lower bound, and rarely below a third of it. */
TEST(reciprocal_condition_matches_an_explicit_inverse)
{
    uint64_t seed = 2;
    const double supports[] = {0.3, 1, 2, 5, 20};
    for (int k = 0; k < 5; ++k) {
        mote_vec3 centres[14];
        spread_points(centres, 14, 0.25, &seed);
        mote_field *field = csrbf_field(centres, 14, supports[k]);
        double got = 0;
        mote_csrbf_fit *fit = fit_of(field, &got);
        const long double exact = reciprocal_condition(centres, 14, supports[k]);
        assert_true(got >= exact * (1 - 1e-8L));
        assert_true(got <= 3 * exact);
        mote_csrbf_fit_destroy(fit);
        mote_field_destroy(field);
    }
}

TEST(create_with_disjoint_supports_has_condition_one)
{
    const mote_vec3 centres[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const mote_vec3 wanted[3] = {{1, 2, 3}, {-4, 5, 6}, {7, 8, -9}};
    mote_vec3 weights[3];
    mote_field *field = csrbf_field(centres, 3, 1); /* neighbours lie on the rim */
    double reciprocal = 0;
    mote_csrbf_fit *fit = fit_of(field, &reciprocal);
    assert_true(reciprocal == 1);
    assert_int_equal(mote_csrbf_fit_solve(fit, wanted, weights), MOTE_OK);
    assert_memory_equal(weights, wanted, sizeof weights);
    mote_csrbf_fit_destroy(fit);
    mote_field_destroy(field);
}

/* Expects MOTE_ENUMERIC with a text that names the number of centres, and untouched outputs. */
static void expect_singular(const mote_vec3 *centres, uint32_t count, double support)
{
    mote_field *field = csrbf_field(centres, count, support);
    mote_csrbf_fit *const mark = (mote_csrbf_fit *)(void *)field;
    mote_csrbf_fit *fit = mark;
    double reciprocal = -7;
    assert_int_equal(mote_csrbf_fit_create(field, &fit, &reciprocal), MOTE_ENUMERIC);
    assert_ptr_equal(fit, mark);
    assert_true(reciprocal == -7);
    const char *text = mote_error_text();
    assert_non_null(strstr(text, "CSRBF centres is singular to working precision (reciprocal "
                                 "condition "));
    assert_non_null(strstr(text, "); centres must be further apart, or the support radius "
                                 "smaller"));
    mote_field_destroy(field);
}

TEST(create_with_coincident_centres_is_a_numeric_error)
{
    uint64_t seed = 3;
    const uint32_t counts[] = {2, 3, 8, 14, 30, MOST};
    for (int round = 0; round < 1800; ++round) {
        const uint32_t count = counts[round % 6];
        mote_vec3 centres[MOST];
        for (uint32_t i = 0; i < count; ++i)
            centres[i] = random_vec3(&seed, 1);
        const uint32_t copy = 1 + (uint32_t)(random_bits(&seed) % (count - 1));
        centres[copy] = centres[random_bits(&seed) % copy];
        if (round % 2)
            centres[copy].x += 1e-9; /* the matrix differs from a singular one by 1e-17 */
        expect_singular(centres, count, 0.3 + round % 9 * 0.5);
    }
}

TEST(create_of_another_kind_names_it)
{
    mote_field *field = NULL;
    mote_csrbf_fit *fit = NULL;
    assert_int_equal(mote_field_create_static(&field), MOTE_OK);
    assert_int_equal(mote_csrbf_fit_create(field, &fit, NULL), MOTE_EINVAL);
    assert_string_equal(mote_error_text(),
                        "a field of kind static has no centres to fit; CSRBF is needed");
    mote_field_destroy(field);
    const mote_vec3 mode[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    assert_int_equal(mote_field_create_modes(mode, 1, 3, &field), MOTE_OK);
    assert_int_equal(mote_csrbf_fit_create(field, &fit, NULL), MOTE_EINVAL);
    assert_string_equal(mote_error_text(),
                        "a field of kind modes has no centres to fit; CSRBF is needed");
    assert_null(fit);
    mote_field_destroy(field);
    mote_csrbf_fit_destroy(NULL);
}

TEST(solve_with_a_displacement_not_finite_names_the_point)
{
    const mote_vec3 centres[2] = {{0, 0, 0}, {0.5, 0, 0}};
    mote_field *field = csrbf_field(centres, 2, 1);
    mote_csrbf_fit *fit = fit_of(field, NULL);
    const mote_vec3 bad[3] = {{nan(""), 5, 6}, {4, HUGE_VAL, 6}, {4, 5, -HUGE_VAL}};
    mote_vec3 weights[2] = {{1, 1, 1}, {2, 2, 2}};
    const mote_vec3 before[2] = {{1, 1, 1}, {2, 2, 2}};
    for (int c = 0; c < 3; ++c) {
        const mote_vec3 wanted[2] = {{1, 2, 3}, bad[c]};
        assert_int_equal(mote_csrbf_fit_solve(fit, wanted, weights), MOTE_EINVAL);
        assert_string_equal(mote_error_text(),
                            "the displacement of control point 1 is not finite");
        assert_memory_equal(weights, before, sizeof weights);
    }
    mote_csrbf_fit_destroy(fit);
    mote_field_destroy(field);
}

/* Mirrored centres and vectors have mirrored weights. The solution is linear and depends on no
   scale but that of the vectors. */
TEST(solve_keeps_symmetry_linearity_and_scale)
{
    uint64_t seed = 4;
    mote_vec3 centres[14];
    mote_vec3 wanted[14];
    mote_vec3 weights[14];
    mote_vec3 twice[14];
    mote_vec3 mirrored[14];
    spread_points(centres, 14, 0.3, &seed);
    for (int i = 0; i < 14; ++i)
        wanted[i] = random_vec3(&seed, 1);
    mote_field *field = csrbf_field(centres, 14, 1.5);
    mote_csrbf_fit *fit = fit_of(field, NULL);
    assert_int_equal(mote_csrbf_fit_solve(fit, wanted, weights), MOTE_OK);
    for (int i = 0; i < 14; ++i)
        twice[i] = mote_scale(wanted[i], 2);
    assert_int_equal(mote_csrbf_fit_solve(fit, twice, twice), MOTE_OK); /* in place */
    for (int i = 0; i < 14; ++i) {
        assert_true(twice[i].x == 2 * weights[i].x && twice[i].z == 2 * weights[i].z);
        centres[i] = mote_vec3_make(-0x1p-30 * centres[i].x, 0x1p-30 * centres[i].y,
                                    0x1p-30 * centres[i].z);
        mirrored[i] = mote_vec3_make(-wanted[i].x, wanted[i].y, wanted[i].z);
    }
    mote_csrbf_fit_destroy(fit);
    mote_field_destroy(field);
    field = csrbf_field(centres, 14, 1.5 * 0x1p-30);
    fit = fit_of(field, NULL);
    assert_int_equal(mote_csrbf_fit_solve(fit, mirrored, mirrored), MOTE_OK);
    for (int i = 0; i < 14; ++i)
        assert_true(mirrored[i].x == -weights[i].x && mirrored[i].y == weights[i].y &&
                    mirrored[i].z == weights[i].z);
    mote_csrbf_fit_destroy(fit);
    mote_field_destroy(field);
}
