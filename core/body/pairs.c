#include "core/body/pairs.h"

/* The same vertex, or one in the other's ring. */
static bool adjacent(const mote_mesh *mesh, uint32_t v, uint32_t w)
{
    if (v == w)
        return true;
    for (uint32_t k = mesh->ring_start[v]; k < mesh->ring_start[v + 1]; ++k) {
        if (MOTE_RING_VERTEX(mesh->ring[k]) == w)
            return true;
    }
    return false;
}

/* Two candidates whose vertices are in each other's rings lead to the same minimum. Being near
   in space is not enough: they may be on two sides of a gap, or on two patches that touch. */
static bool alike(const mote_pairs *p, const mote_pair *c, const mote_pair *d)
{
    return mote_distance_squared(c->shape[0], d->shape[0]) <= d->longest_edge_squared[0] &&
           mote_distance_squared(c->shape[1], d->shape[1]) <= d->longest_edge_squared[1] &&
           adjacent(p->mesh[0], c->vertex[0], d->vertex[0]) &&
           adjacent(p->mesh[1], c->vertex[1], d->vertex[1]);
}

void mote_pairs_keep(mote_pairs *candidates, const mote_pair *candidate)
{
    const mote_pair c = *candidate;
    mote_pair *list = candidates->list;
    for (uint32_t i = 0; i < candidates->count; ++i) {
        if ((list[i].squared <= c.squared || list[i].refined) &&
            alike(candidates, &c, &list[i]))
            return;
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < candidates->count; ++i) {
        if (list[i].squared > c.squared && alike(candidates, &c, &list[i]))
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
