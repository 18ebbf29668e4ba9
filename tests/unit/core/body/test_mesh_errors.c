/* What mote_mesh_create rejects: the complete text, and untouched outputs. */
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <float.h>
#include <stdio.h>

/* Expects MOTE_EINVAL with this text, and an untouched output. s is freed. */
static void expect_error(solid s, const char *text)
{
    mote_mesh *const mark = (mote_mesh *)(void *)&s;
    mote_mesh *mesh = mark;
    assert_int_equal(mote_mesh_create(s.xyz, s.vertex_count, s.faces, s.triangle_count, &mesh),
                     MOTE_EINVAL);
    assert_string_equal(mote_error_text(), text);
    assert_ptr_equal(mesh, mark);
    solid_free(&s);
}

TEST(create_without_a_triangle_is_an_error)
{
    const char *text = "the mesh has no triangle; at least one is needed";
    solid s = solid_triangle();
    s.triangle_count = 0;
    expect_error(s, text);
    s = solid_triangle();
    s.vertex_count = 0;
    expect_error(s, text);
}

TEST(create_with_too_many_elements_is_an_error)
{
    solid s = solid_triangle();
    s.vertex_count = (size_t)1 << 31;
    expect_error(s, "the mesh has 2147483648 vertices and 1 triangles; below 2^31 vertices and "
                    "2^31 / 3 triangles are supported");
    s = solid_triangle();
    s.triangle_count = ((size_t)1 << 31) / 3;
    expect_error(s, "the mesh has 3 vertices and 715827882 triangles; below 2^31 vertices and "
                    "2^31 / 3 triangles are supported");
}

TEST(create_with_a_coordinate_not_finite_names_it)
{
    const double bad[] = {NAN, INFINITY, -INFINITY};
    const char *text[] = {
        "vertex 3: x is not finite; every coordinate must be a finite number",
        "vertex 3: y is not finite; every coordinate must be a finite number",
        "vertex 3: z is not finite; every coordinate must be a finite number"};
    for (int k = 0; k < 3; ++k) {
        solid s = solid_tetrahedron();
        s.xyz[9 + k] = bad[k];
        expect_error(s, text[k]);
    }
}

TEST(create_with_an_index_out_of_range_names_the_face)
{
    solid s = solid_tetrahedron();
    s.faces[7] = 4;
    expect_error(s, "face 2: index 4 is out of range; there are 4 vertices, counted from 0");
    s = solid_tetrahedron();
    s.faces[11] = UINT32_MAX;
    expect_error(
        s, "face 3: index 4294967295 is out of range; there are 4 vertices, counted from 0");
}

TEST(create_with_a_repeated_vertex_names_the_face)
{
    for (size_t k = 0; k < 3; ++k) {
        solid s = solid_tetrahedron();
        solid_set_face(&s, 1, 2, 2, 2);
        s.faces[3 + k] = 3;
        char text[120];
        (void)snprintf(text, sizeof text,
                       "face 1: repeats a vertex (%u, %u, %u); a face needs three different "
                       "vertices",
                       s.faces[3], s.faces[4], s.faces[5]);
        expect_error(s, text);
    }
}

TEST(create_with_three_faces_at_an_edge_names_the_edge)
{
    const uint32_t order[][2] = {{2, 3}, {3, 2}};
    for (int k = 0; k < 2; ++k) {
        solid s = solid_join(solid_tetrahedron(), solid_triangle(), 5);
        s.faces[12] = order[k][0]; /* a fin on edge 2-3 */
        s.faces[13] = order[k][1];
        solid_weld(&s, 5, 5);
        solid_weld(&s, 4, 4);
        expect_error(s, "edge 2-3 has more than two faces (non-manifold); every edge may have "
                        "one or two");
    }
}

TEST(create_with_three_equal_faces_names_an_edge)
{
    solid s = solid_allocate(3, 3);
    solid_set_vertex(&s, 0, 0, 0, 0);
    solid_set_vertex(&s, 1, 1, 0, 0);
    solid_set_vertex(&s, 2, 0, 1, 0);
    for (size_t f = 0; f < 3; ++f)
        solid_set_face(&s, f, 0, 1, 2);
    expect_error(s, "edge 0-1 has more than two faces (non-manifold); every edge may have one "
                    "or two");
}

TEST(create_with_an_unused_vertex_names_it)
{
    solid s = solid_tetrahedron();
    s.triangle_count = 1; /* 0, 1, 2 */
    expect_error(s, "vertex 3 belongs to no face; leave it out or use it");
}

TEST(create_without_extent_is_an_error)
{
    solid s = solid_tetrahedron();
    for (size_t i = 0; i < 12; ++i)
        s.xyz[i] = 7.5;
    expect_error(s, "all vertices coincide; a mesh needs an extent");
}

/* Squares of distances between such bodies are no normal numbers. */
TEST(create_with_an_extent_out_of_range_is_an_error)
{
    static const struct {
        double size;
        const char *extent;
    } rows[] = {{1.7e308, "inf"},
                {3e129, "1.04e+130"},
                {2.8e-131, "9.7e-131"},
                {1e-310, "3.46e-310"},
                {4 * DBL_TRUE_MIN, "6.92e-323"}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char expected[160];
        solid s = solid_tetrahedron();
        test_row("coordinates of %g", rows[i].size);
        for (size_t k = 0; k < 12; ++k)
            s.xyz[k] *= rows[i].size;
        (void)snprintf(expected, sizeof expected,
                       "the bounding-box diagonal is %s; it must be from 1e-130 to 1e+130, "
                       "since distances are squared; use another unit of length",
                       rows[i].extent);
        expect_error(s, expected);
    }
}
