/* jansson when memory runs out. Its parser does not look whether a token's text could grow, and
   reads and writes past its end then (2.14); its other functions tell of it only where they are
   asked, and json_dumps leaves out a key without a word. */
#ifndef MOTE_HARNESS_JSON_MEMORY_H
#define MOTE_HARNESS_JSON_MEMORY_H

#include <jansson.h>
#include <stdbool.h>

/* From now on jansson's memory is watched, for the two functions below. Once, before anything
   is made of JSON; all of it in one thread. */
void mote_json_heed_memory(void);

/* Whether memory ran out since this was last asked: what was made of JSON since may lack a
   part. */
bool mote_json_memory_short(void);

/* json_loadb, which ends, NULL, as soon as memory runs out, with nothing left of what it made.
 */
json_t *mote_json_load(const char *text, size_t size, size_t flags, json_error_t *error);

#endif
