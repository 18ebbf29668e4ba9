#include "harness/scene/mesh_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *mote_skip_mark(const char *text)
{
    return strncmp(text, "\xef\xbb\xbf", 3) == 0 ? text + 3 : text;
}

mote_status mote_mesh_read_vertex(mote_mesh_reader *reader, const char *at, const char *right)
{
    double xyz[3];
    for (int i = 0; i < 3; ++i) {
        at = mote_skip_blanks(at);
        char *end;
        /* strtod would go on to the next line for a number. */
        xyz[i] = mote_is_end(*at) ? (double)NAN : strtod(at, &end);
        if (mote_is_end(*at) || end == at || (!mote_is_blank(*end) && !mote_is_end(*end)))
            return mote_fail(MOTE_EINVAL, "%s:%zu: a vertex without three numbers; %s",
                             reader->path, reader->line, right);
        if (!isfinite(xyz[i]))
            return mote_fail(
                MOTE_EINVAL,
                "%s:%zu: a coordinate is not a finite double; give a smaller number",
                reader->path, reader->line);
        at = end;
    }
    return mote_soup_add_vertex(reader->soup, xyz[0], xyz[1], xyz[2]);
}

mote_status mote_polygon_add(mote_mesh_reader *reader, mote_polygon *polygon, uint32_t corner)
{
    mote_status status = MOTE_OK;
    if (polygon->corners == 0)
        polygon->first = corner;
    if (polygon->corners >= 2) {
        if (polygon->first == polygon->before || polygon->before == corner ||
            corner == polygon->first)
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: a face with a vertex twice; give different ones",
                             reader->path, reader->line);
        status = mote_soup_add_triangle(reader->soup, polygon->first, polygon->before, corner);
    }
    polygon->before = corner;
    ++polygon->corners;
    return status;
}

mote_status mote_polygon_end(const mote_mesh_reader *reader, const mote_polygon *polygon)
{
    if (polygon->corners >= 3)
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL, "%s:%zu: a face of %zu vertices; give at least 3",
                     reader->path, reader->line, polygon->corners);
}
