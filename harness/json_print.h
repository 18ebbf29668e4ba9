/* JSON as a person would write it: what fits on a line stays on one. */
#ifndef MOTE_HARNESS_JSON_PRINT_H
#define MOTE_HARNESS_JSON_PRINT_H

#include "harness/file.h"

#include <jansson.h>
#include <stdbool.h>

/* From now on each call of jansson for memory that fails is remembered, until it is told by one
   of the functions below or by mote_json_parse: what was made of JSON since may lack a part,
   since jansson's own functions tell of it only where they are asked, and json_dumps leaves out
   a key without a word. Once, before anything is made of JSON. */
void mote_json_heed_memory(void);

/* Whether memory ran out since this was last asked. */
bool mote_json_memory_short(void);

/* json_dumps: value as text with jansson's flags, for the caller to free; NULL when memory ran
   out while the value or its text was made, and where value is NULL. */
char *mote_json_text(const json_t *value, size_t flags);

/* Appends value, indented by two spaces a level, numbers with `digits` significant digits,
   ended by a line feed. text fails where memory ran out since value was begun. */
void mote_json_print(const json_t *value, int digits, mote_text *text);

#endif
