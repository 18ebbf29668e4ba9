#include "harness/mesh/mesh_import.h"

#include "harness/base/file.h"
#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/gltf/gltf_file.h"
#include "harness/mesh/import_child.h"
#include "harness/mesh/mesh_soup.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FILE_LIMIT ((size_t)4 << 30)
#define MEMORY_BYTES ((size_t)128 << 20) /* plus sixty times the bytes read */
#define SECONDS 4.0                      /* plus one for every 8 MB read */

typedef struct header {
    uint64_t vertex_count, triangle_count;
    mote_import import;
} header;

/* Reads a format whose vertices have numbers of their own: they stay apart. */
static mote_status read_text(const char *path, const char *text, size_t size, bool is_off,
                             mote_soup *soup)
{
    mote_status status = mote_soup_check_encoding(path, text, size);
    if (status == MOTE_OK)
        status = is_off ? mote_soup_read_off(path, text, size, soup)
                        : mote_soup_read_obj(path, text, soup);
    if (status != MOTE_OK)
        return status;
    mote_soup_drop_collapsed(soup);
    mote_soup_compact(soup);
    return mote_soup_refuse_collapsed(path, soup);
}

static bool is_off_file(const char *path)
{
    return mote_name_ends(path, ".off");
}

static bool is_text_file(const char *path)
{
    return is_off_file(path) || mote_name_ends(path, ".obj");
}

static bool is_ply_file(const char *path)
{
    return mote_name_ends(path, ".ply");
}

/* Reads a format whose files may have several vertices at one place: PLY, or one of assimp's.
 */
static mote_status read_to_weld(const char *path, const char *data, size_t size,
                                mote_soup *soup)
{
    mote_frame_file file = {0};
    mote_status status = MOTE_OK;
    if (is_ply_file(path)) {
        status = mote_frame_file_read_ply(path, data, size, &file, soup);
    } else {
        status = mote_soup_check_text(path, data, size);
        if (status == MOTE_OK)
            status = mote_soup_read_assimp(path, soup);
    }
    if (status != MOTE_OK)
        return status;
    mote_soup_weld(soup);
    return mote_soup_refuse_collapsed(path, soup);
}

static mote_status read_soup(const char *path, mote_soup *soup)
{
    char *data;
    size_t size;
    mote_status status = mote_file_read(path, FILE_LIMIT, &data, &size);
    if (status != MOTE_OK)
        return status;
    if (size == 0)
        status = mote_soup_refuse_empty(path);
    else if (is_text_file(path))
        status = read_text(path, data, size, is_off_file(path), soup);
    else
        status = read_to_weld(path, data, size, soup);
    free(data);
    return status;
}

/* Discards output: assimp prints its failed assertions; our own text says what is wrong. */
static void silence(void)
{
    int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0)
        return;
    (void)dup2(nowhere, STDOUT_FILENO);
    (void)dup2(nowhere, STDERR_FILENO);
    (void)close(nowhere);
}

/* Lets a crash end the child, whatever handlers the caller has. */
static void crash_for_good(void)
{
    static const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    for (size_t i = 0; i < sizeof signals / sizeof signals[0]; ++i)
        (void)signal(signals[i], SIG_DFL);
}

void mote_import_begin_child(void)
{
    silence();
    crash_for_good();
}

static mote_status import_in_child(void *context, int output)
{
    mote_import_begin_child();
    mote_soup soup = {0};
    header head;
    memset(&head, 0, sizeof head);
    mote_status status = read_soup(context, &soup);
    if (status == MOTE_OK)
        mote_soup_split(&soup, &head.import.split);
    head.vertex_count = soup.vertex_count;
    head.triangle_count = soup.triangle_count;
    head.import.single_precision = soup.single_precision;
    head.import.welded = soup.welded;
    head.import.collapsed = soup.collapsed;
    head.import.unused = soup.unused;
    if (status == MOTE_OK)
        status = mote_child_put(output, &head, sizeof head);
    if (status == MOTE_OK)
        status = mote_child_put(output, soup.xyz, 3 * soup.vertex_count * sizeof *soup.xyz);
    if (status == MOTE_OK)
        status = mote_child_put(output, soup.indices,
                                3 * soup.triangle_count * sizeof *soup.indices);
    mote_soup_free(&soup);
    return status;
}

static bool is_strict;

void mote_mesh_import_strictly(void)
{
    is_strict = true;
}

bool mote_import_is_strict(void)
{
    return is_strict;
}

mote_status mote_import_refuse_split(const char *path, const mote_import *import)
{
    if (import->split.edges == 0)
        return MOTE_OK;
    return mote_fail(
        MOTE_EINVAL,
        "%s: %zu edge%s of more than two faces (non-manifold): %s%s; give each edge "
        "one or two, or leave out --strict to have them cut apart",
        path, import->split.edges, import->split.edges == 1 ? "" : "s", import->split.where,
        import->split.edges > MOTE_SPLIT_EDGES_TOLD ? "; ..." : "");
}

#define FILES_TOLD 64

void mote_import_tell_split(const char *path, const mote_import *import)
{
    static uint64_t told[FILES_TOLD];
    static size_t count;
    const uint64_t name = mote_hash_text(path);
    if (import->split.edges == 0)
        return;
    for (size_t i = 0; i < count; ++i) {
        if (told[i] == name)
            return;
    }
    if (count < FILES_TOLD)
        told[count++] = name;
    (void)fprintf(stderr,
                  "mote: %s: note: %zu edge%s of more than two faces cut apart, the surface "
                  "being the same: %s%s\n",
                  path, import->split.edges, import->split.edges == 1 ? "" : "s",
                  import->split.where,
                  import->split.edges > MOTE_SPLIT_EDGES_TOLD ? "; ..." : "");
}

/* Makes a mesh from the child's output. The counts are checked against its size. */
static mote_status make_mesh(const char *path, const char *data, size_t size, mote_mesh **mesh,
                             mote_import *import)
{
    header head;
    if (size < sizeof head)
        return mote_fail(MOTE_EIO, "%s: reading it gave no result", path);
    memcpy(&head, data, sizeof head);
    const uint64_t vertex_bytes = 3 * sizeof(double);
    const uint64_t triangle_bytes = 3 * sizeof(uint32_t);
    if (head.vertex_count > size / vertex_bytes ||
        head.triangle_count > size / triangle_bytes ||
        size != sizeof head + head.vertex_count * vertex_bytes +
                    head.triangle_count * triangle_bytes)
        return mote_fail(MOTE_EIO, "%s: reading it ended early", path);
    head.import.split.where[MOTE_SPLIT_TEXT - 1] = '\0';
    if (is_strict && mote_import_refuse_split(path, &head.import) != MOTE_OK)
        return MOTE_EINVAL;
    data += sizeof head;
    double *xyz = mote_copy(data, head.vertex_count * vertex_bytes);
    uint32_t *indices = mote_copy(data + head.vertex_count * vertex_bytes,
                                  head.triangle_count * triangle_bytes);
    mote_status status =
        mote_mesh_create(xyz, head.vertex_count, indices, head.triangle_count, mesh);
    if (status != MOTE_OK)
        status = mote_fail(status, "%s: %s", path, mote_error_text());
    free(xyz);
    free(indices);
    if (status == MOTE_OK && import)
        *import = head.import;
    return status;
}

static mote_child_limits limits_of(size_t bytes)
{
    return (mote_child_limits){.seconds = SECONDS + (double)bytes / 8e6,
                               .memory_bytes = MEMORY_BYTES + 60 * bytes,
                               .output_bytes = MEMORY_BYTES + 60 * bytes,
                               .confined = true};
}

/* Sends the bytes of the files that a glTF file names. */
static mote_status measure_in_child(void *context, int output)
{
    char *data = NULL;
    size_t size = 0;
    mote_gltf gltf = {0};
    mote_import_begin_child();
    mote_status status = mote_file_read(context, FILE_LIMIT, &data, &size);
    if (status == MOTE_OK)
        status = mote_gltf_open(context, data, size, &gltf);
    const uint64_t bytes = mote_gltf_bytes_beside(&gltf);
    mote_gltf_close(&gltf);
    free(data);
    return status == MOTE_OK ? mote_child_put(output, &bytes, sizeof bytes) : status;
}

/* Whether a file is glTF, by its first bytes where its name does not say so. */
static bool is_gltf_file(const char *path)
{
    char start[4096]; /* blanks may come first */
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    const ssize_t size = file < 0 ? 0 : read(file, start, sizeof start);
    if (file >= 0)
        (void)close(file);
    return mote_gltf_is(path, start, size > 0 ? (size_t)size : 0);
}

/* The bytes that are read for a file of so many: with those of the files that a glTF file
   names. Nothing else is read of those here, and what is wrong is said later. */
static uint64_t bytes_read_for(const char *path, size_t bytes)
{
    char *output = NULL;
    size_t size = 0;
    uint64_t beside = 0;
    if (is_gltf_file(path) &&
        mote_child_run(path, measure_in_child, (void *)(uintptr_t)path, limits_of(bytes),
                       &output, &size) == MOTE_OK &&
        size == sizeof beside)
        memcpy(&beside, output, sizeof beside);
    free(output);
    return beside > FILE_LIMIT ? beside : bytes + beside;
}

/* Adds to the text of a failure of the child itself, and not of what it read, what to do. */
static mote_status blame_reader(const char *path, const char *reader, mote_status status,
                                const mote_child_limits *limits)
{
    const bool read_by_us = is_text_file(path) || is_ply_file(path);
    const char *right = read_by_us ? "triangles, or fewer of them" : "the mesh in OBJ";
    if (status == MOTE_ENOMEM)
        return mote_fail(status,
                         "%s: needs more memory than the %zu MB that a file of this size gets; "
                         "give %s",
                         reader, limits->memory_bytes >> 20, right);
    if (strncmp(mote_error_text(), reader, strlen(reader)) == 0)
        return mote_fail(status, "%s; give %s", mote_error_text(), right);
    return status;
}

mote_status mote_import_run_child(const char *path, mote_child_work work, char **output,
                                  size_t *size)
{
    struct stat info;
    if (stat(path, &info) != 0)
        return mote_fail(MOTE_EIO, "%s: %s; name a mesh file", path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return mote_fail(MOTE_EINVAL, "%s: not a regular file; name a mesh file", path);
    uint64_t bytes = (uint64_t)info.st_size;
    if (bytes <= FILE_LIMIT)
        bytes = bytes_read_for(path, (size_t)bytes);
    if (bytes > FILE_LIMIT)
        return mote_fail(MOTE_EINVAL, "%s: %llu bytes; at most %zu are read", path,
                         (unsigned long long)bytes, FILE_LIMIT);
    const mote_child_limits limits = limits_of((size_t)bytes);
    char *reader = mote_format("%s: the reader of this format", path);
    /* The child only reads the name. */
    mote_status status =
        mote_child_run(reader, work, (void *)(uintptr_t)path, limits, output, size);
    if (status != MOTE_OK)
        status = blame_reader(path, reader, status, &limits);
    free(reader);
    return status;
}

mote_status mote_mesh_import(const char *path, mote_mesh **mesh, mote_import *import)
{
    char *output = NULL;
    size_t size = 0;
    mote_status status = mote_import_run_child(path, import_in_child, &output, &size);
    if (status == MOTE_OK)
        status = make_mesh(path, output, size, mesh, import);
    free(output);
    return status;
}
