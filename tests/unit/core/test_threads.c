/* The pool of threads and the queue of frames. */
#include "core/base/frame_queue.h"
#include "core/base/pool.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define ITEMS 10007

typedef struct tally {
    uint32_t done[ITEMS]; /* how often each item was processed */
    uint32_t threads;
    size_t count, grain;
    int bad;
} tally;

static void count_items(void *context, uint32_t worker, size_t first, size_t end)
{
    tally *t = context;
    if (worker >= t->threads || first >= end || end > t->count || end - first > t->grain)
        t->bad = 1;
    for (size_t i = first; i < end; ++i)
        ++t->done[i];
}

TEST(mote_pool_run_any_threads_does_each_item_once)
{
    static const uint32_t threads[] = {1, 2, 3, 16};
    static const size_t counts[] = {0, 1, 5, 64, ITEMS}, grains[] = {1, 7, 20000};
    static tally t;
    for (size_t a = 0; a < 4; ++a) {
        mote_pool *pool = NULL;
        assert_int_equal(mote_pool_create(threads[a], &pool), MOTE_OK);
        assert_int_equal(mote_pool_threads(pool), threads[a]);
        for (size_t k = 0; k < 15 * 8; ++k) { /* repeated: no loop takes items of another */
            memset(&t, 0, sizeof t);
            t.threads = threads[a];
            t.count = counts[k % 5];
            t.grain = grains[k / 5 % 3];
            mote_pool_run(pool, count_items, &t, t.count, t.grain);
            assert_int_equal(t.bad, 0);
            for (size_t i = 0; i < ITEMS; ++i)
                assert_int_equal(t.done[i], i < t.count);
        }
        mote_pool_destroy(pool);
    }
    mote_pool_destroy(NULL);
}

TEST(mote_pool_create_bad_number_is_refused)
{
    mote_pool *pool = NULL;
    assert_int_equal(mote_pool_create(0, &pool), MOTE_EINVAL);
    assert_int_equal(mote_pool_create(MOTE_POOL_MAX + 1, &pool), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "give 1 to 256"));
    assert_null(pool);
}

#define PLACES 3

typedef struct stream {
    mote_frame_queue *queue;
    uint64_t frames[PLACES];
    uint64_t count; /* number to write */
    uint64_t written;
} stream;

static void *write_frames(void *argument)
{
    stream *s = argument;
    size_t place;
    for (; s->written < s->count && mote_frame_queue_reserve(s->queue, &place); ++s->written) {
        s->frames[place] = 1000 + s->written;
        mote_frame_queue_commit(s->queue);
    }
    mote_frame_queue_close(s->queue);
    return NULL;
}

/* Reads at most `wanted` frames while another thread writes; returns how many came. */
static uint64_t read_frames(stream *s, uint64_t wanted)
{
    pthread_t writer;
    uint64_t read = 0;
    size_t place;
    assert_int_equal(pthread_create(&writer, NULL, write_frames, s), 0);
    while (read < wanted && mote_frame_queue_take(s->queue, &place)) {
        assert_int_equal(s->frames[place], 1000 + read);
        ++read;
        mote_frame_queue_release(s->queue);
    }
    if (read == wanted)
        mote_frame_queue_cancel(s->queue);
    assert_int_equal(pthread_join(writer, NULL), 0);
    return read;
}

TEST(mote_frame_queue_all_frames_arrive_in_order)
{
    for (size_t places = 1; places <= PLACES; ++places) {
        stream s = {.count = 5000};
        assert_int_equal(mote_frame_queue_create(places, &s.queue), MOTE_OK);
        assert_int_equal(read_frames(&s, UINT64_MAX), 5000);
        assert_int_equal(s.written, 5000);
        mote_frame_queue_destroy(s.queue);
    }
}

TEST(mote_frame_queue_cancelled_reader_ends_the_writer)
{
    stream s = {.count = UINT64_MAX};
    assert_int_equal(mote_frame_queue_create(PLACES, &s.queue), MOTE_OK);
    assert_int_equal(read_frames(&s, 100), 100);
    assert_true(s.written >= 100 && s.written <= 100 + PLACES);
    mote_frame_queue_destroy(s.queue);
}

TEST(mote_frame_queue_no_frames_ends_the_reader)
{
    stream s = {.count = 0};
    assert_int_equal(mote_frame_queue_create(PLACES, &s.queue), MOTE_OK);
    assert_int_equal(read_frames(&s, UINT64_MAX), 0);
    mote_frame_queue_destroy(s.queue);
    mote_frame_queue_destroy(NULL);
    assert_int_equal(mote_frame_queue_create(0, &s.queue), MOTE_EINVAL);
}
