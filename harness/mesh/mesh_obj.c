/* Wavefront OBJ, read in double precision: assimp would round the coordinates to 32 bits. */
#include "harness/mesh/mesh_text.h"

#include <stdlib.h>
#include <string.h>

/* Reads "7", "7/1", "7//2" or "-1/..." as a vertex number from 0. */
static mote_status read_corner(mote_mesh_reader *reader, const char **at, uint32_t *vertex)
{
    const size_t count = reader->soup->vertex_count;
    char *end;
    const long long number = strtoll(*at, &end, 10);
    if (end == *at || (!mote_mesh_word_ends(reader, end) && *end != '/'))
        return mote_fail(MOTE_EINVAL,
                         "%s:%zu: a face corner that is not a vertex number; "
                         "write f 1 2 3",
                         reader->path, reader->line);
    if (count == 0)
        return mote_fail(MOTE_EINVAL,
                         "%s:%zu: a face before any vertex; give the lines of v first",
                         reader->path, reader->line);
    const long long index = number < 0 ? (long long)count + number : number - 1;
    if (number == 0 || index < 0 || index >= (long long)count)
        return mote_fail(MOTE_EINVAL,
                         "%s:%zu: face with vertex %lld, but %zu vertices came "
                         "before; use 1 to %zu",
                         reader->path, reader->line, number, count, count);
    while (!mote_mesh_word_ends(reader, end))
        ++end;
    *vertex = (uint32_t)index;
    *at = mote_mesh_next_word(reader, end);
    return MOTE_OK;
}

static mote_status read_face(mote_mesh_reader *reader, const char *at)
{
    mote_status status = MOTE_OK;
    at = mote_mesh_next_word(reader, at);
    while (!mote_is_end(*at) && status == MOTE_OK) {
        uint32_t corner = 0;
        status = read_corner(reader, &at, &corner);
        if (status == MOTE_OK)
            mote_mesh_add_corner(reader, corner);
    }
    return status == MOTE_OK ? mote_mesh_end_face(reader) : status;
}

/* The line after this one and the lines joined to it; *line counts them. A comment ends with
   its line, even after a backslash. */
static const char *next_line(const mote_mesh_reader *reader, const char *at, size_t *line)
{
    for (bool in_comment = false; *at && *at != '\n'; ++at) {
        in_comment = in_comment || *at == '#';
        const size_t length = in_comment ? 0 : mote_continuation(reader, at);
        if (length == 0)
            continue;
        at += length - 1;
        ++*line;
    }
    ++*line;
    return at + (*at == '\n');
}

static mote_status read_lines(mote_mesh_reader *reader, const char *at)
{
    mote_status status = MOTE_OK;
    for (size_t line = 1; *at && status == MOTE_OK; at = next_line(reader, at, &line)) {
        reader->line = line;
        const char *word = mote_mesh_next_word(reader, at);
        if (word[0] == 'v' && mote_mesh_word_ends(reader, word + 1))
            status = mote_mesh_read_vertex(reader, word + 1, "write v x y z");
        else if (word[0] == 'f' && mote_mesh_word_ends(reader, word + 1))
            status = read_face(reader, word + 1);
    }
    if (status == MOTE_OK && reader->soup->triangle_count == 0)
        status = mote_fail(MOTE_EINVAL, "%s:%zu: no face in it; give triangles", reader->path,
                           reader->line);
    return status;
}

mote_status mote_soup_read_obj(const char *path, const char *text, mote_soup *soup)
{
    mote_mesh_reader reader = {.path = path, .soup = soup, .continues = true};
    const mote_status status = read_lines(&reader, mote_skip_mark(text));
    mote_mesh_reader_free(&reader);
    return status;
}
