#include "harness/base/json_memory.h"

#include <setjmp.h>
#include <stdlib.h>

/* A text being read: what jansson holds for it, and where to go on when memory runs out. */
typedef struct reading {
    void **blocks;
    size_t count, capacity;
    jmp_buf out_of_memory;
} reading;

static reading *current; /* or NULL */
static bool memory_short;

static bool remember(reading *r, void *block)
{
    if (r->count == r->capacity) {
        const size_t capacity = r->capacity ? 2 * r->capacity : 256;
        void **blocks = realloc(r->blocks, capacity * sizeof *blocks);
        if (!blocks)
            return false;
        r->blocks = blocks;
        r->capacity = capacity;
    }
    r->blocks[r->count++] = block;
    return true;
}

static void *allocate(size_t size)
{
    void *block = malloc(size);
    if (block && (!current || remember(current, block)))
        return block;
    free(block);
    memory_short = true;
    if (current)
        longjmp(current->out_of_memory, 1);
    return NULL;
}

/* What is released while a text is read was mostly made a moment ago. */
static void release(void *block)
{
    for (size_t i = current ? current->count : 0; i-- > 0;) {
        if (current->blocks[i] == block) {
            current->blocks[i] = current->blocks[--current->count];
            break;
        }
    }
    free(block);
}

void mote_json_heed_memory(void)
{
    json_set_alloc_funcs(allocate, release);
}

bool mote_json_memory_short(void)
{
    const bool was = memory_short;
    memory_short = false;
    return was;
}

json_t *mote_json_load(const char *text, size_t size, size_t flags, json_error_t *error)
{
    static reading r;
    json_t *volatile root = NULL;
    r.count = 0;
    if (setjmp(r.out_of_memory) == 0) {
        current = &r;
        root = json_loadb(text, size, flags, error);
    } else {
        while (r.count > 0)
            free(r.blocks[--r.count]);
    }
    current = NULL;
    free(r.blocks);
    r.blocks = NULL;
    r.capacity = 0;
    return root;
}
