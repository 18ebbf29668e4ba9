#include "core/lazy.h"

#include <stdlib.h>

static uint32_t log2_at_least(uint32_t count)
{
    uint32_t bits = 4;
    while (bits < 31 && (1u << bits) < count)
        ++bits;
    return bits;
}

static void use_table(mote_lazy *lazy, mote_lazy_slot *slots, uint32_t bits)
{
    lazy->slots = slots;
    lazy->mask = (1u << bits) - 1;
    lazy->shift = 32 - bits;
    lazy->limit = 1u << (bits - 1);
}

mote_status mote_lazy_init(mote_lazy *lazy, const mote_body *body, uint32_t expected)
{
    if (expected > body->mesh->vertex_count)
        expected = body->mesh->vertex_count;
    const uint32_t bits = log2_at_least(2 * expected);
    mote_lazy_slot *slots = calloc((size_t)1 << bits, sizeof *slots);
    if (!slots)
        return mote_fail(MOTE_ENOMEM, "no memory for %u positions", 1u << bits);
    *lazy = (mote_lazy){.body = body};
    use_table(lazy, slots, bits);
    return MOTE_OK;
}

void mote_lazy_free(mote_lazy *lazy)
{
    free(lazy->slots);
    lazy->slots = NULL;
}

void mote_lazy_begin(mote_lazy *lazy, const mote_body_state *state, bool use_given)
{
    lazy->state = state;
    lazy->given = use_given ? state->vertices : NULL;
    lazy->filled = 0;
    if (++lazy->stamp == 0) { /* after 2^32 frames old stamps could be taken for new ones */
        for (uint32_t i = 0; i <= lazy->mask; ++i)
            lazy->slots[i].stamp = 0;
        lazy->stamp = 1;
    }
}

static uint32_t free_index(const mote_lazy *lazy, uint32_t vertex)
{
    uint32_t index = (vertex * 2654435769u) >> lazy->shift;
    while (lazy->slots[index].stamp == lazy->stamp)
        index = (index + 1) & lazy->mask;
    return index;
}

static bool grow(mote_lazy *lazy)
{
    const uint32_t bits = 32 - lazy->shift + 1;
    mote_lazy_slot *slots = bits < 32 ? calloc((size_t)1 << bits, sizeof *slots) : NULL;
    if (!slots)
        return false;
    mote_lazy_slot *old = lazy->slots;
    const uint32_t old_mask = lazy->mask;
    use_table(lazy, slots, bits);
    for (uint32_t i = 0; i <= old_mask; ++i) {
        if (old[i].stamp == lazy->stamp)
            slots[free_index(lazy, old[i].vertex)] = old[i];
    }
    free(old);
    return true;
}

mote_vec3 mote_lazy_fill(mote_lazy *lazy, uint32_t vertex, uint32_t index)
{
    const mote_vec3 position = mote_body_position(lazy->body, lazy->state, vertex);
    ++lazy->evaluated;
    if (lazy->filled >= lazy->limit) {
        if (!grow(lazy))
            return position;
        index = free_index(lazy, vertex);
    }
    lazy->slots[index] = (mote_lazy_slot){vertex, lazy->stamp, position};
    ++lazy->filled;
    return position;
}
