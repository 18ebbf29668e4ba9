#include "harness/scene/bodies_poses.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#define HEAD "frame,body,deformation,x,y,z,qw,qx,qy,qz"
#define NUMBERS 8

/* The largest file that is read. */
#define SIZE_LIMIT ((size_t)1 << 33)

/* The largest coordinate allowed, in L. */
#define FAR 1e6

/* Whether a number may begin here: strtod and strtoul would skip the end of a line. */
static bool begins_number(const char *c)
{
    return !isspace((unsigned char)*c);
}

/* The next line after the end of this one, which may be a line feed, a carriage return and a
   line feed, or the end of the file; NULL if the line goes on. */
static const char *end_line(const char *at)
{
    at += *at == '\r' && (at[1] == '\n' || at[1] == '\0');
    return *at == '\n' ? at + 1 : *at == '\0' ? at : NULL;
}

/* Reads "F,B," and NUMBERS numbers from a line; returns the next line, or NULL if the line is
   different. */
static const char *read_row(const char *line, uint32_t frame, uint32_t body,
                            double numbers[NUMBERS])
{
    char *end;
    if (!begins_number(line) || strtoul(line, &end, 10) != frame || *end != ',')
        return NULL;
    if (!begins_number(end + 1) || strtoul(end + 1, &end, 10) != body)
        return NULL;
    for (int k = 0; k < NUMBERS; ++k) {
        const char *from = end + 1;
        if (*end != ',' || !begins_number(from))
            return NULL;
        numbers[k] = strtod(from, &end);
        if (end == from || !(fabs(numbers[k]) <= (k == 0 ? 1e12 : FAR)))
            return NULL;
    }
    return end_line(end);
}

/* Makes room for the rows as they come: a scenario may ask for more than its file has. */
static mote_status read_rows(const char *path, const char *text, mote_bodies *bodies)
{
    size_t capacity = 0;
    const size_t head = strlen(HEAD);
    const char *line = strncmp(text, HEAD, head) == 0 ? end_line(text + head) : NULL;
    if (!line)
        return mote_fail(MOTE_EINVAL, "%s:1: not the columns of recorded poses; expected %s",
                         path, HEAD);
    const size_t rows = (size_t)bodies->frames * bodies->count;
    for (size_t r = 0; r < rows; ++r) {
        double n[NUMBERS];
        const uint32_t frame = (uint32_t)(r / bodies->count) + 1;
        const uint32_t body = (uint32_t)(r % bodies->count) + 1;
        line = read_row(line, frame, body, n);
        if (!line || !(n[4] * n[4] + n[5] * n[5] + n[6] * n[6] + n[7] * n[7] > 0))
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: not a pose; expected frame %u, body %u, a deformation, a "
                             "place and a quaternion",
                             path, r + 2, frame, body);
        bodies->recorded =
            mote_reserve(bodies->recorded, r + 1, &capacity, sizeof *bodies->recorded);
        bodies->recorded[r] = (mote_bodies_record){
            .middle = mote_scale(mote_vec3_make(n[1], n[2], n[3]), bodies->length),
            .turn = mote_quaternion_normalise((mote_quaternion){n[4], n[5], n[6], n[7]}),
            .deformation = n[0]};
    }
    if (*line)
        return mote_fail(MOTE_EINVAL, "%s:%zu: more rows than %u frames of %u bodies", path,
                         rows + 2, bodies->frames, bodies->count);
    return MOTE_OK;
}

/* Sets the start of body i's path, from which simulations continue. */
static void set_path(mote_bodies *bodies, uint32_t i)
{
    const mote_bodies_record *a = &bodies->recorded[i];
    const mote_bodies_record *b = bodies->frames > 1 ? a + bodies->count : a;
    const mote_quaternion back = {a->turn.w, -a->turn.x, -a->turn.y, -a->turn.z};
    const mote_quaternion d = mote_quaternion_multiply(b->turn, back);
    const double sign = d.w < 0 ? -1 : 1;
    const mote_vec3 axis = mote_vec3_make(sign * d.x, sign * d.y, sign * d.z);
    const double sine = mote_length(axis);
    mote_bodies_path *path = &bodies->paths[i];
    *path = (mote_bodies_path){
        .place = a->middle, .velocity = mote_sub(b->middle, a->middle), .axis = {1, 0, 0}};
    if (sine > 0) {
        path->axis = mote_scale(axis, 1 / sine);
        path->spin = 2 * atan2(sine, fabs(d.w)) / 0.017453292519943295;
    }
}

mote_status mote_bodies_poses_read(const char *path, mote_bodies *bodies)
{
    char *text = NULL;
    size_t size = 0;
    mote_status status = mote_file_read(path, SIZE_LIMIT, &text, &size);
    if (status != MOTE_OK)
        return status;
    status = read_rows(path, text, bodies);
    for (uint32_t i = 0; i < bodies->count && status == MOTE_OK; ++i)
        set_path(bodies, i);
    free(text);
    return status;
}

mote_status mote_bodies_poses_write(const char *path, const mote_bodies *bodies,
                                    const mote_bodies_record *records, uint32_t frames)
{
    mote_text text = {0};
    mote_text_add(&text, HEAD "\n");
    for (size_t r = 0; r < (size_t)frames * bodies->count; ++r) {
        const mote_bodies_record *record = &records[r];
        const mote_vec3 p = mote_scale(record->middle, 1 / bodies->length);
        const mote_quaternion q = record->turn;
        mote_text_add(&text, "%zu,%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n",
                      r / bodies->count + 1, r % bodies->count + 1, record->deformation, p.x,
                      p.y, p.z, q.w, q.x, q.y, q.z);
    }
    const mote_status status = mote_file_write(path, text.data, text.size);
    free(text.data);
    return status;
}
