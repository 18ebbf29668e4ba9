/* Bad input at the command line: an error within 5 seconds and 1 GiB, exit 4, one line that
   names the file. Input that is merely unusual is read. */
#include "harness/base/clock.h"
#include "harness/base/file.h"
#include "harness/mesh/mesh_import.h"
#include "tests/support/folder.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/resource.h>
#include <sys/stat.h>

#define SECONDS 5.0
#define BYTES ((rlim_t)1 << 30)

/* A sanitizer reserves more address space than any limit leaves. */
#if defined(__SANITIZE_ADDRESS__)
#define LIMITED 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIMITED 0
#endif
#endif
#if !defined(LIMITED)
#define LIMITED 1
#endif

#define PLY                                                                                    \
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"            \
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
#define PLY_VERTICES "0 0 0\n1 0 0\n0 1 0\n0 0 0.1\n"
#define PLY_FACES "3 0 2 1\n3 0 1 3\n3 0 3 2\n"
#define STL(x)                                                                                 \
    "solid t\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex " x          \
    " 0 0\nendloop\nendfacet\nendsolid t\n"
#define OFF "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 0.1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
#define OBJ "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
#define GLTF_HEAD                                                                              \
    "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0]}], "
#define GLTF(node, count, indices, bytes, uri)                                                 \
    GLTF_HEAD                                                                                  \
    "\"nodes\": [{\"mesh\": 0" node "}], \"meshes\": [{\"primitives\": [{\"attributes\": "     \
    "{\"POSITION\": 0}, \"indices\": 1}]}], \"accessors\": [{\"bufferView\": 0, "              \
    "\"componentType\": 5126, \"count\": " count ", \"type\": \"VEC3\", \"min\": [0, 0, 0], "  \
    "\"max\": [1, 1, 0.1]}, {\"bufferView\": 1, \"componentType\": 5123, \"count\": " indices  \
    ", \"type\": \"SCALAR\"}], \"bufferViews\": [{\"buffer\": 0, \"byteOffset\": 0, "          \
    "\"byteLength\": 48}, {\"buffer\": 0, \"byteOffset\": 48, \"byteLength\": 24}], "          \
    "\"buffers\": [{\"byteLength\": " bytes ", \"uri\": \"" uri "\"}]}"
#define GLTF_DATA                                                                              \
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAA"  \
    "AAAAAAAADNzMw9AAACAAEAAAABAAMAAAADAAIAAQACAAMA"
/* The last vertex index is 99. */
#define GLTF_DATA_99                                                                           \
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAA"  \
    "AAAAAAAADNzMw9AAACAAEAAAABAAMAAAADAAIAAQACAGMA"
#define SCENE(more, file)                                                                      \
    "{\"purpose\": \"x\", \"frames\": 2, \"ask\": \"distance\"" more ", \"bodies\": ["         \
    "{\"file\": \"" file "\"}, {\"letter\": \"V\", \"triangles\": 400}]}\n"

typedef struct input {
    const char *file, *text;
    int status;
    const char *says; /* part of the output */
} input;

static const input inputs[] = {
    {"nan.obj", "v 0 0 nan\n", 4, "nan.obj:1:"},
    {"1e400.obj", "v 0 0 1e400\n", 4, "1e400.obj:1:"},
    {"index.obj", OBJ "f 1 2 99999999999999999999\n", 4, "index.obj:5:"},
    {"comma.obj", "v 1,5 0 0\n", 4, "comma.obj:1:"},
    {"nothing.obj", "", 4, "nothing.obj"},
    {"early.obj", "f 1 2 3\n", 4, "early.obj:1: a face before any vertex; give the lines of v"},
    {"none.off", "OFF\n0 1 0\n3 0 1 2\n", 4, "none.off:2: declares no vertex; give a mesh"},
    {"none.ply",
     "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
     "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
     "3 0 1 2\n",
     4, "none.ply:9: declares no vertex; give a mesh"},
    {"nan.off", "OFF\n3 1 0\n0 0 nan\n", 4, "nan.off:3:"},
    {"counts.off", "OFF\n4000000000 4000000000 0\n", 4, "counts.off:2:"},
    {"index.off", OFF "\n", 0, "triangles           4"},
    {"nan.ply", PLY "0 0 0\n1 0 0\n0 1 0\n0 0 nan\n" PLY_FACES "3 1 2 3\n", 4,
     "nan.ply:13: vertex 4 has a coordinate that is not a finite number"},
    {"1e400.ply", PLY "0 0 0\n1 0 0\n0 1 0\n0 0 1e400\n" PLY_FACES "3 1 2 3\n", 4,
     "1e400.ply:13: vertex 4 has a coordinate that is not a finite number"},
    {"comma.ply", PLY "0 0 0\n1 0 0\n0 1 0\n0 0 0,1\n" PLY_FACES "3 1 2 3\n", 4,
     "comma.ply:13: a comma"},
    {"index.ply", PLY PLY_VERTICES PLY_FACES "3 1 2 99\n", 4,
     "index.ply:17: face 4 has vertex 99"},
    {"negative.ply", PLY PLY_VERTICES PLY_FACES "3 1 2 -1\n", 4, ":17: face 4 has vertex -1"},
    {"wraps.ply", PLY PLY_VERTICES PLY_FACES "3 1 2 4294967298\n", 4, ":17: face 4 has vertex"},
    {"list.ply", PLY PLY_VERTICES PLY_FACES "99999999 1 2 3\n", 4, ":17: a list of 99999999"},
    {"short.ply", PLY PLY_VERTICES PLY_FACES, 4, "ends after face 3 of 4"},
    {"counts.ply", "ply\nformat ascii 1.0\nelement vertex 999999999\nend_header\n", 4,
     "counts.ply:3: declares 999999999"},
    {"many.ply",
     "ply\nformat ascii 1.0\nelement a 1\nelement a 1\nelement a 1\nelement a 1\n"
     "element a 1\nelement a 1\nelement a 1\nelement a 1\nelement a 1\nelement a 1\n"
     "element a 1\nelement a 1\nelement a 1\nelement a 1\nelement a 1\nelement a 1\n"
     "element a 1\nend_header\n",
     4, "more than 16 elements"},
    {"facet.stl",
     "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n", 4,
     "facet.stl:6: a facet of 2 vertices"},
    {"nan.stl", STL("nan"), 4, "not finite"},
    {"1e400.stl", STL("1e400"), 4, "not finite"},
    {"comma.stl", STL("1,5"), 4, "comma.stl:6: a vertex without"},
    {"good.gltf", GLTF("", "4", "12", "72", GLTF_DATA), 0, "triangles           4"},
    {"index.gltf", GLTF("", "4", "12", "72", GLTF_DATA_99), 4, "index out of range"},
    {"count.gltf", GLTF("", "999999999", "12", "72", GLTF_DATA), 4,
     "its 999999999 elements do not lie"},
    {"indices.gltf", GLTF("", "4", "999999999", "72", GLTF_DATA), 4,
     "its 999999999 elements do not lie"},
    {"bytes.gltf", GLTF("", "4", "12", "99999999999", GLTF_DATA), 4, "bytes.gltf"},
    {"absent.gltf", GLTF("", "4", "12", "72", "absent.bin"), 4, "absent.bin"},
    {"cycle.gltf", GLTF(", \"children\": [0]", "4", "12", "72", GLTF_DATA), 4, "cycle.gltf"},
    {"tall.gltf",
     GLTF(", \"matrix\": [1, 0, 0, 0, 0, 1e39, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]", "4", "12", "72",
          GLTF_DATA),
     4, "is not finite"},
    {"deep.gltf",
     GLTF(", \"matrix\": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1e39, 0, 0, 0, 0, 1]", "4", "12", "72",
          GLTF_DATA),
     4, "is not finite"},
    {"cut.gltf", GLTF_HEAD, 4, "cut.gltf"},
    {"unknown.json", SCENE(", \"speed\": 1", "a.obj"), 4, "unknown.json:1: speed: unknown key"},
    {"missing.json", SCENE("", "absent.obj"), 4, "absent.obj"},
    {"nan.json", SCENE(", \"tolerance\": nan", "a.obj"), 4, "nan.json:1:"},
    {"1e400.json", SCENE(", \"tolerance\": 1e400", "a.obj"), 4, "1e400.json:1:"},
    {"comma.json", SCENE(", \"tolerance\": 0,5", "a.obj"), 4, "comma.json:1:"},
    {"mark.json", "\xef\xbb\xbf" SCENE("", "a.obj"), 0, "mark: fingerprint"},
    {"frames.json", "{\"purpose\": \"x\", \"frames\": 99999999999999999999, \"bodies\": []}", 4,
     "frames.json:1:"},
    {"circle.json", "{\"purpose\": \"x\", \"like\": \"circle.json\"}\n", 4, "circle.json"},
    {"deep.json", "[[[[[[[[[[[[[[[[", 4, "deep.json:1:"},
    /* Unusual, but good. */
    {"crlf.ply",
     "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\n"
     "property float z\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n"
     "end_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n",
     0, "triangles           1"},
    {"mark.off", "\xef\xbb\xbfOFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n", 0,
     "triangles           1"},
    {"mark.obj", "\xef\xbb\xbf" OBJ, 0, "triangles           1"},
};

/* Runs `mote LINE` with a limit on its memory, and checks status, text and time. */
static void expect(const char *line, int status, const char *says)
{
    char said[4096];
    struct rlimit before, limit = {BYTES, BYTES};
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    limit.rlim_max = before.rlim_max;
    if (LIMITED)
        assert_int_equal(setrlimit(RLIMIT_AS, &limit), 0);
    const double start = mote_clock_seconds();
    const pid_t pid = program_start(line, "said");
    assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
    const int ended = program_wait(pid);
    const double took = mote_clock_seconds() - start;
    program_read("said", said, sizeof said);
    if (ended != status || !strstr(said, says))
        fail_msg("mote %s: exit %d, not %d, or not \"%s\":\n%s", line, ended, status, says,
                 said);
    if (took > SECONDS)
        fail_msg("mote %s: took %.1f s", line, took);
    if (status != 0 && (strncmp(said, "mote: ", 6) != 0 || strchr(said, '\n')[1] != '\0'))
        fail_msg("mote %s: not one line:\n%s", line, said);
}

/* Scenarios are checked, meshes are shown. */
static void expect_file(const char *file, int status, const char *says)
{
    char line[256];
    const char *ending = strrchr(file, '.');
    (void)snprintf(line, sizeof line, "%s %s",
                   ending && strcmp(ending, ".json") == 0 ? "check" : "mesh", file);
    expect(line, status, says);
}

static int put_mesh(void)
{
    file_put("a.obj", OBJ);
    return 0;
}

TEST_GROUP(put_mesh, NULL);

TEST(program_bad_files_exit_4_in_time_and_memory)
{
    for (size_t i = 0; i < ROWS_OF(inputs); ++i) {
        file_put(inputs[i].file, inputs[i].text);
        expect_file(inputs[i].file, inputs[i].status, inputs[i].says);
    }
}

/* A process whose locale has decimal commas still reads decimal points. */
TEST(program_in_a_comma_locale_reads_points)
{
    assert_int_equal(setenv("LC_ALL", "de_DE.UTF-8", 1), 0);
    static const char points[] = "v 0 0 0\nv 1.5 0 0\nv 0 1.5 0\nf 1 2 3\n";
    static const char scene[] = SCENE(", \"tolerance\": 0,5", "a.obj");
    file_put("point.obj", points);
    expect_file("point.obj", 0, "L                   2.12132034");
    file_put("point.json", scene);
    expect_file("point.json", 4, "point.json:1:");
    assert_int_equal(unsetenv("LC_ALL"), 0);
}

TEST(program_what_is_no_file_exits_4)
{
    expect("mesh .", 4, "not a regular file");
    expect("mesh /dev/zero", 4, "not a regular file");
    expect("check ./", 4, "not a regular file");
    expect("check /dev/zero/", 4, "/dev/zero/");
    expect("mesh absent.obj", 4, "absent.obj");
    expect("check absent.json", 4, "absent.json");
    assert_int_equal(mkfifo("pipe.obj", 0600), 0);
    assert_int_equal(mkfifo("pipe.json", 0600), 0);
    expect_file("pipe.obj", 4, "not a regular file");
    expect_file("pipe.json", 4, "not a regular file");
    expect("distance pipe.obj a.obj", 4, "not a regular file");
}

/* 80 bytes, a count, and 50 bytes a triangle. */
TEST(program_bad_binary_stl_exits_4)
{
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    unsigned char data[84 + 50] = "solid, but binary";
    data[80] = 1;
    memcpy(data + 96, corners, sizeof corners);
    file_write("b.stl", data, sizeof data);
    expect_file("b.stl", 0, "triangles           1");
    file_write("b.stl", data, sizeof data - 10);
    expect_file("b.stl", 4, "b.stl");
    memset(data + 80, 0xff, 4);
    file_write("b.stl", data, sizeof data);
    expect_file("b.stl", 4, "b.stl");
    data[0] = 'x';
    file_write("b.stl", data, sizeof data);
    expect_file("b.stl", 4, "b.stl");
    memset(data + 80, 0, 4);
    data[80] = 1;
    memset(data + 96, 0xff, 4); /* not a number */
    file_write("b.stl", data, sizeof data);
    expect_file("b.stl", 4, "not finite");
}

/* Every prefix of a good file is read or refused quickly, with an error that names it. */
TEST(mote_mesh_import_truncated_anywhere_is_read_or_refused)
{
    static const struct {
        const char *file, *text;
        size_t most; /* characters that may be missing without harm */
    } good[] = {{"t.obj", OBJ, sizeof OBJ},
                {"t.off", OFF, 1},
                {"t.ply", PLY PLY_VERTICES PLY_FACES "3 1 2 3\n", 1},
                {"t.stl", STL("1"), 3},
                {"t.gltf", GLTF("", "4", "12", "72", GLTF_DATA), 0}};
    for (size_t i = 0; i < ROWS_OF(good); ++i) {
        const size_t whole = strlen(good[i].text);
        for (size_t size = 0; size < whole; ++size) {
            mote_mesh *mesh = NULL;
            file_write(good[i].file, good[i].text, size);
            const double start = mote_clock_seconds();
            const mote_status status = mote_mesh_import(good[i].file, &mesh, NULL);
            assert_true(mote_clock_seconds() - start < SECONDS);
            if (status == MOTE_OK && whole - size > good[i].most)
                fail_msg("%zu of %zu bytes of %s are read", size, whole, good[i].file);
            if (status != MOTE_OK && !strstr(mote_error_text(), good[i].file))
                fail_msg("%zu bytes of %s: \"%s\"", size, good[i].file, mote_error_text());
            mote_mesh_destroy(mesh);
        }
    }
}
