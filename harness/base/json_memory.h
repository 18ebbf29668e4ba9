/* jansson when memory runs out: its parser does not look whether a token's text could grow, and
   reads and writes past its end then (2.14), and json_dumps leaves out a key without a word. */
#ifndef MOTE_HARNESS_JSON_MEMORY_H
#define MOTE_HARNESS_JSON_MEMORY_H

/* From now on memory that runs out within jansson ends the process, as in memory.h. Once,
   before anything is made of JSON. */
void mote_json_use_memory(void);

#endif
