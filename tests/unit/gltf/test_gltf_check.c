/* What mote_gltf_check refuses in a glTF text, and what passes; and that both readers ask. */
#include "harness/base/file.h"
#include "harness/gltf/gltf_file.h"
#include "harness/mesh/character.h"
#include "harness/mesh/mesh_import.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"
#include "tests/unit/mesh/refused.h"

#include <assimp/cimport.h>
#include <assimp/scene.h>
#include <math.h>

/* Three corners, one bone, one morph target and two keys. at: where write_numbers has them. */
#define ACCESSOR(at, component, count, type)                                                   \
    "{\"bufferView\":0,\"byteOffset\":" #at ",\"componentType\":" #component                   \
    ",\"count\":" #count ",\"type\":\"" #type "\",\"min\":[0,0,0],\"max\":[1,1,0]}"
#define POSITION ACCESSOR(0, 5126, 3, VEC3)
#define WEIGHTS ACCESSOR(36, 5126, 3, VEC4)
#define BINDS ACCESSOR(84, 5126, 1, MAT4)
#define TIMES ACCESSOR(148, 5126, 2, SCALAR)
#define KEYS ACCESSOR(156, 5126, 2, VEC4)
#define SHIFTS ACCESSOR(188, 5126, 3, VEC3)
#define JOINTS ACCESSOR(224, 5121, 3, VEC4)
#define REQUIRED "\"asset\":{\"version\":\"2.0\"}"
#define WHOLE                                                                                  \
    "{" REQUIRED ",\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0,"         \
    "\"skin\":0},{\"name\":\"bone\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{"          \
    "\"POSITION\":0,\"WEIGHTS_0\":1,\"JOINTS_0\":6},\"targets\":[{\"POSITION\":5}]}]}],"       \
    "\"skins\":[{\"joints\":[1],\"inverseBindMatrices\":2}],\"animations\":[{\"channels\":[{"  \
    "\"sampler\":0,\"target\":{\"node\":1,\"path\":\"rotation\"}}],\"samplers\":[{\"input\":"  \
    "3,\"output\":4}]}],\"accessors\":[" POSITION "," WEIGHTS "," BINDS "," TIMES "," KEYS     \
    "," SHIFTS "," JOINTS "],\"bufferViews\":[{\"buffer\":0,\"byteLength\":236}],"             \
    "\"buffers\":[{\"uri\":\"c.bin\",\"byteLength\":236}]}"

#define VIEWS "\"bufferViews\":[{\"buffer\":0,\"byteLength\":236}"
#define NUMBERS                                                                                \
    POSITION "," WEIGHTS "," BINDS "," TIMES "," KEYS "," SHIFTS "," JOINTS "]," VIEWS
#define SPARSE(stride) SPARSE_AT(stride, "224", "0")
#define SPARSE_AT(stride, indices, values)                                                     \
    "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"  \
    "\"max\":[1,1,0],\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,"                   \
    "\"byteOffset\":" indices                                                                  \
    ",\"componentType\":5121},\"values\":{\"bufferView\":0,\"byteOffset\":" values             \
    "}}}," WEIGHTS "," BINDS "," TIMES "," KEYS "," SHIFTS "," JOINTS "]," VIEWS               \
    ",{\"buffer\":0,\"byteLength\":48,\"byteStride\":" stride "}"
#define BEYOND(entry, count)                                                                   \
    "c.gltf: accessors[" entry "]: its " count                                                 \
    " elements do not lie within the byteLength of "                                           \
    "bufferViews[0]; give"

#define INTEGERS(entry, what, bits)                                                            \
    "c.gltf: " entry ": " what " has " bits " integers, which assimp takes for floats; write " \
    "32-bit floats"
#define TOOL ", as gltf-transform dequantize does"
#define BOUND "\"WEIGHTS_0\":1,\"JOINTS_0\":6"
#define CHANNEL "\"node\":1,\"path\":\"rotation\""
#define SHAPE(entry, what, right)                                                              \
    "c.gltf: " entry ": " what " has too few elements, or of a wrong type; give " right
#define PACKED(name)                                                                           \
    "c.gltf: requires " name                                                                   \
    ", which assimp does not read; uncompress it, as gltf-transform dequantize does"

static const struct {
    const char *from, *to; /* one replacement in the whole text */
    const char *mesh;      /* what a reader of the mesh is told; "": it is read */
    const char *motion;    /* and a reader of what moves; NULL: the same */
} rows[] = {
    {"", "", "", NULL},
    {POSITION, ACCESSOR(0, 5122, 3, VEC3), INTEGERS("meshes[0]", "POSITION", "16-bit") TOOL,
     NULL},
    {POSITION, ACCESSOR(0, 5125, 3, VEC3), INTEGERS("meshes[0]", "POSITION", "32-bit") TOOL,
     NULL},
    {POSITION, ACCESSOR(0, 5130, 3, VEC3),
     "c.gltf: meshes[0]: POSITION has numbers of an unknown type, which assimp takes for ",
     NULL},
    {POSITION, ACCESSOR(0, 5126, 3, VEC2), SHAPE("meshes[0]", "POSITION", "3 of VEC3"), NULL},
    {POSITION, "{\"bufferView\":0,\"componentType\":5126,\"count\":3}",
     SHAPE("meshes[0]", "POSITION", "3 of VEC3"), NULL},
    {WEIGHTS, ACCESSOR(36, 5121, 3, VEC4), "", INTEGERS("meshes[0]", "WEIGHTS", "8-bit") TOOL},
    {WEIGHTS, ACCESSOR(36, 5123, 3, VEC4), "", INTEGERS("meshes[0]", "WEIGHTS", "16-bit") TOOL},
    {WEIGHTS, ACCESSOR(36, 5126, 2, VEC4), "", SHAPE("meshes[0]", "WEIGHTS", "3 of VEC4")},
    {WEIGHTS, ACCESSOR(36, 5126, 3, VEC3), "", SHAPE("meshes[0]", "WEIGHTS", "3 of VEC4")},
    {JOINTS, ACCESSOR(224, 5121, 2, VEC4), "", SHAPE("meshes[0]", "JOINTS", "3 of VEC4")},
    {SHIFTS, ACCESSOR(188, 5120, 3, VEC3), "",
     INTEGERS("meshes[0]", "a target's POSITION", "8-bit") TOOL},
    {SHIFTS, ACCESSOR(188, 5126, 3, VEC2), "",
     SHAPE("meshes[0]", "a target's POSITION", "3 of VEC3")},
    {BINDS, ACCESSOR(84, 5122, 1, MAT4), "",
     INTEGERS("skins[0]", "inverseBindMatrices", "16-bit")},
    {"\"joints\":[1]", "\"joints\":[1,0]", "",
     SHAPE("skins[0]", "inverseBindMatrices", "2 of MAT4")},
    {"\"joints\":[1]", "\"joints\":[2]", "",
     "c.gltf: skins[0]: joints[0] is not a node; name one"},
    {"\"joints\":[1]", "\"joints\":[\"1\"]", "",
     "c.gltf: skins[0]: joints[0] is not a node; name one"},
    {"\"inverseBindMatrices\":2", "\"inverseBindMatrices\":9", "",
     "c.gltf: skins[0]: inverseBindMatrices is not an accessor; name one of 1"},
    {",\"inverseBindMatrices\":2", "", "", NULL},
    {"\"skin\":0", "\"skin\":1", "", "c.gltf: nodes[0]: skin is not a skin; name one"},
    {TIMES, ACCESSOR(148, 5123, 2, SCALAR), "",
     INTEGERS("animations[0]", "a sampler's input", "16-bit")},
    {KEYS, ACCESSOR(156, 5120, 2, VEC4), "",
     INTEGERS("animations[0]", "a sampler's output", "8-bit")},
    {KEYS, ACCESSOR(156, 5126, 1, VEC4), "", SHAPE("animations[0]", "a sampler's output", "2")},
    {SHIFTS, ACCESSOR(188, 5126, 2, VEC3), SHAPE("meshes[0]", "a target's POSITION", "3"),
     NULL},
    {POSITION, ACCESSOR(204, 5126, 3, VEC3), BEYOND("0", "3"), NULL},
    {POSITION, ACCESSOR(9223372036854775807, 5126, 3, VEC3), BEYOND("0", "3"), NULL},
    {KEYS, ACCESSOR(156, 5126, 9223372036854775807, VEC4), BEYOND("4", "9223372036854775807"),
     NULL},
    {VIEWS, "\"bufferViews\":[{\"buffer\":0,\"byteLength\":235}", BEYOND("6", "3"), NULL},
    {VIEWS, "\"bufferViews\":[{\"buffer\":0,\"byteLength\":236,\"byteStride\":100}",
     BEYOND("1", "3"), NULL},
    {VIEWS, "\"bufferViews\":[{\"buffer\":0,\"byteLength\":237}",
     "c.gltf: accessors[0]: bufferViews[0] does not lie within the byteLength of buffers[0]",
     NULL},
    {VIEWS, "\"bufferViews\":[{\"buffer\":0,\"byteLength\":236,\"byteOffset\":1}",
     "c.gltf: accessors[0]: bufferViews[0] does not lie within the byteLength of buffers[0]",
     NULL},
    {NUMBERS, SPARSE("12"), "", NULL},
    {NUMBERS, SPARSE_AT("12", "235", "224"), "", NULL},
    {NUMBERS, SPARSE_AT("12", "236", "224"), BEYOND("0", "1 sparse"), NULL},
    {NUMBERS, SPARSE_AT("12", "235", "228"), BEYOND("0", "1 sparse"), NULL},
    {NUMBERS, SPARSE_AT("12", "-1", "224"), BEYOND("0", "1 sparse"), NULL},
    {NUMBERS, SPARSE("16"),
     "c.gltf: accessors[0]: sparse, over bufferViews[1] with a byteStride, which assimp "
     "ignores",
     NULL},
    /* Such a channel is ignored, and its numbers may be any. */
    {CHANNEL "}}],\"samplers\":[{\"input\":3,\"output\":4}",
     "\"path\":\"pointer\"}}],\"samplers\":[{\"input\":3,\"output\":6}", "", NULL},
    /* What a file only uses may be ignored; what it requires may not. */
    {REQUIRED, REQUIRED ",\"extensionsUsed\":[\"EXT_meshopt_compression\"]", "", NULL},
    {REQUIRED, REQUIRED ",\"extensionsRequired\":[\"KHR_texture_basisu\"]", "", NULL},
    {REQUIRED, REQUIRED ",\"extensionsRequired\":[3,\"EXT_meshopt_compression\"]",
     PACKED("EXT_meshopt_compression"), NULL},
    {REQUIRED, REQUIRED ",\"extensionsRequired\":[\"KHR_meshopt_compression\"]",
     PACKED("KHR_meshopt_compression"), NULL},
    {REQUIRED, REQUIRED ",\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"]",
     "c.gltf: requires EXT_mesh_gpu_instancing, which assimp does not read; give each instance "
     "a node",
     NULL},
};

static char *text_of(size_t row)
{
    static const char whole[] = WHOLE;
    const char *at = strstr(whole, rows[row].from);
    assert_non_null(at);
    return mote_format("%.*s%s%s", (int)(at - whole), whole, rows[row].to,
                       at + strlen(rows[row].from));
}

static void expect(mote_status status, const char *says)
{
    if (says[0] ? status != MOTE_EINVAL || !strstr(mote_error_text(), says) : status != MOTE_OK)
        fail_msg("status %d: %s; not: %s", (int)status, mote_error_text(), says);
}

static void check(const mote_gltf *gltf, bool moves, const char *says)
{
    expect(mote_gltf_check(gltf, moves), says);
}

TEST(gltf_numbers_that_assimp_would_misread_are_refused)
{
    for (size_t r = 0; r < ROWS_OF(rows); ++r) {
        char *text = text_of(r);
        mote_gltf gltf;
        test_row("%zu: %s", r, rows[r].to);
        assert_int_equal(mote_gltf_open("c.gltf", text, strlen(text), &gltf), MOTE_OK);
        check(&gltf, false, rows[r].mesh);
        check(&gltf, true, rows[r].motion ? rows[r].motion : rows[r].mesh);
        mote_gltf_close(&gltf);
        free(text);
    }
}

/* A file in which the members that are looked at are missing or of another kind: assimp refuses
   it. */
TEST(gltf_of_other_members_passes)
{
    static const char *const texts[] = {
        "[]",
        "{\"meshes\":3,\"accessors\":{}}",
        "{\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":7},\"targets\":[4]}]}]}",
        "{\"meshes\":[{},5],\"skins\":[null],\"animations\":[{\"samplers\":[{\"input\":-1}]}]}",
    };
    for (size_t t = 0; t < ROWS_OF(texts); ++t) {
        mote_gltf gltf;
        test_row("%s", texts[t]);
        assert_int_equal(mote_gltf_open("c.gltf", texts[t], strlen(texts[t]), &gltf), MOTE_OK);
        check(&gltf, true, "");
        mote_gltf_close(&gltf);
    }
}

/* Such a file may require Draco or only use it, with the numbers beside it. */
TEST(gltf_of_draco_with_indices_of_32_bits_is_refused)
{
    static const char says[] =
        "c.gltf: meshes[1]: KHR_draco_mesh_compression with indices of 32 bits, which assimp "
        "misreads; uncompress it, as gltf-transform dequantize does";
    static const struct {
        const char *extensions;
        int component;
        const char *says;
    } primitives[] = {
        {"\"KHR_draco_mesh_compression\":{}", 5125, says},
        {"\"KHR_draco_mesh_compression\":{}", 5123, ""},
        {"\"KHR_materials_variants\":{}", 5125, ""},
    };
    for (size_t r = 0; r < ROWS_OF(primitives); ++r) {
        char *text = mote_format(
            "{\"meshes\":[{},{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,"
            "\"extensions\":{%s}}]}],\"accessors\":[{\"componentType\":5126,\"count\":3,"
            "\"type\":\"VEC3\"},{\"componentType\":%d,\"count\":3,\"type\":\"SCALAR\"}]}",
            primitives[r].extensions, primitives[r].component);
        mote_gltf gltf;
        test_row("%zu", r);
        assert_int_equal(mote_gltf_open("c.gltf", text, strlen(text), &gltf), MOTE_OK);
        check(&gltf, false, primitives[r].says);
        mote_gltf_close(&gltf);
        free(text);
    }
}

/* The bytes of the accessors: a triangle, all of whose weights are the bone's, which turns. */
static void write_numbers(void)
{
    const struct {
        float positions[9], weights[12], binds[16], times[2], keys[8], shifts[9];
        uint8_t joints[12];
    } bytes = {.positions = {[3] = 1, [7] = 1},
               .weights = {[0] = 1, [4] = 1, [8] = 1},
               .binds = {[0] = 1, [5] = 1, [10] = 1, [15] = 1},
               .times = {[1] = 1},
               .keys = {[3] = 1, [6] = 1}};
    file_write("c.bin", &bytes, sizeof bytes);
}

TEST(gltf_is_checked_by_the_readers_of_meshes_and_of_characters)
{
    write_numbers();
    for (size_t r = 0; r < ROWS_OF(rows); ++r) {
        char *text = text_of(r);
        mote_mesh *mesh = NULL;
        mote_character *character = NULL;
        test_row("%zu: %s", r, rows[r].to);
        file_put("c.gltf", text);
        expect(mote_mesh_import("c.gltf", &mesh, NULL), rows[r].mesh);
        expect(mote_character_import_file("c.gltf", &character, NULL),
               rows[r].motion ? rows[r].motion : rows[r].mesh);
        mote_mesh_destroy(mesh);
        mote_character_destroy(character);
        free(text);
    }
}

TEST(gltf_is_recognised_by_its_name_or_by_its_content)
{
    static const struct {
        const char *path, *data;
        size_t size;
        bool is;
    } files[] = {
        {"a.gltf", "", 0, true},      {"b.GLB", "x", 1, true}, {"c", " \r\n\t{", 5, true},
        {"d.vrm", "glTF", 4, true},   {"e", "glT", 3, false},  {"f.gltfx", "ply", 3, false},
        {"g.stl", "\0\0{", 3, false}, {"h", " \n", 2, false},  {"folder.gltf/i", "x", 1, false},
    };
    for (size_t f = 0; f < ROWS_OF(files); ++f) {
        test_row("%s", files[f].path);
        assert_int_equal(mote_gltf_is(files[f].path, files[f].data, files[f].size),
                         files[f].is);
    }
}

TEST(gltf_of_any_name_is_checked_and_read)
{
    static const char *const names[] = {"model", "c.glb", "c.ply.gltf"};
    char *wrong = text_of(1), *right = text_of(0);
    write_numbers();
    for (size_t n = 0; n < ROWS_OF(names); ++n) {
        mote_mesh *mesh = NULL;
        char *says = mote_format("%s: meshes[0]: POSITION has 16-bit integers", names[n]);
        file_put(names[n], wrong);
        refuse_mesh(names[n], says);
        free(says);
        file_put(names[n], right);
        expect(mote_mesh_import(names[n], &mesh, NULL), "");
        assert_int_equal(mesh->triangle_count, 1);
        mote_mesh_destroy(mesh);
    }
    free(wrong);
    free(right);
    /* Version 1 is another format, whose files assimp knows by their names. */
    file_put("c.glb", "{\"asset\":{\"version\":\"1.0\"}}");
    refuse_mesh("c.glb", "c.glb: glTF, and text; give it a name that ends in .gltf");
    file_write("c.vrm", "glTF\2\0\0\0\30\0\0\0\4\0\0\0JSON{}  ", 24);
    refuse_mesh("c.vrm", "c.vrm: glTF, and binary; give it a name that ends in .glb");
}

/* As programs write them whose numbers are all real. assimp took 12.0 for 0, and 3.0 for none.
 */
TEST(gltf_whole_numbers_may_have_a_decimal_point)
{
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0.0,\"scenes\":[{\"nodes\":[0.0]}],"
        "\"nodes\":[{\"mesh\":0.0,\"translation\":[-0.0,2.0,0.5]}],\"meshes\":[{"
        "\"primitives\":[{\"mode\":4.0,\"attributes\":{\"POSITION\":0.0}}]}],\"accessors\":[{"
        "\"bufferView\":0.0,\"byteOffset\":4.0,\"componentType\":5126.0,\"count\":3.0,"
        "\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":0.0,\"byteOffset\":8.0,"
        "\"byteLength\":40.0}],\"buffers\":[{\"byteLength\":48.0,\"uri\":\"w.bin\"}]}";
    static const float numbers[12] = {5, 6, 7, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const mote_vec3 wanted[3] = {{0, 2, 0.5}, {1, 2, 0.5}, {0, 3, 0.5}};
    mote_mesh *mesh = NULL;
    file_write("w.bin", numbers, sizeof numbers);
    file_put("w.gltf", text);
    expect(mote_mesh_import("w.gltf", &mesh, NULL), "");
    assert_int_equal(mesh->vertex_count, 3);
    assert_memory_equal(mesh->positions, wanted, sizeof wanted);
    mote_mesh_destroy(mesh);
}

/* datasets/defects.md, entry 22: the corners of a triangle, up to 1,000 away in 16-bit
   integers, by assimp. */
TEST(defect_22_assimp_takes_integers_for_floats)
{
    static const char triangle[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]"
        ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{"
        "\"bufferView\":0,\"componentType\":5122,\"count\":3,\"type\":\"VEC3\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":24,\"byteStride\":8}],\"buffers\":[{"
        "\"byteLength\":24,\"uri\":\"data:;base64,AAAAAAAAAADoAwAAAAAAAAAA6AMAAAAA\"}]}";
    file_put("t.gltf", triangle);
    const struct aiScene *scene = aiImportFile("t.gltf", 0);
    assert_non_null(scene);
    for (int v = 0; v < 3; ++v) {
        const struct aiVector3D *at = &scene->mMeshes[0]->mVertices[v];
        if (fabsf(at->x) > 1e-30F || fabsf(at->y) > 1e-30F)
            fail_msg("the library no longer shows this defect; see datasets/defects.md");
    }
    aiReleaseImport(scene);
}
