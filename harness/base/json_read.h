/* Reads a JSON file strictly: every error names the file, the line and the path within it. */
#ifndef MOTE_HARNESS_JSON_READ_H
#define MOTE_HARNESS_JSON_READ_H

#include "core/base/status.h"
#include "core/base/vec3.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct mote_json_file {
    char *path;
    char *text;
    json_t *root;
    bool own; /* written by this program from files its user named: it may name any file */
} mote_json_file;

/* A value in a file. value is NULL where an optional key is absent. */
typedef struct mote_json {
    const mote_json_file *file; /* borrowed */
    json_t *value;              /* borrowed */
    char path[160];             /* "bodies[1].field.support"; "" at the root */
} mote_json;

/* The largest file that mote_json_open reads, in bytes. */
#define MOTE_JSON_LIMIT ((size_t)16 << 20)

/* Parses a whole JSON text; a duplicate key is an error. path is for the message: MOTE_EINVAL
   with "PATH:LINE:COLUMN: what; ADVICE". The caller decrefs *root. */
mote_status mote_json_parse(const char *path, const char *text, size_t size, const char *advice,
                            json_t **root);

/* Reads and parses a file of at most MOTE_JSON_LIMIT; a duplicate key is an error. MOTE_EINVAL
   with "FILE:LINE:COLUMN: what", MOTE_EIO. Close with mote_json_close. */
mote_status mote_json_open(const char *path, mote_json_file *file);
void mote_json_close(mote_json_file *file);
mote_json mote_json_root(const mote_json_file *file);

/* MOTE_EINVAL with "FILE:LINE: PATH: TEXT"; the line is that of the value. */
mote_status mote_json_fail(const mote_json *node, const char *format, ...) MOTE_PRINTF(2, 3);

/* The same with what the value is and what would be right: "is null; give RIGHT". */
mote_status mote_json_refuse(const mote_json *node, const char *right);

/* Puts the node's place before the error text of a failure that its value caused, unless it
   begins with a place in this file; the status becomes MOTE_EINVAL. MOTE_OK and MOTE_ENOMEM
   stay as they are. */
mote_status mote_json_blame(const mote_json *node, mote_status status);

/* The member of an object, or a node without a value. */
mote_json mote_json_member(const mote_json *object, const char *key);
/* The element of an array, index < json_array_size(array->value). */
mote_json mote_json_element(const mote_json *array, size_t index);

/* Checks that the node is an object with keys from known ("a|b|c") only. */
mote_status mote_json_object(const mote_json *node, const char *known);

/* Checks that the node is an array of minimum to maximum elements; *size is their number. */
mote_status mote_json_array(const mote_json *node, size_t minimum, size_t maximum,
                            size_t *size);

/* A number in [minimum, maximum], finite. */
mote_status mote_json_real(const mote_json *node, double minimum, double maximum,
                           double *value);
/* A whole number in [minimum, maximum], also if it is written as 2.0. */
mote_status mote_json_integer(const mote_json *node, int64_t minimum, int64_t maximum,
                              int64_t *value);
/* An array of exactly count numbers. */
mote_status mote_json_reals(const mote_json *node, size_t count, double minimum, double maximum,
                            double *values);
mote_status mote_json_vec3(const mote_json *node, double minimum, double maximum,
                           mote_vec3 *value);
/* A number for all three axes, or an array of one for each. */
mote_status mote_json_number_or_vec3(const mote_json *node, double minimum, double maximum,
                                     mote_vec3 *value);
mote_status mote_json_boolean(const mote_json *node, bool *value);
/* A string that is not empty, borrowed from the file. */
mote_status mote_json_string(const mote_json *node, const char **value);

/* The line, from 1, on which the value at a path begins in a valid JSON text. If the path does
   not exist, the line of its deepest part that does. */
int mote_json_line(const char *text, const char *path);

#endif
