/* What the readers of mesh files as text share: lines, blanks, comments, vertices. */
#ifndef MOTE_HARNESS_MESH_TEXT_H
#define MOTE_HARNESS_MESH_TEXT_H

#include "harness/scene/mesh_soup.h"

typedef struct mote_mesh_reader {
    const char *path; /* for messages */
    size_t line;      /* from 1 */
    mote_soup *soup;
} mote_mesh_reader;

static inline bool mote_is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* The end of a line, or a comment. */
static inline bool mote_is_end(char c)
{
    return c == '\0' || c == '\n' || c == '\r' || c == '#';
}

static inline const char *mote_skip_blanks(const char *at)
{
    while (mote_is_blank(*at))
        ++at;
    return at;
}

/* The text after a byte-order mark, if there is one. */
const char *mote_skip_mark(const char *text);

/* Reads three finite numbers, whatever follows them, and adds them as a vertex. MOTE_EINVAL
   with file and line; `right` says what would be right ("write v x y z"). */
mote_status mote_mesh_read_vertex(mote_mesh_reader *reader, const char *at, const char *right);

/* A polygon, corner by corner, as a fan of triangles. */
typedef struct mote_polygon {
    uint32_t first, before;
    size_t corners;
} mote_polygon;

/* Adds a corner to a zero-initialised polygon. MOTE_EINVAL with file and line for a triangle of
   the fan that has a vertex twice. */
mote_status mote_polygon_add(mote_mesh_reader *reader, mote_polygon *polygon, uint32_t corner);

/* MOTE_EINVAL with file and line unless there were three corners. */
mote_status mote_polygon_end(const mote_mesh_reader *reader, const mote_polygon *polygon);

#endif
