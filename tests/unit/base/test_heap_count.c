#include "harness/base/heap_count.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SANITIZED 1
#endif
#endif
#ifndef SANITIZED
#define SANITIZED 0
#endif

/* Lets results escape, so that the compiler cannot remove the calls. */
static void *volatile sink;

static void skip_if_not_counted(void)
{
    if (!mote_heap_read().counted)
        skip();
}

/* All other tests here, and others that look at the heap, are skipped where it is not
   counted. */
TEST(heap_without_sanitizers_is_counted)
{
    assert_int_equal(mote_heap_read().counted, !SANITIZED);
}

TEST(heap_after_malloc_and_free_is_what_it_was)
{
    skip_if_not_counted();
    mote_heap before = mote_heap_read();
    sink = malloc(100000);
    mote_heap during = mote_heap_read();
    free(sink);
    mote_heap after = mote_heap_read();
    assert_true(during.live_bytes - before.live_bytes >= 100000);
    assert_true(during.live_bytes - before.live_bytes < 110000);
    assert_int_equal(during.allocations - before.allocations, 1);
    assert_int_equal(after.live_bytes, before.live_bytes);
}

TEST(heap_counts_every_allocating_function)
{
    skip_if_not_counted();
    void *blocks[5] = {NULL};
    mote_heap before = mote_heap_read();
    blocks[0] = calloc(10, 1000);
    blocks[1] = realloc(NULL, 10000);
    blocks[2] = aligned_alloc(64, 10048);
    assert_int_equal(posix_memalign(&blocks[3], 64, 10000), 0);
    blocks[4] = strdup("text");
    mote_heap during = mote_heap_read();
    for (int i = 0; i < 5; ++i) {
        assert_non_null(blocks[i]);
        free(blocks[i]);
    }
    assert_int_equal(during.allocations - before.allocations, 5);
    assert_true(during.live_bytes - before.live_bytes >= 40048);
    assert_int_equal(mote_heap_read().live_bytes, before.live_bytes);
}

TEST(heap_after_realloc_holds_the_new_size_only)
{
    skip_if_not_counted();
    mote_heap before = mote_heap_read();
    sink = malloc(1000);
    sink = realloc(sink, 500000);
    assert_true(mote_heap_read().live_bytes - before.live_bytes < 510000);
    sink = realloc(sink, 10);
    assert_true(mote_heap_read().live_bytes - before.live_bytes < 10000);
    free(sink);
    assert_int_equal(mote_heap_read().live_bytes, before.live_bytes);
}

/* A failed allocation is not counted, and the existing block stays counted. */
TEST(heap_of_calls_that_fail_is_what_it_was)
{
    skip_if_not_counted();
    const size_t too_much = PTRDIFF_MAX;
    void *block = malloc(1000), *none = &block;
    assert_non_null(block);
    const mote_heap before = mote_heap_read();
    sink = malloc(too_much);
    assert_null(sink);
    sink = realloc(block, too_much);
    assert_null(sink);
    assert_int_equal(posix_memalign(&none, 64, too_much), ENOMEM);
    static const size_t bad[] = {0, 4, 24};
    for (int k = 0; k < 3; ++k)
        assert_int_equal(posix_memalign(&none, bad[k], 100), EINVAL);
    assert_ptr_equal(none, &block); /* untouched */
    free(NULL);
    const mote_heap after = mote_heap_read();
    assert_int_equal(after.live_bytes, before.live_bytes);
    assert_int_equal(after.allocations, before.allocations);
    free(block);
}

TEST(heap_peak_is_kept_until_reset)
{
    skip_if_not_counted();
    mote_heap_reset_peak();
    mote_heap before = mote_heap_read();
    sink = malloc(300000);
    free(sink);
    assert_true(mote_heap_read().peak_bytes - before.live_bytes >= 300000);
    mote_heap_reset_peak();
    assert_int_equal(mote_heap_read().peak_bytes, mote_heap_read().live_bytes);
}
