/* Lengths and angles of a mesh over the whole range of doubles. */
#include "tests/support/solids.h"
#include "tests/support/test.h"

/* A solid scaled by 2^k; returns its mesh. */
static mote_mesh *scaled_icosphere(int k)
{
    solid s = solid_icosphere(2);
    for (size_t i = 0; i < 3 * s.vertex_count; ++i)
        s.xyz[i] = ldexp(s.xyz[i], k);
    return solid_to_mesh(s);
}

TEST(lengths_scaled_by_powers_of_two_scale_exactly)
{
    mote_mesh *unit = scaled_icosphere(0);
    const int exponents[] = {-432, -300, -40, -1, 1, 40, 300, 430};
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; ++i) {
        mote_mesh *mesh = scaled_icosphere(exponents[i]);
        assert_true(mesh->diagonal == ldexp(unit->diagonal, exponents[i]));
        assert_true(mesh->mean_edge == ldexp(unit->mean_edge, exponents[i]));
        assert_true(mote_mesh_smallest_angle(mesh) == mote_mesh_smallest_angle(unit));
        mote_mesh_destroy(mesh);
    }
    mote_mesh_destroy(unit);
}

/* By the law of cosines, in long double. */
static long double angle_by_cosines(mote_vec3 at, mote_vec3 p, mote_vec3 q)
{
    const long double ux = (long double)p.x - at.x;
    const long double uy = (long double)p.y - at.y;
    const long double uz = (long double)p.z - at.z;
    const long double vx = (long double)q.x - at.x;
    const long double vy = (long double)q.y - at.y;
    const long double vz = (long double)q.z - at.z;
    const long double dot = ux * vx + uy * vy + uz * vz;
    const long double square = (ux * ux + uy * uy + uz * uz) * (vx * vx + vy * vy + vz * vz);
    return acosl(dot / sqrtl(square)) * 180 / acosl(-1);
}

static long double smallest_by_cosines(const mote_mesh *mesh)
{
    long double smallest = 180;
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        for (int k = 0; k < 3; ++k)
            smallest = fminl(smallest, angle_by_cosines(mesh->positions[t[k]],
                                                        mesh->positions[t[(k + 1) % 3]],
                                                        mesh->positions[t[(k + 2) % 3]]));
    }
    return smallest;
}

TEST(smallest_angle_matches_law_of_cosines)
{
    mote_mesh *mesh = solid_to_mesh(solid_torus(23, 7));
    assert_close(mote_mesh_smallest_angle(mesh), smallest_by_cosines(mesh), 1e-11);
    mote_mesh_destroy(mesh);
}

/* Differences are taken before anything is rounded again, so a mesh far from the origin keeps
   the angles given by its coordinates. */
TEST(smallest_angle_far_from_the_origin_stays_accurate)
{
    solid s = solid_torus(23, 7);
    for (size_t i = 0; i < 3 * s.vertex_count; ++i)
        s.xyz[i] += 3e6;
    mote_mesh *mesh = solid_to_mesh(s);
    assert_close(mote_mesh_smallest_angle(mesh), smallest_by_cosines(mesh), 1e-11);
    mote_mesh_destroy(mesh);
}

TEST(create_at_the_ends_of_the_range_is_finite)
{
    const double size[] = {3e-131, 2.8e129}; /* L is 3.46 times as large */
    for (int k = 0; k < 2; ++k) {
        solid s = solid_tetrahedron();
        for (size_t i = 0; i < 12; ++i)
            s.xyz[i] *= size[k];
        mote_mesh *mesh = solid_to_mesh(s);
        assert_close(mesh->diagonal / size[k], sqrtl(12), 1e-15);
        assert_close(mesh->mean_edge / size[k], sqrtl(8), 1e-15);
        assert_close(mote_mesh_smallest_angle(mesh), 60, 1e-12);
        mote_mesh_destroy(mesh);
    }
}
