#include "core/base/pool.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

typedef struct member {
    mote_pool *pool;
    uint32_t worker;
} member;

struct mote_pool {
    uint32_t threads, started;
    pthread_t *ids;  /* [threads - 1] */
    member *members; /* [threads - 1] */
    pthread_mutex_t lock;
    pthread_cond_t begin, end;
    /* Under the lock: */
    uint64_t loop; /* how many loops were begun */
    uint32_t busy; /* threads that have not finished it yet */
    bool closing;
    /* Set before a loop begins: */
    mote_pool_work work;
    void *context;
    size_t count, grain;
    atomic_size_t next; /* the first item that no thread has taken */
};

static void run_share(mote_pool *pool, uint32_t worker)
{
    for (;;) {
        const size_t first =
            atomic_fetch_add_explicit(&pool->next, pool->grain, memory_order_relaxed);
        if (first >= pool->count)
            return;
        const size_t left = pool->count - first;
        pool->work(pool->context, worker, first,
                   first + (left < pool->grain ? left : pool->grain));
    }
}

static void *serve(void *argument)
{
    const member *self = argument;
    mote_pool *pool = self->pool;
    uint64_t seen = 0;
    (void)pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (pool->loop == seen && !pool->closing)
            (void)pthread_cond_wait(&pool->begin, &pool->lock);
        if (pool->closing)
            break;
        seen = pool->loop;
        (void)pthread_mutex_unlock(&pool->lock);
        run_share(pool, self->worker);
        (void)pthread_mutex_lock(&pool->lock);
        if (--pool->busy == 0)
            (void)pthread_cond_signal(&pool->end);
    }
    (void)pthread_mutex_unlock(&pool->lock);
    return NULL;
}

static mote_status start_threads(mote_pool *pool)
{
    for (uint32_t i = 0; i + 1 < pool->threads; ++i) {
        pool->members[i] = (member){pool, i + 1};
        if (pthread_create(&pool->ids[i], NULL, serve, &pool->members[i]) != 0)
            return mote_fail(MOTE_ENOMEM, "only %u of %u threads could be started", i + 1,
                             pool->threads);
        ++pool->started;
    }
    return MOTE_OK;
}

mote_status mote_pool_create(uint32_t threads, mote_pool **pool)
{
    if (threads < 1 || threads > MOTE_POOL_MAX)
        return mote_fail(MOTE_EINVAL, "%u threads is out of range; give 1 to %u", threads,
                         MOTE_POOL_MAX);
    mote_pool *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a pool of threads");
    (void)pthread_mutex_init(&made->lock, NULL);
    (void)pthread_cond_init(&made->begin, NULL);
    (void)pthread_cond_init(&made->end, NULL);
    made->threads = threads;
    made->ids = calloc(threads, sizeof *made->ids);
    made->members = calloc(threads, sizeof *made->members);
    mote_status status = made->ids && made->members
                             ? start_threads(made)
                             : mote_fail(MOTE_ENOMEM, "no memory for %u threads", threads);
    if (status == MOTE_OK)
        *pool = made;
    else
        mote_pool_destroy(made);
    return status;
}

void mote_pool_destroy(mote_pool *pool)
{
    if (!pool)
        return;
    (void)pthread_mutex_lock(&pool->lock);
    pool->closing = true;
    (void)pthread_cond_broadcast(&pool->begin);
    (void)pthread_mutex_unlock(&pool->lock);
    for (uint32_t i = 0; i < pool->started; ++i)
        (void)pthread_join(pool->ids[i], NULL);
    (void)pthread_cond_destroy(&pool->begin);
    (void)pthread_cond_destroy(&pool->end);
    (void)pthread_mutex_destroy(&pool->lock);
    free(pool->ids);
    free(pool->members);
    free(pool);
}

uint32_t mote_pool_threads(const mote_pool *pool)
{
    return pool->threads;
}

void mote_pool_run(mote_pool *pool, mote_pool_work work, void *context, size_t count,
                   size_t grain)
{
    pool->work = work;
    pool->context = context;
    pool->count = count;
    pool->grain = grain;
    atomic_store_explicit(&pool->next, 0, memory_order_relaxed);
    const bool alone = pool->started == 0 || count <= grain;
    if (!alone) {
        (void)pthread_mutex_lock(&pool->lock);
        ++pool->loop;
        pool->busy = pool->started;
        (void)pthread_cond_broadcast(&pool->begin);
        (void)pthread_mutex_unlock(&pool->lock);
    }
    run_share(pool, 0);
    if (alone)
        return;
    (void)pthread_mutex_lock(&pool->lock);
    while (pool->busy > 0)
        (void)pthread_cond_wait(&pool->end, &pool->lock);
    (void)pthread_mutex_unlock(&pool->lock);
}
