/* The initial places of particles. */
#include "core/particle/start.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

/* A torus beside the smallest possible bodies: five components. */
static mote_mesh *five_components(void)
{
    solid s = solid_torus(20, 10);
    for (int k = 0; k < 4; ++k)
        s = solid_join(s, solid_tetrahedron(), 6 + 4 * k);
    return solid_to_mesh(s);
}

TEST(start_places_different_vertices_on_every_component)
{
    mote_mesh *mesh = five_components();
    assert_int_equal(mesh->component_count, 5);
    const uint32_t counts[3] = {5, 17, mesh->vertex_count};
    for (int round = 0; round < 60; ++round) {
        const uint32_t count = counts[round % 3];
        const mote_start start = round % 2 ? MOTE_START_RANDOM : MOTE_START_FARTHEST;
        uint32_t v[300], again[300];
        bool taken[300] = {false}, covered[5] = {false};
        assert_int_equal(mote_start_vertices(mesh, count, start, (uint64_t)round, v), MOTE_OK);
        assert_int_equal(mote_start_vertices(mesh, count, start, (uint64_t)round, again),
                         MOTE_OK);
        assert_memory_equal(v, again, count * sizeof *v);
        for (uint32_t i = 0; i < count; ++i) {
            assert_true(v[i] < mesh->vertex_count && !taken[v[i]]);
            taken[v[i]] = true;
            covered[mesh->component[v[i]]] = true;
        }
        for (int c = 0; c < 5; ++c)
            assert_true(covered[c]);
    }
    mote_mesh_destroy(mesh);
}

TEST(start_with_a_bad_count_says_the_range)
{
    mote_mesh *mesh = five_components();
    uint32_t v[300] = {7};
    assert_int_equal(mote_start_vertices(mesh, 0, MOTE_START_RANDOM, 1, v), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "0 particles on a body of 216 vertices; n must be "
                                           "from 1 to the vertex count");
    assert_int_equal(mote_start_vertices(mesh, 217, MOTE_START_FARTHEST, 1, v), MOTE_EINVAL);
    assert_int_equal(mote_start_vertices(mesh, 4, MOTE_START_RANDOM, 1, v), MOTE_EUNSUPPORTED);
    assert_string_equal(mote_error_text(), "4 particles on a body of 5 connected components; "
                                           "each needs at least one");
    assert_int_equal(v[0], 7);
    mote_mesh_destroy(mesh);
}
