/* Memory for the program: an allocation that fails ends the process with one line and an
   exit status of its own, so that callers need not check. Finished files are whole by then,
   and a run goes on where it stopped. core/ is a library and returns MOTE_ENOMEM instead.
   All blocks are released by free. */
#ifndef MOTE_HARNESS_MEMORY_H
#define MOTE_HARNESS_MEMORY_H

#include <stddef.h>

/* count elements of size bytes, all 0. Never NULL, also for no bytes. */
void *mote_allocate(size_t count, size_t size);

/* The block (or NULL) with room for count elements of size bytes; what is new is undefined.
   Never NULL. */
void *mote_resize(void *block, size_t count, size_t size);

/* The block with room for at least `needed` elements of size bytes; where it grows it grows to
   twice that, and *capacity, which starts as 0 with a NULL block, says how many fit. */
void *mote_reserve(void *block, size_t needed, size_t *capacity, size_t size);

/* A copy of size bytes, of a text. */
void *mote_copy(const void *data, size_t size);
char *mote_duplicate(const char *text);

/* Prints "mote: out of memory ..." to stderr, or calls the function set below, and ends the
   process with MOTE_EXIT_OUT_OF_MEMORY. What is in the buffers of streams is not written.
   bytes: how many were asked for; 0: unknown. */
_Noreturn void mote_out_of_memory(size_t bytes);

/* tell is called once, instead of printing the line; it may end the process itself. It must
   not allocate. NULL: the line. */
void mote_out_of_memory_tell(void (*tell)(const char *text));

#endif
