/* Mass properties against closed forms, exact solids and changes of frame. */
#include "core/body/mass.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <float.h>

static const double pi = 3.14159265358979323846;

/* A box of edges a, b, c with a corner at the origin. */
static solid solid_box(double a, double b, double c)
{
    static const uint32_t face[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7},
                                         {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                                         {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    static const double corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    solid s = solid_allocate(8, 12);
    for (size_t i = 0; i < 8; ++i)
        solid_set_vertex(&s, i, a * corner[i][0], b * corner[i][1], c * corner[i][2]);
    for (size_t f = 0; f < 12; ++f)
        solid_set_face(&s, f, face[f][0], face[f][1], face[f][2]);
    return s;
}

static solid corner_tetrahedron(double size)
{
    static const uint32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    solid s = solid_allocate(4, 4);
    solid_set_vertex(&s, 0, 0, 0, 0);
    solid_set_vertex(&s, 1, size, 0, 0);
    solid_set_vertex(&s, 2, 0, size, 0);
    solid_set_vertex(&s, 3, 0, 0, size);
    for (size_t f = 0; f < 4; ++f)
        solid_set_face(&s, f, face[f][0], face[f][1], face[f][2]);
    return s;
}

static void flip_faces(solid *s, size_t first, size_t last)
{
    for (size_t f = first; f < last; ++f) {
        const uint32_t swap = s->faces[3 * f];
        s->faces[3 * f] = s->faces[3 * f + 1];
        s->faces[3 * f + 1] = swap;
    }
}

static void move_vertices(solid *s, mote_mat3 turn, mote_vec3 shift, double scale)
{
    for (size_t i = 0; i < s->vertex_count; ++i) {
        const double *p = s->xyz + 3 * i;
        const mote_vec3 v = mote_rotate(&turn, mote_vec3_make(p[0], p[1], p[2]));
        const mote_vec3 at = mote_add(mote_scale(v, scale), shift);
        solid_set_vertex(s, i, at.x, at.y, at.z);
    }
}

static mote_mass mass_of(solid s, double density)
{
    mote_mesh *mesh = solid_to_mesh(s);
    mote_mass mass;
    if (mote_mass_of_mesh(mesh, density, &mass) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_mesh_destroy(mesh);
    return mass;
}

static void assert_vec3_close(mote_vec3 a, mote_vec3 b, double tolerance)
{
    assert_close(a.x, b.x, tolerance);
    assert_close(a.y, b.y, tolerance);
    assert_close(a.z, b.z, tolerance);
}

/* Checks that the axes are a rotation. */
static void assert_rotation(const mote_mat3 *r)
{
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            double product = 0;
            for (int k = 0; k < 3; ++k)
                product += r->m[k][i] * r->m[k][j];
            assert_close(product, i == j, 1e-14);
        }
    }
    const mote_vec3 x = mote_vec3_make(r->m[0][0], r->m[1][0], r->m[2][0]);
    const mote_vec3 y = mote_vec3_make(r->m[0][1], r->m[1][1], r->m[2][1]);
    const mote_vec3 z = mote_vec3_make(r->m[0][2], r->m[1][2], r->m[2][2]);
    assert_close(mote_dot(mote_cross(x, y), z), 1, 1e-14);
}

TEST(mass_of_mesh_box_closed_form)
{
    const double a = 3, b = 2, c = 1, density = 5, m = density * a * b * c;
    const mote_mass mass = mass_of(solid_box(a, b, c), density);
    assert_close(mass.volume, a * b * c, 1e-14);
    assert_close(mass.mass, m, 1e-13);
    assert_vec3_close(mass.centre, mote_vec3_make(a / 2, b / 2, c / 2), 1e-14);
    assert_vec3_close(mass.inertia,
                      mote_vec3_make(m / 12 * (b * b + c * c), m / 12 * (a * a + c * c),
                                     m / 12 * (a * a + b * b)),
                      1e-12);
    assert_rotation(&mass.axes);
    for (int k = 0; k < 3; ++k)
        assert_close(fabs(mass.axes.m[k][k]), 1, 1e-14);
}

TEST(mass_of_mesh_tetrahedron_closed_form)
{
    /* About the centre: squares 3 m a^2 / 80 each, products -m a^2 / 80. */
    const double a = 2, m = a * a * a / 6;
    const mote_mass mass = mass_of(corner_tetrahedron(a), 1);
    assert_close(mass.mass, m, 1e-14);
    assert_vec3_close(mass.centre, mote_vec3_make(a / 4, a / 4, a / 4), 1e-15);
    const double square = 3 * m * a * a / 80, mixed = -m * a * a / 80;
    assert_close(mass.inertia.x, 2 * square + mixed, 1e-14);
    assert_close(mass.inertia.y, 2 * square + mixed, 1e-14);
    assert_close(mass.inertia.z, 2 * square - 2 * mixed, 1e-14);
    /* The axis of the single moment is the diagonal. */
    const double along = mass.axes.m[0][2] + mass.axes.m[1][2] + mass.axes.m[2][2];
    assert_close(fabs(along), sqrt(3.0), 1e-13);
}

TEST(mass_of_mesh_sphere_converges_to_closed_form)
{
    double before = HUGE_VAL;
    for (int level = 2; level <= 4; ++level) {
        const mote_mass mass = mass_of(solid_icosphere(level), 1);
        const double error =
            fmax(fabs(mass.volume - 4 * pi / 3), fabs(mass.inertia.z - 8 * pi / 15));
        assert_close(mass.inertia.x, mass.inertia.z, 1e-14);
        assert_vec3_close(mass.centre, mote_vec3_make(0, 0, 0), 1e-15);
        assert_true(error < before / 3.8); /* of second order: a quarter each time */
        before = error;
    }
    assert_true(before < 0.02);
}

TEST(mass_of_mesh_torus_converges_to_closed_form)
{
    const double r = 0.3, volume = 2 * pi * pi * r * r;
    const double axial = volume * (1 + 3 * r * r / 4);
    const double across = volume * (0.5 + 5 * r * r / 8);
    double before = HUGE_VAL;
    for (uint32_t n = 24; n <= 96; n *= 2) {
        const mote_mass mass = mass_of(solid_torus(2 * n, n), 1);
        const double error = fmax(
            fabs(mass.volume - volume) / volume,
            fmax(fabs(mass.inertia.z - axial) / axial, fabs(mass.inertia.x - across) / across));
        assert_close(fabs(mass.axes.m[2][2]), 1, 1e-12);
        assert_true(error < before / 3.8);
        before = error;
    }
    assert_true(before < 2e-3);
}

TEST(mass_of_mesh_moved_and_scaled_follows)
{
    uint64_t seed = 5;
    const mote_mass at_rest = mass_of(solid_box(3, 2, 1), 1);
    for (int i = 0; i < 50; ++i) {
        const mote_mat3 turn = random_rotation_matrix(&seed);
        const mote_vec3 shift = random_vec3(&seed, 10);
        const double scale = ldexp(1, i - 25);
        solid s = solid_box(3, 2, 1);
        move_vertices(&s, turn, mote_scale(shift, scale), scale);
        const mote_mass mass = mass_of(s, 1);
        const double fifth = pow(scale, 5);
        assert_close(mass.inertia.x / fifth, at_rest.inertia.x, 1e-12);
        assert_close(mass.inertia.z / fifth, at_rest.inertia.z, 1e-12);
        const mote_vec3 centre = mote_add(mote_rotate(&turn, at_rest.centre), shift);
        assert_vec3_close(mote_scale(mass.centre, 1 / scale), centre, 1e-13);
        for (int k = 0; k < 3; ++k) {
            const mote_vec3 axis =
                mote_vec3_make(mass.axes.m[0][k], mass.axes.m[1][k], mass.axes.m[2][k]);
            const mote_vec3 wanted = mote_vec3_make(turn.m[0][k], turn.m[1][k], turn.m[2][k]);
            assert_close(fabs(mote_dot(axis, wanted)), 1, 1e-13);
        }
    }
}

TEST(mass_of_mesh_inside_out_is_the_same)
{
    solid s = solid_box(3, 2, 1);
    flip_faces(&s, 0, 12);
    const mote_mass a = mass_of(s, 2), b = mass_of(solid_box(3, 2, 1), 2);
    assert_close(a.mass, b.mass, 1e-14);
    assert_vec3_close(a.centre, b.centre, 1e-15);
    assert_vec3_close(a.inertia, b.inertia, 1e-13);
}

TEST(mass_of_mesh_cavity_is_taken_off)
{
    /* A unit sphere inside one twice as large that is wound the other way. */
    solid outer = solid_icosphere(2);
    move_vertices(&outer, (mote_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                  mote_vec3_make(0, 0, 0), 2);
    solid inner = solid_icosphere(2);
    flip_faces(&inner, 0, inner.triangle_count);
    const mote_mass whole = mass_of(solid_icosphere(2), 1);
    const mote_mass hollow = mass_of(solid_join(outer, inner, 0), 1);
    assert_close(hollow.volume, 7 * whole.volume, 1e-12);
    assert_close(hollow.inertia.y, 31 * whole.inertia.y, 1e-12);
}

typedef struct refusal {
    solid shape;
    double density;
    const char *says;
} refusal;

TEST(mass_of_mesh_bad_input_refused_with_reason)
{
    solid twisted = solid_box(1, 1, 1);
    flip_faces(&twisted, 3, 4);
    /* A solid and its mirror image with unchanged winding: their volumes cancel. */
    solid mirrored = solid_box(1, 1, 1);
    flip_faces(&mirrored, 0, mirrored.triangle_count);
    /* A long bar with most of it subtracted, far from its middle: no solid has such moments. */
    solid taken = solid_box(1, 1, 1);
    flip_faces(&taken, 0, taken.triangle_count);
    /* Many plates in the same place. */
    solid piled = solid_box(1e60, 1e60, 5e59);
    for (int k = 1; k < 120; ++k)
        piled = solid_join(piled, solid_box(1e60, 1e60, 5e59), 0);
    refusal cases[] = {
        {solid_join(solid_box(1, 1, 1), mirrored, 3), 1, "no volume"},
        {solid_join(solid_box(1, 1, 1.5), taken, 9), 1, "not that of a solid"},
        {solid_box(1e-120, 1e-120, 1e-120), 1, "mass 0 "},
        {solid_box(1e60, 1e63, 1e63), 1, "not that of a solid"}, /* moments of inf */
        {piled, 2.24e7, "inf is not that of a solid"},           /* only the larger moments */
        {solid_grid(3, 3), 1, "open"},
        {twisted, 1, "wound differently"},
        {solid_box(1, 1, 0), 1, "no volume"},
        {solid_box(1, 1, 1), 0, "density 0"},
        {solid_box(1, 1, 1), -2, "density -2"},
        {solid_box(1, 1, 1), NAN, "density"},
        {solid_box(1, 1, 1), HUGE_VAL, "density inf"},
        {solid_box(1e100, 1e100, 1e100), 1, "moderate size"},
        {solid_box(1e-100, 1e-100, 1e-100), 1, "moderate size"},
        {solid_box(1e-64, 1e-64, 1e-64), 1, "moderate size"}, /* moments of 1.7e-321 */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        mote_mesh *mesh = solid_to_mesh(cases[i].shape);
        mote_mass mass = {.mass = -7};
        assert_int_equal(mote_mass_of_mesh(mesh, cases[i].density, &mass), MOTE_EINVAL);
        if (!strstr(mote_error_text(), cases[i].says))
            fail_msg("\"%s\" says nothing of %s", mote_error_text(), cases[i].says);
        assert_true(mass.mass == -7);
        mote_mesh_destroy(mesh);
    }
}

TEST(mass_of_mesh_sliver_keeps_its_digits)
{
    for (double thin = 1; thin > 1e-12; thin /= 16) {
        const mote_mass mass = mass_of(solid_box(1, 2, thin), 1);
        assert_close(mass.mass / thin, 2, 1e-14);
        assert_close(mass.inertia.z / thin, 2.0 / 12 * 5, 1e-13);
        assert_close(mass.inertia.x / thin, 2.0 / 12 * (1 + thin * thin), 1e-13);
    }
}
