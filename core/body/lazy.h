/* World positions that are computed when first looked at in a frame and remembered for the rest
   of it, in a hash table sized by the vertices visited, not by the mesh (docs/architecture.md,
   "Lazy deformation"). */
#ifndef MOTE_CORE_LAZY_H
#define MOTE_CORE_LAZY_H

#include "core/body/body.h"
#include "core/body/positions.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_lazy_slot {
    uint32_t vertex;
    uint32_t stamp; /* the frame it was filled in; another value: empty */
    mote_vec3 position;
} mote_lazy_slot;

/* The same in single precision. */
typedef struct mote_lazy_slot_single {
    uint32_t vertex, stamp;
    float position[3];
} mote_lazy_slot_single;

typedef struct mote_lazy {
    const mote_body *body;
    const mote_body_state *state;
    const mote_vec3 *given;         /* all vertices, already deformed by the caller, or NULL */
    const mote_positions *points;   /* the same in another layout, or NULL */
    mote_lazy_slot *slots;          /* [mask + 1], a power of two; NULL in single precision */
    mote_lazy_slot_single *singles; /* [mask + 1] in single precision, else NULL */
    float *weights_single; /* x, y, z of the frame's weights rounded, [3][padded], or NULL */
    uint32_t mask, shift;
    uint32_t stamp;
    uint32_t filled; /* slots filled in this frame */
    uint32_t limit;  /* the table grows when filled reaches it */
    bool fixed; /* the table does not grow: positions beyond the limit are not remembered */
    uint64_t evaluated; /* positions evaluated since creation */
} mote_lazy;

/* expected: how many vertices a query is likely to visit (a hint; the table grows). */
mote_status mote_lazy_init(mote_lazy *lazy, const mote_body *body, uint32_t expected);

/* The same with positions evaluated and remembered in single precision: faster and smaller (20
   bytes a slot instead of 32), but less precise. */
mote_status mote_lazy_init_single(mote_lazy *lazy, const mote_body *body, uint32_t expected);

void mote_lazy_free(mote_lazy *lazy);

/* Starts a frame: forgets all positions. state is borrowed until the next call. With use_given,
   or where the body's positions are given, they are read from state->vertices, which must not
   be NULL then. Constant time; O(J) in single precision. */
void mote_lazy_begin(mote_lazy *lazy, const mote_body_state *state, bool use_given);

/* The same with positions read from points, which are borrowed until the next call. Not in
   single precision. */
void mote_lazy_begin_points(mote_lazy *lazy, const mote_positions *points);

/* The slow path of mote_lazy_position: evaluates and remembers (or, out of memory, only
   evaluates). */
mote_vec3 mote_lazy_fill(mote_lazy *lazy, uint32_t vertex, uint32_t index);

/* Evaluates those of count vertices (repetitions allowed) that are not known yet, MOTE_LANES at
   a time. This takes a third of the time of evaluating them one by one and gives the same bits.
   Does nothing where positions are given, or in single precision. */
void mote_lazy_fetch(mote_lazy *lazy, const uint32_t *vertices, size_t count);

/* mote_lazy_fetch of some vertices and their rings. */
void mote_lazy_fetch_rings(mote_lazy *lazy, const uint32_t *centres, size_t count);

/* mote_lazy_position in single precision. */
mote_vec3 mote_lazy_position_single(mote_lazy *lazy, uint32_t vertex);

static inline mote_vec3 mote_lazy_position(mote_lazy *lazy, uint32_t vertex)
{
    if (lazy->given)
        return lazy->given[vertex];
    if (lazy->singles)
        return mote_lazy_position_single(lazy, vertex);
    uint32_t index = (vertex * 2654435769u) >> lazy->shift;
    for (;;) {
        const mote_lazy_slot *slot = &lazy->slots[index];
        if (slot->stamp != lazy->stamp)
            return mote_lazy_fill(lazy, vertex, index);
        if (slot->vertex == vertex)
            return slot->position;
        index = (index + 1) & lazy->mask;
    }
}

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
