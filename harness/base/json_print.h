/* JSON as a person would write it: what fits on a line stays on one. */
#ifndef MOTE_HARNESS_JSON_PRINT_H
#define MOTE_HARNESS_JSON_PRINT_H

#include "harness/base/file.h"

#include <jansson.h>

/* json_dumps: value as text with jansson's flags, for the caller to free; NULL when memory ran
   out while the value or its text was made, and where value is NULL. */
char *mote_json_text(const json_t *value, size_t flags);

/* Appends value, indented by two spaces a level, numbers with `digits` significant digits,
   ended by a line feed. text fails where memory ran out since value was begun. */
void mote_json_print(const json_t *value, int digits, mote_text *text);

#endif
