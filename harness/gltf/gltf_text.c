/* The text of a glTF file for assimp: see mote_gltf_text. All entries that are changed are
   copies; the file's own stay as they are. */
#include "harness/gltf/gltf_file.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define MATRIX_FLOATS 16

static void set(json_t *object, const char *key, json_t *value)
{
    (void)json_object_set_new(object, key, value);
}

static int64_t append(json_t *list, json_t *value)
{
    (void)json_array_append_new(list, value);
    return (int64_t)json_array_size(list) - 1;
}

/* Replaces a list of the root by a copy of it, or by an empty one, and returns that. */
static json_t *own_list(json_t *root, const char *name)
{
    json_t *list = json_object_get(root, name);
    json_t *own = json_is_array(list) ? json_copy(list) : json_array();
    set(root, name, own);
    return own;
}

/* Replaces an entry of such a list by a copy of it, and returns that. */
static json_t *own_entry(json_t *list, size_t index)
{
    json_t *own = json_copy(json_array_get(list, index));
    (void)json_array_set_new(list, index, own);
    return own;
}

/* A buffer whose length is not given, as assimp allows for data in the text, gets one. One that
   cannot be loaded fails when assimp opens it. */
static void set_buffers(mote_gltf *gltf, json_t *root)
{
    json_t *buffers = own_list(root, "buffers");
    for (size_t b = 0; b < json_array_size(buffers); ++b) {
        json_t *buffer = own_entry(buffers, b);
        const char *uri = json_string_value(json_object_get(buffer, "uri"));
        const bool is_bin = !uri && b == 0 && gltf->bin;
        mote_gltf_bytes bytes;
        if ((is_bin || (uri && strncmp(uri, "data:", 5) == 0)) &&
            mote_gltf_load(gltf, b, &bytes) == MOTE_OK &&
            (is_bin || mote_gltf_whole(buffer, "byteLength") <= 0))
            set(buffer, "byteLength", json_integer((json_int_t)bytes.size));
        if (is_bin || uri)
            set(buffer, "uri", json_sprintf(MOTE_GLTF_BUFFER "%zu", b));
    }
}

/* The mesh that stands for one of the file's meshes with a skin (-1: without). */
typedef struct body {
    int64_t skin, mesh;
    size_t next; /* of the same mesh, from 1; 0: none */
} body;

typedef struct bodies {
    json_t *meshes;
    body *list;
    size_t count, capacity;
    size_t *first; /* [meshes of the file], from 1; 0: none */
} bodies;

static bool has_targets(const json_t *mesh)
{
    const json_t *first = json_array_get(json_object_get(mesh, "primitives"), 0);
    return json_array_size(json_object_get(first, "targets")) > 0;
}

/* Where nothing but a skin moves a mesh, it is the same for all nodes with that skin. */
static int64_t mesh_of(bodies *all, int64_t mesh, int64_t skin)
{
    json_t *entry = json_array_get(all->meshes, (size_t)mesh);
    const bool shares = skin < 0 || !has_targets(entry);
    const size_t first = all->first[mesh];
    for (size_t b = first; b > 0; b = all->list[b - 1].next) {
        if (all->list[b - 1].skin == skin && shares)
            return all->list[b - 1].mesh;
    }
    const int64_t own = first > 0 ? append(all->meshes, json_incref(entry)) : mesh;
    all->list = mote_reserve(all->list, all->count + 1, &all->capacity, sizeof *all->list);
    all->list[all->count++] = (body){.skin = skin, .mesh = own, .next = first};
    all->first[mesh] = all->count;
    return own;
}

static void set_nodes(json_t *root, bool moves)
{
    json_t *nodes = own_list(root, "nodes");
    bodies all = {.meshes = own_list(root, "meshes")};
    const int64_t meshes = (int64_t)json_array_size(all.meshes);
    all.first = mote_allocate((size_t)meshes, sizeof *all.first);
    for (size_t n = 0; n < json_array_size(nodes); ++n) {
        json_t *node = own_entry(nodes, n);
        const int64_t mesh = mote_gltf_whole(node, "mesh");
        if (!moves)
            (void)json_object_del(node, "skin");
        if (mesh >= 0 && mesh < meshes)
            set(node, "mesh", json_integer(mesh_of(&all, mesh, mote_gltf_whole(node, "skin"))));
        set(node, "name", json_sprintf("%zu", n));
    }
    free(all.list);
    free(all.first);
}

/* Adds a buffer of so many matrices that change nothing; returns its number. */
static int64_t add_identities(mote_gltf *gltf, json_t *buffers, size_t count)
{
    const size_t size = count * MATRIX_FLOATS * sizeof(float);
    float *matrices = mote_allocate(count * MATRIX_FLOATS, sizeof *matrices);
    for (size_t i = 0; i < count * MATRIX_FLOATS; ++i)
        matrices[i] = i % MATRIX_FLOATS % 5 == 0 ? 1 : 0;
    mote_gltf_bytes *bytes = &gltf->buffers[gltf->buffer_count - 1];
    free(bytes->own);
    *bytes = (mote_gltf_bytes){(char *)matrices, size, (char *)matrices};
    return append(buffers,
                  json_pack("{s:o,s:I}", "uri",
                            json_sprintf(MOTE_GLTF_BUFFER "%zu", gltf->buffer_count - 1),
                            "byteLength", (json_int_t)size));
}

static bool lacks_binds(const json_t *skin)
{
    return json_is_object(skin) && !json_object_get(skin, "inverseBindMatrices");
}

static void set_skins(mote_gltf *gltf, json_t *root)
{
    json_t *skins = own_list(root, "skins");
    size_t most = 0;
    for (size_t s = 0; s < json_array_size(skins); ++s) {
        const json_t *skin = json_array_get(skins, s);
        const size_t joints = json_array_size(json_object_get(skin, "joints"));
        most = lacks_binds(skin) && joints > most ? joints : most;
    }
    if (most == 0)
        return;
    const int64_t buffer = add_identities(gltf, own_list(root, "buffers"), most);
    const int64_t view =
        append(own_list(root, "bufferViews"),
               json_pack("{s:I,s:I}", "buffer", (json_int_t)buffer, "byteLength",
                         (json_int_t)gltf->buffers[gltf->buffer_count - 1].size));
    const int64_t accessor =
        append(own_list(root, "accessors"),
               json_pack("{s:I,s:i,s:I,s:s}", "bufferView", (json_int_t)view, "componentType",
                         MOTE_GLTF_FLOATS, "count", (json_int_t)most, "type", "MAT4"));
    for (size_t s = 0; s < json_array_size(skins); ++s) {
        if (lacks_binds(json_array_get(skins, s)))
            set(own_entry(skins, s), "inverseBindMatrices", json_integer(accessor));
    }
}

/* The channels that move nodes. */
static json_t *moving_channels(const mote_gltf *gltf, const json_t *channels)
{
    json_t *moving = json_array();
    for (size_t c = 0; c < json_array_size(channels); ++c) {
        json_t *channel = json_array_get(channels, c);
        if (mote_gltf_moves(gltf, channel))
            (void)append(moving, json_incref(channel));
    }
    return moving;
}

static void set_animations(const mote_gltf *gltf, json_t *root)
{
    json_t *animations = own_list(root, "animations");
    for (size_t a = 0; a < json_array_size(animations); ++a) {
        json_t *animation = own_entry(animations, a);
        set(animation, "channels",
            moving_channels(gltf, json_object_get(animation, "channels")));
    }
}

char *mote_gltf_text(mote_gltf *gltf, bool moves)
{
    json_t *root = json_copy(gltf->root);
    set_buffers(gltf, root);
    set_nodes(root, moves);
    if (moves) {
        set_skins(gltf, root);
        set_animations(gltf, root);
    } else {
        (void)json_object_del(root, "skins");
        (void)json_object_del(root, "animations");
    }
    char *text = json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(root);
    if (!text)
        mote_out_of_memory(0);
    return text;
}
