/* The numbers in the buffers of a glTF file (glTF 2.0, section 3.6). */
#include "harness/gltf/gltf_file.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/gltf/gltf_uri.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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

static const char *uri_of(const mote_gltf *gltf, size_t buffer)
{
    const json_t *entry = mote_gltf_entry(gltf, "buffers", (int64_t)buffer);
    return json_string_value(json_object_get(entry, "uri"));
}

/* The data of a URI that has them, base 64 or as they are, or NULL. */
static const char *data_of(const char *uri)
{
    return uri && strncmp(uri, "data:", 5) == 0 ? strchr(uri, ',') : NULL;
}

uint64_t mote_gltf_bytes_beside(const mote_gltf *gltf)
{
    uint64_t bytes = 0;
    for (size_t b = 0; b < gltf->buffer_count; ++b) {
        const char *uri = uri_of(gltf, b);
        char *path = NULL;
        struct stat info;
        if (uri && !data_of(uri) && mote_gltf_path(gltf->path, uri, &path) == MOTE_OK &&
            stat(path, &info) == 0 && S_ISREG(info.st_mode))
            bytes += (uint64_t)info.st_size;
        free(path);
    }
    return bytes;
}

static mote_status load_uri(const mote_gltf *gltf, const char *uri, mote_gltf_bytes *to)
{
    static const char base64[] = ";base64";
    const char *data = data_of(uri);
    char *path = NULL;
    if (data) {
        const size_t mark = strlen(base64);
        const bool coded = (size_t)(data - uri) >= mark && !strncmp(data - mark, base64, mark);
        to->size = strlen(data + 1);
        to->own = coded ? decode(data + 1, &to->size) : mote_duplicate(data + 1);
        return MOTE_OK;
    }
    mote_status status = mote_gltf_path(gltf->path, uri, &path);
    if (status != MOTE_OK)
        return status;
    status = mote_file_read(path, MOTE_GLTF_BYTES, &to->own, &to->size);
    free(path);
    return status == MOTE_OK
               ? status
               : mote_fail(status, "%s: buffer %s", gltf->path, mote_error_text());
}

mote_status mote_gltf_load(mote_gltf *gltf, size_t buffer, mote_gltf_bytes *bytes)
{
    const char *uri = uri_of(gltf, buffer);
    const json_t *entry = mote_gltf_entry(gltf, "buffers", (int64_t)buffer);
    const int64_t length = mote_gltf_whole(entry, "byteLength");
    mote_gltf_bytes made = {0};
    mote_status status = MOTE_OK;
    if (buffer < gltf->buffer_count && gltf->buffers[buffer].data) {
        *bytes = gltf->buffers[buffer];
        return MOTE_OK;
    }
    if (entry && !uri && gltf->bin && buffer == 0)
        made = (mote_gltf_bytes){.data = gltf->bin, .size = gltf->bin_size};
    else if (uri)
        status = load_uri(gltf, uri, &made);
    else
        status = mote_fail(MOTE_EINVAL, "%s: buffers[%zu] has no bytes; give it a uri",
                           gltf->path, buffer);
    if (status == MOTE_OK && length > 0 && (uint64_t)length > made.size)
        status = mote_fail(MOTE_EINVAL,
                           "%s: buffers[%zu] has %zu bytes, and byteLength says %lld; give all "
                           "of them",
                           gltf->path, buffer, made.size, (long long)length);
    if (status != MOTE_OK) {
        free(made.own);
        return status;
    }
    made.data = made.own ? made.own : made.data;
    *bytes = gltf->buffers[buffer] = made;
    return MOTE_OK;
}

/* Where the elements of an accessor are in its buffer. */
typedef struct elements {
    uint64_t count, begin, step, size;
    int64_t component;
} elements;

static double number_at(const char *at, int64_t component)
{
    float real;
    if (component == MOTE_GLTF_FLOATS) {
        memcpy(&real, at, sizeof real);
        return (double)real;
    }
    const unsigned low = (unsigned char)at[0];
    return component == 5121 ? low : low | (unsigned)(unsigned char)at[1] << 8;
}

static mote_status wrong(const mote_gltf *gltf, const char *what, bool floats, const char *how)
{
    return mote_fail(MOTE_EINVAL, "%s: %s %s; give %s in a buffer of the file", gltf->path,
                     what, how, floats ? "floats" : "whole numbers of 8 or 16 bits");
}

static size_t component_size(int64_t component)
{
    return component == MOTE_GLTF_FLOATS ? 4 : component == 5123 ? 2 : component == 5121;
}

/* Finds the elements and loads their buffer. */
static mote_status find_elements(mote_gltf *gltf, const char *what, const json_t *accessor,
                                 size_t width, bool floats, elements *found,
                                 mote_gltf_bytes *bytes)
{
    const json_t *view =
        mote_gltf_entry(gltf, "bufferViews", mote_gltf_whole(accessor, "bufferView"));
    const int64_t count = mote_gltf_whole(accessor, "count");
    const int64_t component = mote_gltf_whole(accessor, "componentType");
    const int64_t stride = mote_gltf_whole_or_0(view, "byteStride");
    const int64_t offset[2] = {mote_gltf_whole_or_0(accessor, "byteOffset"),
                               mote_gltf_whole_or_0(view, "byteOffset")};
    const int64_t buffer = mote_gltf_whole(view, "buffer");
    const uint64_t size = width * component_size(component);
    if (json_object_get(accessor, "sparse"))
        return wrong(gltf, what, floats, "that are sparse");
    if (!view || count < 1 || size == 0 || (component == MOTE_GLTF_FLOATS) != floats)
        return wrong(gltf, what, floats,
                     floats ? "that are no floats" : "that are no whole numbers");
    if (stride < 0 || offset[0] < 0 || offset[1] < 0)
        return wrong(gltf, what, floats,
                     "whose byteOffset or byteStride is not a whole number");
    if (buffer < 0)
        return wrong(gltf, what, floats, "in no buffer");
    *found = (elements){.count = (uint64_t)count,
                        .begin = (uint64_t)offset[0] + (uint64_t)offset[1],
                        .step = stride > 0 ? (uint64_t)stride : size,
                        .size = size,
                        .component = component};
    return mote_gltf_load(gltf, (size_t)buffer, bytes);
}

mote_status mote_gltf_read(mote_gltf *gltf, const char *what, int64_t accessor, size_t width,
                           bool floats, mote_gltf_numbers *out)
{
    elements e = {0};
    mote_gltf_bytes bytes = {0};
    const mote_status status = find_elements(
        gltf, what, mote_gltf_entry(gltf, "accessors", accessor), width, floats, &e, &bytes);
    if (status != MOTE_OK)
        return status;
    if (e.step > 4096 || e.begin > bytes.size || e.size > bytes.size - e.begin ||
        e.count - 1 > (bytes.size - e.begin - e.size) / e.step)
        return wrong(gltf, what, floats, "beyond the end of their buffer");
    out->count = (size_t)e.count;
    out->values = mote_allocate(out->count * width, sizeof *out->values);
    for (size_t i = 0; i < out->count * width; ++i)
        out->values[i] =
            number_at(bytes.data + e.begin + i / width * e.step + i % width * (e.size / width),
                      e.component);
    return MOTE_OK;
}
