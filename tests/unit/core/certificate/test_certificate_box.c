/* Boxes of the certificate's tree: their axes and their coordinates. */
#include "core/certificate/certificate_box.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

static double entry(double m[3][3], mote_vec3 a, mote_vec3 b)
{
    const double x[3] = {a.x, a.y, a.z}, y[3] = {b.x, b.y, b.z};
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            sum += x[i] * m[i][k] * y[k];
    }
    return sum;
}

static void check_axes(double m[3][3])
{
    double work[3][3], size = 0;
    mote_vec3 axes[3];
    memcpy(work, m, sizeof work);
    for (int i = 0; i < 9; ++i)
        size = fmax(size, fabs(m[i / 3][i % 3]));
    mote_cert_principal_axes(work, axes);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            assert_true(fabs(mote_dot(axes[i], axes[k]) - (i == k)) < 1e-14);
            if (i != k)
                assert_true(fabs(entry(m, axes[i], axes[k])) < 1e-14 * size);
        }
        if (i > 0)
            assert_true(entry(m, axes[i], axes[i]) <=
                        entry(m, axes[i - 1], axes[i - 1]) + 1e-14 * size);
    }
}

TEST(principal_axes_diagonalise_by_falling_eigenvalue)
{
    uint64_t seed = 3;
    for (int round = 0; round < 2000; ++round) {
        double m[3][3];
        for (int i = 0; i < 3; ++i) {
            for (int k = i; k < 3; ++k)
                m[i][k] = m[k][i] = random_between(&seed, -1, 1);
        }
        check_axes(m);
    }
}

/* With a trace of 0 there is no scale to judge small entries by; the iteration ends anyway. */
TEST(principal_axes_without_a_trace_diagonalise)
{
    static double m[3][3][3] = {{{0, 1, 0}, {1, 0, 0}, {0, 0, 0}},
                                {{1, 2, 3}, {2, -3, 5}, {3, 5, 2}},
                                {{-1, 0.1, 0.7}, {0.1, -1, 0.3}, {0.7, 0.3, -1}}};
    for (int k = 0; k < 3; ++k)
        check_axes(m[k]);
}

TEST(box_coordinates_outside_are_held_within)
{
    const mote_cert_box box = {.centre = {1, 2, 3}, .half = {{4, 0, 0}, {0, 2, 0}, {0, 0, 1}}};
    double z[3];
    mote_cert_box_coordinates(&box, mote_vec3_make(3, 1, 3), z);
    assert_true(z[0] == 0.5 && z[1] == -0.5 && z[2] == 0);
    mote_cert_box_coordinates(&box, mote_vec3_make(5.001, -0.001, 9), z);
    assert_true(z[0] == 1 && z[1] == -1 && z[2] == 1);
    mote_cert_box_coordinates(&box, mote_vec3_make(-7, 4.1, 1.9), z);
    assert_true(z[0] == -1 && z[1] == 1 && z[2] == -1);
}

/* Counts on both sides of whole lanes and of a full sample, and strides with a rest. */
TEST(box_sample_equals_the_coordinates_one_by_one)
{
    enum { VERTICES = 1100 };
    static mote_vec3 positions[VERTICES];
    static uint32_t vertices[VERTICES];
    static double z[3][MOTE_CERT_FIT_CHUNK];
    static const size_t cases[][2] = {{1, 1},   {7, 1},   {8, 1},   {9, 1},
                                      {511, 1}, {512, 1}, {513, 2}, {VERTICES, 3}};
    uint64_t seed = 11;
    for (uint32_t i = 0; i < VERTICES; ++i) {
        vertices[i] = (i * 7) % VERTICES;
        positions[i] =
            mote_vec3_make(random_between(&seed, -6, 6), random_between(&seed, -6, 6),
                           random_between(&seed, -6, 6));
    }
    const mote_mesh mesh = {.positions = positions, .vertex_count = VERTICES};
    const mote_body body = {.mesh = &mesh};
    const mote_cert_tree tree = {.body = &body, .scale = 0.5, .origin = {0.3, -0.2, 0.1}};
    const mote_cert_box box = {.centre = {0.1, 0.2, 0.3},
                               .half = {{1.5, 0.5, 0}, {-0.5, 1.5, 0}, {0, 0, 1.2}}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        const size_t count = cases[c][0], stride = cases[c][1];
        const size_t made = mote_cert_box_sample(&tree, vertices, count, &box, stride, z);
        assert_int_equal(made, (count + stride - 1) / stride);
        for (size_t i = 0; i < made; ++i) {
            double one[3];
            mote_cert_box_coordinates(
                &box, mote_cert_tree_position(&tree, vertices[i * stride]), one);
            for (int k = 0; k < 3; ++k)
                assert_memory_equal(&one[k], &z[k][i], sizeof one[k]);
        }
    }
}
