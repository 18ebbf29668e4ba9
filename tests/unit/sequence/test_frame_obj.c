/* OBJ texts of one triangle read as a frame: written in other ways, or with one thing wrong.
   The reader of meshes, which is another program text, must agree. */
#include "harness/mesh/mesh_soup.h"
#include "harness/sequence/frame_file.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define VERTICES "v 0 0 0\nv 1 0 0\nv 0 1 0.5\n"

static mote_status read(const char *text, double xyz[9], mote_frame_file *file)
{
    *file = (mote_frame_file){.xyz = xyz, .room = 3};
    return mote_frame_file_read_obj("f.obj", text, file);
}

static mote_status read_mesh(const char *text, mote_soup *soup)
{
    *soup = (mote_soup){0};
    return mote_soup_read_obj("f.obj", text, soup);
}

TEST(obj_that_is_written_otherwise_is_the_same_triangle)
{
    static const char *const texts[] = {
        VERTICES "f 1 2 3\n",
        "\xef\xbb\xbf" VERTICES "f 1 2 3",
        VERTICES "f +1 +2 +3 ",
        VERTICES "f -3 -2 -1\n",
        VERTICES "f 1/1 2/2 3/3\n",
        VERTICES "f 1//4 2//5 3//6\n",
        VERTICES "f 1/1/4 2/2/5 3/3/6 # faces\n",
        VERTICES "\tf\t1\t2\t3\t\n",
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0.5\r\nf 1 2 3\r\n",
        "v 0 0 0 #x\nv 1 0 0 1.5#\nv 0 1 .5e0 #\nf 1 2 3#4\n",
        "v 0\t0 0\nv +1. -0 0e5\nv 0e-5 1E+0 5e-1\nf 1 2 3\n",
        "v 0 0e0001 0\nv 10e-1 0 0\nv 0 0x1 0.50000000000000000000000\nf 1 2 3\n",
        "# none \\\nv \\\n0 0 0\nv 1 0\\\r\n 0\nv 0 1 0.5\\\n\nf 1 2\\\n\\\n 3\n\\\n\n",
        ("\r\n\n#\n \\\n\nvn 0 0 1\nvt 0 0\nvp 1\nfo 1 2\nv\\\n 0 0 0\nv 1 0 0\nv 0 1 0.5\n"
         "g v f\nf\\\n 1 2 3\nusemtl f"),
        "\\\r\nv 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n",
    };
    static const double corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0.5};
    uint64_t topology = 0;
    for (size_t i = 0; i < ROWS_OF(texts); ++i) {
        double xyz[9];
        mote_frame_file file;
        mote_soup soup;
        test_row("%s", texts[i]);
        if (read(texts[i], xyz, &file) != MOTE_OK || read_mesh(texts[i], &soup) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        assert_int_equal(file.count, 3);
        assert_int_equal(soup.vertex_count, 3);
        assert_int_equal(soup.triangle_count, 1);
        for (int k = 0; k < 9; ++k)
            assert_true(xyz[k] == corners[k] && soup.xyz[k] == corners[k]);
        topology = i == 0 ? file.topology : topology;
        assert_true(file.topology == topology);
        mote_soup_free(&soup);
    }
}

/* Another order of corners or faces, or another number of corners, is another topology. */
TEST(obj_topology_depends_on_faces)
{
    static const char *const faces[] = {
        "",          "f 1 2 3\n",          "f 2 3 1\n",          "f 1 2\n",
        "f 1 2 2\n", "f 1 2 3\nf 1 3 2\n", "f 1 3 2\nf 1 2 3\n", "f 1 2 3 1 3 2\n"};
    uint64_t topology[ROWS_OF(faces)];
    for (size_t i = 0; i < ROWS_OF(faces); ++i) {
        double xyz[9];
        char text[200];
        mote_frame_file file;
        (void)snprintf(text, sizeof text, "%s%s", VERTICES, faces[i]);
        assert_int_equal(read(text, xyz, &file), MOTE_OK);
        topology[i] = file.topology;
        for (size_t k = 0; k < i; ++k)
            assert_true(topology[k] != topology[i]);
    }
}

/* Vertices beyond the room are counted, and neither stored nor lost from the check. */
TEST(obj_with_more_vertices_than_room_counts_them)
{
    double xyz[3] = {9, 9, 9};
    mote_frame_file file = {.xyz = xyz, .room = 1};
    assert_int_equal(mote_frame_file_read_obj("f.obj", VERTICES "f 1 2 3\n", &file), MOTE_OK);
    assert_int_equal(file.count, 3);
    assert_true(xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0);
    assert_int_equal(mote_frame_file_read_obj("f.obj", "v 1 2\n", &file), MOTE_EINVAL);
}

TEST(obj_frame_with_one_thing_wrong_names_the_line)
{
    static const char vertex[] = "a vertex without three numbers; write v x y z",
                      finite[] = "a coordinate is not a finite double; give a smaller number",
                      corner[] = "a face corner that is none of the vertices before it; write";
    static const struct {
        const char *text;
        int line;
        const char *says;
    } rows[] = {
        {"v\n", 1, vertex},
        {"v", 1, vertex},
        {"v 1 2\n", 1, vertex},
        {"v 1 2 # 3\n", 1, vertex},
        {"\nv 1 2 x\n", 2, vertex},
        {"v 1 2 3x\n", 1, vertex},
        {"v 1,5 2 3\n", 1, vertex},
        {"v 1 2 3e\n", 1, vertex},
        {"v 1 2 3e+\n", 1, vertex},
        {"v 1 2 3e-x\n", 1, vertex},
        {"v 1 2 \\ 3\n", 1, vertex},
        {"v 1 \\\n2\n", 2, vertex},
        {"v 1 2 --3\n", 1, vertex},
        {"v 1 2 .\n", 1, vertex},
        {"v 1 2 1e400\n", 1, finite},
        {"v 1 2 1e99999999999\n", 1, finite},
        {"v -inf 2 3\n", 1, finite},
        {"v 1 nan 3\n", 1, finite},
        {"v 1 2 -1.#IND00\n", 1, finite},
        {"v 1.#INF 2 3\n", 1, finite},
        {"v 1 1#QNAN 3\n", 1, finite},
        {"v 1 2 3#\n", 1, finite},
        {VERTICES "f 1 2 4\n", 4, corner},
        {VERTICES "f 1 2 0\n", 4, corner},
        {VERTICES "f 1 2 -4\n", 4, corner},
        {VERTICES "f 1 2 3x\n", 4, corner},
        {VERTICES "f 1 2 x\n", 4, corner},
        {VERTICES "f /1 2 3\n", 4, corner},
        {VERTICES "f 1 2 99999999999999999999\n", 4, corner},
        {VERTICES "f 1 2 4294967297\n", 4, corner},
        {VERTICES "f 1 2 1.5\n", 4, corner},
        {VERTICES "#\\\nf 1 \\\n2 7\n", 6, corner},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        double xyz[9];
        char place[32];
        mote_frame_file file;
        mote_soup soup;
        test_row("%s", rows[i].text);
        (void)snprintf(place, sizeof place, "f.obj:%d: ", rows[i].line);
        assert_int_equal(read(rows[i].text, xyz, &file), MOTE_EINVAL);
        if (strncmp(mote_error_text(), place, strlen(place)) != 0 ||
            strncmp(mote_error_text() + strlen(place), rows[i].says, strlen(rows[i].says)) != 0)
            fail_msg("%s", mote_error_text());
        assert_int_equal(read_mesh(rows[i].text, &soup), MOTE_EINVAL);
        assert_int_equal(strncmp(mote_error_text(), place, strlen(place)), 0);
        mote_soup_free(&soup);
    }
}

/* Numbers at the ends of what is read without strtod: 18 digits, 2^53, powers of ten up to 22.
 */
TEST(obj_numbers_are_those_of_strtod)
{
    static const char *const numbers[] = {"9007199254740992",
                                          "9007199254740993",
                                          "9007199254740994",
                                          "1e22",
                                          "1e23",
                                          "1e-22",
                                          "1e-23",
                                          "123456789012345678",
                                          "1234567890123456789",
                                          "0.123456789012345678",
                                          "0.1234567890123456789",
                                          "1e-400",
                                          "-1e+22",
                                          "+0.1e-21",
                                          "12345678901234567890e-20",
                                          "00000000000000000001",
                                          "1e0000000000000001",
                                          "1.5E-0000000000000000000000003",
                                          "1e1000"};
    for (size_t i = 0; i < ROWS_OF(numbers); ++i) {
        double xyz[9];
        char text[200];
        mote_frame_file file;
        (void)snprintf(text, sizeof text, "v 0 0 %s\n", numbers[i]);
        test_row("%s", text);
        const double right = strtod(numbers[i], NULL);
        assert_int_equal(read(text, xyz, &file), isfinite(right) ? MOTE_OK : MOTE_EINVAL);
        if (isfinite(right))
            assert_memory_equal(&xyz[2], &right, sizeof right);
    }
}
