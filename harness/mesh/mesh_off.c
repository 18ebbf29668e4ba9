/* OFF, read in double precision and checked line by line: assimp would round the coordinates
   to 32 bits, and use another vertex for an index out of range. */
#include "harness/mesh/mesh_text.h"

#include <stdlib.h>
#include <string.h>

typedef struct off_reader {
    mote_mesh_reader common;
    const char *at; /* unread text */
    size_t size;    /* of the text */
    size_t vertices, faces;
} off_reader;

static const char *skip_word(const char *at)
{
    while (!mote_is_blank(*at) && !mote_is_end(*at))
        ++at;
    return mote_skip_blanks(at);
}

/* The first word of the next line that is neither blank nor a comment, or NULL at the end. */
static const char *next_line(off_reader *reader)
{
    while (*reader->at) {
        const char *line = mote_skip_blanks(reader->at);
        reader->at += strcspn(reader->at, "\n");
        reader->at += *reader->at == '\n';
        ++reader->common.line;
        if (!mote_is_end(*line))
            return line;
    }
    return NULL;
}

static mote_status fail_at(const off_reader *reader, const char *what)
{
    return mote_fail(MOTE_EINVAL, "%s:%zu: %s", reader->common.path, reader->common.line, what);
}

/* Reads a whole number >= 0 of elements that fit into the file, each at least least_bytes
   long. */
static mote_status read_count(const off_reader *reader, const char **at, const char *what,
                              size_t least_bytes, size_t *count)
{
    char *end;
    const long long number = strtoll(*at, &end, 10);
    if (end == *at || (!mote_is_blank(*end) && !mote_is_end(*end)) || number < 0)
        return fail_at(reader, "no counts; write the numbers of vertices, faces and edges");
    if ((unsigned long long)number > reader->size / least_bytes)
        return mote_fail(MOTE_EINVAL,
                         "%s:%zu: declares %lld %s, which %zu bytes cannot hold; give the "
                         "number that follows",
                         reader->common.path, reader->common.line, number, what, reader->size);
    *count = (size_t)number;
    *at = mote_skip_blanks(end);
    return MOTE_OK;
}

/* Reads "OFF", and the counts of vertices, faces and edges on the same line or the next. */
static mote_status read_header(off_reader *reader)
{
    const char *at = next_line(reader);
    if (!at)
        return fail_at(reader, "an empty file; give a mesh");
    if (strncmp(at, "ST", 2) == 0)
        at += 2;
    at += *at == 'C';
    at += *at == 'N';
    if (strncmp(at, "OFF", 3) != 0 || !(mote_is_blank(at[3]) || mote_is_end(at[3])))
        return fail_at(reader, "no word OFF to begin with; give ASCII OFF in three dimensions");
    at = skip_word(at);
    if (strncmp(at, "BINARY", 6) == 0)
        return fail_at(reader, "binary; give ASCII OFF");
    if (mote_is_end(*at))
        at = next_line(reader);
    if (!at)
        return fail_at(reader, "no counts; write the numbers of vertices, faces and edges");
    /* A vertex takes at least three digits and three blanks; a face a further digit. */
    mote_status status = read_count(reader, &at, "vertices", 6, &reader->vertices);
    if (status == MOTE_OK && reader->vertices == 0)
        status = fail_at(reader, "declares no vertex; give a mesh");
    return status == MOTE_OK ? read_count(reader, &at, "faces", 7, &reader->faces) : status;
}

/* Reads "3 0 1 2": the number of corners, and vertices from 0. */
static mote_status read_face(off_reader *reader, const char *at)
{
    char *end;
    const long long corners = strtoll(at, &end, 10);
    if (end == at || corners < 0 || !(mote_is_blank(*end) || mote_is_end(*end)))
        return fail_at(reader, "a face without its number of corners; write 3 0 1 2");
    for (long long i = 0; i < corners; ++i) {
        at = mote_skip_blanks(end);
        const long long index = mote_is_end(*at) ? 0 : strtoll(at, &end, 10);
        if (mote_is_end(*at) || end == at || !(mote_is_blank(*end) || mote_is_end(*end)))
            return mote_fail(MOTE_EINVAL, "%s:%zu: a face of %lld corners with %lld; give all",
                             reader->common.path, reader->common.line, corners, i);
        if (index < 0 || index >= (long long)reader->vertices)
            return mote_fail(MOTE_EINVAL, "%s:%zu: face with vertex %lld of %zu; use 0 to %zu",
                             reader->common.path, reader->common.line, index, reader->vertices,
                             reader->vertices - 1);
        mote_mesh_add_corner(&reader->common, (uint32_t)index);
    }
    return mote_mesh_end_face(&reader->common);
}

static mote_status read_all(off_reader *reader)
{
    mote_status status = read_header(reader);
    for (size_t i = 0; status == MOTE_OK && i < reader->vertices + reader->faces; ++i) {
        const bool is_vertex = i < reader->vertices;
        const char *line = next_line(reader);
        if (!line)
            return mote_fail(
                MOTE_EINVAL, "%s:%zu: ends after %zu of %zu %s; give all, or declare fewer",
                reader->common.path, reader->common.line, is_vertex ? i : i - reader->vertices,
                is_vertex ? reader->vertices : reader->faces, is_vertex ? "vertices" : "faces");
        status = is_vertex ? mote_mesh_read_vertex(&reader->common, line, "write x y z")
                           : read_face(reader, line);
    }
    if (status == MOTE_OK && reader->common.soup->triangle_count == 0)
        status = fail_at(reader, "no face in it; give triangles");
    return status;
}

mote_status mote_soup_read_off(const char *path, const char *text, size_t size, mote_soup *soup)
{
    off_reader reader = {
        .common = {.path = path, .soup = soup}, .at = mote_skip_mark(text), .size = size};
    const mote_status status = read_all(&reader);
    mote_mesh_reader_free(&reader.common);
    return status;
}
