/* A flat sheet that sinks frame by frame, in every format of sequences. Heights are multiples
   of 1/64, which single precision and text hold exactly. */
#ifndef MOTE_TESTS_SHEET_H
#define MOTE_TESTS_SHEET_H

#include "harness/base/file.h"
#include "tests/support/folder.h"

#include <stdint.h>

#define SHEET_EDGE 5 /* vertices */
#define SHEET_VERTICES (SHEET_EDGE * SHEET_EDGE)
#define SHEET_FACES (2 * (SHEET_EDGE - 1) * (SHEET_EDGE - 1))

/* Coordinate c of a vertex at a frame, from 1; any real number between frames. */
static inline double sheet_at(int vertex, int c, double frame)
{
    return c == 0   ? (vertex % SHEET_EDGE - 2) / 4.0
           : c == 1 ? (vertex / SHEET_EDGE - 2) / 4.0
                    : 2 - (frame - 1) / 64;
}

static inline void sheet_face(int face, int corner[3])
{
    const int row = face / 2 / (SHEET_EDGE - 1), column = face / 2 % (SHEET_EDGE - 1);
    const int a = row * SHEET_EDGE + column, b = a + 1, c = a + SHEET_EDGE, d = c + 1;
    corner[0] = face % 2 ? b : a;
    corner[1] = face % 2 ? d : b;
    corner[2] = c;
}

/* Appends a number in either byte order. */
static inline void sheet_put(mote_text *text, const void *number, size_t size, bool big)
{
    const uint16_t probe = 1;
    const bool host_is_big = *(const unsigned char *)&probe == 0;
    const unsigned char *bytes = number;
    for (size_t i = 0; i < size; ++i) {
        /* mote_text_add skips 0 bytes, so they are stored directly. */
        mote_text_add(text, "x");
        text->data[text->size - 1] = (char)bytes[big == host_is_big ? i : size - 1 - i];
    }
}

static inline void sheet_put_int(mote_text *text, int32_t value, bool big)
{
    sheet_put(text, &value, sizeof value, big);
}

static inline void sheet_put_float(mote_text *text, double value, bool big)
{
    const float single = (float)value;
    sheet_put(text, &single, sizeof single, big);
}

static inline void sheet_save(const char *path, mote_text *text)
{
    file_write(path, text->data, text->size);
    free(text->data);
    *text = (mote_text){0};
}

static inline void sheet_write_obj(const char *path, double frame)
{
    mote_text text = {0};
    for (int v = 0; v < SHEET_VERTICES; ++v)
        mote_text_add(&text, "v %.17g %.17g %.17g\n", sheet_at(v, 0, frame),
                      sheet_at(v, 1, frame), sheet_at(v, 2, frame));
    for (int f = 0; f < SHEET_FACES; ++f) {
        int k[3];
        sheet_face(f, k);
        mote_text_add(&text, "f %d %d %d\n", k[0] + 1, k[1] + 1, k[2] + 1);
    }
    sheet_save(path, &text);
}

typedef enum sheet_ply { SHEET_ASCII, SHEET_LITTLE, SHEET_BIG } sheet_ply;

/* Binary: little-endian in double precision, big-endian in single; with an extra property and
   an extra element that the reader must skip. */
static inline void sheet_write_ply(const char *path, double frame, sheet_ply form)
{
    static const char *const forms[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const bool big = form == SHEET_BIG;
    mote_text text = {0};
    mote_text_add(&text,
                  "ply\nformat %s 1.0\ncomment a sheet\nelement vertex %d\nproperty uchar "
                  "red\nproperty %s z\nproperty %s x\nproperty %s y\nelement edge 1\nproperty "
                  "short a\nproperty list uchar float b\nelement face %d\nproperty list uchar "
                  "int vertex_index\nend_header\n",
                  forms[form], SHEET_VERTICES, big ? "float" : "double",
                  big ? "float" : "double", big ? "float" : "double", SHEET_FACES);
    for (int v = 0; v < SHEET_VERTICES; ++v) {
        const double xyz[3] = {sheet_at(v, 2, frame), sheet_at(v, 0, frame),
                               sheet_at(v, 1, frame)};
        if (form == SHEET_ASCII) {
            mote_text_add(&text, "7 %.17g %.17g %.17g\n", xyz[0], xyz[1], xyz[2]);
            continue;
        }
        sheet_put(&text, "\7", 1, big);
        for (int c = 0; c < 3; ++c) {
            if (big)
                sheet_put_float(&text, xyz[c], big);
            else
                sheet_put(&text, &xyz[c], sizeof xyz[c], big);
        }
    }
    if (form == SHEET_ASCII) {
        mote_text_add(&text, "3 2 0.5 0.25\n");
    } else {
        const int16_t a = 3;
        sheet_put(&text, &a, sizeof a, big);
        sheet_put(&text, "\2", 1, big);
        sheet_put_float(&text, 0.5, big);
        sheet_put_float(&text, 0.25, big);
    }
    for (int f = 0; f < SHEET_FACES; ++f) {
        int k[3];
        sheet_face(f, k);
        if (form == SHEET_ASCII) {
            mote_text_add(&text, "3 %d %d %d\n", k[0], k[1], k[2]);
            continue;
        }
        sheet_put(&text, "\3", 1, big);
        for (int c = 0; c < 3; ++c)
            sheet_put_int(&text, k[c], big);
    }
    sheet_save(path, &text);
}

static inline void sheet_put_positions(mote_text *text, int frames, bool big)
{
    for (int k = 1; k <= frames; ++k) {
        for (int i = 0; i < 3 * SHEET_VERTICES; ++i)
            sheet_put_float(text, sheet_at(i / 3, i % 3, k), big);
    }
}

static inline void sheet_write_pc2(const char *path, int frames, bool big)
{
    mote_text text = {0};
    for (const char *c = "POINTCACHE2"; *c; ++c)
        sheet_put(&text, c, 1, big);
    sheet_put(&text, "", 1, big);
    sheet_put_int(&text, 1, big);
    sheet_put_int(&text, SHEET_VERTICES, big);
    sheet_put_float(&text, 7, big);
    sheet_put_float(&text, 0.5, big);
    sheet_put_int(&text, frames, big);
    sheet_put_positions(&text, frames, big);
    sheet_save(path, &text);
}

static inline void sheet_write_mdd(const char *path, int frames, bool big)
{
    mote_text text = {0};
    sheet_put_int(&text, frames, big);
    sheet_put_int(&text, SHEET_VERTICES, big);
    for (int k = 0; k < frames; ++k)
        sheet_put_float(&text, k / 24.0, big);
    sheet_put_positions(&text, frames, big);
    sheet_save(path, &text);
}

#endif
