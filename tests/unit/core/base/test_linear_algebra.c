/* Cholesky factors and eigenvectors of random symmetric matrices against their definitions. */
#include "core/base/linear_algebra.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

static mote_mat3 random_symmetric(uint64_t *seed)
{
    mote_mat3 m;
    for (int i = 0; i < 3; ++i) {
        for (int k = i; k < 3; ++k)
            m.m[i][k] = m.m[k][i] = random_between(seed, -1, 1);
    }
    return m;
}

static mote_vec3 column(const mote_mat3 *m, int k)
{
    return mote_vec3_make(m->m[0][k], m->m[1][k], m->m[2][k]);
}

TEST(eigen_symmetric_rises_and_is_a_rotation)
{
    uint64_t seed = 1;
    for (int round = 0; round < 1000; ++round) {
        const mote_mat3 m = random_symmetric(&seed);
        mote_vec3 values;
        mote_mat3 vectors;
        assert_int_equal(mote_eigen_symmetric(&m, &values, &vectors), MOTE_OK);
        const double value[3] = {values.x, values.y, values.z};
        assert_true(value[0] <= value[1] && value[1] <= value[2]);
        for (int k = 0; k < 3; ++k) {
            const mote_vec3 v = column(&vectors, k);
            const mote_vec3 rest = mote_sub(mote_rotate(&m, v), mote_scale(v, value[k]));
            assert_true(mote_length(rest) < 1e-14);
            assert_true(fabs(mote_length(v) - 1) < 1e-14);
        }
        const mote_vec3 third = mote_cross(column(&vectors, 0), column(&vectors, 1));
        assert_true(mote_length(mote_sub(third, column(&vectors, 2))) < 1e-14);
    }
}

TEST(eigen_symmetric_not_finite_is_refused)
{
    uint64_t seed = 2;
    for (int k = 0; k < 9; ++k) {
        mote_mat3 m = random_symmetric(&seed), vectors;
        mote_vec3 values = {7, 7, 7};
        m.m[k / 3][k % 3] = k % 2 ? NAN : HUGE_VAL;
        assert_int_equal(mote_eigen_symmetric(&m, &values, &vectors), MOTE_ENUMERIC);
        assert_string_equal(mote_error_text(),
                            "the matrix is not finite; its eigenvectors do not exist");
        assert_true(values.x == 7);
    }
}

TEST(cholesky_of_an_indefinite_matrix_is_refused)
{
    const double matrix[9] = {1, 0, 0, 0, -1, 0, 0, 0, 1};
    mote_cholesky *factor = NULL;
    double condition = -1;
    assert_int_equal(mote_cholesky_create(3, matrix, &factor, &condition), MOTE_ENUMERIC);
    assert_string_equal(mote_error_text(), "a matrix of 3 rows is not positive definite");
    assert_null(factor);
    assert_true(condition == -1);
}

TEST(cholesky_solves_every_third_number)
{
    const double matrix[9] = {4, 1, 0, 1, 3, -1, 0, -1, 2};
    const double x[3] = {1, -2, 5};
    double values[9], solved[9];
    for (int i = 0; i < 9; ++i)
        values[i] = solved[i] = 100 + i;
    for (int i = 0; i < 3; ++i)
        values[3 * i] =
            matrix[3 * i] * x[0] + matrix[3 * i + 1] * x[1] + matrix[3 * i + 2] * x[2];
    mote_cholesky *factor = NULL;
    double condition = -1;
    assert_int_equal(mote_cholesky_create(3, matrix, &factor, &condition), MOTE_OK);
    assert_true(condition > 0.05 && condition <= 1);
    mote_cholesky_solve_coordinate(factor, values, solved);
    for (int i = 0; i < 9; ++i) {
        const double expected = i % 3 == 0 ? x[i / 3] : 100 + i;
        assert_true(fabs(solved[i] - expected) < 1e-14);
    }
    mote_cholesky_destroy(factor);
    mote_cholesky_destroy(NULL);
}
