/* A pool of threads that share out a loop. */
#ifndef MOTE_CORE_POOL_H
#define MOTE_CORE_POOL_H

#include "core/base/status.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* At most so many threads. */
#define MOTE_POOL_MAX 256u

typedef struct mote_pool mote_pool;

/* Does items first .. end - 1. worker: 0 .. threads - 1, which of the threads does it; one
   worker does one range at a time. */
typedef void (*mote_pool_work)(void *context, uint32_t worker, size_t first, size_t end);

/* threads: 1 .. MOTE_POOL_MAX, the calling thread among them, so that threads - 1 are started.
   MOTE_EINVAL, MOTE_ENOMEM when the system gives no more of them. */
mote_status mote_pool_create(uint32_t threads, mote_pool **pool);

/* NULL is allowed. */
void mote_pool_destroy(mote_pool *pool);

uint32_t mote_pool_threads(const mote_pool *pool);

/* Has items 0 .. count - 1 done, grain >= 1 at a time, by whichever thread is free, and returns
   when all are. One caller at a time; work must not call it. No allocation. */
void mote_pool_run(mote_pool *pool, mote_pool_work work, void *context, size_t count,
                   size_t grain);

#ifdef __cplusplus
}
#endif
#endif
