/* Shared by the readers of mesh files as text: lines, blanks, comments, vertices, faces. */
#ifndef MOTE_HARNESS_MESH_TEXT_H
#define MOTE_HARNESS_MESH_TEXT_H

#include "harness/base/file.h"
#include "harness/mesh/mesh_soup.h"

#include <math.h>

typedef struct mote_mesh_reader {
    const char *path; /* for messages */
    size_t line;      /* from 1 */
    bool continues;   /* a backslash at the end of a line joins it to the next (OBJ) */
    mote_soup *soup;
    uint32_t *corners; /* of the face being read */
    size_t corner_count, corner_capacity;
} mote_mesh_reader;

static inline bool mote_is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static inline bool mote_is_digit(char c)
{
    return c >= '0' && c <= '9';
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

/* The length of a backslash and the line end after it; 0 where there is none. */
static inline size_t mote_continuation(const mote_mesh_reader *reader, const char *at)
{
    if (!reader->continues || at[0] != '\\')
        return 0;
    return at[1] == '\n' ? 2 : at[1] == '\r' && at[2] == '\n' ? 3 : 0;
}

/* Reads a number as strtod does, bit for bit, most of them in a fifth of its time. */
double mote_mesh_number(const char *at, const char **end);

/* Goes to the next word of a line; counts the lines joined to it. */
const char *mote_mesh_next_word(mote_mesh_reader *reader, const char *at);

/* Whether a word or a number ends here. */
static inline bool mote_mesh_word_ends(const mote_mesh_reader *reader, const char *at)
{
    return mote_is_blank(*at) || mote_is_end(*at) || mote_continuation(reader, at) > 0;
}

/* Whether a number that was read up to `end` is a coordinate. A # right behind it begins no
   comment: old runtimes of Microsoft wrote NaN and infinity as -1.#IND and 1.#INF. */
static inline bool mote_mesh_is_coordinate(double value, const char *end)
{
    return isfinite(value) && *end != '#';
}

/* MOTE_EINVAL with file and line for a number that is none. */
mote_status mote_mesh_refuse_coordinate(const mote_mesh_reader *reader, const char *end);

/* Reads three finite numbers, ignoring what follows them, and adds them as a vertex.
   MOTE_EINVAL with file and line; `right` gives the correct form ("write v x y z"). */
mote_status mote_mesh_read_vertex(mote_mesh_reader *reader, const char *at, const char *right);

/* Adds a corner to the face being read. */
void mote_mesh_add_corner(mote_mesh_reader *reader, uint32_t vertex);

/* Ends the face being read: its triangles go into the soup. MOTE_EINVAL with file and line if
   it has fewer than three corners or mote_soup_add_polygon refuses it. */
mote_status mote_mesh_end_face(mote_mesh_reader *reader);

/* Frees the reader's own memory, not its soup. */
void mote_mesh_reader_free(mote_mesh_reader *reader);

#endif
