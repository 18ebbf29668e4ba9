#include "core/pairs.h"

/* Two candidates whose vertices are within a ring of each other lead to the same minimum. */
static bool alike(const mote_pair *c, const mote_pair *d)
{
    return mote_distance_squared(c->shape[0], d->shape[0]) <= d->reach_squared[0] &&
           mote_distance_squared(c->shape[1], d->shape[1]) <= d->reach_squared[1];
}

void mote_pairs_keep(mote_pairs *candidates, const mote_pair *candidate)
{
    const mote_pair c = *candidate;
    mote_pair *list = candidates->list;
    for (uint32_t i = 0; i < candidates->count; ++i) {
        if ((list[i].squared <= c.squared || list[i].refined) && alike(&c, &list[i]))
            return;
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < candidates->count; ++i) {
        if (list[i].squared > c.squared && alike(&c, &list[i]))
            continue;
        if (kept != i)
            list[kept] = list[i];
        ++kept;
    }
    candidates->count = kept;
    if (kept == MOTE_PAIRS_MAX) {
        if (list[kept - 1].squared <= c.squared)
            return;
        --kept;
    }
    uint32_t i = kept;
    for (; i > 0 && list[i - 1].squared > c.squared; --i)
        list[i] = list[i - 1];
    list[i] = c;
    candidates->count = kept + 1;
}
