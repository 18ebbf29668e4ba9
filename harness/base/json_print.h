/* JSON as a person would write it: what fits on a line stays on one. */
#ifndef MOTE_HARNESS_JSON_PRINT_H
#define MOTE_HARNESS_JSON_PRINT_H

#include "harness/base/file.h"

#include <jansson.h>

/* Appends value, indented by two spaces a level, numbers with `digits` significant digits,
   ended by a line feed. */
void mote_json_print(const json_t *value, int digits, mote_text *text);

#endif
