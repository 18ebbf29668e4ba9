/* Files that a sequence cannot be made of, and a reader whose process dies or is asked to
   stop. */
#include "harness/base/file.h"
#include "harness/process/child.h"
#include "harness/sequence/numbered_mesh.h"
#include "harness/sequence/point_cache.h"
#include "harness/sequence/sequence_reader.h"
#include "tests/support/sheet.h"
#include "tests/support/test.h"

#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

TEST_EACH(folder_next, NULL);

TEST(numbered_mesh_of_a_wrong_file_is_refused)
{
    static const struct {
        const char *name, *text, *says;
        mote_status status;
    } rows[] = {
        {"m.stl", "", "m.stl: neither OBJ nor PLY; give a mesh with positions", MOTE_EINVAL},
        {".ply", "", ".ply: neither OBJ nor PLY", MOTE_EINVAL},
        {"m", "", "m: neither OBJ nor PLY", MOTE_EINVAL},
        {"m.obj", NULL, "m.obj: No such file or directory; name a mesh file", MOTE_EIO},
        {"m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "m.obj:4: face with vertex 4",
         MOTE_EINVAL},
        {"m.OBJ", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", "m.OBJ: ", MOTE_EINVAL},
        {"m.PLY", "ply\n", "m.PLY:1: a header without a line end_header", MOTE_EINVAL},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_numbered_mesh made = {0};
        test_row("%s: %s", rows[i].name, rows[i].text);
        (void)unlink(rows[i].name);
        if (rows[i].text)
            file_put(rows[i].name, rows[i].text);
        assert_int_equal(mote_numbered_mesh_read(rows[i].name, &made), rows[i].status);
        if (strncmp(mote_error_text(), rows[i].says, strlen(rows[i].says)) != 0)
            fail_msg("%s", mote_error_text());
        assert_null(made.mesh);
    }
    mote_numbered_mesh made = {0};
    assert_int_equal(mkfifo("pipe.obj", 0600), 0);
    assert_int_equal(mote_numbered_mesh_read("pipe.obj", &made), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "pipe.obj: not a regular file; name a mesh file");
    file_write("z.obj", "v 0 0 0\n\0v 1 0 0\n", 18);
    assert_int_equal(mote_numbered_mesh_read("z.obj", &made), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "z.obj: a zero byte at 8; give text");
}

/* Vertices in no face are left out; those of an edge of three faces are copied. All know their
   numbers in the file. */
TEST(numbered_mesh_remembers_the_numbers_of_its_file)
{
    mote_numbered_mesh made = {0};
    file_put("m.Obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 8 8 8\nv 0 -1 0\nv 0 0 1\n"
                      "f 2 3 4\nf 2 2 4\nf 2 3 6\nf 2 3 7\n");
    assert_int_equal(mote_numbered_mesh_read("m.Obj", &made), MOTE_OK);
    static const double places[7][3] = {{9, 9, 9}, {0, 0, 0},  {1, 0, 0}, {0, 1, 0},
                                        {8, 8, 8}, {0, -1, 0}, {0, 0, 1}};
    assert_int_equal(made.file_vertices, 7);
    assert_int_equal(made.import.unused, 2);
    assert_int_equal(made.import.collapsed, 1);
    assert_true(made.import.split.edges == 1 && made.mesh->vertex_count > 5);
    for (uint32_t v = 0; v < made.mesh->vertex_count; ++v) {
        const mote_vec3 at = made.mesh->positions[v];
        const double *right = places[made.file_vertex[v]];
        assert_true(at.x == right[0] && at.y == right[1] && at.z == right[2]);
    }
    mote_numbered_mesh_free(&made);
    assert_null(made.mesh);
}

typedef struct opened {
    mote_sequence *sequence;
    mote_mesh *mesh;
    mote_import import;
} opened;

static void close_all(opened *o)
{
    mote_sequence_destroy(o->sequence);
    mote_mesh_destroy(o->mesh);
    *o = (opened){0};
}

TEST(sequence_of_files_without_a_number_or_a_file_is_refused)
{
    static const struct {
        const char *path, *says;
        uint32_t frames;
        mote_status status;
    } rows[] = {
        {"none.obj", "none.obj: no number of at most 15 digits in the name; name the", 1,
         MOTE_EINVAL},
        {"2/none.obj", "2/none.obj: no number of at most 15 digits in the name", 1,
         MOTE_EINVAL},
        {"none", "none: no number of at most 15 digits in the name", 1, MOTE_EINVAL},
        {"", ": no number of at most 15 digits in the name", 1, MOTE_EINVAL},
        {"f.obj2", "f.obj2: no number of at most 15 digits in the name", 1, MOTE_EINVAL},
        {"f1234567890123456.obj", "f1234567890123456.obj: no number of at most 15 digits", 1,
         MOTE_EINVAL},
        {"f123456789012345.obj", "f123456789012345.obj: No such file", 1, MOTE_EIO},
        {"f1.obj", "f3.obj: No such file or directory; it is frame 3 of 3 that the", 3,
         MOTE_EIO},
        {"d1.obj", "d2.obj: not a regular file; it is frame 2", 2, MOTE_EINVAL},
        {"1", "1: neither OBJ nor PLY", 1, MOTE_EINVAL},
    };
    sheet_write_obj("f1.obj", 1);
    sheet_write_obj("f2.obj", 2);
    sheet_write_obj("d1.obj", 1);
    file_put("1", "a file");
    assert_int_equal(mkdir("d2.obj", 0700), 0);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        opened o = {0};
        test_row("%s", rows[i].path);
        assert_int_equal(mote_sequence_open_files(rows[i].path, rows[i].frames, &o.sequence,
                                                  &o.mesh, &o.import),
                         rows[i].status);
        if (strncmp(mote_error_text(), rows[i].says, strlen(rows[i].says)) != 0)
            fail_msg("%s", mote_error_text());
        assert_true(!o.sequence && !o.mesh);
    }
}

TEST(sequence_number_may_stand_anywhere_in_a_name)
{
    static const char *const names[] = {"a1:.obj", "0009b.obj", "x12y/c7-8_.obj"};
    static const char *const second[] = {"a2:.obj", "0010b.obj", "x12y/c7-9_.obj"};
    assert_int_equal(mkdir("x12y", 0700), 0);
    for (size_t i = 0; i < ROWS_OF(names); ++i) {
        opened o = {0};
        test_row("%s", names[i]);
        sheet_write_obj(names[i], 1);
        sheet_write_obj(second[i], 2);
        assert_int_equal(mote_sequence_open_files(names[i], 2, &o.sequence, &o.mesh, &o.import),
                         MOTE_OK);
        char *path = mote_sequence_path(o.sequence, 2);
        assert_string_equal(path, second[i]);
        free(path);
        close_all(&o);
    }
}

/* A cache without a mesh file: positions of a given mesh, in its order. */
TEST(cache_of_a_given_mesh_is_read_in_its_order)
{
    mote_numbered_mesh sheet = {0};
    opened o = {0};
    mote_vec3 at[SHEET_VERTICES];
    sheet_write_obj("m.obj", 1);
    sheet_write_pc2("c.pc2", 3, false);
    assert_int_equal(mote_numbered_mesh_read("m.obj", &sheet), MOTE_OK);
    assert_int_equal(
        mote_sequence_open_cache("c.pc2", NULL, 3, &o.sequence, &sheet.mesh, &o.import),
        MOTE_OK);
    mote_sequence_reader *reader = mote_sequence_reader_create(o.sequence);
    for (uint32_t frame = 3; frame >= 1; --frame) {
        assert_int_equal(mote_sequence_read(reader, frame, at), MOTE_OK);
        for (int v = 0; v < SHEET_VERTICES; ++v)
            assert_true(at[v].x == sheet_at(v, 0, frame) && at[v].y == sheet_at(v, 1, frame) &&
                        at[v].z == sheet_at(v, 2, frame));
    }
    /* A coordinate beyond a billion times the mesh. */
    FILE *file = fopen("c.pc2", "r+b");
    assert_non_null(file);
    for (int c = 0; c < 3; ++c) {
        const float values[3] = {c == 0 ? 1e12F : 0, c == 1 ? -1e12F : 0, c == 2 ? 1e12F : 0};
        assert_int_equal(fseek(file, 32 + 12 * SHEET_VERTICES + 12 * 7, SEEK_SET), 0);
        assert_int_equal(fwrite(values, 4, 3, file), 3);
        assert_int_equal(fflush(file), 0);
        assert_int_equal(mote_sequence_read(reader, 2, at), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "frame 2: c.pc2: vertex 8 is at ("));
    }
    assert_int_equal(fclose(file), 0);
    mote_sequence_reader_destroy(reader);
    mote_numbered_mesh_free(&sheet);
    close_all(&o);
    mote_sequence_reader_destroy(NULL);
    mote_sequence_destroy(NULL);
}

/* The order of bytes that fits the file's size; the usual one where neither or both do. */
TEST(cache_whose_byte_order_is_ambiguous_is_read_in_the_usual_one)
{
    mote_point_cache cache;
    static const unsigned char usual[8] = {0, 0, 0, 1, 0, 0, 0, 3};
    unsigned char data[8 + 4 + 36] = {0};
    memcpy(data, usual, sizeof usual);
    file_write("c.mdd", data, sizeof data);
    assert_int_equal(mote_point_cache_open("c.mdd", &cache), MOTE_OK);
    assert_true(cache.big_endian && cache.frames == 1 && cache.points == 3);
    file_write("c.mdd", data, sizeof data - 1);
    assert_int_equal(mote_point_cache_open("c.mdd", &cache), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "c.mdd: ends in frame 1: 47 bytes, where 1 fra"));
    /* Longer than needed: the rest does not count. */
    FILE *file = fopen("c.mdd", "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, sizeof data, file), sizeof data);
    assert_int_equal(fwrite(data, 1, sizeof data, file), sizeof data);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(mote_point_cache_open("c.mdd", &cache), MOTE_OK);
    assert_int_equal(cache.frames, 1);
    file_write(".mdd", data, sizeof data); /* no name before the ending: not MDD */
    assert_int_equal(mote_point_cache_open(".mdd", &cache), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "does not begin with POINTCACHE2"));
}

/* The only child of this process; 0: it has none, or several. */
static pid_t only_child(void)
{
    char path[64], text[64] = "";
    (void)snprintf(path, sizeof path, "/proc/%d/task/%d/children", (int)getpid(),
                   (int)getpid());
    FILE *file = fopen(path, "r");
    if (!file)
        return 0;
    const size_t size = fread(text, 1, sizeof text - 1, file);
    (void)fclose(file);
    char *end;
    const long pid = strtol(text, &end, 10);
    return size > 0 && strspn(end, " ") == strlen(end) ? (pid_t)pid : 0;
}

static void pause_for(long milliseconds)
{
    const struct timespec time = {0, milliseconds * 1000000};
    (void)nanosleep(&time, NULL);
}

/* Sends a signal to a process somewhat later. */
static pid_t signal_later(pid_t to, int signal_number)
{
    const pid_t helper = fork();
    if (helper != 0)
        return helper;
    pause_for(100);
    _exit(kill(to, signal_number) == 0 ? 0 : 1);
}

static bool has_helped(pid_t helper)
{
    int status = 1;
    return waitpid(helper, &status, 0) == helper && status == 0;
}

static mote_sequence_reader *open_reader(opened *o, mote_vec3 *at)
{
    for (int k = 1; k <= 3; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "f%d.obj", k);
        sheet_write_obj(name, k);
    }
    assert_int_equal(mote_sequence_open_files("f1.obj", 3, &o->sequence, &o->mesh, &o->import),
                     MOTE_OK);
    mote_sequence_reader *reader = mote_sequence_reader_create(o->sequence);
    assert_int_equal(mote_sequence_read(reader, 1, at), MOTE_OK);
    return reader;
}

TEST(sequence_reader_whose_process_died_says_so_and_starts_another)
{
    opened o = {0};
    mote_vec3 at[SHEET_VERTICES];
    mote_sequence_reader *reader = open_reader(&o, at);
    pid_t child = only_child();
    if (child == 0) { /* this kernel does not tell */
        mote_sequence_reader_destroy(reader);
        close_all(&o);
        skip();
    }
    assert_int_equal(kill(child, SIGKILL), 0);
    pause_for(50);
    assert_int_equal(mote_sequence_read(reader, 2, at), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "frame 2: f2.obj: reading it"));
    assert_int_equal(mote_sequence_read(reader, 2, at), MOTE_OK);
    assert_true(at[3].z == sheet_at(3, 2, 2));
    /* It dies after it was asked. */
    child = only_child();
    assert_true(child > 0);
    assert_int_equal(kill(child, SIGSTOP), 0);
    const pid_t helper = signal_later(child, SIGKILL);
    assert_int_equal(mote_sequence_read(reader, 3, at), MOTE_EIO);
    /* The second text: on a busy machine it may have died before the question was sent. */
    assert_true(strstr(mote_error_text(), "frame 3: f3.obj: reading it: ended by signal 9") ||
                strstr(mote_error_text(), "frame 3: f3.obj: reading it ended: "));
    assert_true(has_helped(helper));
    assert_int_equal(mote_sequence_read(reader, 3, at), MOTE_OK);
    mote_sequence_reader_destroy(reader);
    close_all(&o);
}

/* In a process of its own, as it remembers that it was asked to stop. */
TEST(sequence_reader_asked_to_stop_stops)
{
    opened o = {0};
    mote_vec3 at[SHEET_VERTICES];
    const pid_t pid = fork();
    if (pid == 0) {
        mote_child_heed_signals();
        mote_sequence_reader *reader = open_reader(&o, at);
        const pid_t child = only_child();
        if (child == 0 || kill(child, SIGSTOP) != 0)
            _exit(2);
        const pid_t helper = signal_later(getpid(), SIGTERM);
        const mote_status status = mote_sequence_read(reader, 2, at);
        const bool said = strstr(mote_error_text(), "frame 2: f2.obj: stopped by a signal");
        mote_sequence_reader_destroy(reader);
        close_all(&o);
        _exit(status == MOTE_EIO && said && has_helped(helper) && only_child() == 0 ? 0 : 1);
    }
    int status = 1;
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_true(WIFEXITED(status));
    if (WEXITSTATUS(status) == 2)
        skip();
    assert_int_equal(WEXITSTATUS(status), 0);
}
