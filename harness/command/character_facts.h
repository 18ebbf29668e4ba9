/* What `mote mesh` reports about a file that can move. */
#ifndef MOTE_HARNESS_CHARACTER_FACTS_H
#define MOTE_HARNESS_CHARACTER_FACTS_H

#include "core/base/status.h"

#include <jansson.h>

/* Reads the file at path as a character and prints lines; nothing if it cannot move, and a line
   with the reason if it is not a valid character. */
void mote_character_facts_print(const char *path);

/* The same as an object; null if it cannot move, {"error": ...} if it is invalid. */
json_t *mote_character_facts_json(const char *path);

#endif
