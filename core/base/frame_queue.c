#include "core/base/frame_queue.h"

#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>

struct mote_frame_queue {
    size_t places;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    uint64_t written, released; /* frames so far */
    uint64_t taken;
    bool closed, cancelled;
};

mote_status mote_frame_queue_create(size_t places, mote_frame_queue **queue)
{
    if (places < 1)
        return mote_fail(MOTE_EINVAL, "a queue needs at least 1 frame, not 0");
    mote_frame_queue *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a queue of frames");
    made->places = places;
    (void)pthread_mutex_init(&made->lock, NULL);
    (void)pthread_cond_init(&made->changed, NULL);
    *queue = made;
    return MOTE_OK;
}

void mote_frame_queue_destroy(mote_frame_queue *queue)
{
    if (!queue)
        return;
    (void)pthread_cond_destroy(&queue->changed);
    (void)pthread_mutex_destroy(&queue->lock);
    free(queue);
}

bool mote_frame_queue_reserve(mote_frame_queue *queue, size_t *place)
{
    (void)pthread_mutex_lock(&queue->lock);
    while (!queue->cancelled && queue->written - queue->released >= queue->places)
        (void)pthread_cond_wait(&queue->changed, &queue->lock);
    const bool free_place = !queue->cancelled;
    *place = (size_t)(queue->written % queue->places);
    (void)pthread_mutex_unlock(&queue->lock);
    return free_place;
}

/* Each thread waits only for the other, so that one signal wakes the right one. */
static void signal_and_unlock(mote_frame_queue *queue)
{
    (void)pthread_cond_signal(&queue->changed);
    (void)pthread_mutex_unlock(&queue->lock);
}

void mote_frame_queue_commit(mote_frame_queue *queue)
{
    (void)pthread_mutex_lock(&queue->lock);
    ++queue->written;
    signal_and_unlock(queue);
}

void mote_frame_queue_close(mote_frame_queue *queue)
{
    (void)pthread_mutex_lock(&queue->lock);
    queue->closed = true;
    signal_and_unlock(queue);
}

bool mote_frame_queue_take(mote_frame_queue *queue, size_t *place)
{
    (void)pthread_mutex_lock(&queue->lock);
    while (!queue->closed && queue->taken == queue->written)
        (void)pthread_cond_wait(&queue->changed, &queue->lock);
    const bool any = queue->taken < queue->written;
    *place = (size_t)(queue->taken % queue->places);
    queue->taken += any;
    (void)pthread_mutex_unlock(&queue->lock);
    return any;
}

void mote_frame_queue_release(mote_frame_queue *queue)
{
    (void)pthread_mutex_lock(&queue->lock);
    ++queue->released;
    signal_and_unlock(queue);
}

void mote_frame_queue_cancel(mote_frame_queue *queue)
{
    (void)pthread_mutex_lock(&queue->lock);
    queue->cancelled = true;
    signal_and_unlock(queue);
}
