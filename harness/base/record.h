/* Files of a run directory: complete or absent. */
#ifndef MOTE_HARNESS_RECORD_H
#define MOTE_HARNESS_RECORD_H

#include "harness/base/file.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

/* The largest cells/ID.pairs.csv that is read or copied, in bytes. No other file of a run is as
   large. */
#define MOTE_PAIRS_LIMIT ((size_t)1 << 32)

/* Whether directory/name is there. */
bool mote_record_exists(const char *directory, const char *name);

/* Whether from/name, the JSON of a cell or simulation, belongs into the directory `to`: it is
   missing there, or what is there failed and this one did not. */
bool mote_record_is_wanted(const char *from, const char *to, const char *name);

/* Writes directory/name. Frees text. */
mote_status mote_record_text(const char *directory, const char *name, mote_text *text);

/* Writes directory/name, numbers with 17 digits, and decrefs object. MOTE_EINVAL if object is
   NULL, which jansson returns for text that is not UTF-8. */
mote_status mote_record_json(const char *directory, const char *name, json_t *object);

/* Copies from/name, of at most MOTE_PAIRS_LIMIT bytes, to to/name. */
mote_status mote_record_copy(const char *from, const char *to, const char *name);

/* Reads directory/name as JSON; MOTE_EINVAL with file, line and column if it is not JSON. The
   caller decrefs. */
mote_status mote_record_read_json(const char *directory, const char *name, json_t **object);

/* A real, or null where it is not finite. */
json_t *mote_json_number(double value);

/* The number that a JSON value or object[key] is; NaN if it is not a number. The text
   object[key]; "" if it is not a string. */
double mote_number_of(const json_t *value);
double mote_number_at(const json_t *object, const char *key);
const char *mote_text_at(const json_t *object, const char *key);

/* Prints object with jansson's flags and a line end, and decrefs it; MOTE_EINVAL if object is
   NULL, as above. The caller checks out for errors. */
mote_status mote_json_put(json_t *object, size_t flags, FILE *out);

/* Iterates over the items of a JSON array, over nothing if it is not an array; item is never
   NULL. */
#define MOTE_EACH(i, item, array)                                                              \
    for ((i) = 0; (i) < json_array_size(array) && ((item) = json_array_get(array, i), true);   \
         ++(i))

/* Iterates over the members of a JSON object, over nothing if it is not an object; value is
   never NULL. */
#define MOTE_EACH_MEMBER(key, value, object)                                                   \
    for ((key) = json_object_iter_key(json_object_iter(object));                               \
         (key) && ((value) = json_object_iter_value(json_object_key_to_iter(key)), true);      \
         (key) = json_object_iter_key(                                                         \
             json_object_iter_next(object, json_object_key_to_iter(key))))

/* Indented, numbers with 17 digits. */
#define MOTE_JSON_FLAGS (JSON_INDENT(1) | JSON_REAL_PRECISION(17))

#endif
