#include "harness/base/heap_count.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HEAP_OWNED_BY_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HEAP_OWNED_BY_SANITIZER 1
#endif
#endif

#ifdef HEAP_OWNED_BY_SANITIZER

mote_heap mote_heap_read(void)
{
    mote_heap heap = {0};
    return heap;
}

void mote_heap_reset_peak(void)
{
}

#else

#include <errno.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>

/* glibc exports these so that programs can replace malloc. */
/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *block);
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

/* Exported so that shared libraries use them, too. */
#define EXPORTED __attribute__((visibility("default")))

static _Atomic int64_t live_bytes, peak_bytes;
static _Atomic uint64_t allocations;

static void *count_in(void *block)
{
    if (!block)
        return NULL;
    int64_t size = (int64_t)malloc_usable_size(block);
    int64_t live = atomic_fetch_add_explicit(&live_bytes, size, memory_order_relaxed) + size;
    (void)atomic_fetch_add_explicit(&allocations, 1, memory_order_relaxed);
    int64_t peak = atomic_load_explicit(&peak_bytes, memory_order_relaxed);
    while (live > peak &&
           !atomic_compare_exchange_weak_explicit(&peak_bytes, &peak, live,
                                                  memory_order_relaxed, memory_order_relaxed)) {
    }
    return block;
}

static void count_out(size_t size)
{
    (void)atomic_fetch_sub_explicit(&live_bytes, (int64_t)size, memory_order_relaxed);
}

EXPORTED void *malloc(size_t size)
{
    return count_in(__libc_malloc(size));
}

EXPORTED void *calloc(size_t count, size_t size)
{
    return count_in(__libc_calloc(count, size));
}

EXPORTED void *realloc(void *block, size_t size)
{
    size_t before = block ? malloc_usable_size(block) : 0;
    void *moved = __libc_realloc(block, size);
    /* A realloc that fails frees nothing, but glibc's realloc(block, 0) frees and returns
       NULL. */
    if (moved || size == 0)
        count_out(before);
    return count_in(moved);
}

EXPORTED void free(void *block)
{
    if (!block)
        return;
    count_out(malloc_usable_size(block));
    __libc_free(block);
}

EXPORTED void *memalign(size_t alignment, size_t size)
{
    return count_in(__libc_memalign(alignment, size));
}

EXPORTED void *aligned_alloc(size_t alignment, size_t size)
{
    return count_in(__libc_memalign(alignment, size));
}

EXPORTED int posix_memalign(void **block, size_t alignment, size_t size)
{
    if (alignment % sizeof(void *) != 0 || alignment == 0 || (alignment & (alignment - 1)) != 0)
        return EINVAL;
    void *made = count_in(__libc_memalign(alignment, size));
    if (!made)
        return ENOMEM;
    *block = made;
    return 0;
}

mote_heap mote_heap_read(void)
{
    mote_heap heap = {
        .counted = true,
        .live_bytes = atomic_load_explicit(&live_bytes, memory_order_relaxed),
        .peak_bytes = atomic_load_explicit(&peak_bytes, memory_order_relaxed),
        .allocations = atomic_load_explicit(&allocations, memory_order_relaxed),
    };
    return heap;
}

void mote_heap_reset_peak(void)
{
    atomic_store_explicit(&peak_bytes, atomic_load_explicit(&live_bytes, memory_order_relaxed),
                          memory_order_relaxed);
}

#endif
