#include "core/base/random.h"
#include "harness/base/clock.h"
#include "harness/base/file.h"
#include "harness/mesh/mesh_import.h"
#include "harness/mesh/mesh_soup.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A tetrahedron in several formats. */
static const char obj_text[] =
    "\xef\xbb\xbf# a comment\r\nv 0 0 0\r\nv 1 0 0 # x\r\nv 0 1 0\r\n"
    "v 0 0 0.1\r\nv 9 9 9\r\nvn 0 0 1\r\n"
    "f 1/1/1 3/1/1 2/1/1\r\nf 1 2 4\r\nf -5//1 -2//1 -3//1\r\n"
    "f 2 3 4\r\n";
static const char off_text[] = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 0.1\n3 0 2 1\n3 0 1 3\n"
                               "3 0 3 2\n3 1 2 3\n";
static const char ply_text[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 0.1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
static const char stl_text[] =
    "solid t\n"
    "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\n"
    "endfacet\nfacet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 0.1\n"
    "endloop\nendfacet\nfacet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 0.1\n"
    "vertex 0 1 0\nendloop\nendfacet\nfacet normal 1 1 1\nouter loop\nvertex 1 0 0\n"
    "vertex 0 1 0\nvertex 0 0 0.1\nendloop\nendfacet\nendsolid t\n";

static const char gltf_text[] =
    "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0]}]"
    ", \"nodes\": [{\"mesh\": 0}], \"meshes\": [{\"primitives\": [{\"attributes\": {\""
    "POSITION\": 0}, \"indices\": 1}]}], \"accessors\": [{\"bufferView\": 0, \"compon"
    "entType\": 5126, \"count\": 4, \"type\": \"VEC3\", \"min\": [0, 0, 0], \"max\": "
    "[1, 1, 0.1]}, {\"bufferView\": 1, \"componentType\": 5123, \"count\": 12, \"type"
    "\": \"SCALAR\"}], \"bufferViews\": [{\"buffer\": 0, \"byteOffset\": 0, \"byteLen"
    "gth\": 48}, {\"buffer\": 0, \"byteOffset\": 48, \"byteLength\": 24}], \"buffers\""
    ": [{\"byteLength\": 72, \"uri\": \"data:application/octet-stream;base64,AAAAAAAA"
    "AAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAADNzMw9AAACAAEAAAABAAMAAAADAAIA"
    "AQACAAMA\"}]}";

static mote_status import_text(const char *name, const void *text, size_t size,
                               mote_mesh **mesh, mote_import *import)
{
    file_write(name, text, size);
    return mote_mesh_import(name, mesh, import);
}

static void check_tetrahedron(const char *name, const char *text, bool single)
{
    mote_mesh *mesh;
    mote_import import;
    if (import_text(name, text, strlen(text), &mesh, &import) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->triangle_count, 4);
    assert_int_equal(mesh->open_edge_count, 0);
    assert_int_equal(mote_mesh_euler(mesh), 2);
    assert_int_equal(import.single_precision, single);
    /* 0.1 is rounded differently in 32 bits. */
    assert_true(mesh->high.z == (single ? (double)0.1f : 0.1));
    mote_mesh_destroy(mesh);
}

TEST(mote_mesh_import_formats_give_the_same_tetrahedron)
{
    check_tetrahedron("t.obj", obj_text, false);
    check_tetrahedron("t.off", off_text, false);
    check_tetrahedron("t.ply", ply_text, false);
    check_tetrahedron("t.stl", stl_text, true);
    check_tetrahedron("t.gltf", gltf_text, true);
}

/* The tetrahedron in a glTF file of a folder, with its buffer in the file that `uri` names. */
static void check_buffer(const char *folder, const char *uri, const char *file)
{
    static const struct {
        float xyz[12];
        uint16_t corner[12];
    } buffer = {{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.1F}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}};
    const char *inside = strstr(gltf_text, "data:");
    char *text = mote_format("%.*s%s\"}]}", (int)(inside - gltf_text), gltf_text, uri);
    char *path = mote_format("%st.gltf", folder), *beside = mote_format("%s%s", folder, file);
    test_row("%s, a buffer in %s", path, uri);
    file_write(beside, &buffer, sizeof buffer);
    check_tetrahedron(path, text, true);
    assert_int_equal(unlink(beside), 0);
    free(beside);
    free(path);
    free(text);
}

/* A buffer is named by a URI: percent signs stand for bytes, unless a file has them in its
   name, as some exporters leave them. The folder's name is none. */
TEST(gltf_buffers_are_found_by_uris)
{
    static const char *const folders[] = {"", "x%20y/", "./x y/"};
    assert_int_equal(mkdir("x%20y", 0777), 0);
    assert_int_equal(mkdir("x y", 0777), 0);
    for (size_t i = 0; i < ROWS_OF(folders); ++i) {
        check_buffer(folders[i], "a.bin", "a.bin");
        check_buffer(folders[i], "a b.bin", "a b.bin");
        check_buffer(folders[i], "a%20b.bin", "a b.bin");
        check_buffer(folders[i], "a%20b.bin", "a%20b.bin");
        check_buffer(folders[i], "%c3%A9.bin", "\xc3\xa9.bin");
        check_buffer(folders[i], "50%.bin", "50%.bin");
        check_buffer(folders[i], "50%25%2.bin", "50%%2.bin");
    }
}

/* Everything that the format allows around the numbers. */
TEST(mote_mesh_import_off_with_extras_is_read)
{
    static const char text[] =
        "\xef\xbb\xbf# made by hand\r\nSTCNOFF 6 2\r\n\r\n0 0 0 1 0 0 0.5 0.5 0.5 1 0 0\r\n"
        "1 0 0 0 # second\r\n1 1 0\r\n \t0 1 0\r\n9 9 9\r\n0 0 1\r\n# faces\r\n4 0 1 2 3 255 0 "
        "0\r\n"
        "3 5 1 0 0.5 0.5 0.5\r\nrest";
    mote_mesh *mesh;
    mote_import import;
    if (import_text("t.off", text, strlen(text), &mesh, &import) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(mesh->vertex_count, 5);
    assert_int_equal(mesh->triangle_count, 3);
    assert_int_equal(import.unused, 1);
    assert_true(mesh->high.x == 1 && mesh->high.y == 1 && mesh->high.z == 1);
    mote_mesh_destroy(mesh);
}

/* A backslash at the end of a line of OBJ continues it on the next one. */
TEST(obj_lines_go_on_after_a_backslash)
{
    static const char written[] =
        "# no join here \\\nv 0 0 \\\n0\nv 1 \\\r\n 0 0\nv \\\n\\\n0 1 0\n"
        "v 0 0 1\\\n\nf 1/1/1 2/2/2\\\n 3\nf\\\n1 2 4\nf 1 3 4\n";
    mote_mesh *mesh = NULL;
    if (import_text("c.obj", written, strlen(written), &mesh, NULL) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->triangle_count, 3);
    assert_true(mesh->high.x == 1 && mesh->high.y == 1 && mesh->high.z == 1);
    mote_mesh_destroy(mesh);
}

/* 80 bytes that begin with "solid", a count, and 50 bytes a triangle. */
TEST(mote_mesh_import_binary_stl_beginning_with_solid_is_read)
{
    static const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1f}};
    static const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    unsigned char data[84 + 4 * 50] = "solid but binary";
    data[80] = 4;
    for (int f = 0; f < 4; ++f) {
        for (int k = 0; k < 3; ++k)
            memcpy(data + 84 + 50 * f + 12 + 12 * k, corners[faces[f][k]], 12);
    }
    mote_mesh *mesh;
    mote_import import;
    assert_int_equal(import_text("b.stl", data, sizeof data, &mesh, &import), MOTE_OK);
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(import.welded, 8);
    assert_int_equal(import.unused, 0);
    mote_mesh_destroy(mesh);
}

/* gltf_text with the first `from` replaced, and its last accessor followed by `accessor`. */
static mote_status import_changed(const char *from, const char *to, const char *accessor,
                                  mote_mesh **mesh)
{
    const char *at = strstr(gltf_text, from), *views = strstr(gltf_text, "], \"bufferViews\"");
    char *text =
        mote_format("%.*s%s%.*s%s%s", (int)(at - gltf_text), gltf_text, to,
                    (int)(views - at - (long)strlen(from)), at + strlen(from), accessor, views);
    const mote_status status = import_text("d.gltf", text, strlen(text), mesh, NULL);
    free(text);
    return status;
}

/* assimp drops corners that are left over, and says so in its log. */
TEST(gltf_of_corners_left_over_is_refused_where_they_are_of_triangles)
{
    mote_mesh *mesh = NULL;
    assert_int_equal(import_changed(", \"indices\": 1", "", "", &mesh), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "d.gltf: triangles whose corners cannot be divided "
                                           "by three; give three for each triangle");
    assert_int_equal(
        import_changed("\"indices\": 1}",
                       "\"indices\": 1}, {\"attributes\": {\"POSITION\": 2}, \"mode\": 1}",
                       ", {\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": "
                       "\"VEC3\", \"min\": [0, 0, 0], \"max\": [1, 1, 0]}",
                       &mesh),
        MOTE_OK);
    assert_int_equal(mesh->triangle_count, 4);
    mote_mesh_destroy(mesh);
}

/* A triangle and a square, of each of which one corner follows itself. */
TEST(faces_with_a_vertex_twice_in_a_row_collapse_in_every_format)
{
    static const char *const files[][2] = {
        {"d.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 1 2 2\nf 2 4 4 3\nf 3 1 3\n"},
        {"d.off",
         "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 0 1 1\n4 1 3 3 2\n3 2 0 2\n"},
        {"d.ply",
         "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
         "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 0 1 1\n4 1 3 3 2\n3 2 0 2\n"}};
    for (size_t i = 0; i < ROWS_OF(files); ++i) {
        mote_mesh *mesh = NULL;
        mote_import facts;
        test_row("%s", files[i][0]);
        if (import_text(files[i][0], files[i][1], strlen(files[i][1]), &mesh, &facts) !=
            MOTE_OK)
            fail_msg("%s", mote_error_text());
        assert_int_equal(mesh->triangle_count, 2);
        assert_int_equal(mesh->vertex_count, 4);
        assert_int_equal(facts.collapsed, 3);
        mote_mesh_destroy(mesh);
    }
}

TEST(mote_soup_weld_equal_places_become_one)
{
    mote_soup soup = {0};
    static const double places[][3] = {{0, 0, 0},    {1, 0, 0}, {0, 1, 0},
                                       {-0.0, 0, 0}, {1, 0, 0}, {5, 5, 5}};
    for (int i = 0; i < 6; ++i)
        assert_int_equal(mote_soup_add_vertex(&soup, places[i][0], places[i][1], places[i][2]),
                         MOTE_OK);
    mote_soup_add_triangle(&soup, 0, 1, 2);
    mote_soup_add_triangle(&soup, 2, 4, 3);
    mote_soup_add_triangle(&soup, 0, 3, 2); /* collapses */
    mote_soup_weld(&soup);
    assert_int_equal(soup.vertex_count, 3);
    assert_int_equal(soup.triangle_count, 2);
    assert_int_equal(soup.welded, 2);
    assert_int_equal(soup.collapsed, 1);
    assert_int_equal(soup.unused, 1);
    assert_int_equal(soup.indices[3], 2);
    assert_int_equal(soup.indices[4], 1);
    assert_int_equal(soup.indices[5], 0);
    mote_soup_free(&soup);
}

typedef struct bad_text {
    const char *name, *text, *says;
} bad_text;

#define PLY_HEAD                                                                               \
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"            \
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"

static const bad_text bad_texts[] = {
    {"b.obj", "", "no face"},
    {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ":4: face with vertex 4"},
    {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", ":4: face with vertex -4"},
    {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", ":4: face with vertex 0"},
    {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", ":4: face"},
    {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n",
     "b.obj: each of its 1 faces has two corners"},
    {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", ":4: a face of 2 vertices"},
    {"b.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", ":2: a vertex without three numbers"},
    {"b.obj", "v 0 0 0\nv 1,5 0 0\n", ":2: a vertex without three numbers"},
    {"b.obj", "v 0 0 nan\n", ":1: a coordinate is not a finite double"},
    {"b.obj", "v 0 0 1e400\n", ":1: a coordinate is not a finite double"},
    {"b.obj", "v 0 0 0\nv 0 0 -1.#IND00\n", ":2: a coordinate is not a finite double"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1.#INF 1 0\n3 0 1 2\n", ":5: a coordinate is not a"},
    {"b.stl", "solid t\nouter loop\nvertex 0 0 0\nvertex 0 1 -1.#IND\n",
     ":4: a vertex without three numbers"},
    {"b.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", "b.obj"},
    {"b.off", "", "an empty file"},
    {"b.off", "4OFF\n1 0 0\n0 0 0 0\n", ":1: no word OFF"},
    {"b.off", "OFF BINARY\n3 1 0\n", ":1: binary"},
    {"b.off", "OFF\n1\n", ":2: no counts"},
    {"b.off", "OFF\n-1 1 0\n", ":2: no counts"},
    {"b.off", "OFF\n999999999 999999999 0\n0 0 0\n", "declares 999999999 vertices"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n", ":5: a coordinate"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\ninf 1 0\n3 0 1 2\n", ":5: a coordinate"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1,5 1 0\n3 0 1 2\n", ":5: a vertex without three"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 99\n", ":6: face with vertex 99 of 3"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ":6: face with vertex 3 of 3"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", ":6: face with vertex -1 of 3"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 4294967298\n", ":6: face with vertex"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 1\n",
     "b.off: each of its 1 faces has two corners"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", ":6: a face of 3 corners with 2"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", ":6: a face of 2 vertices"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n", ":5: ends after 0 of 1 faces"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", ":4: ends after 2 of 3 vertices"},
    {"b.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "no face"},
    {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\n",
     "b.obj: each of its 1 faces has two corners"},
    {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 1\n",
     "b.obj: each of its 1 faces has two corners"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", ":6: a face without its number"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\nx 0 1 2\n", ":6: a face without its number"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3.5 0 1 2\n", ":6: a face without its number"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2.5\n", ":6: a face of 3 corners"},
    {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 0 2\n", ":6: a face with a vertex twice"},
    {"b.ply", "ply\nformat ascii 1.0\nelement vertex 3\nend_headers\n",
     "without a line end_header"},
    {"b.stl", "solid t\nendsolid t\nmore\n", ":4: ends without a line endsolid"},
    {"b.stl", "solid t\nouter loop\nvertex 0 0 0\nvertex 0 1\n", ":4: a vertex without three"},
    {"b", "v 0 0 0\n", "b: "},
    {"b.ply", "ply\nformat ascii 1.0\nelement vertex 3\n",
     "declares 3 elements, which the 0 bytes left cannot hold"},
    {"b.ply", "ply\nformat ascii 1.0\nelement vertex 77777777\nend_header\n",
     "declares 77777777"},
    {"b.stl", "solid t\nendsolid t\n", "b.stl"},
    {"b.xyz", "what is this?",
     "b.xyz: neither its name nor its content is that of a known mesh format"},
    {"b.glb", "glTFvvvvLLL\1more",
     "b.glb: ends after 16 of 21777484 bytes; give the whole glTF file"},
    {"b.ac", "AC3Db\nOBJECT", "b.ac: assimp cannot read it ("},
    {"b.ply", "", "b.ply: an empty file"},
    {"b.ply", PLY_HEAD "0 0 0\n", ":11: ends after vertex 1 of 4; give all"},
    {"b.obj", "", "b.obj: an empty file"},
    {"b.obj", "\xff\xfev", "a text in UTF-16; save it as UTF-8"},
    {"b.off", "\xfe\xffO", "a text in UTF-16; save it as UTF-8"},
    {"b.ply", PLY_HEAD "0 0 0\n1 0 0\n0 1 0\n0 0 1\nx 0 1 2\n",
     ":14: has something that is not"},
    {"b.ply", PLY_HEAD "0 0 0\n1 0 0\n0 1 0\n0 0 1\n-3 0 1 2\n", ":14: a list of -3 entries"},
    {"b.off", "OFF", ":1: no counts; write the numbers"},
    {"b.ply",
     "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
     "property double y\nelement face 1\nproperty list uchar int vertex_indices\n"
     "end_header\n1234",
     "b.ply:8: no vertex element with x, y and z once each"},
    {"b.stl",
     "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 0 0\n"
     "endloop\nendfacet\nendsolid t\n",
     "each of its 1 faces has two corners at one place"},
    /* Two groups crash assimp 5.2. */
    {"b.raw", "a\n1 1 1 0 0 0 0 1 0 1 0 0\n\nb\n1 1 1 0 0 0 0 1 0 1 0 0\n",
     "b.raw: the reader of this format: crashed: "},
    /* The line ends of old Macs. */
    {"m.obj", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
     "m.obj: lines that end with a carriage return alone; end them with a line feed"},
    {"m.off", "OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r", "m.off: lines that end with a"},
    {"m.ply", "ply\rformat ascii 1.0\rend_header\r", "m.ply: lines that end with a"},
    {"m.stl", "solid t\rendsolid t\r", "m.stl: lines that end with a"},
    /* Polygons that are not simple. */
    {"w.obj", "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nf 1 2 3 4\n",
     "w.obj:5: a face whose edges 1 and 3 cross or touch; give triangles"},
    {"w.off", "OFF\n4 1 0\n0 0 0\n2 2 0\n2 0 0\n0 2 0\n4 0 1 2 3\n",
     "w.off:7: a face whose edges 1 and 3 cross or touch; give triangles"},
    {"w.ply", PLY_HEAD "0 0 0\n2 2 0\n2 0 0\n0 2 0\n4 0 1 2 3\n",
     "w.ply:14: face 1: a face whose edges 1 and 3 cross"},
    {"w.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 1 4\n",
     "w.obj:5: a face with a vertex twice; give different ones"},
    /* Lines continued after a backslash. */
    {"c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\n2 \\\n7\n", "c.obj:6: face with vertex 7"},
    {"c.obj", "v 0 0 0\nv 1 \\\r\n0 0\nv 0 1 0\nf 1 2 \\\n3\nf 1 2 9\n",
     "c.obj:7: face with vertex 9"},
    {"c.obj", "v 0 0 \\\nx\n", "c.obj:2: a vertex without three numbers"},
    {"c.obj", "v 0 0 \\ 0\n", "c.obj:1: a vertex without three numbers"},
    {"c.obj", "v 0 0 0 # \\\nv 1 0\n", "c.obj:2: a vertex without three numbers"},
    {"c.obj", "v 0 0 \\", "c.obj:1: a vertex without three numbers"},
};

TEST(mote_mesh_import_bad_file_names_the_place)
{
    for (size_t i = 0; i < sizeof bad_texts / sizeof bad_texts[0]; ++i) {
        const bad_text *bad = &bad_texts[i];
        mote_mesh *mesh = NULL;
        const double start = mote_clock_seconds();
        mote_status status = import_text(bad->name, bad->text, strlen(bad->text), &mesh, NULL);
        assert_true(mote_clock_seconds() - start < 5);
        assert_null(mesh);
        const mote_status right = strstr(bad->says, "crashed") ? MOTE_EIO : MOTE_EINVAL;
        if (status != right || !strstr(mote_error_text(), bad->says) ||
            !strstr(mote_error_text(), bad->name))
            fail_msg("case %zu: status %d, \"%s\" lacks \"%s\"", i, (int)status,
                     mote_error_text(), bad->says);
    }
}

TEST(mote_mesh_import_not_a_file_is_refused)
{
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_import("no/such.obj", &mesh, NULL), MOTE_EIO);
    assert_int_equal(mote_mesh_import(".", &mesh, NULL), MOTE_EINVAL);
    assert_int_equal(mote_mesh_import("/dev/zero", &mesh, NULL), MOTE_EINVAL);
    assert_int_equal(mkfifo("p.obj", 0600), 0);
    assert_int_equal(mote_mesh_import("p.obj", &mesh, NULL), MOTE_EINVAL);
    file_write("z.obj", "v 0 0 0\n\0\n", 10);
    assert_int_equal(mote_mesh_import("z.obj", &mesh, NULL), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "z.obj: a zero byte at 8; give text");
    /* No byte of this file is stored. */
    file_put("l.obj", "");
    assert_int_equal(truncate("l.obj", ((off_t)4 << 30) + 1), 0);
    assert_int_equal(mote_mesh_import("l.obj", &mesh, NULL), MOTE_EINVAL);
    assert_string_equal(mote_error_text(),
                        "l.obj: 4294967297 bytes; at most 4294967296 are read");
    assert_null(mesh);
}

/* Copies text with a few bytes changed, cut or repeated, or with absurd numbers. */
static size_t mutate(const char *text, mote_random *random, char *out)
{
    static const char *const absurd[] = {"-1",         "99999999",   "nan", "1e400",
                                         "0x7fffffff", "4294967295", ",",   "\r",
                                         "1e-320",     "-2147483648"};
    size_t size = strlen(text);
    memcpy(out, text, size);
    for (uint64_t changes = 1 + mote_random_below(random, 4); changes > 0; --changes) {
        const size_t at = mote_random_below(random, size);
        const char *word = absurd[mote_random_below(random, sizeof absurd / sizeof absurd[0])];
        switch (mote_random_below(random, 4)) {
        case 0:
            out[at] = (char)mote_random_below(random, 256);
            break;
        case 1:
            size = at + 1;
            break;
        default:
            memmove(out + at + strlen(word), out + at, size - at);
            memcpy(out + at, word, strlen(word));
            size += strlen(word);
            break;
        }
    }
    return size;
}

/* Every result comes soon, as a valid mesh or as an error. */
TEST(mote_mesh_import_mutated_files_are_read_or_refused)
{
    static const struct {
        const char *name, *text;
    } kinds[] = {
        {"m.obj", obj_text}, {"m.off", off_text}, {"m.ply", ply_text}, {"m.stl", stl_text}};
    mote_random random = {1};
    int read = 0;
    for (int i = 0; i < 1000; ++i) {
        char text[2048];
        const size_t kind = i % 8 < 4 ? 0 : (size_t)(i % 4);
        const size_t size = mutate(kinds[kind].text, &random, text);
        mote_mesh *mesh = NULL;
        const double start = mote_clock_seconds();
        if (import_text(kinds[kind].name, text, size, &mesh, NULL) == MOTE_OK) {
            assert_true(isfinite(mesh->diagonal) && mesh->diagonal > 0);
            assert_true(mesh->triangle_count <= 16);
            mote_mesh_destroy(mesh);
            ++read;
        } else {
            assert_null(mesh);
            assert_null(strchr(mote_error_text(), '\n'));
        }
        assert_true(mote_clock_seconds() - start < 5);
    }
    assert_in_range(read, 1, 999);
}
