/* PLY texts and binary files of one triangle, each with one thing changed. */
#include "harness/base/file.h"
#include "harness/mesh/mesh_import.h"
#include "harness/mesh/mesh_soup.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <math.h>

#define VERTEX "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
#define LIST "property list uchar int vertex_indices\n"
#define HEAD_OF(element)                                                                       \
    "ply\nformat ascii 1.0\n" VERTEX "element " element " 1\n" LIST "end_header\n"
#define BODY "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
#define HEAD HEAD_OF("face")
#define WHOLE HEAD BODY
#define STRIPS HEAD_OF("tristrips") BODY

typedef struct row {
    const char *from, *to, *says;
} row;

static char *changed(const char *whole, const row *change)
{
    const char *at = strstr(whole, change->from);
    assert_non_null(at);
    return mote_format("%.*s%s%s", (int)(at - whole), whole, change->to,
                       at + strlen(change->from));
}

typedef struct triangle {
    mote_frame_file file;
    mote_soup soup;
    double xyz[9];
} triangle;

static mote_status read(const void *data, size_t size, triangle *out)
{
    *out = (triangle){.file = {.room = 3}};
    out->file.xyz = out->xyz;
    const mote_status status =
        mote_frame_file_read_ply("p.ply", data, size, &out->file, &out->soup);
    if (status != MOTE_OK)
        return status;
    mote_soup_drop_collapsed(&out->soup);
    return mote_soup_refuse_collapsed("p.ply", &out->soup);
}

/* Positions, and the soup's triangle. */
static void check(const triangle *got)
{
    static const double corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint32_t indices[3] = {0, 1, 2};
    assert_int_equal(got->file.count, 3);
    assert_int_equal(got->soup.triangle_count, 1);
    for (int k = 0; k < 9; ++k)
        assert_true(got->xyz[k] == corners[k] && got->soup.xyz[k] == corners[k]);
    assert_memory_equal(got->soup.indices, indices, sizeof indices);
}

TEST(ply_that_is_written_otherwise_is_the_same_triangle)
{
    static const row rows[] = {
        {"ply\n", "ply\r\n", NULL},
        {"ply\n", "\xef\xbb\xbfPLY\n", NULL},
        {"\nend", "\n\ncomment a\nobj_info b c d e f g h\nend", NULL},
        {"\nend", "\n \t \nend", NULL},
        {LIST, "property list int8 uint16 vertex_index\n", NULL},
        {LIST, "property list uint short vertex_indices\n", NULL},
        {LIST, "property list uchar float vertex_indices\n", NULL},
        {"face 1", "tristrips 1", NULL},
        {"face 1\n" LIST, "face 0\n" LIST "element tristrips 1\n" LIST, NULL},
        {"face 1\n" LIST "end_header\n0 0 0\n1 0 0\n0 1 0\n",
         "face 1\n" LIST "element face 1\n" LIST
         "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 0 2\n", /* a triangle without area */
         NULL},
        {"3 0 1 2\n", "3 0 1 2\n \t\r\n\n", NULL},
        {LIST "end_header\n0 0 0\n1 0 0\n0 1 0\n3",
         "property uchar mark\nproperty list ushort double odd\n" LIST
         "end_header\n0 0 0\n1 0 0\n0 1 0\n7 2 0.5 -1 3",
         NULL},
        {"element face 1\n" LIST "end_header\n0 0 0\n1 0 0\n0 1 0\n",
         "property list uchar int x\nproperty float xy\nproperty float a\nelement odd 2\n"
         "property int x\n" /* of no vertex */
         "property int vertex_indices\nproperty list uchar int other\nelement face 1\n" LIST
         "end_header\n0 0 0 0 4 5\n1 0 0 2 8 9 6 7\n0 1 0 1 9 8 9\n1 1 0\n2 2 1 3\n",
         NULL},
        {"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "0\t0 0 1 0\n\n0\r\n 0 1 0 3 0 1 2", NULL},
        {"0 0 0\n1 0 0\n", "-0 0x0 0e5\n1.0 0. .0\n", NULL},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        triangle got;
        char *text = changed(WHOLE, &rows[i]);
        test_row("%s", text);
        if (read(text, strlen(text), &got) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        check(&got);
        mote_soup_free(&got.soup);
        free(text);
    }
}

static void refuse(const char *text, const char *says)
{
    triangle got;
    test_row("%s", text);
    assert_int_equal(read(text, strlen(text), &got), MOTE_EINVAL);
    if (strncmp(mote_error_text(), says, strlen(says)) != 0)
        fail_msg("%s", mote_error_text());
    assert_non_null(strstr(mote_error_text(), "; ")); /* and what would be right */
    mote_soup_free(&got.soup);
}

static void refuse_rows(const row *rows, size_t count, const char *whole)
{
    for (size_t i = 0; i < count; ++i) {
        char *text = changed(whole, &rows[i]);
        refuse(text, rows[i].says);
        free(text);
    }
}

TEST(ply_with_a_wrong_header_is_refused_with_its_line)
{
    static const row rows[] = {
        {"ply\n", "plx\n", "p.ply:1: does not begin with the word ply"},
        {"ply\n", "ply 1\n", "p.ply:1: does not begin with the word ply"},
        {WHOLE, "ply\rformat ascii 1.0\r", "p.ply: lines that end with a carriage return"},
        {"ply\n", "\n", "p.ply:1: does not begin with the word ply"},
        {WHOLE, "ply", "p.ply:1: a header without a line end_header; add it"},
        {"format ascii 1.0\n", "", "p.ply:8: a header without a format"},
        {"format ascii 1.0", "format ascii", "p.ply:2: an unknown format; write format"},
        {"format ascii 1.0", "format binary 1.0", "p.ply:2: an unknown format; write format"},
        {"format ascii 1.0", "format", "p.ply:2: an unknown format; write format"},
        {"vertex 3", "vertex", "p.ply:3: an element without a name and a count"},
        {"vertex 3", "vertex 3 3", "p.ply:3: an element without a name and a count"},
        {"vertex 3", "vertex three", "p.ply:3: an element without its count; write element"},
        {"vertex 3", "vertex -3", "p.ply:3: an element without its count"},
        {"vertex 3", "vertex 3x", "p.ply:3: an element without its count"},
        {"vertex 3", "vertex 999", "p.ply:3: declares 999 elements, which the 1"},
        {"element vertex 3\n", "", "p.ply:3: a property of no element; write the element"},
        {"element face", "element vertex", "p.ply:7: a second vertex element; give one"},
        {"float x", "float", "p.ply:4: a property that is not a type and a name"},
        {"float x", "float x y", "p.ply:4: a property that is not a type and a name"},
        {"property float x", "property float x y z",
         "p.ply:4: a property that is not a type and a name"},
        {"property float x", "property", "p.ply:4: a property that is not a type and a name"},
        {"float x", "real x", "p.ply:4: a property of an unknown type; give float, int"},
        {"uchar int", "byte int", "p.ply:8: a property of an unknown type"},
        {"uchar int", "float int", "p.ply:8: a property of an unknown type"},
        {"uchar int", "uchar integer", "p.ply:8: a property of an unknown type"},
        {LIST, LIST "property list uchar int vertex_index\n",
         "p.ply:9: a second list of corners in one element; give one"},
        {"float y", "float x", "p.ply:9: no vertex element with x, y and z once each; add it"},
        {"float z\n", "float z\nproperty int z\n", "p.ply:10: no vertex element with x, y"},
        {"float z", "float w", "p.ply:9: no vertex element with x, y and z once each"},
        {"float z", "float zz", "p.ply:9: no vertex element with x, y and z once each"},
        {"float x", "float X", "p.ply:9: no vertex element with x, y and z once each"},
        {"vertex 3", "vertices 3", "p.ply:9: no vertex element with x, y and z once each"},
        {"vertex_indices", "corners", "p.ply:9: no face element with vertex_indices; add it"},
        {"element face", "element faces", "p.ply:9: no face element with vertex_indices"},
        {"property list uchar int vertex_indices", "property int vertex_indices",
         "p.ply:9: no face element with vertex_indices"},
    };
    refuse_rows(rows, ROWS_OF(rows), WHOLE);
}

TEST(ply_with_wrong_entries_is_refused_with_their_number)
{
    static const row rows[] = {
        {"1 0 0", "1 x 0", "p.ply:11: has something that is not a number after vertex 1 of 3"},
        {"1 0 0", "1,5 0 0", "p.ply:11: a comma among numbers; write 1.5, not 1,5"},
        {"3 0 1 2", "3 0,1,2", "p.ply:13: a comma among numbers; write 1.5, not 1,5"},
        {"1 0 0", "1 0; 0", "p.ply:11: has something that is not a number after vertex 1"},
        {"0 1 0\n3 0 1 2\n", "", "p.ply:12: ends after vertex 2 of 3; give all, or declare"},
        {"0 1 0", "inf 1 0", "p.ply:12: vertex 3 has a coordinate that is not a finite"},
        {"0 1 0", "0 1e999 0", "p.ply:12: vertex 3 has a coordinate that is not a finite"},
        {"0 1 0", "0 1 nan", "p.ply:12: vertex 3 has a coordinate that is not a finite"},
        {"3 0 1 2\n", "", "p.ply:13: ends after face 0 of 1; give all, or declare fewer"},
        {"3 0 1 2", "three", "p.ply:13: has something that is not a number after face 0"},
        {"3 0 1 2\n", "3 0 1", "p.ply:13: ends after face 0 of 1"},
        {"3 0 1 2", "3 0 1 b", "p.ply:13: has something that is not a number after face 0"},
        {"3 0 1 2", "2 0 1", "p.ply:13: face 1 has 2 corners; give at least 3"},
        {"3 0 1 2", "0", "p.ply:13: face 1 has 0 corners; give at least 3"},
        {"3 0 1 2", "-1 0", "p.ply:13: a list of -1 entries; give at most 1000000"},
        {"3 0 1 2", "3.5 0 1 2", "p.ply:13: a list of 3.5 entries; give at most 1000000"},
        {"3 0 1 2", "1e7 0 1 2", "p.ply:13: a list of 10000000 entries; give at most 1000000"},
        {"3 0 1 2", "nan 0 1 2", "p.ply:13: a list of nan entries; give at most 1000000"},
        {"3 0 1 2", "3 0 1 3", "p.ply:13: face 1 has vertex 3 of 3; use 0 to 2"},
        {"3 0 1 2", "3 -1 1 2", "p.ply:13: face 1 has vertex -1 of 3; use 0 to 2"},
        {"3 0 1 2", "3 0 0.5 2", "p.ply:13: face 1 has vertex 0.5 of 3; use 0 to 2"},
        {"3 0 1 2", "3 0 nan 2", "p.ply:13: face 1 has vertex nan of 3; use 0 to 2"},
        {"3 0 1 2", "3 0 1 0", "p.ply: each of its 1 faces has two corners at one place; give"},
        {"3 0 1 2", "5 0 1 2 0 1", "p.ply:13: face 1: a face with a vertex twice; give"},
        {"3 0 1 2\n", "3 0 1 2\n3 0 1 2\n", "p.ply:14: goes on after all that is declared"},
        {"1 0 0", "1 0 0 0", "p.ply:"}, /* numbers of no property */
        {"face 1", "face 0", "p.ply:13: goes on after all that is declared; declare what"},
        {LIST, LIST "element odd 1\nproperty int a\n", "p.ply:16: ends after entry 0 of 1"},
        {LIST, LIST "element odd 1\nproperty list int int a\n",
         "p.ply:16: ends after entry 0 of 1"},
    };
    refuse_rows(rows, ROWS_OF(rows), WHOLE);
}

TEST(ply_with_wrong_strips_is_refused_with_their_number)
{
    static const row rows[] = {
        {"3 0 1 2", "2 0 1", "p.ply:13: strip 1 has a part of 2 corners; give at least 3"},
        {"3 0 1 2", "5 0 1 2 -1 2", "p.ply:13: strip 1 has a part of 1 corners; give at"},
        {"3 0 1 2", "3 0 1 3", "p.ply:13: strip 1 has vertex 3 of 3; use 0 to 2"},
        {"3 0 1 2", "3 0 1 -2", "p.ply:13: strip 1 has vertex -2 of 3; use 0 to 2"},
        {"3 0 1 2", "9 0 1 2", "p.ply:13: a list of 9 entries; give at most 7"},
        {"3 0 1 2\n", "", "p.ply:13: ends after strip 0 of 1; give all"},
        {"3 0 1 2", "0", "p.ply: no face in it; give triangles"},
        {"3 0 1 2", "4 0 0 1 1", "p.ply: each of its 2 faces has two corners at one"},
    };
    refuse_rows(rows, ROWS_OF(rows), STRIPS);
}

/* Five vertices; faces, two strips in one list with a repeated corner that makes no triangle,
   and faces again. */
TEST(ply_faces_and_strips_of_all_elements_are_read_in_order)
{
    static const char text[] =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\n" LIST "element tristrips 1\n"
        "property list int int vertex_indices\nelement face 1\n" LIST "end_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n3 0 1 4\n"
        "10 0 1 2 3 -1 2 3 3 4 -1\n3 4 3 0\n";
    static const uint32_t indices[][3] = {{0, 1, 4}, {0, 1, 2}, {2, 1, 3}, {4, 3, 0}};
    triangle got = {0};
    if (mote_frame_file_read_ply("p.ply", text, strlen(text), &got.file, &got.soup) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_soup_drop_collapsed(&got.soup);
    assert_int_equal(got.soup.triangle_count, ROWS_OF(indices));
    assert_memory_equal(got.soup.indices, indices, sizeof indices);
    assert_int_equal(got.soup.collapsed, 2);
    assert_int_equal(got.soup.lines[2], 20);
    mote_soup_free(&got.soup);
}

/* As a mesh, vertices at one place become one; coordinates are those of the text. */
TEST(ply_as_a_mesh_is_exact_and_welded)
{
    static const char text[] =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\n" LIST "end_header\n"
        "0 0 0\n1 0 0\n0 0.1 0\n1 0 0\n1 0.1 0\n3 0 1 2\n3 3 4 2\n";
    mote_mesh *mesh;
    mote_import import;
    file_write("exact.ply", text, strlen(text));
    if (mote_mesh_import("exact.ply", &mesh, &import) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(import.welded, 1);
    assert_false(import.single_precision);
    assert_true(mesh->high.y == 0.1);
    mote_mesh_destroy(mesh);
}

TEST(ply_with_too_many_declarations_is_refused)
{
    mote_text elements = {0}, properties = {0};
    mote_text_add(&elements, "ply\nformat ascii 1.0\n");
    for (int k = 0; k < 17; ++k)
        mote_text_add(&elements, "element e%d 1\n", k);
    refuse(elements.data, "p.ply:19: more than 16 elements; leave some out");
    mote_text_add(&properties, "ply\nformat ascii 1.0\nelement vertex 3\n");
    for (int k = 0; k < 65; ++k)
        mote_text_add(&properties, "property int p%d\n", k);
    refuse(properties.data, "p.ply:68: more than 64 properties; leave some out");
    free(elements.data);
    free(properties.data);
}

/* A line of the header is read to its 255th character; what follows is a comment's. */
TEST(ply_with_a_long_comment_is_read)
{
    triangle got;
    char *text = mote_format("ply\ncomment %0300d end_header\n%s", 1, &WHOLE[4]);
    assert_int_equal(read(text, strlen(text), &got), MOTE_OK);
    check(&got);
    mote_soup_free(&got.soup);
    free(text);
}

/* Without a soup, faces are counted but not made into triangles. */
TEST(ply_without_a_soup_gives_positions_and_topology)
{
    uint64_t topology[3];
    static const char *const faces[] = {"3 0 1 2\n", "3 1 0 2\n", "2 0 1\n"};
    for (int k = 0; k < 3; ++k) {
        double xyz[3] = {9, 9, 9};
        mote_frame_file file = {.xyz = xyz, .room = 1};
        char *text = mote_format("%s7 8 9\n1 0 0\n0 1 0\n%s", HEAD, faces[k]);
        assert_int_equal(mote_frame_file_read_ply("p.ply", text, strlen(text), &file, NULL),
                         MOTE_OK);
        assert_int_equal(file.count, 3);
        assert_true(xyz[0] == 7 && xyz[1] == 8 && xyz[2] == 9);
        topology[k] = file.topology;
        free(text);
    }
    assert_true(topology[0] != topology[1] && topology[0] != topology[2] &&
                topology[1] != topology[2]);
}

typedef struct bytes {
    char data[1024];
    size_t size;
} bytes;

/* Appends the low bytes of a word. */
static void put(bytes *to, uint64_t word, size_t size, bool big)
{
    for (size_t k = 0; k < size; ++k)
        to->data[to->size++] = (char)(word >> 8 * (big ? size - 1 - k : k) & 0xff);
}

static const struct {
    const char *name;
    size_t size;
    uint64_t bits; /* of the value */
    double value;
} types[] = {
    {"char", 1, 0xfe, -2},
    {"int8", 1, 0x7f, 127},
    {"uchar", 1, 0xfe, 254},
    {"uint8", 1, 0x80, 128},
    {"short", 2, 0xfffe, -2},
    {"int16", 2, 0x7fff, 32767},
    {"ushort", 2, 0xfffe, 65534},
    {"uint16", 2, 0x0102, 258},
    {"int", 4, 0xfffffffe, -2},
    {"int32", 4, 0x01020304, 16909060},
    {"uint", 4, 0xfffffffe, 4294967294.0},
    {"uint32", 4, 0x80000000, 2147483648.0},
    {"float", 4, 0xbfc00000, -1.5},
    {"float32", 4, 0x3e800000, 0.25},
    {"double", 8, 0xbff8000000000000, -1.5},
    {"float64", 8, 0x3fd0000000000000, 0.25},
};

/* A binary file whose coordinate x, and the counts of its face, are of these types. */
static bytes binary(size_t x, size_t count, bool big)
{
    bytes file = {.size = 0};
    file.size = (size_t)snprintf(
        file.data, sizeof file.data,
        "ply\nformat binary_%s_endian 1.0\nelement vertex 3\nproperty %s x\nproperty float y\n"
        "property double z\nelement face 1\nproperty list %s ushort vertex_indices\n"
        "end_header\n",
        big ? "big" : "little", types[x].name, types[count].name);
    for (uint64_t v = 0; v < 3; ++v) {
        put(&file, types[x].bits, types[x].size, big);
        put(&file, v == 1 ? 0x3f800000 : 0, 4, big);
        put(&file, v == 2 ? 0x3ff0000000000000 : 0, 8, big);
    }
    put(&file, 3, types[count].size, big);
    for (uint64_t v = 0; v < 3; ++v)
        put(&file, v, 2, big);
    return file;
}

TEST(ply_numbers_of_each_type_and_byte_order_are_read)
{
    for (size_t i = 0; i < 2 * ROWS_OF(types); ++i) {
        triangle got;
        const size_t x = i / 2;
        const bytes file = binary(x, x % 12, i % 2);
        test_row("%s, %s", types[x].name, i % 2 ? "big" : "little");
        if (read(file.data, file.size, &got) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        for (int v = 0; v < 3; ++v) {
            assert_true(got.xyz[3 * v] == types[x].value);
            assert_true(got.xyz[3 * v + 1] == (v == 1) && got.xyz[3 * v + 2] == (v == 2));
        }
        assert_int_equal(got.soup.triangle_count, 1);
        mote_soup_free(&got.soup);
    }
}

/* Wherever it is cut behind its header, also within a number. */
TEST(ply_binary_that_is_cut_short_says_where)
{
    const bytes file = binary(8, 4, false);
    const size_t vertex = 4 + 4 + 8, header = file.size - 3 * vertex - 2 - 3 * 2;
    for (size_t size = header; size < file.size; ++size) {
        triangle got;
        char says[80];
        const size_t vertices = (size - header) / vertex;
        (void)snprintf(says, sizeof says, "p.ply: ends after %s %zu of %d; give all",
                       vertices < 3 ? "vertex" : "face", vertices < 3 ? vertices : 0,
                       vertices < 3 ? 3 : 1);
        test_row("%zu of %zu bytes", size, file.size);
        assert_int_equal(read(file.data, size, &got), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), says));
        mote_soup_free(&got.soup);
    }
}
