/* Small files of characters, each with one thing that is unusual or wrong. */
#include "harness/base/file.h"
#include "harness/mesh/character.h"
#include "harness/mesh/character_parts.h"
#include "tests/support/bar.h"
#include "tests/support/test.h"
#include "tests/unit/mesh/refused.h"

#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

/* The bytes that the accessors below refer to: a triangle bound to the first joint, the joint's
   inverse bind matrix, and a clip that moves a node from 0 to 3 along x. */
typedef struct buffer {
    float corners[9], weights[12], bind[16], times[2], places[6];
    uint8_t joints[12];
} buffer;

static buffer make_buffer(void)
{
    return (buffer){.corners = {0, 0, 0, 1, 0, 0, 0, 1, 0},
                    .weights = {[0] = 1, [4] = 1, [8] = 1},
                    .bind = {[0] = 1, [5] = 1, [10] = 1, [15] = 1},
                    .times = {0, 1},
                    .places = {[3] = 3}};
}

#define SKIN "\"skins\":[{\"joints\":[1],\"inverseBindMatrices\":2}],"
#define ANIMATION(node)                                                                        \
    "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":" node                 \
    ",\"path\":\"translation\"}}],\"samplers\":[{\"input\":3,\"output\":4}]}],"
#define BOUND "{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":5,\"WEIGHTS_0\":1}}"
#define PLAIN "{\"attributes\":{\"POSITION\":0}}"
#define POINTS "{\"attributes\":{\"POSITION\":0},\"mode\":0}"

/* A glTF file of these nodes (the first is the scene), primitives and further members. */
static void write_gltf(const char *path, const buffer *data, const char *nodes,
                       const char *primitives, const char *more)
{
    static const struct {
        size_t at, size;
        int count, type; /* of components */
        const char *name;
    } parts[] = {
        {offsetof(buffer, corners), sizeof data->corners, 3, 5126, "VEC3"},
        {offsetof(buffer, weights), sizeof data->weights, 3, 5126, "VEC4"},
        {offsetof(buffer, bind), sizeof data->bind, 1, 5126, "MAT4"},
        {offsetof(buffer, times), sizeof data->times, 2, 5126, "SCALAR"},
        {offsetof(buffer, places), sizeof data->places, 2, 5126, "VEC3"},
        {offsetof(buffer, joints), sizeof data->joints, 3, 5121, "VEC4"},
    };
    mote_text text = {0};
    mote_text_add(&text,
                  "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
                  "\"nodes\":[%s],%s\"meshes\":[{\"name\":\"Cup\",\"primitives\":[%s]}],"
                  "\"buffers\":[{\"uri\":\"c.bin\",\"byteLength\":%zu}],\"bufferViews\":[",
                  nodes, more, primitives, sizeof *data);
    for (size_t p = 0; p < ROWS_OF(parts); ++p)
        mote_text_add(&text, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}",
                      p ? "," : "", parts[p].at, parts[p].size);
    mote_text_add(&text, "],\"accessors\":[");
    for (size_t p = 0; p < ROWS_OF(parts); ++p)
        mote_text_add(&text,
                      "%s{\"bufferView\":%zu,\"componentType\":%d,\"count\":%d,\"type\":\"%s\","
                      "\"min\":[0,0,0],\"max\":[1,1,0]}",
                      p ? "," : "", p, parts[p].type, parts[p].count, parts[p].name);
    mote_text_add(&text, "]}");
    file_write("c.bin", data, sizeof *data);
    file_put(path, text.data);
    free(text.data);
}

static mote_character *import(const char *path, mote_character_import *facts)
{
    mote_character *made = NULL;
    if (mote_character_import_file(path, &made, facts) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return made;
}

/* Replaces a word each time it occurs. */
static void replace(const char *path, const char *from, const char *to)
{
    char *text = file_text(path), *rest = text;
    mote_text changed = {0};
    for (char *at; (at = strstr(rest, from)) != NULL; rest = at + strlen(from))
        mote_text_add(&changed, "%.*s%s", (int)(at - rest), rest, to);
    mote_text_add(&changed, "%s", rest);
    file_put(path, changed.data);
    free(changed.data);
    free(text);
}

#define TWO_NODES                                                                              \
    "{\"name\":\"Part\",\"mesh\":0,\"skin\":0,\"children\":[1]},{\"name\":\"Joint\"}"

/* A mesh in centimetres, whose bone's matrix makes metres of it, rests in metres; a matrix that
   flattens it changes nothing. */
TEST(character_rests_in_the_units_of_its_bones)
{
    static const struct {
        float scale[3];
        double size; /* of the mesh at rest */
    } rows[] = {{{1, 1, 1}, 1},      {{0.01F, 0.01F, 0.01F}, 0.01}, {{50, 50, 50}, 50},
                {{1.005F, 1, 1}, 1}, {{0, 0.01F, 0.01F}, 1},        {{1, 1, 0}, 1}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        buffer data = make_buffer();
        test_row("%zu", i);
        for (int k = 0; k < 3; ++k)
            data.bind[5 * k] = rows[i].scale[k];
        write_gltf("c.gltf", &data, TWO_NODES, BOUND, SKIN);
        mote_character *c = import("c.gltf", NULL);
        assert_true(fabs(c->mesh->high.y - rows[i].size) <= 1e-6 * rows[i].size);
        mote_character_destroy(c);
    }
    buffer data = make_buffer();
    mote_character *c = NULL;
    data.bind[0] = INFINITY;
    write_gltf("c.gltf", &data, TWO_NODES, BOUND, SKIN);
    assert_int_equal(mote_character_import_file("c.gltf", &c, NULL), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "the matrix of bone Joint is not finite"));
}

/* Two sets of the same weights give each vertex a sum of 2. */
TEST(character_has_all_sets_of_weights)
{
    static const char twice[] =
        "{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":5,\"WEIGHTS_0\":1,"
        "\"JOINTS_1\":5,\"WEIGHTS_1\":1}}";
    const buffer data = make_buffer();
    mote_character_import facts;
    write_gltf("c.gltf", &data, TWO_NODES, twice, SKIN);
    mote_character_destroy(import("c.gltf", &facts));
    assert_true(facts.off == 1);
}

/* A mesh with bones stands once, however many nodes refer to it; one without, at each. */
TEST(character_of_a_mesh_at_two_nodes)
{
    static const struct {
        const char *nodes, *primitive, *more;
        uint32_t meshes;
    } rows[] = {
        {"{\"name\":\"Part\",\"mesh\":0,\"skin\":0,\"children\":[1,2]},{\"name\":\"Joint\"},"
         "{\"name\":\"Again\",\"mesh\":0,\"skin\":0}",
         BOUND, SKIN ANIMATION("1"), 1},
        {"{\"name\":\"Part\",\"mesh\":0,\"children\":[1]},"
         "{\"name\":\"Again\",\"mesh\":0,\"translation\":[0,0,5]}",
         PLAIN, ANIMATION("0"), 2},
    };
    const buffer data = make_buffer();
    for (size_t k = 0; k < ROWS_OF(rows); ++k) {
        mote_character_import facts;
        write_gltf("c.gltf", &data, rows[k].nodes, rows[k].primitive, rows[k].more);
        mote_character *c = import("c.gltf", &facts);
        assert_int_equal(c->mesh->triangle_count, rows[k].meshes);
        assert_int_equal(facts.meshes, rows[k].meshes);
        mote_character_destroy(c);
    }
}

/* Nothing but an animated node: its mesh follows it. A node that flattens space is passed over,
   and its mesh stays as it is in the file. */
TEST(character_of_a_moving_node_follows_it)
{
    static const char *const nodes[] = {
        "{\"name\":\"Part\",\"mesh\":0}",
        "{\"name\":\"Part\",\"children\":[1],\"scale\":[0,0,0]},{\"mesh\":0}"};
    buffer data = make_buffer();
    for (int k = 0; k < 2; ++k) {
        write_gltf("c.gltf", &data, nodes[k], PLAIN, ANIMATION("0"));
        mote_character *c = import("c.gltf", NULL);
        assert_int_equal(c->rig.bones_count, 1);
        assert_true(c->mesh->high.x == 1 && c->mesh->high.y == 1);
        mote_character_pose pose = mote_character_pose_create(c);
        mote_character_pose_set(c, 0, 0.5, &pose);
        assert_true(k == 1 || fabs(pose.matrices[0].m[0][3] - 1.5) < 1e-6);
        mote_character_pose_free(&pose);
        mote_character_destroy(c);
    }
}

/* The place of a vertex at a time of the first clip, or where there is none. */
static mote_vec3 place_at(const mote_character *c, double seconds, uint32_t v)
{
    mote_vec3 x = c->mesh->positions[v], at = {0, 0, 0};
    mote_character_pose pose = mote_character_pose_create(c);
    mote_character_pose_set(c, c->rig.clips_count > 0 ? 0 : MOTE_RIG_NONE, seconds, &pose);
    for (uint32_t i = c->shift_start[v]; i < c->shift_start[v + 1]; ++i)
        x = mote_add_scaled(x, pose.morphs[c->target[i]], c->shift[i]);
    for (uint32_t i = c->start[v]; i < c->start[v + 1]; ++i)
        at =
            mote_add_scaled(at, c->weight[i], mote_affine_apply(&pose.matrices[c->bone[i]], x));
    mote_character_pose_free(&pose);
    return at;
}

#define MORPHS "{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":0}]}"
#define BARE_SKIN "\"skins\":[{\"joints\":[1]}],"
#define TWO_SKINS                                                                              \
    "\"skins\":[{\"joints\":[2],\"inverseBindMatrices\":2},{\"joints\":[4],"                   \
    "\"inverseBindMatrices\":2}],"
#define CHANNEL(target) "{\"sampler\":0,\"target\":{" target "\"path\":\"translation\"}}"
#define CHANNELS(list, mode)                                                                   \
    "\"animations\":[{\"channels\":[" list "],\"samplers\":[{\"input\":3,\"output\":4" mode    \
    "}]}],"

/* Files of glTF that assimp alone reads as something else (docs/characters.md). The clip moves
   a node by 3 along x. */
TEST(character_of_gltf_moves_as_its_indices_say)
{
    static const struct {
        const char *what, *nodes, *primitive, *more;
        double seconds;
        uint32_t vertices, moved; /* all, and those beyond x = 1.5 at that time */
    } rows[] = {
        {"two nodes of one name",
         "{\"children\":[1,2]},{\"name\":\"a\",\"mesh\":0},{\"name\":\"a\",\"mesh\":0}", PLAIN,
         ANIMATION("2"), 1, 6, 3},
        {"two joints of one name, and two skins of one mesh",
         "{\"children\":[1,2,3,4]},{\"mesh\":0,\"skin\":0},{\"name\":\"a\"},{\"mesh\":0,"
         "\"skin\":1}"
         ",{\"name\":\"a\"}",
         BOUND, TWO_SKINS ANIMATION("4"), 1, 6, 3},
        {"a mesh with a skin and without",
         "{\"children\":[1,2,3,4]},{\"mesh\":0,\"skin\":0},{},{\"mesh\":0,\"translation\":"
         "[0,0,7]},{}",
         BOUND, TWO_SKINS ANIMATION("3"), 1, 6, 3},
        {"one skin, two morphs of one mesh",
         "{\"children\":[1,2,3,4]},{\"mesh\":0,\"skin\":0},{},{\"mesh\":0,\"skin\":0,"
         "\"weights\":"
         "[1]},{}",
         "{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":5,\"WEIGHTS_0\":1},\"targets\":[{"
         "\"POSITION\":0}]}",
         TWO_SKINS, 0, 5, 1},
        {"a channel without a node", "{\"mesh\":0}", PLAIN, CHANNELS(CHANNEL(""), ""), 1, 3, 0},
        {"a channel without a node, and one with", "{\"mesh\":0},{}", PLAIN,
         CHANNELS(CHANNEL("\"node\":0,") "," CHANNEL(""), ""), 1, 3, 3},
        {"a path that an extension knows", "{\"mesh\":0}", PLAIN,
         CHANNELS("{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"pointer\"}}", ""), 1, 3, 0},
        {"the weights of a node", "{\"mesh\":0,\"weights\":[1]}", MORPHS, "", 0, 3, 1},
        {"a node without weights", "{\"mesh\":0}", MORPHS, "", 0, 3, 0},
        {"a step of a node with a tab in its name", "{\"name\":\"a\\tb\",\"mesh\":0}", PLAIN,
         CHANNELS(CHANNEL("\"node\":0,"), ",\"interpolation\":\"STEP\""), 0.75, 3, 0},
        {"and its end", "{\"name\":\"a\\tb\",\"mesh\":0}", PLAIN,
         CHANNELS(CHANNEL("\"node\":0,"), ",\"interpolation\":\"STEP\""), 1, 3, 3},
        {"a skin without inverse bind matrices",
         "{\"mesh\":0,\"skin\":0,\"children\":[1]},{\"name\":\"a\"}", BOUND,
         BARE_SKIN ANIMATION("1"), 1, 3, 3},
    };
    const buffer data = make_buffer();
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        uint32_t moved = 0;
        test_row("%s", rows[i].what);
        write_gltf("c.gltf", &data, rows[i].nodes, rows[i].primitive, rows[i].more);
        mote_character *c = import("c.gltf", NULL);
        assert_int_equal(c->mesh->vertex_count, rows[i].vertices);
        for (uint32_t v = 0; v < c->mesh->vertex_count; ++v)
            moved += place_at(c, rows[i].seconds, v).x > 1.5;
        assert_int_equal(moved, rows[i].moved);
        mote_character_destroy(c);
    }
}

static void refuse(const char *path, const char *says)
{
    mote_character *c = NULL;
    test_row("%s", says);
    assert_int_equal(mote_character_import_file(path, &c, NULL), MOTE_EINVAL);
    if (strncmp(mote_error_text(), says, strlen(says)) != 0)
        fail_msg("%s", mote_error_text());
    assert_null(c);
}

TEST(character_without_faces_or_with_bad_ones_is_refused)
{
    buffer data = make_buffer();
    write_gltf("c.gltf", &data, "{\"name\":\"Part\",\"mesh\":0}", POINTS, ANIMATION("0"));
    refuse("c.gltf", "c.gltf: no face in it; give triangles");
    refuse_mesh("c.gltf", "c.gltf: no face in it; give triangles");
    data.corners[4] = NAN;
    write_gltf("c.gltf", &data,
               "{\"name\":\"Part\",\"mesh\":0,\"children\":[1,2]},{\"mesh\":0},{\"mesh\":0}",
               PLAIN "," PLAIN, ANIMATION("0"));
    refuse("c.gltf", "c.gltf: vertex 1 of mesh Cup");
    refuse_mesh("c.gltf", "c.gltf: vertex 1 of mesh Cup");
    data = make_buffer();
    memcpy(data.corners + 3, data.corners, 3 * sizeof(float));
    write_gltf("c.gltf", &data, "{\"name\":\"Part\",\"mesh\":0}", PLAIN, ANIMATION("0"));
    refuse("c.gltf", "c.gltf: each of its 1 faces has two corners at one place; give");
    refuse_mesh("c.gltf", "c.gltf: each of its 1 faces has two corners at one place; give");
}

/* A chain of 300 nodes, with a node beside each. */
TEST(file_of_nodes_nested_too_deep_is_refused)
{
    buffer data = make_buffer();
    mote_text nodes = {0};
    for (int n = 0; n < 300; ++n)
        mote_text_add(&nodes, "{\"children\":[%d,%d]},{},", 2 * n + 2, 2 * n + 1);
    mote_text_add(&nodes, "{\"mesh\":0}");
    write_gltf("c.gltf", &data, nodes.data, PLAIN, ANIMATION("0"));
    refuse("c.gltf", "c.gltf: nodes nested deeper than 256; flatten them");
    refuse_mesh("c.gltf", "c.gltf: nodes nested deeper than 256; flatten them");
    free(nodes.data);
}

TEST(files_that_end_early_or_hold_no_mesh_are_refused)
{
    file_put("c.glb", "glTF\2");
    refuse_mesh("c.glb", "c.glb: ends after 5 of 12 bytes; give the whole glTF file");
    file_put("c.glb", "glTX\2\0\0\0\0\0\0\0");
    refuse_mesh("c.glb", "c.glb:1: ");
    file_put("c.x", "xof 0303txt 0032\nFrame Root {\n}\n");
    refuse_mesh("c.x", "c.x: no mesh in it; give triangles");
}

/* The bone with the largest weights has no node, or one before it. */
TEST(character_whose_bone_has_no_node_is_refused)
{
    bar_text part = bar_default();
    part.upper = "Other";
    part.upper_weights = "5.0,5.0,5.0,5.0,5.0,5.0,5.0,5.0";
    bar_write("c.x", part);
    refuse("c.x", "c.x: bone Upper is not a node; give each bone a node");
    part.upper = "Upper";
    bar_write("c.x", part);
    replace("c.x", "{ \"Lower\"", "{ \"zone\"");
    refuse("c.x", "c.x: bone zone is not a node; give each bone a node");
}

/* Skins and joints that assimp ignores, or crashes from. */
TEST(character_of_wrong_joints_is_refused)
{
#define SET(n) "\"JOINTS_" n "\":5,\"WEIGHTS_" n "\":1"
    static const char pairs[] = "c.gltf: meshes[0]: its JOINTS and WEIGHTS are not pairs";
    static const struct {
        const char *attributes, *says;
    } rows[] = {
        {SET("0"), "c.gltf: meshes[0]: JOINTS_0 (accessors[5]) has joint 1 of 1 of skins[0] at "
                   "vertex 1; use 0 to 0"},
        {"\"JOINTS_0\":5", pairs},
        {"\"WEIGHTS_0\":1", pairs},
        {SET("1"), pairs},
        {SET("0") ",\"WEIGHTS_1\":1", pairs},
        {"\"JOINTS_0\":5,\"WEIGHTS_0\":9", pairs},
        {"\"JOINTS_0\":1,\"WEIGHTS_0\":1",
         "c.gltf: JOINTS that are no whole numbers; give who"},
    };
    buffer data = make_buffer();
    data.joints[4] = 1;
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char *primitive =
            mote_format("{\"attributes\":{\"POSITION\":0,%s}}", rows[i].attributes);
        write_gltf("c.gltf", &data, TWO_NODES, primitive, SKIN);
        refuse("c.gltf", rows[i].says);
        free(primitive);
    }
    data.weights[4] = 0; /* what has no weight may be any joint */
    write_gltf("c.gltf", &data, TWO_NODES, BOUND, SKIN);
    mote_character_destroy(import("c.gltf", NULL));
}

/* assimp ignores such weights. */
TEST(character_of_wrong_weights_is_refused)
{
    static const char nan[] = "c.gltf: meshes[0]: WEIGHTS_0 (accessors[1]) has the weight nan",
                      none[] = "c.gltf: meshes[0]: WEIGHTS_0 (accessors[1]) has the weight "
                               "-0.25 at vertex 2; give a finite one that is not negative";
    static const struct {
        float weight;
        const char *says;
    } rows[] = {{-0.25F, none}, {NAN, nan}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        buffer data = make_buffer();
        data.weights[9] = rows[i].weight;
        write_gltf("c.gltf", &data, TWO_NODES, BOUND, SKIN);
        refuse("c.gltf", rows[i].says);
    }
    buffer data = make_buffer();
    data.weights[9] = -0.0F;
    write_gltf("c.gltf", &data, TWO_NODES, BOUND, SKIN);
    mote_character_destroy(import("c.gltf", NULL));
}

/* The joint is no part of the scene. */
TEST(character_whose_joint_is_elsewhere_is_refused_by_its_name)
{
    const buffer data = make_buffer();
    write_gltf("c.gltf", &data, "{\"mesh\":0,\"skin\":0},{\"name\":\"Hip\"}", BOUND, SKIN);
    refuse("c.gltf", "c.gltf: bone Hip is not a node of the scene; give each bone a node");
}

/* A buffer in another folder, by a link or by its name; one whose name only looks so; one that
   never ends. */
TEST(gltf_reads_no_files_of_other_folders)
{
    static const char *const names[] = {"../c.bin", "%2e./c.bin", "a/../../c.bin", "/c.bin"};
    const buffer data = make_buffer();
    mote_mesh *mesh = NULL;
    assert_int_equal(mkdir("sub", 0700), 0);
    for (size_t n = 0; n < ROWS_OF(names); ++n) {
        write_gltf("sub/c.gltf", &data, "{\"mesh\":0}", PLAIN, ANIMATION("0"));
        replace("sub/c.gltf", "c.bin", names[n]);
        refuse_mesh("sub/c.gltf", "sub/c.gltf: names ");
        assert_non_null(strstr(mote_error_text(), "which is not in its folder; put that file"));
        refuse("sub/c.gltf", "sub/c.gltf: names ");
    }
    file_write("sub/c..bin", &data, sizeof data);
    replace("sub/c.gltf", names[3], "c..bin");
    assert_int_equal(mote_mesh_import("sub/c.gltf", &mesh, NULL), MOTE_OK);
    mote_mesh_destroy(mesh);
    assert_int_equal(mkfifo("sub/fifo", 0600), 0);
    replace("sub/c.gltf", "c..bin", "fifo");
    refuse_mesh("sub/c.gltf", "sub/c.gltf: buffer sub/fifo: not a regular file; name a file");
}

/* The limits of the process that reads a file follow from its buffers, too: 200 MB here, of
   which the disk stores few. */
TEST(gltf_of_a_large_buffer_in_a_file_is_read)
{
    const buffer data = make_buffer();
    char *length = mote_format("\"byteLength\":%zu}],", sizeof data);
    mote_mesh *mesh = NULL;
    write_gltf("c.gltf", &data, "{\"mesh\":0}", PLAIN, ANIMATION("0"));
    replace("c.gltf", length, "\"byteLength\":200000000}],");
    assert_int_equal(truncate("c.bin", 200000000), 0);
    if (mote_mesh_import("c.gltf", &mesh, NULL) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_mesh_destroy(mesh);
    mote_character_destroy(import("c.gltf", NULL));
    assert_int_equal(rename("c.gltf", "c.vrm"), 0); /* known by its content */
    mote_character_destroy(import("c.vrm", NULL));
    assert_int_equal(rename("c.vrm", "c.gltf"), 0);
    assert_int_equal(truncate("c.bin", ((off_t)4 << 30) + 1), 0);
    refuse_mesh("c.gltf", "c.gltf: 4294967297 bytes; at most 4294967296 are read");
    assert_int_equal(truncate("c.bin", 0), 0);
    free(length);
}

TEST(node_names_are_found_by_halves)
{
    static const mote_node_name names[] = {{"a", 4}, {"c", 2}, {"c", 3}, {"d", 1}};
    static const struct {
        const char *name;
        size_t count;
        uint32_t node;
    } rows[] = {{"a", 4, 4},
                {"c", 4, 2},
                {"d", 4, 1},
                {"b", 4, MOTE_RIG_NONE},
                {"", 4, MOTE_RIG_NONE},
                {"e", 4, MOTE_RIG_NONE},
                {"d", 3, MOTE_RIG_NONE},
                {"a", 0, MOTE_RIG_NONE}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i)
        assert_int_equal(mote_node_find(names, rows[i].count, rows[i].name), rows[i].node);
}

/* Of several nodes with a bone's name, the first is the bone's. */
TEST(character_of_nodes_with_one_name_moves_with_the_first)
{
    bar_write("c.x", bar_default());
    replace("c.x", " Frame Lower {", " Frame Upper {\n }\n Frame Upper {\n }\n Frame Lower {");
    mote_character *c = import("c.x", NULL);
    uint32_t found = MOTE_RIG_NONE, named = 0;
    for (uint32_t n = (uint32_t)c->rig.nodes_count; n-- > 0;) {
        if (strcmp(c->rig.names + c->rig.nodes[n].name, "Upper") == 0) {
            found = n;
            ++named;
        }
    }
    assert_int_equal(named, 3);
    for (size_t b = 0; b < c->rig.bones_count; ++b) {
        const uint32_t node = c->rig.bones[b].node;
        assert_true(node == found ||
                    strcmp(c->rig.names + c->rig.nodes[node].name, "Upper") != 0);
    }
    mote_character_destroy(c);
}

/* The format is known from the content where the name has no ending. */
TEST(character_in_a_file_without_an_ending_is_read)
{
    bar_write("c.x", bar_default());
    assert_int_equal(rename("c.x", "bar"), 0);
    mote_character *c = import("bar", NULL);
    assert_int_equal(c->mesh->vertex_count, BAR_VERTICES);
    mote_character_destroy(c);
}

/* The last test: from here on an edge of three faces is an error. */
TEST(character_with_an_edge_of_three_faces_is_strictly_refused)
{
    mote_character_import facts;
    bar_write("c.x", bar_default());
    replace("c.x", "  20;\n", "  21;\n");
    replace("c.x", "3;8,10,11;;", "3;8,10,11;,\n  3;8,10,1;;");
    mote_character *c = import("c.x", &facts);
    assert_int_equal(facts.mesh.split.edges, 1);
    mote_character_destroy(c);
    mote_mesh_import_strictly();
    refuse("c.x", "c.x: 1 edge of more than two faces (non-manifold): (2, ");
    bar_write("c.x", bar_default());
    c = import("c.x", &facts);
    assert_int_equal(facts.mesh.split.edges, 0);
    mote_character_destroy(c);
}
