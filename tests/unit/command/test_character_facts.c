/* What `mote mesh` says of files that can move. */
#include "harness/base/file.h"
#include "tests/support/bar.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <jansson.h>

#define BONES 13
#define IDENTITY "1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0"

/* Triangles in a row along x, each with a bone of its own and neighbours' corners at its own;
   the weights of the first are halves, and the last triangle has none. */
static void write_row(const char *path, const char *first_bone, bool second_mesh)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "xof 0303txt 0032\nFrame Root {\n FrameTransformMatrix { " IDENTITY ";; }\n");
    for (int b = 0; b < BONES; ++b)
        fprintf(f, " Frame %s%d {\n  FrameTransformMatrix { " IDENTITY ";; }\n }\n",
                b == 0 ? first_bone : "B", b);
    fprintf(f, " Mesh Row {\n  %d;\n", 3 * (BONES + 1));
    for (int v = 0; v < 3 * (BONES + 1); ++v)
        fprintf(f, "  %d.0;%d.0;0.0;%s\n", v / 3 + (v % 3 == 1), v % 3 == 2,
                v + 1 < 3 * (BONES + 1) ? "," : ";");
    fprintf(f, "  %d;\n", BONES + 1);
    for (int t = 0; t <= BONES; ++t)
        fprintf(f, "  3;%d,%d,%d;%s\n", 3 * t, 3 * t + 1, 3 * t + 2, t < BONES ? "," : ";");
    fprintf(f, "  XSkinMeshHeader { 1; 1; %d; }\n", BONES);
    for (int b = 0; b < BONES; ++b)
        fprintf(f, "  SkinWeights { \"%s%d\"; 3; %d,%d,%d; %s; " IDENTITY ";; }\n",
                b == 0 ? first_bone : "B", b, 3 * b, 3 * b + 1, 3 * b + 2,
                b == 0 ? "0.5,0.5,0.5" : "1.0,1.0,1.0");
    fprintf(f, " }\n");
    if (second_mesh)
        fprintf(f, " Mesh Alone {\n  3;\n  0.0;0.0;9.0;,\n  1.0;0.0;9.0;,\n  0.0;1.0;9.0;;\n"
                   "  1;\n  3;0,1,2;;\n }\n");
    fprintf(f, "}\n");
    (void)fclose(f);
}

static json_t *facts_of(const char *path)
{
    mote_expect(0, "", "mesh %s --json 2>/dev/null", path);
    json_t *root = json_loads(said, 0, NULL), *facts = json_object_get(root, "character");
    assert_true(root && facts);
    json_incref(facts);
    json_decref(root);
    return facts;
}

static void check_number(const json_t *facts, const char *key, double wanted)
{
    const double number = json_number_value(json_object_get(facts, key));
    if (number != wanted)
        fail_msg("%s is %g, not %g", key, number, wanted);
}

TEST(character_facts_tell_of_bones_and_weights)
{
    static const char *const lines[] = {
        "character           42 vertices, 14 triangles of 1 mesh\n",
        "bones               14: B0, B1, B2, B3, B4, B5, B6, B7, B8, B9, B10, B11, ...\n",
        "weights a vertex    1 on average, 1 at most; sums off by 0.5 at most, in 7.14 % of ",
        " by more than 1e-4: normalised\n",
        "7.14 % of the file's vertices have none and follow their mesh\n",
        ("kept apart          13 vertices at the place of another that moves differently: "
         "weights differ by 1 at most\n"),
        "clips               0\n"};
    write_row("row.x", "B", false);
    mote_expect(0, "", "mesh row.x");
    for (size_t i = 0; i < ROWS_OF(lines); ++i) {
        if (!strstr(said, lines[i]))
            fail_msg("not \"%s\":\n%s", lines[i], said);
    }
    assert_null(strstr(said, "morph targets"));
    json_t *facts = facts_of("row.x");
    check_number(facts, "vertices", 42);
    check_number(facts, "triangles", 14);
    check_number(facts, "weights_off", 0.5);
    check_number(facts, "weights_off_vertices", 3);
    check_number(facts, "unweighted", 3);
    check_number(facts, "kept_apart", 13);
    check_number(facts, "kept_apart_difference", 1);
    assert_int_equal(json_array_size(json_object_get(facts, "bones")), 14);
    assert_int_equal(json_array_size(json_object_get(facts, "clips")), 0);
    json_decref(facts);
}

TEST(character_facts_count_meshes_and_write_odd_names)
{
    write_row("row.x", "\xff", true);
    mote_expect(0, "character           45 vertices, 15 triangles of 2 meshes\n", "mesh row.x");
    json_t *facts = facts_of("row.x");
    check_number(facts, "meshes", 2);
    const json_t *bones = json_object_get(facts, "bones");
    assert_string_equal(json_string_value(json_array_get(bones, 0)), "?"); /* not UTF-8 */
    assert_string_equal(json_string_value(json_array_get(bones, 1)), "B1");
    json_decref(facts);
}

TEST(character_facts_tell_of_clips)
{
    bar_write("bar.x", bar_default());
    mote_expect(0, "clip 1            1 s, 4 keys of 1 nodes and 0 targets: Bend\n",
                "mesh bar.x");
    assert_non_null(strstr(said, "bones               2: Lower, Upper\n"));
    assert_null(strstr(said, "normalised"));
    assert_null(strstr(said, "kept apart"));
    json_t *facts = facts_of("bar.x");
    const json_t *clip = json_array_get(json_object_get(facts, "clips"), 1);
    assert_string_equal(json_string_value(json_object_get(clip, "name")), "Still");
    check_number(clip, "nodes", 1);
    json_decref(facts);
}

/* A file whose mesh is good and whose character is not. */
TEST(character_facts_of_a_bad_character_say_what_is_wrong)
{
    bar_text part = bar_default();
    part.bind = "1e39,0.0,0.0,1.0";
    bar_write("bad.x", part);
    mote_expect(0, "character           none: bad.x: the matrix of bone Upper is not finite",
                "mesh bad.x");
    json_t *facts = facts_of("bad.x");
    assert_non_null(strstr(json_string_value(json_object_get(facts, "error")),
                           "bad.x: the matrix of bone Upper is not finite"));
    json_decref(facts);
    file_put("still.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    mote_expect(0, "", "mesh still.obj");
    assert_null(strstr(said, "character"));
    facts = facts_of("still.obj");
    assert_true(json_is_null(facts));
    json_decref(facts);
}

#define TARGETS 13

/* One triangle (36 bytes), which each target raises by its own height; the animation has no
   name. */
TEST(character_facts_name_the_first_targets)
{
    mote_text text = {0};
    float data[9 * (1 + TARGETS) + 2 + 2 * TARGETS] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (int t = 1; t <= TARGETS; ++t) {
        for (int v = 0; v < 3; ++v)
            data[9 * t + 3 * v + 2] = (float)t;
    }
    const size_t times = 36 * (1 + TARGETS);
    data[9 * (1 + TARGETS) + 1] = 2; /* seconds */
    file_write("t.bin", data, sizeof data);
    mote_text_add(&text, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":"
                         "[0]}],\"nodes\":[{\"name\":\"Part\",\"mesh\":0}],\"meshes\":[{"
                         "\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[");
    for (int t = 1; t <= TARGETS; ++t)
        mote_text_add(&text, "%s{\"POSITION\":%d}", t > 1 ? "," : "", t);
    mote_text_add(&text, "]}]}],\"accessors\":[");
    for (int t = 0; t <= TARGETS; ++t)
        mote_text_add(&text,
                      "{\"bufferView\":0,\"byteOffset\":%d,\"componentType\":5126,\"count\":3,"
                      "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,20]},",
                      36 * t);
    mote_text_add(&text,
                  "{\"bufferView\":0,\"byteOffset\":%zu,\"componentType\":5126,\"count\":2,"
                  "\"type\":\"SCALAR\",\"min\":[0],\"max\":[2]},{\"bufferView\":0,"
                  "\"byteOffset\":%zu,\"componentType\":5126,\"count\":%d,\"type\":\"SCALAR\"}"
                  "],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%zu}],"
                  "\"buffers\":[{\"uri\":\"t.bin\",\"byteLength\":%zu}],\"animations\":[{"
                  "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}}],"
                  "\"samplers\":[{\"input\":%d,\"output\":%d}]}]}",
                  times, times + 8, 2 * TARGETS, sizeof data, sizeof data, TARGETS + 1,
                  TARGETS + 2);
    file_put("t.gltf", text.data);
    free(text.data);
    mote_expect(0, "morph targets       13: ", "mesh t.gltf");
    const char *line = strstr(said, "morph targets"), *more = strstr(line, ", ...\n");
    assert_true(more && more < strchr(line, '\n'));
    assert_non_null(strstr(said, " 2 s, 26 keys of 0 nodes and 13 targets\n"));
    json_t *facts = facts_of("t.gltf");
    assert_int_equal(json_array_size(json_object_get(facts, "morph_targets")), TARGETS);
    json_decref(facts);
}
