/* Checks texts before they are read: their encoding, and what assimp makes up in STL. */
#include "harness/mesh/mesh_text.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

mote_status mote_soup_check_line_ends(const char *path, const char *text)
{
    if (strchr(text, '\r') && !strchr(text, '\n'))
        return mote_fail(MOTE_EINVAL,
                         "%s: lines that end with a carriage return alone; end them with a "
                         "line feed",
                         path);
    return MOTE_OK;
}

static const char *next_line(const char *at)
{
    at += strcspn(at, "\n");
    return at + (*at == '\n');
}

static bool begins(const char *line, const char *word)
{
    return strncasecmp(line, word, strlen(word)) == 0;
}

/* Whether a line has three numbers and nothing else. A # may follow after a blank only: assimp
   reads -1.#IND, as old runtimes of Microsoft wrote NaN, as -1. */
static bool has_three_numbers(const char *at)
{
    for (int i = 0; i < 3; ++i) {
        char *end;
        at = mote_skip_blanks(at);
        if (mote_is_end(*at))
            return false;
        (void)strtod(at, &end);
        if (end == at || *end == '#' || !(mote_is_blank(*end) || mote_is_end(*end)))
            return false;
        at = end;
    }
    return true;
}

/* Checks ASCII STL: facets of three vertices of three numbers, up to a line endsolid. assimp
   makes up missing numbers. */
static mote_status check_stl_text(const char *path, const char *text)
{
    size_t number = 1;
    int corners = 0;
    bool ended = false;
    for (const char *at = text; *at; at = next_line(at), ++number) {
        const char *line = mote_skip_blanks(at);
        ended = ended ? mote_is_end(*line) : begins(line, "endsolid");
        corners = begins(line, "outer") ? 0 : corners;
        if (begins(line, "vertex") && ++corners && !has_three_numbers(line + strlen("vertex")))
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: a vertex without three numbers; write vertex x y z", path,
                             number);
        if (begins(line, "endloop") && corners != 3)
            return mote_fail(MOTE_EINVAL, "%s:%zu: a facet of %d vertices; give three", path,
                             number, corners);
    }
    if (!ended)
        return mote_fail(MOTE_EINVAL, "%s:%zu: ends without a line endsolid; add it", path,
                         number);
    return MOTE_OK;
}

/* Checks STL. A binary file (80 bytes, a count, 50 bytes per triangle) may also begin with
   "solid". */
static mote_status check_stl(const char *path, const char *text, size_t size)
{
    const bool is_text = strlen(text) == size && begins(mote_skip_mark(text), "solid");
    if (!is_text)
        return MOTE_OK;
    const mote_status status = mote_soup_check_line_ends(path, text);
    return status == MOTE_OK ? check_stl_text(path, text) : status;
}

mote_status mote_soup_refuse_empty(const char *path)
{
    return mote_fail(MOTE_EINVAL, "%s: an empty file, no face in it; give a mesh", path);
}

mote_status mote_soup_check_encoding(const char *path, const char *text, size_t size)
{
    if (size == 0)
        return mote_soup_refuse_empty(path);
    if (strncmp(text, "\xff\xfe", 2) == 0 || strncmp(text, "\xfe\xff", 2) == 0)
        return mote_fail(MOTE_EINVAL, "%s: a text in UTF-16; save it as UTF-8", path);
    if (strlen(text) != size)
        return mote_fail(MOTE_EINVAL, "%s: a zero byte at %zu; give text", path, strlen(text));
    return mote_soup_check_line_ends(path, text);
}

mote_status mote_soup_check_text(const char *path, const char *text, size_t size)
{
    if (mote_name_ends(path, ".stl"))
        return check_stl(path, text, size);
    return MOTE_OK;
}
