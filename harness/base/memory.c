#include "harness/base/memory.h"

#include "harness/base/options.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void (*tell_instead)(const char *text);

void mote_out_of_memory_tell(void (*tell)(const char *text))
{
    tell_instead = tell;
}

void mote_out_of_memory(size_t bytes)
{
    char asked[48] = "", text[192];
    if (bytes > 0)
        (void)snprintf(asked, sizeof asked, " for another %zu bytes", bytes);
    (void)snprintf(text, sizeof text,
                   "out of memory%s; use a machine with more, or ask for less at a time: what "
                   "was finished is kept",
                   asked);
    if (tell_instead)
        tell_instead(text);
    else
        (void)fprintf(stderr, "mote: %s\n", text);
    _exit(MOTE_EXIT_OUT_OF_MEMORY);
}

void *mote_allocate(size_t count, size_t size)
{
    void *block = calloc(count > 0 ? count : 1, size > 0 ? size : 1);
    if (!block)
        mote_out_of_memory(size > 0 && count > SIZE_MAX / size ? SIZE_MAX : count * size);
    return block;
}

void *mote_resize(void *block, size_t count, size_t size)
{
    const bool too_many = size > 0 && count > SIZE_MAX / size;
    const size_t bytes = count * size;
    void *resized = too_many ? NULL : realloc(block, bytes > 0 ? bytes : 1);
    if (!resized)
        mote_out_of_memory(too_many ? SIZE_MAX : bytes);
    return resized;
}

void *mote_reserve(void *block, size_t needed, size_t *capacity, size_t size)
{
    if (block && needed <= *capacity)
        return block;
    *capacity = needed < SIZE_MAX / 2 ? 2 * needed : needed;
    return mote_resize(block, *capacity, size);
}

void *mote_copy(const void *data, size_t size)
{
    void *copy = mote_allocate(1, size);
    memcpy(copy, data, size);
    return copy;
}

char *mote_duplicate(const char *text)
{
    return mote_copy(text, strlen(text) + 1);
}
