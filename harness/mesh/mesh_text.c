#include "harness/mesh/mesh_text.h"

#include "harness/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Powers of ten that a double holds exactly. */
static const double tens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                              1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                              1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
#define TENS_MAX 22
#define EXACT_MAX ((uint64_t)1 << 53)

/* If the digits make an integer below 2^53 and the power of ten is exact, one multiplication or
   division rounds as strtod does. */
double mote_mesh_number(const char *at, const char **end)
{
    const char *p = at + (*at == '-' || *at == '+');
    uint64_t digits = 0;
    int count = 0, power = 0;
    for (; mote_is_digit(*p) && count < 18; ++p, ++count)
        digits = 10 * digits + (uint64_t)(*p - '0');
    if (*p == '.') {
        for (++p; mote_is_digit(*p) && count < 18; ++p, ++count, --power)
            digits = 10 * digits + (uint64_t)(*p - '0');
    }
    if (count > 0 && (*p == 'e' || *p == 'E') &&
        (mote_is_digit(p[1]) || ((p[1] == '-' || p[1] == '+') && mote_is_digit(p[2])))) {
        const bool negative = p[1] == '-';
        int exponent = 0;
        for (p += mote_is_digit(p[1]) ? 1 : 2; mote_is_digit(*p) && exponent < 1000; ++p)
            exponent = 10 * exponent + (*p - '0');
        power += negative ? -exponent : exponent;
    }
    const bool ends = *p == ' ' || *p == '\n' || *p == '\r' || *p == '\t' || *p == '\0';
    if (count == 0 || !ends || digits > EXACT_MAX || power < -TENS_MAX || power > TENS_MAX) {
        char *stop;
        const double value = strtod(at, &stop);
        *end = stop;
        return value;
    }
    const double whole = (double)digits;
    const double value = power < 0 ? whole / tens[-power] : whole * tens[power];
    *end = p;
    return *at == '-' ? -value : value;
}

const char *mote_mesh_next_word(mote_mesh_reader *reader, const char *at)
{
    for (;;) {
        at = mote_skip_blanks(at);
        const size_t length = mote_continuation(reader, at);
        if (length == 0)
            return at;
        at += length;
        ++reader->line;
    }
}

mote_status mote_mesh_refuse_coordinate(const mote_mesh_reader *reader, const char *end)
{
    return mote_fail(
        MOTE_EINVAL, "%s:%zu: a coordinate is not a finite double; give a smaller number%s",
        reader->path, reader->line, *end == '#' ? ", and a blank before a comment" : "");
}

mote_status mote_mesh_read_vertex(mote_mesh_reader *reader, const char *at, const char *right)
{
    double xyz[3];
    for (int i = 0; i < 3; ++i) {
        at = mote_mesh_next_word(reader, at);
        char *end;
        /* strtod would skip the line end and read a number from the next line. */
        xyz[i] = mote_is_end(*at) ? (double)NAN : strtod(at, &end);
        if (mote_is_end(*at) || end == at || !mote_mesh_word_ends(reader, end))
            return mote_fail(MOTE_EINVAL, "%s:%zu: a vertex without three numbers; %s",
                             reader->path, reader->line, right);
        if (!mote_mesh_is_coordinate(xyz[i], end))
            return mote_mesh_refuse_coordinate(reader, end);
        at = end;
    }
    return mote_soup_add_vertex(reader->soup, xyz[0], xyz[1], xyz[2]);
}

void mote_mesh_add_corner(mote_mesh_reader *reader, uint32_t vertex)
{
    reader->corners = mote_reserve(reader->corners, reader->corner_count + 1,
                                   &reader->corner_capacity, sizeof *reader->corners);
    reader->corners[reader->corner_count++] = vertex;
}

mote_status mote_mesh_end_face(mote_mesh_reader *reader)
{
    const size_t count = reader->corner_count;
    reader->corner_count = 0;
    if (count < 3)
        return mote_fail(MOTE_EINVAL, "%s:%zu: a face of %zu vertices; give at least 3",
                         reader->path, reader->line, count);
    reader->soup->line = reader->line < UINT32_MAX ? (uint32_t)reader->line : 0;
    const mote_status status = mote_soup_add_polygon(reader->soup, reader->corners, count);
    return status == MOTE_OK
               ? status
               : mote_fail(status, "%s:%zu: %s", reader->path, reader->line, mote_error_text());
}

void mote_mesh_reader_free(mote_mesh_reader *reader)
{
    free(reader->corners);
}
