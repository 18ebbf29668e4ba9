/* What `mote mesh` says of a file that can move. */
#ifndef MOTE_HARNESS_CHARACTER_FACTS_H
#define MOTE_HARNESS_CHARACTER_FACTS_H

#include "core/base/status.h"

#include <jansson.h>

/* Reads the file at path as a character and prints lines; nothing where it cannot move, and a
   line with the reason where it is wrong as a character. */
void mote_character_facts_print(const char *path);

/* The same as an object; null where it cannot move, {"error": ...} where it is wrong. */
json_t *mote_character_facts_json(const char *path);

#endif
