/* JSON as a person would write it: a value that fits on a line stays on one. */
#ifndef MOTE_HARNESS_JSON_PRINT_H
#define MOTE_HARNESS_JSON_PRINT_H

#include "harness/base/file.h"

#include <jansson.h>

/* Appends value and a line feed, indented by two spaces per level, numbers with `digits`
   significant digits. */
void mote_json_print(const json_t *value, int digits, mote_text *text);

#endif
