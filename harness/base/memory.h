/* Memory for the program: an allocation that fails ends the process with one line and an exit
   status of its own, so callers need not check. Finished files are complete by then, and the
   run can be resumed. core/ is a library and returns MOTE_ENOMEM instead. All blocks are
   released by free. */
#ifndef MOTE_HARNESS_MEMORY_H
#define MOTE_HARNESS_MEMORY_H

#include <stddef.h>

/* count elements of size bytes, all 0. Never NULL, even for 0 bytes. */
void *mote_allocate(size_t count, size_t size);

/* The block (or NULL) resized to count elements of size bytes; new bytes are undefined. Never
   NULL. */
void *mote_resize(void *block, size_t count, size_t size);

/* The block with room for at least `needed` elements of size bytes. When it grows, it grows to
   twice that. *capacity is how many elements fit; it starts as 0 with a NULL block. */
void *mote_reserve(void *block, size_t needed, size_t *capacity, size_t size);

/* A copy of size bytes; a copy of a text. */
void *mote_copy(const void *data, size_t size);
char *mote_duplicate(const char *text);

/* Prints "mote: out of memory ..." to stderr, or calls the function set below, and ends the
   process with MOTE_EXIT_OUT_OF_MEMORY. Stream buffers are not flushed. bytes: how many were
   asked for; 0: unknown. */
_Noreturn void mote_out_of_memory(size_t bytes);

/* tell is called once instead of printing the line; it may end the process itself. It must not
   allocate. NULL restores the line. */
void mote_out_of_memory_tell(void (*tell)(const char *text));

#endif
