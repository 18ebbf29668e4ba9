/* Reads PLY, keeping the vertices as in the file. */
#include "harness/mesh/mesh_soup.h"

#include "harness/base/memory.h"
#include "harness/mesh/mesh_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define ELEMENTS_MAX 16
#define PROPERTIES_MAX 64
#define LIST_MAX 1000000     /* entries of a list; those of a strip are limited by the file */
#define STRIP_END UINT32_MAX /* the corner -1 */

typedef enum number_type { NONE, I8, U8, I16, U16, I32, U32, F32, F64 } number_type;

static const size_t type_bytes[] = {
    [I8] = 1, [U8] = 1, [I16] = 2, [U16] = 2, [I32] = 4, [U32] = 4, [F32] = 4, [F64] = 8};

typedef enum role { OTHER, X, Y, Z, CORNERS } role;

typedef struct property {
    number_type length; /* of a list: the type of its count; otherwise NONE */
    number_type type;
    role role;
} property;

typedef struct element {
    uint64_t count;
    bool is_vertex, is_face, is_strips;
    property property[PROPERTIES_MAX];
    size_t properties;
} element;

typedef struct ply {
    const char *path;
    const char *at, *end; /* unread data */
    size_t line;          /* of an ASCII file */
    bool ascii, big_endian;
    element element[ELEMENTS_MAX];
    size_t elements;
    size_t vertices;
    mote_frame_file *file;
    mote_soup *soup;
    uint32_t *corners; /* of the face or strip being read */
    size_t corner_room;
} ply;

static mote_status MOTE_PRINTF(2, 3) fail(const ply *p, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return p->line > 0 ? mote_fail(MOTE_EINVAL, "%s:%zu: %s", p->path, p->line, text)
                       : mote_fail(MOTE_EINVAL, "%s: %s", p->path, text);
}

static number_type type_named(const char *name)
{
    static const struct {
        const char *name;
        number_type type;
    } types[] = {{"char", I8},   {"int8", I8},     {"uchar", U8},   {"uint8", U8},
                 {"short", I16}, {"int16", I16},   {"ushort", U16}, {"uint16", U16},
                 {"int", I32},   {"int32", I32},   {"uint", U32},   {"uint32", U32},
                 {"float", F32}, {"float32", F32}, {"double", F64}, {"float64", F64}};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; ++i) {
        if (strcmp(name, types[i].name) == 0)
            return types[i].type;
    }
    return NONE;
}

static role role_named(const element *e, const char *name, bool list)
{
    if (e->is_vertex && !list && name[0] >= 'x' && name[0] <= 'z' && name[1] == '\0')
        return name[0] == 'x' ? X : name[0] == 'y' ? Y : Z;
    if ((e->is_face || e->is_strips) && list &&
        (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0))
        return CORNERS;
    return OTHER;
}

static mote_status add_element(ply *p, const char *name, const char *count)
{
    char *end;
    const unsigned long long number = strtoull(count, &end, 10);
    if (p->elements == ELEMENTS_MAX)
        return fail(p, "more than %d elements; leave some out", ELEMENTS_MAX);
    if (count[0] < '0' || count[0] > '9' || *end)
        return fail(p, "an element without its count; write element vertex 8, for example");
    /* An element takes at least one byte. */
    if (number > (uint64_t)(p->end - p->at))
        return fail(
            p,
            "declares %llu elements, which the %zu bytes left cannot hold; give the number "
            "that follows",
            number, (size_t)(p->end - p->at));
    element *e = &p->element[p->elements++];
    e->count = number;
    e->is_vertex = strcmp(name, "vertex") == 0;
    e->is_face = strcmp(name, "face") == 0;
    e->is_strips = strcmp(name, "tristrips") == 0;
    if (!e->is_vertex)
        return MOTE_OK;
    for (size_t i = 0; i + 1 < p->elements; ++i) {
        if (p->element[i].is_vertex)
            return fail(p, "a second vertex element; give one");
    }
    p->vertices = number;
    return MOTE_OK;
}

static mote_status add_property(ply *p, char *const words[], int count)
{
    if (p->elements == 0)
        return fail(p, "a property of no element; write the element first");
    element *e = &p->element[p->elements - 1];
    const bool list = count == 5 && strcmp(words[1], "list") == 0;
    if (e->properties == PROPERTIES_MAX)
        return fail(p, "more than %d properties; leave some out", PROPERTIES_MAX);
    if (!list && count != 3)
        return fail(
            p, "a property that is not a type and a name; write property float x, for example");
    property *made = &e->property[e->properties++];
    made->length = list ? type_named(words[2]) : NONE;
    made->type = type_named(words[list ? 3 : 1]);
    made->role = role_named(e, words[list ? 4 : 2], list);
    if (made->type == NONE || (list && (made->length == NONE || made->length >= F32)))
        return fail(p, "a property of an unknown type; give float, int, uchar or the like");
    for (size_t k = 0; made->role == CORNERS && k + 1 < e->properties; ++k) {
        if (e->property[k].role == CORNERS)
            return fail(p, "a second list of corners in one element; give one");
    }
    return MOTE_OK;
}

static mote_status read_format(ply *p, char *const words[], int count)
{
    p->ascii = count == 3 && strcmp(words[1], "ascii") == 0;
    p->big_endian = count == 3 && strcmp(words[1], "binary_big_endian") == 0;
    if (p->ascii || p->big_endian || (count == 3 && !strcmp(words[1], "binary_little_endian")))
        return MOTE_OK;
    return fail(p, "an unknown format; write format ascii 1.0, binary_little_endian 1.0 or "
                   "binary_big_endian 1.0");
}

#define WORDS_MAX 6

/* Splits the next line of the header into words. */
static int header_words(ply *p, char line[256], char *words[WORDS_MAX])
{
    const char *stop = memchr(p->at, '\n', (size_t)(p->end - p->at));
    const size_t length = stop ? (size_t)(stop - p->at) : (size_t)(p->end - p->at);
    const size_t kept = length < 255 ? length : 255;
    int count = 0;
    memcpy(line, p->at, kept);
    line[kept] = '\0';
    p->at = stop ? stop + 1 : p->end;
    ++p->line;
    char *rest = NULL;
    for (char *word = strtok_r(line, " \t\r", &rest); word && count < WORDS_MAX;
         word = strtok_r(NULL, " \t\r", &rest))
        words[count++] = word;
    return count;
}

static mote_status read_header(ply *p)
{
    char line[256], *words[WORDS_MAX];
    bool has_format = false;
    mote_status status = MOTE_OK;
    if (header_words(p, line, words) != 1 || strcasecmp(words[0], "ply") != 0)
        return fail(p, "does not begin with the word ply; write it on a line of its own");
    while (status == MOTE_OK && p->at < p->end) {
        const int count = header_words(p, line, words);
        const char *word = count > 0 ? words[0] : "";
        if (strcmp(word, "format") == 0) {
            status = read_format(p, words, count);
            has_format = true;
        } else if (strcmp(word, "element") == 0) {
            status = count == 3 ? add_element(p, words[1], words[2])
                                : fail(p, "an element without a name and a count; write "
                                          "element vertex 8, for example");
        } else if (strcmp(word, "property") == 0) {
            status = add_property(p, words, count);
        } else if (strcmp(word, "end_header") == 0) {
            return has_format
                       ? MOTE_OK
                       : fail(p,
                              "a header without a format; write format ascii 1.0, for example");
        }
    }
    return status == MOTE_OK ? fail(p, "a header without a line end_header; add it") : status;
}

static uint64_t bits_of(const ply *p, const char *at, size_t bytes)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < bytes; ++i) {
        const size_t place = p->big_endian ? bytes - 1 - i : i;
        bits |= (uint64_t)(unsigned char)at[i] << (8 * place);
    }
    return bits;
}

static double number_of(uint64_t bits, number_type type)
{
    const uint32_t low = (uint32_t)bits;
    float single;
    double value;
    switch (type) {
    case I8:
        return (int8_t)low;
    case I16:
        return (int16_t)low;
    case I32:
        return (int32_t)low;
    case F32:
        memcpy(&single, &low, sizeof single);
        return (double)single;
    case F64:
        memcpy(&value, &bits, sizeof value);
        return value;
    default:
        return low;
    }
}

static void skip_blanks(ply *p)
{
    for (; *p->at == ' ' || *p->at == '\t' || *p->at == '\r' || *p->at == '\n'; ++p->at)
        p->line += *p->at == '\n';
}

/* Reads the next number, from text or binary. */
static mote_status next_number(ply *p, number_type type, double *value)
{
    if (!p->ascii) {
        const size_t bytes = type_bytes[type];
        if ((size_t)(p->end - p->at) < bytes)
            return MOTE_EINVAL;
        *value = number_of(bits_of(p, p->at, bytes), type);
        p->at += bytes;
        return MOTE_OK;
    }
    skip_blanks(p);
    const char *stop;
    *value = mote_mesh_number(p->at, &stop);
    const bool ends = *stop == ' ' || *stop == '\t' || *stop == '\r' || *stop == '\n' || !*stop;
    if (stop == p->at || !ends)
        return MOTE_EINVAL;
    p->at = stop;
    return MOTE_OK;
}

static const char *kind_of(const element *e)
{
    return e->is_vertex ? "vertex" : e->is_face ? "face" : e->is_strips ? "strip" : "entry";
}

/* Why there was no next number. Any bytes of a binary file are one. */
static mote_status no_number(const ply *p, const element *e, uint64_t number)
{
    if (!p->ascii || p->at >= p->end)
        return fail(p, "ends after %s %" PRIu64 " of %" PRIu64 "; give all, or declare fewer",
                    kind_of(e), number, e->count);
    if (memchr(p->at, ',', strcspn(p->at, " \t\r\n")))
        return fail(p, "a comma among numbers; write 1.5, not 1,5");
    return fail(p,
                "has something that is not a number after %s %" PRIu64 " of %" PRIu64
                "; give a number for each property",
                kind_of(e), number, e->count);
}

static mote_status add_face(ply *p, uint64_t number, size_t count)
{
    const uint32_t *corners = p->corners;
    if (count < 3)
        return fail(p, "face %" PRIu64 " has %zu corners; give at least 3", number + 1, count);
    if (count == 3) {
        mote_soup_add_triangle(p->soup, corners[0], corners[1], corners[2]);
        return MOTE_OK;
    }
    const mote_status status = mote_soup_add_polygon(p->soup, corners, count);
    if (status != MOTE_EINVAL)
        return status;
    char text[200];
    (void)snprintf(text, sizeof text, "%s", mote_error_text());
    return fail(p, "face %" PRIu64 ": %s", number + 1, text);
}

/* Each corner from the third on makes a triangle with the two before it, every other one of
   which is turned round. */
static mote_status add_strip(ply *p, uint64_t number, const uint32_t *corners, size_t count)
{
    if (count == 1 || count == 2)
        return fail(p, "strip %" PRIu64 " has a part of %zu corners; give at least 3",
                    number + 1, count);
    for (size_t k = 2; k < count; ++k)
        mote_soup_add_triangle(p->soup, corners[k - 2 + k % 2], corners[k - 1 - k % 2],
                               corners[k]);
    return MOTE_OK;
}

/* A corner -1 ends a strip; another one follows. */
static mote_status add_strips(ply *p, uint64_t number, size_t count)
{
    mote_status status = MOTE_OK;
    size_t first = 0;
    for (size_t k = 0; k <= count && status == MOTE_OK; ++k) {
        if (k < count && p->corners[k] != STRIP_END)
            continue;
        status = add_strip(p, number, p->corners + first, k - first);
        first = k + 1;
    }
    return status;
}

static mote_status end_corners(ply *p, const element *e, uint64_t number, size_t count)
{
    uint64_t hash = p->file->topology;
    for (size_t k = 0; k < count; ++k)
        hash = mote_frame_file_hash(hash, p->corners[k]);
    p->file->topology = mote_frame_file_hash(hash, count);
    if (!p->soup)
        return MOTE_OK;
    p->soup->line = p->ascii && p->line < UINT32_MAX ? (uint32_t)p->line : 0;
    return e->is_strips ? add_strips(p, number, count) : add_face(p, number, count);
}

static mote_status put_corner(ply *p, const element *e, uint64_t number, size_t k, double value)
{
    const bool ends = e->is_strips && value == -1;
    if (!ends && !(value >= 0 && value < (double)p->vertices && value == floor(value)))
        return fail(p, "%s %" PRIu64 " has vertex %.17g of %zu; use 0 to %zu", kind_of(e),
                    number + 1, value, p->vertices, p->vertices - 1);
    p->corners[k] = ends ? STRIP_END : (uint32_t)value;
    return MOTE_OK;
}

static mote_status read_list(ply *p, const element *e, const property *q, uint64_t number)
{
    double length, value;
    if (next_number(p, q->length, &length) != MOTE_OK)
        return no_number(p, e, number);
    /* An entry takes at least one byte. */
    const size_t most = e->is_strips ? (size_t)(p->end - p->at) : LIST_MAX;
    if (!(length >= 0 && length <= (double)most && length == floor(length)))
        return fail(p, "a list of %.17g entries; give at most %zu", length, most);
    const size_t count = (size_t)length;
    if (q->role == CORNERS)
        p->corners = mote_reserve(p->corners, count + 1, &p->corner_room, sizeof *p->corners);
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < count && status == MOTE_OK; ++k) {
        if (next_number(p, q->type, &value) != MOTE_OK)
            status = no_number(p, e, number);
        else if (q->role == CORNERS)
            status = put_corner(p, e, number, k, value);
    }
    return status == MOTE_OK && q->role == CORNERS ? end_corners(p, e, number, count) : status;
}

static mote_status add_vertex(ply *p, uint64_t number, const double xyz[3])
{
    mote_frame_file *file = p->file;
    if (!isfinite(xyz[0]) || !isfinite(xyz[1]) || !isfinite(xyz[2]))
        return fail(p,
                    "vertex %" PRIu64
                    " has a coordinate that is not a finite number; give finite "
                    "ones",
                    number + 1);
    if (file->count < file->room)
        memcpy(file->xyz + 3 * file->count, xyz, 3 * sizeof *xyz);
    ++file->count;
    return p->soup ? mote_soup_add_vertex(p->soup, xyz[0], xyz[1], xyz[2]) : MOTE_OK;
}

static mote_status read_entry(ply *p, const element *e, uint64_t number)
{
    double xyz[3] = {0, 0, 0};
    for (size_t k = 0; k < e->properties; ++k) {
        const property *q = &e->property[k];
        double value = 0;
        mote_status status = MOTE_OK;
        if (q->length != NONE)
            status = read_list(p, e, q, number);
        else if (next_number(p, q->type, &value) != MOTE_OK)
            status = no_number(p, e, number);
        if (status != MOTE_OK)
            return status;
        if (q->role == X || q->role == Y || q->role == Z)
            xyz[q->role - X] = value;
    }
    return e->is_vertex ? add_vertex(p, number, xyz) : MOTE_OK;
}

/* Checks that vertices with coordinates and faces with corners are declared, in this order. */
static mote_status check_header(const ply *p)
{
    unsigned coordinates = 0, known = 0;
    bool corners = false, early = false;
    for (size_t i = 0; i < p->elements; ++i) {
        const element *e = &p->element[i];
        for (size_t k = 0; k < e->properties; ++k) {
            const role part = e->property[k].role;
            const bool coordinate = part == X || part == Y || part == Z;
            coordinates += coordinate;
            known |= coordinate ? 1u << part : 0;
            early = early || (part == CORNERS && coordinates < 3);
            corners = corners || part == CORNERS;
        }
    }
    if (coordinates != 3 || known != (1u << X | 1u << Y | 1u << Z))
        return fail(p, "no vertex element with x, y and z once each; add it");
    if (p->vertices == 0)
        return fail(p, "declares no vertex; give a mesh");
    if (early)
        return fail(p, "faces before the vertices; give the vertex element first");
    return corners ? MOTE_OK : fail(p, "no face element with vertex_indices; add it");
}

/* More numbers than were declared would be those of a wrong declaration. */
static mote_status check_end(ply *p)
{
    skip_blanks(p);
    return p->at == p->end ? MOTE_OK
                           : fail(p, "goes on after all that is declared; declare what "
                                     "follows, or leave it out");
}

static mote_status read_all(ply *p)
{
    mote_status status = read_header(p);
    if (status == MOTE_OK)
        status = check_header(p);
    p->line = p->ascii ? p->line + 1 : 0;
    for (size_t i = 0; i < p->elements && status == MOTE_OK; ++i) {
        for (uint64_t n = 0; n < p->element[i].count && status == MOTE_OK; ++n)
            status = read_entry(p, &p->element[i], n);
    }
    if (status == MOTE_OK && p->ascii)
        status = check_end(p);
    if (status == MOTE_OK && p->soup && p->soup->triangle_count == 0)
        status = mote_fail(MOTE_EINVAL, "%s: no face in it; give triangles", p->path);
    return status;
}

mote_status mote_frame_file_read_ply(const char *path, const char *data, size_t size,
                                     mote_frame_file *file, mote_soup *soup)
{
    mote_status status = mote_soup_check_line_ends(path, data);
    if (status != MOTE_OK)
        return status;
    ply *p = mote_allocate(1, sizeof *p);
    p->path = path;
    p->at = mote_skip_mark(data);
    p->end = data + size;
    p->file = file;
    p->soup = soup;
    status = read_all(p);
    free(p->corners);
    free(p);
    return status;
}
