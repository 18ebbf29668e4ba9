/* Wavefront OBJ, read in double precision: assimp would round the coordinates to 32 bits. */
#include "harness/scene/mesh_text.h"

#include <stdlib.h>
#include <string.h>

/* Reads "7", "7/1", "7//2" or "-1/..." as a vertex from 0. */
static mote_status read_corner(const mote_mesh_reader *reader, const char **at,
                               uint32_t *vertex)
{
    const size_t count = reader->soup->vertex_count;
    char *end;
    const long long number = strtoll(*at, &end, 10);
    if (end == *at || (!mote_is_blank(*end) && !mote_is_end(*end) && *end != '/'))
        return mote_fail(MOTE_EINVAL,
                         "%s:%zu: a face of something else than vertex numbers; "
                         "write f 1 2 3",
                         reader->path, reader->line);
    const long long index = number < 0 ? (long long)count + number : number - 1;
    if (number == 0 || index < 0 || index >= (long long)count)
        return mote_fail(MOTE_EINVAL,
                         "%s:%zu: face with vertex %lld, but %zu vertices came "
                         "before; use 1 to %zu",
                         reader->path, reader->line, number, count, count);
    while (!mote_is_blank(*end) && !mote_is_end(*end))
        ++end;
    *vertex = (uint32_t)index;
    *at = mote_skip_blanks(end);
    return MOTE_OK;
}

static mote_status read_face(mote_mesh_reader *reader, const char *at)
{
    mote_polygon polygon = {0};
    mote_status status = MOTE_OK;
    at = mote_skip_blanks(at);
    while (!mote_is_end(*at) && status == MOTE_OK) {
        uint32_t corner = 0;
        status = read_corner(reader, &at, &corner);
        if (status == MOTE_OK)
            status = mote_polygon_add(reader, &polygon, corner);
    }
    return status == MOTE_OK ? mote_polygon_end(reader, &polygon) : status;
}

mote_status mote_soup_read_obj(const char *path, const char *text, mote_soup *soup)
{
    mote_mesh_reader reader = {path, 0, soup};
    const char *at = mote_skip_mark(text);
    mote_status status = MOTE_OK;
    while (*at && status == MOTE_OK) {
        ++reader.line;
        const char *word = mote_skip_blanks(at);
        if (word[0] == 'v' && mote_is_blank(word[1]))
            status = mote_mesh_read_vertex(&reader, word + 1, "write v x y z");
        else if (word[0] == 'f' && mote_is_blank(word[1]))
            status = read_face(&reader, word + 1);
        at += strcspn(at, "\n");
        at += *at == '\n';
    }
    if (status == MOTE_OK && soup->triangle_count == 0)
        status =
            mote_fail(MOTE_EINVAL, "%s:%zu: no face in it; give triangles", path, reader.line);
    return status;
}
