/* Counts this process's heap: malloc, calloc, realloc and free of the program count each call
   and pass it on to the C library. Allocations by C++ operator new and by libraries are
   included. */
#ifndef MOTE_HARNESS_HEAP_COUNT_H
#define MOTE_HARNESS_HEAP_COUNT_H

#include <stdbool.h>
#include <stdint.h>

typedef struct mote_heap {
    bool counted;         /* false where sanitizers own the allocator: everything else is then
                             0 */
    int64_t live_bytes;   /* usable bytes of the blocks in use */
    int64_t peak_bytes;   /* the most live bytes since the last mote_heap_reset_peak */
    uint64_t allocations; /* blocks handed out since the process started */
} mote_heap;

/* May be called from any thread; does not allocate. */
mote_heap mote_heap_read(void);

/* Sets the peak to the live bytes. */
void mote_heap_reset_peak(void);

#endif
