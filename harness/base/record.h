/* Files of a run directory: whole or absent. */
#ifndef MOTE_HARNESS_RECORD_H
#define MOTE_HARNESS_RECORD_H

#include "harness/base/file.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

/* Whether directory/name is there. */
bool mote_record_exists(const char *directory, const char *name);

/* Writes directory/name. Frees text. */
mote_status mote_record_text(const char *directory, const char *name, mote_text *text);

/* Writes directory/name, numbers with 17 digits, and decrefs object. An object that is NULL,
   as jansson returns for text that is not UTF-8, is MOTE_EINVAL. */
mote_status mote_record_json(const char *directory, const char *name, json_t *object);

/* Reads directory/name as JSON; MOTE_EINVAL with file, line and column when it is not. The
   caller decrefs. */
mote_status mote_record_read_json(const char *directory, const char *name, json_t **object);

/* A real, or null where it is not finite. */
json_t *mote_json_number(double value);

/* The number that a JSON value is, or that object[key] is; NaN where it is none. The text
   object[key]; "" where it is none. */
double mote_number_of(const json_t *value);
double mote_number_at(const json_t *object, const char *key);
const char *mote_text_at(const json_t *object, const char *key);

/* Prints object with jansson's flags and a line end, and decrefs it; NULL is MOTE_EINVAL as
   above. The caller checks out for errors. */
mote_status mote_json_put(json_t *object, size_t flags, FILE *out);

/* for each item of a JSON array, of none where it is no array: item is never NULL. */
#define MOTE_EACH(i, item, array)                                                              \
    for ((i) = 0; (i) < json_array_size(array) && ((item) = json_array_get(array, i), true);   \
         ++(i))

/* Indented, numbers with 17 digits. */
#define MOTE_JSON_FLAGS (JSON_INDENT(1) | JSON_REAL_PRECISION(17))

#endif
