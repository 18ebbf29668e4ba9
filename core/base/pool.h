/* A pool of threads that share the iterations of a loop. */
#ifndef MOTE_CORE_POOL_H
#define MOTE_CORE_POOL_H

#include "core/base/status.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* At most this many threads. */
#define MOTE_POOL_MAX 256u

typedef struct mote_pool mote_pool;

/* Processes items first .. end - 1. worker: the thread that does it, 0 .. threads - 1; a worker
   processes one range at a time. */
typedef void (*mote_pool_work)(void *context, uint32_t worker, size_t first, size_t end);

/* threads: 1 .. MOTE_POOL_MAX, the calling thread among them, so that threads - 1 are started.
   MOTE_EINVAL, MOTE_ENOMEM when the system cannot start them. */
mote_status mote_pool_create(uint32_t threads, mote_pool **pool);

/* NULL is allowed. */
void mote_pool_destroy(mote_pool *pool);

uint32_t mote_pool_threads(const mote_pool *pool);

/* Processes items 0 .. count - 1, in ranges of grain >= 1 items by whichever thread is free;
   returns when all are done. One caller at a time; work must not call it. No allocation. */
void mote_pool_run(mote_pool *pool, mote_pool_work work, void *context, size_t count,
                   size_t grain);

#ifdef __cplusplus
}
#endif
#endif
