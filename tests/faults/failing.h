/* Makes the n-th allocation fail, for every n. The linker replaces libc's functions by those
   below (--wrap) in our own objects; tests/CMakeLists.txt names the tests. */
#ifndef MOTE_TESTS_FAILING_H
#define MOTE_TESTS_FAILING_H

#include "core/base/status.h"
#include "tests/support/test.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* Calls left before one fails; negative: none fails. */
static const long never = -1;
static long allocations_left = -1;
static long calls_failed; /* in all */

static inline bool is_due(long *left)
{
    if (*left < 0)
        return false;
    if ((*left)-- > 0)
        return false;
    ++calls_failed;
    return true;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

void *__wrap_malloc(size_t size)
{
    return is_due(&allocations_left) ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return is_due(&allocations_left) ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *old, size_t size)
{
    return is_due(&allocations_left) ? NULL : __real_realloc(old, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return is_due(&allocations_left) ? NULL : __real_aligned_alloc(alignment, size);
}

/* Runs work with its n-th allocation failing, for every n, until no allocation is left to fail.
   A run with a failure must either report MOTE_ENOMEM with a text or succeed anyway (a block
   that cannot be shrunk keeps its size); the run without one must succeed. */
static inline void fail_each_allocation(mote_status (*work)(void *), void *context,
                                        const char *what)
{
    for (long n = 0;; ++n) {
        assert_int_equal(mote_fail(MOTE_OK, "nothing said"), MOTE_OK);
        allocations_left = n;
        const mote_status status = work(context);
        const bool failed = allocations_left < 0;
        allocations_left = never;
        if (!failed) {
            if (status != MOTE_OK)
                fail_msg("%s: %s", what, mote_error_text());
            assert_true(n > 0);
            return;
        }
        if (status == MOTE_OK)
            continue;
        if (status != MOTE_ENOMEM)
            fail_msg("%s: allocation %ld failed, status %s: %s", what, n,
                     mote_status_text(status), mote_error_text());
        if (strcmp(mote_error_text(), "nothing said") == 0)
            fail_msg("%s: allocation %ld failed without a text", what, n);
    }
}

#endif
