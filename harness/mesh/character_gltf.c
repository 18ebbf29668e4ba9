/* The parts of a glTF file's animations that assimp leaves out: step interpolation, and the
   tangents of cubic keys (glTF 2.0, section 3.11). */
#include "harness/mesh/character_parts.h"
#include "harness/gltf/gltf_file.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/mesh/uri.h"

#include <stdlib.h>
#include <string.h>

typedef struct gltf {
    const char *path;
    mote_gltf file;
    int64_t buffer; /* the loaded one; -1: none */
    char *bytes;
    size_t size;
    mote_rig *rig;
} gltf;

/* The numbers of an accessor. */
typedef struct numbers {
    double *values;
    size_t count; /* of elements */
} numbers;

static mote_status wrong(const gltf *g, const char *what)
{
    return mote_fail(MOTE_EINVAL,
                     "%s: cubic keys %s; give floats in a buffer of the file, or "
                     "linear keys",
                     g->path, what);
}

/* mote_gltf_whole of a member that may be left out: then 0. */
static int64_t whole_or_none(const json_t *object, const char *key)
{
    return json_object_get(object, key) ? mote_gltf_whole(object, key) : 0;
}

static int digit(char c)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = c ? strchr(digits, c) : NULL;
    return at ? (int)(at - digits) : -1;
}

/* Decodes base 64 up to the end or the first character that is not base 64. */
static char *decode(const char *text, size_t *size)
{
    char *bytes = mote_allocate(strlen(text) / 4 * 3 + 3, 1);
    uint32_t bits = 0;
    int held = 0;
    *size = 0;
    for (; digit(*text) >= 0; ++text) {
        bits = (bits << 6 | (uint32_t)digit(*text)) & 0xffffff;
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes[(*size)++] = (char)(bits >> held & 0xff);
        }
    }
    return bytes;
}

static bool leaves_folder(const char *uri)
{
    char *decoded = mote_uri_decode(uri);
    const bool leaves = decoded[0] == '/' || strstr(decoded, "..");
    free(decoded);
    return leaves;
}

static mote_status load_buffer(gltf *g, int64_t index)
{
    static const char base64[] = ";base64,";
    const json_t *buffer = mote_gltf_entry(&g->file, "buffers", index);
    const char *uri = json_string_value(json_object_get(buffer, "uri"));
    mote_status status = MOTE_OK;
    if (g->buffer == index)
        return MOTE_OK;
    free(g->bytes);
    g->bytes = NULL;
    g->buffer = -1;
    if (!uri && g->file.bin && index == 0) {
        g->bytes = mote_copy(g->file.bin, g->file.bin_size);
        g->size = g->file.bin_size;
    } else if (uri && strncmp(uri, "data:", 5) == 0 && strstr(uri, base64)) {
        g->bytes = decode(strstr(uri, base64) + strlen(base64), &g->size);
    } else if (uri && leaves_folder(uri)) {
        status = wrong(g, "in a file of another folder");
    } else if (uri) {
        char *file = mote_uri_path(g->path, uri);
        status = mote_file_read(file, MOTE_GLTF_BYTES, &g->bytes, &g->size);
        free(file);
    } else {
        status = wrong(g, "in no buffer");
    }
    g->buffer = status == MOTE_OK ? index : -1;
    return status;
}

/* Reads an accessor with `width` floats per element. */
static mote_status read_accessor(gltf *g, int64_t index, size_t width, numbers *out)
{
    const json_t *accessor = mote_gltf_entry(&g->file, "accessors", index);
    const json_t *view =
        mote_gltf_entry(&g->file, "bufferViews", mote_gltf_whole(accessor, "bufferView"));
    const int64_t count = mote_gltf_whole(accessor, "count");
    const int64_t stride = whole_or_none(view, "byteStride");
    const int64_t offset[2] = {whole_or_none(accessor, "byteOffset"),
                               whole_or_none(view, "byteOffset")};
    const uint64_t size = width * sizeof(float);
    const uint64_t step = stride > 0 ? (uint64_t)stride : size;
    const uint64_t begin = (uint64_t)offset[0] + (uint64_t)offset[1];
    if (!view || count < 1 || mote_gltf_whole(accessor, "componentType") != MOTE_GLTF_FLOATS ||
        json_object_get(accessor, "sparse"))
        return wrong(g, "that are no floats");
    if (stride < 0 || offset[0] < 0 || offset[1] < 0)
        return wrong(g, "whose byteOffset or byteStride is not a whole number");
    const mote_status status = load_buffer(g, mote_gltf_whole(view, "buffer"));
    if (status != MOTE_OK)
        return status;
    if (step > 4096 || begin > g->size || size > g->size - begin ||
        ((uint64_t)count - 1) > (g->size - begin - size) / step)
        return wrong(g, "beyond the end of their buffer");
    out->count = (size_t)count;
    out->values = mote_allocate(out->count * width, sizeof *out->values);
    for (size_t i = 0; i < out->count * width; ++i) {
        float value;
        memcpy(&value, g->bytes + begin + i / width * step + i % width * sizeof value,
               sizeof value);
        out->values[i] = (double)value;
    }
    return MOTE_OK;
}

/* Makes a track cubic. keys[3 k + j] is the arriving tangent, the value or the leaving tangent
   (j) of key k; each is `width` numbers from position `first` of an element of `stride`
   numbers. */
static void set_cubic(gltf *g, mote_rig_track *track, const numbers *times, const double *keys,
                      size_t first, size_t stride, size_t width)
{
    mote_rig *rig = g->rig;
    const size_t rows = 3 * times->count;
    *track = (mote_rig_track){MOTE_TRACK_CUBIC, (uint32_t)times->count,
                              (uint32_t)rig->times_count, (uint32_t)rig->values_count};
    MOTE_RIG_GROW(rig, times, times->count);
    MOTE_RIG_GROW(rig, values, rows * width);
    for (size_t k = 0; k < times->count; ++k)
        rig->times[track->time + k] = times->values[k];
    for (size_t r = 0; r < rows; ++r) {
        for (size_t c = 0; c < width; ++c) /* w first */
            rig->values[track->value + r * width + c] =
                keys[r * stride + first + (width == 4 ? (c + 3) % 4 : c)];
    }
}

/* The tracks of a channel: one, or one for each morph target of a node. */
typedef struct tracks {
    mote_rig_track **list;
    size_t count, width;
} tracks;

static uint32_t find_node(const gltf *g, int64_t index)
{
    const char *name =
        json_string_value(json_object_get(mote_gltf_entry(&g->file, "nodes", index), "name"));
    char *own =
        name && *name ? mote_duplicate(name) : mote_format("nodes[%lld]", (long long)index);
    uint32_t found = MOTE_RIG_NONE;
    for (uint32_t n = 0; n < g->rig->nodes_count && found == MOTE_RIG_NONE; ++n) {
        if (strcmp(g->rig->names + g->rig->nodes[n].name, own) == 0)
            found = n;
    }
    free(own);
    return found;
}

static void find_tracks(gltf *g, const mote_rig_clip *clip, uint32_t node, const char *path,
                        tracks *found)
{
    const size_t most = (size_t)clip->morph_count + 1;
    *found = (tracks){mote_allocate(most, sizeof(mote_rig_track *)), 0, 1};
    for (uint32_t m = 0; strcmp(path, "weights") == 0 && m < clip->morph_count; ++m) {
        mote_rig_morph *morph = &g->rig->morphs[clip->morph + m];
        if (g->rig->targets[morph->target].node == node)
            found->list[found->count++] = &morph->weight;
    }
    for (uint32_t c = 0; c < clip->channel_count; ++c) {
        mote_rig_channel *channel = &g->rig->channels[clip->channel + c];
        mote_rig_track *track = strcmp(path, "translation") == 0 ? &channel->position
                                : strcmp(path, "rotation") == 0  ? &channel->rotation
                                : strcmp(path, "scale") == 0     ? &channel->scale
                                                                 : NULL;
        if (channel->node != node || !track || found->count > 0)
            continue;
        found->list[found->count++] = track;
        found->width = track == &channel->rotation ? 4 : 3;
    }
}

/* The targets of a primitive are in order; further primitives of a node repeat them. */
static mote_status set_cubics(gltf *g, const json_t *sampler, const tracks *found,
                              const char *path)
{
    numbers times = {0}, keys = {0};
    const bool is_morph = strcmp(path, "weights") == 0;
    mote_status status = read_accessor(g, mote_gltf_whole(sampler, "input"), 1, &times);
    if (status == MOTE_OK)
        status = read_accessor(g, mote_gltf_whole(sampler, "output"), found->width, &keys);
    const size_t stride = times.count > 0 ? keys.count / (3 * times.count) : 0;
    if (status == MOTE_OK &&
        (stride == 0 || stride * 3 * times.count != keys.count || (!is_morph && stride != 1)))
        status = wrong(g, "that are not three for each time");
    for (size_t t = 0; stride > 0 && t < found->count && status == MOTE_OK; ++t)
        set_cubic(g, found->list[t], &times, keys.values, is_morph ? t % stride : 0,
                  is_morph ? stride : found->width, found->width);
    free(times.values);
    free(keys.values);
    return status;
}

static mote_status set_channel(gltf *g, const json_t *animation, const json_t *channel,
                               const mote_rig_clip *clip)
{
    const json_t *target = json_object_get(channel, "target");
    const char *path = json_string_value(json_object_get(target, "path"));
    const int64_t index = mote_gltf_whole(channel, "sampler");
    const json_t *sampler =
        index < 0 ? NULL
                  : json_array_get(json_object_get(animation, "samplers"), (size_t)index);
    const char *mode = json_string_value(json_object_get(sampler, "interpolation"));
    if (!path || !mode || strcmp(mode, "LINEAR") == 0)
        return MOTE_OK;
    const uint32_t node = find_node(g, mote_gltf_whole(target, "node"));
    if (node == MOTE_RIG_NONE)
        return MOTE_OK; /* moves nothing that assimp read */
    tracks found;
    mote_status status = MOTE_OK;
    find_tracks(g, clip, node, path, &found);
    for (size_t t = 0; t < found.count && strcmp(mode, "STEP") == 0; ++t)
        found.list[t]->mode = MOTE_TRACK_STEP;
    if (found.count > 0 && strcmp(mode, "CUBICSPLINE") == 0)
        status = set_cubics(g, sampler, &found, path);
    free(found.list);
    return status;
}

static mote_status set_clips(gltf *g)
{
    const json_t *animations = json_object_get(g->file.root, "animations");
    const size_t count = json_array_size(animations);
    mote_status status = MOTE_OK;
    if (count != g->rig->clips_count)
        return mote_fail(MOTE_EINVAL,
                         "%s: %zu animations, of which assimp reads %zu; give each "
                         "a channel that moves something",
                         g->path, count, g->rig->clips_count);
    for (size_t k = 0; k < count && status == MOTE_OK; ++k) {
        const json_t *animation = json_array_get(animations, k);
        const json_t *channels = json_object_get(animation, "channels");
        for (size_t c = 0; c < json_array_size(channels) && status == MOTE_OK; ++c)
            status = set_channel(g, animation, json_array_get(channels, c), &g->rig->clips[k]);
    }
    return status;
}

mote_status mote_character_set_gltf_keys(const char *path, const char *data, size_t size,
                                         mote_rig *rig)
{
    gltf g = {.path = path, .buffer = -1, .rig = rig};
    mote_status status = mote_gltf_open(path, data, size, &g.file);
    if (status != MOTE_OK)
        return status;
    status = set_clips(&g);
    mote_gltf_close(&g.file);
    free(g.bytes);
    return status;
}
