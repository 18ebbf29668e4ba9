/* Wavefront OBJ, read in double precision: assimp would round the coordinates to 32 bits. */
#include "harness/mesh_soup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct obj_reader {
    const char *path;
    size_t line;
    mote_soup *soup;
} obj_reader;

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static bool is_end(char c)
{
    return c == '\0' || c == '\n' || c == '\r' || c == '#';
}

static const char *skip_blanks(const char *at)
{
    while (is_blank(*at))
        ++at;
    return at;
}

static mote_status read_vertex(obj_reader *reader, const char *at)
{
    double xyz[3];
    for (int i = 0; i < 3; ++i) {
        at = skip_blanks(at);
        char *end;
        /* strtod would go on to the next line for a number. */
        xyz[i] = is_end(*at) ? (double)NAN : strtod(at, &end);
        if (is_end(*at) || end == at || (!is_blank(*end) && !is_end(*end)))
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: a vertex without three numbers; write v x y z",
                             reader->path, reader->line);
        if (!isfinite(xyz[i]))
            return mote_fail(
                MOTE_EINVAL,
                "%s:%zu: a coordinate is not a finite double; give a smaller number",
                reader->path, reader->line);
        at = end;
    }
    return mote_soup_add_vertex(reader->soup, xyz[0], xyz[1], xyz[2]);
}

/* Reads "7", "7/1", "7//2" or "-1/..." as a vertex from 0. */
static mote_status read_corner(const obj_reader *reader, const char **at, uint32_t *vertex)
{
    const size_t count = reader->soup->vertex_count;
    char *end;
    const long long number = strtoll(*at, &end, 10);
    if (end == *at || (!is_blank(*end) && !is_end(*end) && *end != '/'))
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
    while (!is_blank(*end) && !is_end(*end))
        ++end;
    *vertex = (uint32_t)index;
    *at = skip_blanks(end);
    return MOTE_OK;
}

static mote_status read_face(obj_reader *reader, const char *at)
{
    uint32_t first = 0, before = 0, corner = 0;
    size_t corners = 0;
    mote_status status = MOTE_OK;
    at = skip_blanks(at);
    while (!is_end(*at) && status == MOTE_OK) {
        status = read_corner(reader, &at, &corner);
        if (status != MOTE_OK)
            break;
        if (corners == 0)
            first = corner;
        if (corners >= 2) {
            if (first == before || before == corner || corner == first)
                return mote_fail(MOTE_EINVAL,
                                 "%s:%zu: a face with a vertex twice; give "
                                 "different ones",
                                 reader->path, reader->line);
            status = mote_soup_add_triangle(reader->soup, first, before, corner);
        }
        before = corner;
        ++corners;
    }
    if (status == MOTE_OK && corners < 3)
        status = mote_fail(MOTE_EINVAL, "%s:%zu: a face of %zu vertices; give at least 3",
                           reader->path, reader->line, corners);
    return status;
}

mote_status mote_soup_read_obj(const char *path, const char *text, mote_soup *soup)
{
    obj_reader reader = {path, 0, soup};
    const char *at = text;
    if (strncmp(at, "\xef\xbb\xbf", 3) == 0) /* a byte-order mark */
        at += 3;
    mote_status status = MOTE_OK;
    while (*at && status == MOTE_OK) {
        ++reader.line;
        const char *word = skip_blanks(at);
        if (word[0] == 'v' && is_blank(word[1]))
            status = read_vertex(&reader, word + 1);
        else if (word[0] == 'f' && is_blank(word[1]))
            status = read_face(&reader, word + 1);
        at += strcspn(at, "\n");
        at += *at == '\n';
    }
    if (status == MOTE_OK && soup->triangle_count == 0)
        status =
            mote_fail(MOTE_EINVAL, "%s:%zu: no face in it; give triangles", path, reader.line);
    return status;
}
