#include "harness/gltf/gltf_file.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_binary(const char *data, size_t size)
{
    return size >= 4 && memcmp(data, "glTF", 4) == 0;
}

bool mote_gltf_is(const char *path, const char *data, size_t size)
{
    size_t at = 0;
    while (at < size && data[at] && strchr(" \t\r\n", data[at]))
        ++at;
    return is_binary(data, size) || (at < size && data[at] == '{') ||
           mote_name_ends(path, ".gltf") || mote_name_ends(path, ".glb");
}

static uint32_t word(const char *bytes)
{
    uint32_t value = 0;
    for (int k = 3; k >= 0; --k)
        value = value << 8 | (unsigned char)bytes[k];
    return value;
}

/* Finds the JSON text of a file, and the buffer of a binary one. */
static mote_status find_text(const char *path, const char *data, size_t size, mote_gltf *gltf,
                             const char **text, size_t *length)
{
    *text = data;
    *length = size;
    gltf->is_binary = is_binary(data, size);
    if (!gltf->is_binary)
        return MOTE_OK;
    const uint32_t whole = size < 12 ? 12 : word(data + 8);
    if (size < whole)
        return mote_fail(MOTE_EINVAL,
                         "%s: ends after %zu of %u bytes; give the whole glTF file", path, size,
                         whole);
    if (size < 20 || word(data + 12) > size - 20)
        return mote_fail(MOTE_EINVAL, "%s: ends early; give the whole file", path);
    *text = data + 20;
    *length = word(data + 12);
    const size_t at = 20 + *length;
    if (size - at < 8)
        return MOTE_OK;
    if (word(data + 4) >= 2 && *length % 4 != 0)
        return mote_fail(MOTE_EINVAL,
                         "%s: its JSON has %zu bytes, which is no multiple of 4; add spaces",
                         path, *length);
    if (word(data + at) <= size - at - 8) {
        gltf->bin = data + at + 8;
        gltf->bin_size = word(data + at);
    }
    return MOTE_OK;
}

/* Writes whole numbers without a decimal point, all the way down: assimp takes 36.0 for no
   number where it expects a whole one, and uses 0. */
static json_t *without_points(json_t *value)
{
    const double real = json_real_value(value);
    if (json_is_real(value) && fabs(real) <= 0x1p53 && real == floor(real) &&
        !(real == 0 && signbit(real)))
        return json_integer((json_int_t)real);
    const char *key;
    size_t index;
    json_t *part;
    json_object_foreach(value, key, part)
    {
        (void)json_object_set_new(value, key, without_points(part));
    }
    json_array_foreach(value, index, part)
    {
        (void)json_array_set_new(value, index, without_points(part));
    }
    return json_incref(value);
}

mote_status mote_gltf_open(const char *path, const char *data, size_t size, mote_gltf *gltf)
{
    const char *text;
    size_t length;
    json_error_t error;
    *gltf = (mote_gltf){0};
    const mote_status status = find_text(path, data, size, gltf, &text, &length);
    if (status != MOTE_OK)
        return status;
    gltf->root = json_loadb(text, length, 0, &error);
    if (!gltf->root)
        return mote_fail(MOTE_EINVAL, "%s:%d: %s; write JSON", path, error.line, error.text);
    json_t *as_read = gltf->root;
    gltf->root = without_points(as_read);
    json_decref(as_read);
    gltf->path = mote_duplicate(path);
    gltf->buffer_count = json_array_size(json_object_get(gltf->root, "buffers")) + 1;
    gltf->buffers = mote_allocate(gltf->buffer_count, sizeof *gltf->buffers);
    return MOTE_OK;
}

void mote_gltf_close(mote_gltf *gltf)
{
    for (size_t b = 0; b < gltf->buffer_count; ++b)
        free(gltf->buffers[b].own);
    free(gltf->buffers);
    free(gltf->path);
    json_decref(gltf->root);
    *gltf = (mote_gltf){0};
}

bool mote_gltf_is_2(const mote_gltf *gltf)
{
    const char *version =
        json_string_value(json_object_get(json_object_get(gltf->root, "asset"), "version"));
    return version && version[0] == '2';
}

const json_t *mote_gltf_entry(const mote_gltf *gltf, const char *list, int64_t index)
{
    return index < 0 ? NULL : json_array_get(json_object_get(gltf->root, list), (size_t)index);
}

int64_t mote_gltf_whole(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    return json_is_integer(value) && json_integer_value(value) >= 0 ? json_integer_value(value)
                                                                    : -1;
}

int64_t mote_gltf_whole_or_0(const json_t *object, const char *key)
{
    return json_object_get(object, key) ? mote_gltf_whole(object, key) : 0;
}

char *mote_gltf_node_name(const mote_gltf *gltf, size_t node)
{
    const json_t *entry = mote_gltf_entry(gltf, "nodes", (int64_t)node);
    const char *name = json_string_value(json_object_get(entry, "name"));
    return name && *name ? mote_duplicate(name) : mote_format("nodes[%zu]", node);
}

bool mote_gltf_moves(const mote_gltf *gltf, const json_t *channel)
{
    static const char *const paths[] = {"translation", "rotation", "scale", "weights"};
    const json_t *target = json_object_get(channel, "target");
    const char *path = json_string_value(json_object_get(target, "path"));
    if (!mote_gltf_entry(gltf, "nodes", mote_gltf_whole(target, "node")))
        return false;
    for (size_t p = 0; path && p < sizeof paths / sizeof paths[0]; ++p) {
        if (strcmp(path, paths[p]) == 0)
            return true;
    }
    return false;
}

const json_t *mote_gltf_sampler(const json_t *animation, const json_t *channel)
{
    const int64_t index = mote_gltf_whole(channel, "sampler");
    return index < 0 ? NULL
                     : json_array_get(json_object_get(animation, "samplers"), (size_t)index);
}
