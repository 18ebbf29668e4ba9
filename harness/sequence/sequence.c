#include "harness/sequence/sequence.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/sequence/point_cache.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define DIGITS_MAX 15
#define FAR 1e9 /* of L */

bool mote_sequence_is_cache(const char *path)
{
    return mote_name_ends(path, ".pc2") || mote_name_ends(path, ".mdd");
}

/* Finds the number in a file's name. */
static mote_status find_number(mote_sequence *s)
{
    const char *slash = strrchr(s->path, '/');
    const char *name = slash ? slash + 1 : s->path;
    const char *dot = strrchr(name, '.');
    const char *end = dot ? dot : name + strlen(name);
    while (end > name && !(end[-1] >= '0' && end[-1] <= '9'))
        --end;
    const char *begin = end;
    while (begin > name && begin[-1] >= '0' && begin[-1] <= '9')
        --begin;
    if (begin == end || end - begin > DIGITS_MAX)
        return mote_fail(MOTE_EINVAL,
                         "%s: no number of at most %d digits in the name; name the first of "
                         "numbered files, such as frames/0001.obj, or a .pc2 or .mdd file",
                         s->path, DIGITS_MAX);
    s->digits_at = (size_t)(begin - s->path);
    s->digits = (int)(end - begin);
    s->first = strtoull(begin, NULL, 10);
    return MOTE_OK;
}

char *mote_sequence_path(const mote_sequence *s, uint32_t frame)
{
    if (s->kind == MOTE_SEQUENCE_CACHE)
        return mote_duplicate(s->path);
    return mote_format("%.*s%0*" PRIu64 "%s", (int)s->digits_at, s->path, s->digits,
                       s->first + frame - 1, s->path + s->digits_at + s->digits);
}

static mote_status check_files(const mote_sequence *s)
{
    struct stat info;
    for (uint32_t k = 1; k <= s->frames; ++k) {
        char *path = mote_sequence_path(s, k);
        mote_status status = MOTE_OK;
        if (stat(path, &info) != 0)
            status = mote_fail(MOTE_EIO, "%s: %s; it is frame %u of %u that the scenario shows",
                               path, strerror(errno), k, s->frames);
        else if (!S_ISREG(info.st_mode))
            status = mote_fail(MOTE_EINVAL, "%s: not a regular file; it is frame %u", path, k);
        free(path);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

static void note_mesh(mote_sequence *s, const mote_mesh *mesh)
{
    const mote_vec3 low = mesh->low, high = mesh->high;
    s->vertex_count = mesh->vertex_count;
    s->limit =
        FAR * mesh->diagonal + fmax(fmax(fmax(fabs(low.x), fabs(low.y)), fabs(low.z)),
                                    fmax(fmax(fabs(high.x), fabs(high.y)), fabs(high.z)));
}

/* Takes over everything that was read except the mesh. */
static void keep_numbers(mote_sequence *s, mote_numbered_mesh *read)
{
    s->file_vertex = read->file_vertex;
    s->file_vertices = read->file_vertices;
    s->topology = read->topology;
    note_mesh(s, read->mesh);
}

static mote_sequence *begin(const char *path, mote_sequence_kind kind, uint32_t frames)
{
    mote_sequence *made = mote_allocate(1, sizeof *made);
    made->kind = kind;
    made->path = mote_duplicate(path);
    made->frames = frames;
    made->scale = mote_vec3_make(1, 1, 1);
    return made;
}

mote_status mote_sequence_open_files(const char *path, uint32_t frames,
                                     mote_sequence **sequence, mote_mesh **mesh,
                                     mote_import *import)
{
    mote_sequence *made = begin(path, MOTE_SEQUENCE_FILES, frames);
    mote_numbered_mesh first = {0};
    mote_status status = find_number(made);
    if (status == MOTE_OK)
        status = check_files(made);
    if (status == MOTE_OK)
        status = mote_numbered_mesh_read(path, &first);
    if (status != MOTE_OK) {
        mote_sequence_destroy(made);
        return status;
    }
    keep_numbers(made, &first);
    *mesh = first.mesh;
    *import = first.import;
    *sequence = made;
    return MOTE_OK;
}

/* Reads the cache's header and compares it with the mesh. */
static mote_status open_header(mote_sequence *s, uint32_t frames)
{
    mote_point_cache cache;
    mote_status status = mote_point_cache_open(s->path, &cache);
    if (status != MOTE_OK)
        return status;
    s->start = cache.start;
    s->big_endian = cache.big_endian;
    s->frames = cache.frames;
    if (cache.points != s->file_vertices)
        return mote_fail(MOTE_EINVAL,
                         "%s: %u vertices, and the mesh has %u; give the mesh that the cache "
                         "was made of",
                         s->path, cache.points, s->file_vertices);
    if (cache.frames < frames)
        return mote_fail(MOTE_EINVAL,
                         "%s: %u frames, and the scenario shows %u; give more, or show fewer",
                         s->path, cache.frames, frames);
    return MOTE_OK;
}

mote_status mote_sequence_open_cache(const char *path, const char *mesh_path, uint32_t frames,
                                     mote_sequence **sequence, mote_mesh **mesh,
                                     mote_import *import)
{
    mote_sequence *made = begin(path, MOTE_SEQUENCE_CACHE, frames);
    mote_numbered_mesh beside = {0};
    mote_status status = MOTE_OK;
    if (mesh_path) {
        status = mote_numbered_mesh_read(mesh_path, &beside);
        if (status == MOTE_OK)
            keep_numbers(made, &beside);
    } else {
        made->file_vertices = (*mesh)->vertex_count;
        note_mesh(made, *mesh);
    }
    if (status == MOTE_OK)
        status = open_header(made, frames);
    if (status != MOTE_OK) {
        mote_mesh_destroy(beside.mesh);
        mote_sequence_destroy(made);
        return status;
    }
    if (mesh_path) {
        *mesh = beside.mesh;
        *import = beside.import;
    }
    *sequence = made;
    return MOTE_OK;
}

void mote_sequence_destroy(mote_sequence *sequence)
{
    if (!sequence)
        return;
    free(sequence->path);
    free(sequence->file_vertex);
    free(sequence);
}
