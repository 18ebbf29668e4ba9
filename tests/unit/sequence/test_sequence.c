/* Damaged, changed and unusual files of a sequence, and long ones. */
#include "harness/sequence/frame_file.h"
#include "harness/sequence/point_cache.h"
#include "harness/sequence/sequence_reader.h"
#include "tests/support/sheet.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/stat.h>

TEST_EACH(folder_next, NULL);

/* Opens a sequence and reads all of it; returns the first error. */
static mote_status read_all(const char *path, const char *mesh_path, uint32_t frames)
{
    mote_sequence *sequence = NULL;
    mote_mesh *mesh = NULL;
    mote_import import;
    mote_status status =
        mote_sequence_is_cache(path)
            ? mote_sequence_open_cache(path, mesh_path, frames, &sequence, &mesh, &import)
            : mote_sequence_open_files(path, frames, &sequence, &mesh, &import);
    if (status != MOTE_OK)
        return status;
    mote_sequence_reader *reader = mote_sequence_reader_create(sequence);
    mote_vec3 *positions = malloc(sequence->vertex_count * sizeof *positions);
    for (uint32_t k = 1; k <= frames && status == MOTE_OK; ++k)
        status = mote_sequence_read(reader, k, positions);
    mote_sequence_reader_destroy(reader);
    mote_sequence_destroy(sequence);
    mote_mesh_destroy(mesh);
    free(positions);
    return status;
}

static void expect(mote_status status, const char *says, const char *path, const char *mesh,
                   uint32_t frames)
{
    const mote_status got = read_all(path, mesh, frames);
    if (got != status || !strstr(mote_error_text(), says))
        fail_msg("status %d, and not %d with \"%s\": %s", (int)got, (int)status, says,
                 mote_error_text());
}

/* Replaces `from` once in a file. */
static void replace(const char *path, const char *from, const char *to)
{
    char *text = file_text(path), *at = strstr(text, from);
    assert_non_null(at);
    char *changed = mote_format("%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    file_put(path, changed);
    free(changed);
    free(text);
}

static void write_four(const char *ending)
{
    for (int k = 1; k <= 4; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "f%d.%s", k, ending);
        if (strcmp(ending, "obj") == 0)
            sheet_write_obj(name, k);
        else
            sheet_write_ply(name, k, SHEET_ASCII);
    }
}

TEST(sequence_names_the_frame_and_what_is_wrong_with_it)
{
    static const struct {
        const char *ending, *from, *to, *says;
    } rows[] = {
        {"obj", "v 0.5 0.5 1.96875\n", "", "frame 3: f3.obj:"},
        {"obj", "v 0.5 0.5 1.96875\n", "v 0.5 0.5\n", "frame 3: f3.obj:25: a vertex without"},
        {"obj", "v 0.5 0.5 1.96875\n", "v 0.5 0.5 nan\n", "frame 3: f3.obj:25: a coordinate"},
        {"obj", "v 0.5 0.5 1.96875\n", "v 0.5 0.5 1e999\n", "frame 3: f3.obj:25: a coordinate"},
        {"obj", "v 0.5 0.5 1.96875\n", "v 0.5 0.5 -3e9\n", "frame 3: f3.obj: vertex 25 is at"},
        {"obj", "f 1 2 6\n", "v 1 2 3\nf 1 2 6\n",
         "frame 3: f3.obj: 26 vertices, where f1.obj has 25"},
        {"obj", "f 1 2 6\n", "f 2 1 6\n", "frame 3: f3.obj: other faces than f1.obj has"},
        {"obj", "f 1 2 6\n", "", "frame 3: f3.obj: other faces"},
        {"obj", "f 1 2 6\n", "f 1 2 6 7\n", "frame 3: f3.obj: other faces"},
        {"obj", "f 1 2 6\n", "f 1 2 99\n", "frame 3: f3.obj:26: a face corner that is none"},
        {"obj", "f 1 2 6\n", "f 1 2 x\n", "frame 3: f3.obj:26: a face corner that is none"},
        {"ply", "7 1.96875 0.5 0.5\n", "7 1.96875 0.5 x\n",
         "frame 3: f3.ply:39: has something that is not a number after vertex 24 of 25"},
        {"ply", "7 1.96875 0.5 0.5\n", "7 inf 0.5 0.5\n",
         "frame 3: f3.ply:39: vertex 25 has a coordinate"},
        {"ply", "3 0 1 5\n", "3 0 1 25\n", "face 1 has vertex 25 of 25"},
        {"ply", "3 0 1 5\n", "3 1 0 5\n", "frame 3: f3.ply: other faces"},
        {"ply", "face 32", "face 33", "frame 3: f3.ply:73: ends after face 32 of 33"},
        {"ply", "face 32", "face 31", "frame 3: f3.ply:72: goes on after all that is declared"},
        {"ply", "vertex 25", "vertex 99999", "declares 99999 elements"},
        {"ply", "format ascii", "format odd", "an unknown format"},
        {"ply", "end_header", "end_heads", "end_header"},
        {"ply", "element vertex",
         "element face 1\nproperty list uchar int vertex_indices\nelement vertex",
         "faces before the vertices"},
        {"ply", "end_header", "element vertex 30\nend_header", "a second vertex element"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char name[16], first[16];
        test_row("%s to %s", rows[i].from, rows[i].to);
        write_four(rows[i].ending);
        (void)snprintf(first, sizeof first, "f1.%s", rows[i].ending);
        (void)snprintf(name, sizeof name, "f3.%s", rows[i].ending);
        expect(MOTE_OK, "", first, NULL, 4);
        replace(name, rows[i].from, rows[i].to);
        expect(MOTE_EINVAL, rows[i].says, first, NULL, 4);
        expect(MOTE_OK, "", first, NULL, 2); /* the frames before it are good */
    }
}

TEST(sequence_goes_on_after_a_frame_that_could_not_be_read)
{
    mote_sequence *sequence;
    mote_mesh *mesh;
    mote_import import;
    mote_vec3 at[SHEET_VERTICES];
    write_four("obj");
    assert_int_equal(mote_sequence_open_files("f1.obj", 4, &sequence, &mesh, &import), MOTE_OK);
    mote_sequence_reader *reader = mote_sequence_reader_create(sequence);
    assert_int_equal(mote_sequence_read(reader, 1, at), MOTE_OK);
    assert_int_equal(folder_remove("f2.obj"), 0); /* it existed when the sequence was opened */
    assert_int_equal(mote_sequence_read(reader, 2, at), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "frame 2: f2.obj: "));
    assert_int_equal(mote_sequence_read(reader, 3, at), MOTE_OK);
    assert_true(at[7].z == sheet_at(7, 2, 3));
    mote_sequence_reader_destroy(reader);
    mote_sequence_destroy(sequence);
    mote_mesh_destroy(mesh);
}

/* Every form of number allowed in OBJ, read as strtod reads it. */
TEST(sequence_reads_numbers_as_strtod_does)
{
    static const char *const numbers[] = {"0",
                                          "-0",
                                          "+1.5",
                                          "1.",
                                          ".5",
                                          "-.25",
                                          "1e5",
                                          "1E-5",
                                          "1e+22",
                                          "1e22",
                                          "1e23",
                                          "123456789012345678",
                                          "0.1",
                                          "0.3",
                                          "3.14159",
                                          "1e-22",
                                          "1e-23",
                                          "0.30000000000000004",
                                          "9007199254740993",
                                          "9007199254740992",
                                          "4.35",
                                          "2.675",
                                          "1.7976931348623157e8",
                                          "0x10",
                                          "000000000000000000001.5",
                                          "0.00000000000000000000015",
                                          "7e-0",
                                          "1234567890.12345678901234567890",
                                          "5e-324"};
    for (size_t i = 0; i < ROWS_OF(numbers); ++i) {
        double xyz[3] = {9, 9, 9};
        mote_frame_file file = {.xyz = xyz, .room = 1};
        char *text = mote_format("v %s 0 %s\r\n", numbers[i], numbers[i]);
        test_row("%s", numbers[i]);
        assert_int_equal(mote_frame_file_read_obj("x", text, &file), MOTE_OK);
        const double right = strtod(numbers[i], NULL);
        assert_memory_equal(&xyz[0], &right, sizeof right);
        assert_memory_equal(&xyz[2], &right, sizeof right);
        free(text);
    }
}

/* Sets a number in a header. */
static void set_word(const char *path, size_t place, uint32_t value, bool big)
{
    FILE *file = fopen(path, "r+b");
    unsigned char bytes[4];
    assert_non_null(file);
    for (int k = 0; k < 4; ++k)
        bytes[k] = (unsigned char)(value >> 8 * (big ? 3 - k : k));
    assert_int_equal(fseek(file, (long)place, SEEK_SET), 0);
    assert_int_equal(fwrite(bytes, 1, 4, file), 4);
    assert_int_equal(fclose(file), 0);
}

static void cut(const char *path, size_t size)
{
    char *text = file_text(path);
    file_write(path, text, size);
    free(text);
}

#define FRAME_BYTES ((size_t)12 * SHEET_VERTICES)

TEST(point_cache_with_a_header_of_a_stranger_is_refused)
{
    static const struct {
        const char *path;
        size_t place;
        uint32_t value;
        const char *says;
    } rows[] = {
        {"c.pc2", 0, 0x454e4f4e, "does not begin with POINTCACHE2"},
        {"c.pc2", 12, 2, "version 2 of PC2"},
        {"c.pc2", 16, 0, "0 vertices in 5 frames"},
        {"c.pc2", 16, 2, "2 vertices in 5 frames"},
        {"c.pc2", 16, 0xffffffff, "4294967295 vertices in 5 frames"},
        {"c.pc2", 16, 24, "24 vertices, and the mesh has 25"},
        {"c.pc2", 28, 0, "25 vertices in 0 frames"},
        {"c.pc2", 28, 0x7fffffff, "ends in frame 6"},
        {"c.pc2", 28, 6, "ends in frame 6"},
        {"c.pc2", 28, 3, "3 frames, and the scenario shows 4"},
        {"c.mdd", 0, 0, "25 vertices in 0 frames"},
        {"c.mdd", 0, 0x7fffffff, "ends in frame 1"},
        {"c.mdd", 4, 26, "ends in frame 5"},
        {"c.mdd", 4, 0x80000000, "2147483648 vertices in 5 frames"},
    };
    sheet_write_obj("m.obj", 1);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        const bool mdd = strcmp(rows[i].path, "c.mdd") == 0;
        test_row("%s: %zu at %zu", rows[i].path, (size_t)rows[i].value, rows[i].place);
        sheet_write_pc2("c.pc2", 5, false);
        sheet_write_mdd("c.mdd", 5, true);
        expect(MOTE_OK, "", rows[i].path, "m.obj", 4);
        set_word(rows[i].path, rows[i].place, rows[i].value, mdd);
        expect(MOTE_EINVAL, rows[i].says, rows[i].path, "m.obj", 4);
    }
    file_put("e.pc2", "");
    expect(MOTE_EINVAL, "0 bytes are too few for the header", "e.pc2", "m.obj", 1);
    file_put("e.mdd", "MDD");
    expect(MOTE_EINVAL, "3 bytes are too few for the header", "e.mdd", "m.obj", 1);
    assert_int_equal(mkfifo("fifo.pc2", 0600), 0);
    expect(MOTE_EINVAL, "not a regular file", "fifo.pc2", "m.obj", 1);
    expect(MOTE_EIO, "No such file", "none.pc2", "m.obj", 1);
}

TEST(point_cache_that_is_cut_short_or_not_finite_names_the_frame)
{
    sheet_write_obj("m.obj", 1);
    sheet_write_pc2("c.pc2", 5, false);
    cut("c.pc2", 32 + 3 * FRAME_BYTES + 7);
    expect(MOTE_EINVAL, "c.pc2: ends in frame 4", "c.pc2", "m.obj", 1);
    sheet_write_mdd("c.mdd", 5, true);
    cut("c.mdd", 8 + 20 + FRAME_BYTES - 1);
    expect(MOTE_EINVAL, "c.mdd: ends in frame 1", "c.mdd", "m.obj", 1);
    sheet_write_mdd("c.mdd", 5, true);
    set_word("c.mdd", 8 + 20 + 2 * FRAME_BYTES + 12 * 4, 0x7fc00000, true);
    expect(MOTE_EINVAL, "frame 3: c.mdd: vertex 5 is at (nan", "c.mdd", "m.obj", 5);
    set_word("c.mdd", 8 + 20 + 2 * FRAME_BYTES + 12 * 4, 0xff800000, true);
    expect(MOTE_EINVAL, "frame 3: c.mdd: vertex 5 is at (-inf", "c.mdd", "m.obj", 5);
    /* Truncated after it was opened. */
    mote_sequence *sequence;
    mote_mesh *mesh;
    mote_import import;
    mote_vec3 at[SHEET_VERTICES];
    sheet_write_pc2("c.pc2", 5, false);
    assert_int_equal(mote_sequence_open_cache("c.pc2", "m.obj", 5, &sequence, &mesh, &import),
                     MOTE_OK);
    cut("c.pc2", 32 + 4 * FRAME_BYTES);
    mote_sequence_reader *reader = mote_sequence_reader_create(sequence);
    assert_int_equal(mote_sequence_read(reader, 4, at), MOTE_OK);
    assert_int_equal(mote_sequence_read(reader, 5, at), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "frame 5: c.pc2: ends early"));
    mote_sequence_reader_destroy(reader);
    mote_sequence_destroy(sequence);
    mote_mesh_destroy(mesh);
}

static long resident_kb(int who)
{
    struct rusage usage;
    assert_int_equal(getrusage(who, &usage), 0);
    return usage.ru_maxrss;
}

/* The largest file that a quick test can write: 30 MB. */
#define LONG_FRAMES 10000
#define LONG_VERTICES 250

TEST(sequence_of_ten_thousand_frames_takes_the_memory_of_two)
{
    unsigned char header[MOTE_POINT_CACHE_HEADER], bytes[12 * LONG_VERTICES];
    double xyz[3 * LONG_VERTICES];
    FILE *file = fopen("long.pc2", "wb");
    assert_non_null(file);
    mote_point_cache_put_header(LONG_VERTICES, LONG_FRAMES, header);
    assert_int_equal(fwrite(header, 1, sizeof header, file), sizeof header);
    for (int k = 1; k <= LONG_FRAMES; ++k) {
        for (int i = 0; i < 3 * LONG_VERTICES; ++i)
            xyz[i] = i + k / 16384.0 * (i % 3 == 2);
        mote_point_cache_put(xyz, LONG_VERTICES, bytes);
        assert_int_equal(fwrite(bytes, 1, sizeof bytes, file), sizeof bytes);
    }
    assert_int_equal(fclose(file), 0);
    mote_text text = {0};
    for (int v = 0; v < LONG_VERTICES; ++v)
        mote_text_add(&text, "v %d %d %d\n", 3 * v, 3 * v + 1, 3 * v + (v % 7));
    for (int v = 1; v + 2 <= LONG_VERTICES; ++v)
        mote_text_add(&text, "f %d %d %d\n", v, v % 2 ? v + 1 : v + 2, v % 2 ? v + 2 : v + 1);
    sheet_save("long.obj", &text);
    assert_int_equal(read_all("long.pc2", "long.obj", 2), MOTE_OK);
    const long before = resident_kb(RUSAGE_SELF), child_before = resident_kb(RUSAGE_CHILDREN);
    assert_int_equal(read_all("long.pc2", "long.obj", LONG_FRAMES), MOTE_OK);
    /* The file has 30,000 kB. */
    assert_true(resident_kb(RUSAGE_SELF) - before < 2000);
    assert_true(resident_kb(RUSAGE_CHILDREN) - child_before < 2000);
}
