#include "harness/base/json_memory.h"

#include "harness/base/memory.h"

#include <jansson.h>
#include <stdlib.h>

static void *allocate(size_t size)
{
    return mote_resize(NULL, size, 1);
}

void mote_json_use_memory(void)
{
    json_set_alloc_funcs(allocate, free);
}
