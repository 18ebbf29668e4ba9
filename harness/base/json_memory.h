/* Guards against jansson's behaviour when memory runs out: its parser (2.14) does not check
   whether the buffer of a token could grow and then reads and writes past its end; json_dumps
   silently leaves out a key. */
#ifndef MOTE_HARNESS_JSON_MEMORY_H
#define MOTE_HARNESS_JSON_MEMORY_H

/* From now on an allocation that fails within jansson ends the process, as in memory.h. Call it
   once, before any other function of jansson. */
void mote_json_use_memory(void);

#endif
