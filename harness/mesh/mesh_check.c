/* Checks a file before assimp reads it, for errors that assimp silently accepts: it trusts
   declared counts and then loops or allocates for minutes; it takes a comma for a decimal
   point, and an index modulo 2^32. */
#include "harness/mesh/mesh_text.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The elements of a PLY header, in the file's order. */
#define ELEMENTS_MAX 16

typedef struct ply_element {
    char name[16]; /* truncated */
    unsigned long long count;
    bool has_properties, begins_with_list; /* its first property is a list */
    size_t bytes;                          /* of one in a binary file, if its lists are empty */
} ply_element;

typedef struct ply_header {
    ply_element element[ELEMENTS_MAX];
    size_t count;
    bool ascii;
    size_t lines; /* of the header */
    unsigned long long vertices;
} ply_header;

/* We and assimp would take a text with the line ends of old Macs for one line. */
static mote_status check_line_ends(const char *path, const char *text)
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

/* Reads "element NAME COUNT"; an element takes at least one byte. */
static mote_status read_element(const char *path, const char *at, size_t size, ply_header *h)
{
    if (h->count == ELEMENTS_MAX)
        return mote_fail(MOTE_EINVAL, "%s:%zu: more than %d elements; leave some out", path,
                         h->lines + 1, ELEMENTS_MAX);
    ply_element *e = &h->element[h->count++];
    *e = (ply_element){0};
    const size_t length = strcspn(at, " \t\r\n");
    memcpy(e->name, at, length < sizeof e->name ? length : sizeof e->name - 1);
    e->count = strtoull(at + length, NULL, 10);
    if (e->count > size)
        return mote_fail(MOTE_EINVAL,
                         "%s:%zu: declares %llu elements, which %zu bytes cannot hold; give "
                         "the number that follows",
                         path, h->lines + 1, e->count, size);
    if (strcmp(e->name, "vertex") == 0)
        h->vertices = e->count;
    return MOTE_OK;
}

/* The text after `word` and blanks, or NULL. */
static const char *after(const char *at, const char *word)
{
    const size_t length = strlen(word);
    if (strncmp(at, word, length) != 0 || !mote_is_blank(at[length]))
        return NULL;
    return mote_skip_blanks(at + length);
}

/* Bytes of a number in a binary file; 0 for an unknown type. */
static size_t type_bytes(const char *type)
{
    static const struct {
        const char *name;
        size_t bytes;
    } types[] = {{"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},
                 {"short", 2}, {"ushort", 2},  {"int16", 2},  {"uint16", 2},
                 {"int", 4},   {"uint", 4},    {"int32", 4},  {"uint32", 4},
                 {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; ++i) {
        if (after(type, types[i].name))
            return types[i].bytes;
    }
    return 0;
}

static void note_property(ply_element *e, const char *property)
{
    const char *list = after(property, "list");
    if (!e->has_properties)
        e->begins_with_list = list != NULL;
    e->has_properties = true;
    e->bytes += type_bytes(list ? list : property);
}

/* Reads up to the line end_header; without that line assimp would never end. *body is the text
   after it. */
static mote_status read_header(const char *path, const char *text, size_t size, ply_header *h,
                               const char **body)
{
    for (const char *line = mote_skip_mark(text); *line; line = next_line(line), ++h->lines) {
        const char *element = after(line, "element"), *property = after(line, "property");
        const char *format = after(line, "format");
        mote_status status = MOTE_OK;
        if (element)
            status = read_element(path, element, size, h);
        else if (property && h->count > 0)
            note_property(&h->element[h->count - 1], property);
        if (status != MOTE_OK)
            return status;
        h->ascii = h->ascii || (format && strncmp(format, "ascii", 5) == 0);
        if (strncmp(line, "end_header", 10) == 0 && strchr("\r\n", line[10])) {
            *body = next_line(line);
            ++h->lines;
            return MOTE_OK;
        }
    }
    return mote_fail(MOTE_EINVAL, "%s: a header without a line end_header; add it", path);
}

/* Checks "3 0 1 2"; anything may follow on the line. */
static mote_status check_face(const char *path, size_t number, const char *line,
                              unsigned long long vertices)
{
    char *end;
    const long long corners = strtoll(line, &end, 10);
    if (end == line || corners < 0)
        return mote_fail(MOTE_EINVAL,
                         "%s:%zu: a face without its number of corners; write 3 0 1 2", path,
                         number);
    for (long long i = 0; i < corners; ++i) {
        const char *at = mote_skip_blanks(end);
        const long long index = mote_is_end(*at) ? 0 : strtoll(at, &end, 10);
        if (mote_is_end(*at) || end == at)
            return mote_fail(MOTE_EINVAL, "%s:%zu: a face of %lld corners with %lld; give all",
                             path, number, corners, i);
        if (index < 0 || (unsigned long long)index >= vertices)
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: face with vertex %lld of %llu; use 0 to %llu", path,
                             number, index, vertices, vertices - 1);
    }
    return MOTE_OK;
}

static mote_status comma_at(const char *path, size_t number)
{
    return mote_fail(MOTE_EINVAL, "%s:%zu: a comma among numbers; write 1.5, not 1,5", path,
                     number);
}

/* Checks the lines of an ASCII body, one per element. */
static mote_status check_ply_body(const char *path, const ply_header *h, const char *body)
{
    size_t number = h->lines;
    const char *line = body;
    for (size_t e = 0; e < h->count; ++e) {
        const bool is_face =
            strcmp(h->element[e].name, "face") == 0 && h->element[e].begins_with_list;
        for (unsigned long long i = 0; i < h->element[e].count; ++i) {
            for (++number; *line && mote_is_end(*mote_skip_blanks(line)); ++number)
                line = next_line(line);
            if (!*line)
                return mote_fail(MOTE_EINVAL,
                                 "%s:%zu: ends after %llu of %llu elements %s; give all, or "
                                 "declare fewer",
                                 path, number, i, h->element[e].count, h->element[e].name);
            const char *next = next_line(line);
            mote_status status = MOTE_OK;
            if (memchr(line, ',', (size_t)(next - line)))
                status = comma_at(path, number);
            else if (is_face)
                status = check_face(path, number, mote_skip_blanks(line), h->vertices);
            if (status != MOTE_OK)
                return status;
            line = next;
        }
    }
    return MOTE_OK;
}

/* Checks that the declared elements fit into a binary body. */
static mote_status check_binary_ply(const char *path, const ply_header *h, size_t body_size)
{
    size_t least = 0;
    for (size_t e = 0; e < h->count; ++e)
        least += h->element[e].bytes * (size_t)h->element[e].count;
    if (least > body_size)
        return mote_fail(MOTE_EINVAL,
                         "%s: ends early: what its header declares takes %zu bytes at least, "
                         "and %zu follow; give all elements, or declare fewer",
                         path, least, body_size);
    return MOTE_OK;
}

static mote_status check_ply(const char *path, const char *text, size_t size)
{
    ply_header header = {0};
    const char *body = NULL;
    mote_status status = check_line_ends(path, text);
    if (status == MOTE_OK)
        status = read_header(path, text, size, &header, &body);
    if (status == MOTE_OK && header.vertices == 0)
        status = mote_fail(MOTE_EINVAL, "%s: declares no vertex; give a mesh", path);
    if (status != MOTE_OK)
        return status;
    return header.ascii ? check_ply_body(path, &header, body)
                        : check_binary_ply(path, &header, size - (size_t)(body - text));
}

static bool begins(const char *line, const char *word)
{
    return strncasecmp(line, word, strlen(word)) == 0;
}

/* Whether a line has three numbers and nothing else. */
static bool has_three_numbers(const char *at)
{
    for (int i = 0; i < 3; ++i) {
        char *end;
        at = mote_skip_blanks(at);
        if (mote_is_end(*at))
            return false;
        (void)strtod(at, &end);
        if (end == at || !(mote_is_blank(*end) || mote_is_end(*end)))
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
    const mote_status status = check_line_ends(path, text);
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
    return check_line_ends(path, text);
}

mote_status mote_soup_check_text(const char *path, const char *text, size_t size)
{
    if (mote_name_ends(path, ".ply"))
        return check_ply(path, text, size);
    if (mote_name_ends(path, ".stl"))
        return check_stl(path, text, size);
    return MOTE_OK;
}
