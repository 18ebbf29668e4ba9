/* Walks over memory that belong to no method: one that evicts the caches, and one that reads
   positions, which is what every method that is told them has to pay at least. */
#ifndef MOTE_HARNESS_MEMORY_PASS_H
#define MOTE_HARNESS_MEMORY_PASS_H

#include <stddef.h>

/* Memory larger than the caches that belong to one core. The caller frees it. */
volatile unsigned char *mote_evict_create(void);

/* Walks over it: what was in the caches is no longer. */
void mote_evict(volatile unsigned char *bytes);

/* The time of reading the positions of so many vertices once, three doubles each, from start to
   end: the median of several passes in ns, less the cost of the clock. evict: NULL for hot
   caches; otherwise walked over before each pass. */
double mote_read_pass_ns(size_t vertices, volatile unsigned char *evict);

#endif
