/* One streamed query of two bodies: its first upper bound, its axes, its limits and its answer.
 */
#include "core/stream/stream_state.h"

#include "core/body/triangle.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Where the last faces have moved apart by more than this part of L, nearer ones are looked for
   in the boxes. Measured on jump: of values from 0.01 to 0.1, 0.03 takes the least time. */
#define LEAP 0.03

/* Coordinates of a query are below this. */
#define FARTHEST 0x1p60

/* 32 u, and the least B that is used: see stream_state.h. */
#define MARGIN 0x1p-19
#define LEAST_BOUND 0x1p-6

/* Positions kept while sliding, where they are not an array of vectors. */
#define POSITIONS 2048

static void *allocate_aligned(size_t count, size_t size)
{
    return aligned_alloc(64, (count * size + 63) / 64 * 64);
}

static mote_status side_init(mote_stream_side *side, const mote_body *largest, uint32_t room)
{
    mote_status status = mote_lazy_init(&side->lazy, largest, POSITIONS);
    if (status != MOTE_OK)
        return status;
    side->lazy.fixed = true;
    side->room = room;
    side->leaves = allocate_aligned(room, sizeof *side->leaves);
    side->groups = malloc(room * sizeof *side->groups);
    side->opened = calloc(room, sizeof *side->opened);
    side->slots = allocate_aligned(MOTE_STREAM_SLOTS, sizeof *side->slots);
    if (!side->leaves || !side->groups || !side->opened || !side->slots)
        return mote_fail(MOTE_ENOMEM, "no memory for the leaves of %u groups", room);
    memset(side->slots, 0, MOTE_STREAM_SLOTS * sizeof *side->slots);
    return MOTE_OK;
}

mote_status mote_stream_search_init(mote_stream_search *s, const mote_stream_options *options,
                                    const mote_body *const largest[2], const uint32_t room[2])
{
    memset(s, 0, sizeof *s);
    s->options = *options;
    mote_status status = side_init(&s->side[0], largest[0], room[0]);
    return status == MOTE_OK ? side_init(&s->side[1], largest[1], room[1]) : status;
}

void mote_stream_search_free(mote_stream_search *s)
{
    for (int k = 0; k < 2; ++k) {
        mote_stream_side *side = &s->side[k];
        mote_lazy_free(&side->lazy);
        free(side->leaves);
        free(side->groups);
        free(side->opened);
        free(side->slots);
    }
}

size_t mote_stream_search_bytes(const mote_stream_search *s)
{
    size_t bytes = 0;
    for (int k = 0; k < 2; ++k) {
        const mote_stream_side *side = &s->side[k];
        bytes +=
            (side->lazy.mask + (size_t)1) * sizeof(mote_lazy_slot) +
            side->room * (sizeof *side->leaves + sizeof *side->groups + sizeof *side->opened) +
            MOTE_STREAM_SLOTS * sizeof *side->slots;
    }
    return bytes;
}

/* After 2^32 queries old stamps could be mistaken for new ones. */
static void next_stamp(mote_stream_search *s)
{
    if (++s->stamp != 0)
        return;
    s->stamp = 1;
    for (int k = 0; k < 2; ++k) {
        memset(s->side[k].opened, 0, s->side[k].room * sizeof *s->side[k].opened);
        memset(s->side[k].slots, 0, MOTE_STREAM_SLOTS * sizeof *s->side[k].slots);
    }
}

static void begin(mote_stream_search *s, mote_stream_body *const body[2], double enough)
{
    next_stamp(s);
    memset(&s->counters, 0, sizeof s->counters);
    s->enough = enough;
    s->slack = s->options.slack * s->options.length;
    s->done = s->stopped = s->has_direction = false;
    s->unvisited = DBL_MAX;
    s->limit = 0;
    s->searches = s->separated = 0;
    for (int k = 0; k < 2; ++k) {
        s->side[k].body = body[k];
        s->side[k].lazy.body = &body[k]->tree->body;
        s->side[k].evaluated = s->side[k].lazy.evaluated;
    }
}

/* Whether the upper bound is all that is asked for. */
static bool decided(const mote_stream_search *s)
{
    return !(s->upper > s->slack) || s->upper <= s->enough;
}

bool mote_stream_seed(mote_stream_search *s, mote_stream_body *const body[2],
                      const mote_stream_memory *memory, double enough)
{
    begin(s, body, enough);
    mote_vec3 corner[2][3];
    for (int b = 0; b < 2; ++b) {
        const uint32_t *face =
            memory->has_last ? memory->last[b] : body[b]->tree->mesh->triangles[0];
        mote_lazy_begin_points(&s->side[b].lazy, &body[b]->positions);
        memcpy(s->best.triangle[b], face, sizeof s->best.triangle[b]);
        for (int k = 0; k < 3; ++k)
            corner[b][k] = mote_position_at(&body[b]->positions, face[k]);
    }
    s->best.squared =
        mote_triangle_triangle(corner[0], corner[1], &s->best.witness[0], &s->best.witness[1]);
    ++s->counters.triangle_tests;
    const double enough_squared = enough > 0 ? enough * enough : 0;
    if (s->best.squared > enough_squared && isfinite(s->best.squared)) {
        mote_lazy *const lazy[2] = {&s->side[0].lazy, &s->side[1].lazy};
        mote_refine_slide(lazy, enough_squared, &s->best);
        s->counters.triangle_tests += s->best.triangle_tests;
        ++s->counters.refined;
    }
    s->upper = sqrt(s->best.squared);
    s->done = decided(s);
    return memory->has_last && s->upper <= memory->distance + LEAP * s->options.length;
}

/* A unit vector at right angles to another. */
static mote_vec3 perpendicular(mote_vec3 u)
{
    const mote_vec3 v =
        fabs(u.x) < fabs(u.y) ? mote_vec3_make(0, -u.z, u.y) : mote_vec3_make(u.z, 0, -u.x);
    return mote_scale(v, 1 / mote_length(v));
}

/* Points from witness 0 to witness 1; where they are too near for that, anywhere. */
static void aim(mote_stream_search *s)
{
    const mote_vec3 gap =
        mote_scale(mote_sub(s->best.witness[1], s->best.witness[0]), s->scale);
    const double length = mote_length(gap);
    s->toward = length > 1e-100 ? mote_scale(gap, 1 / length) : mote_vec3_make(1, 0, 0);
    if (++s->aim == 0)
        s->aim = 1;
}

static void set_axes(mote_stream_search *s)
{
    aim(s);
    const mote_vec3 u = s->toward;
    const mote_vec3 v = perpendicular(u);
    const mote_vec3 w = mote_cross(u, v);
    const double rows[3][3] = {{u.x, u.y, u.z}, {v.x, v.y, v.z}, {w.x, w.y, w.z}};
    for (size_t r = 0; r < 3; ++r) {
        for (size_t k = 0; k < 3; ++k)
            s->turn[r][k] = (float)rows[r][k];
    }
}

/* Pairs whose bound is at least the limit are skipped, so that the distance is proven to 1e-13
   of itself. */
static void set_limit(mote_stream_search *s)
{
    double limit = (s->upper - s->slack) * s->scale * (1 - 1e-13);
    if (s->enough >= 0) {
        /* just above the tolerance, so that a pair exactly at the tolerance is found */
        const double enough = s->enough * s->scale * (1 + 1e-13) + 4 * s->noise;
        limit = enough < limit ? enough : limit;
    }
    /* Where the bodies nearly touch, no bound may depend on rounding: all pairs that might
       touch are measured, so that contact is found whatever the query started from. */
    if (limit < 8 * s->noise)
        limit = 8 * s->noise;
    s->limit = limit;
    s->need = (float)limit * (1 + 0x1p-22F) + 0x1p-60F;
    const float reach = (float)(limit + s->margin) * (1 + 0x1p-22F);
    s->squared = reach * reach * (1 + 0x1p-20F);
}

void mote_stream_set_best(mote_stream_search *s, double squared)
{
    s->best.squared = squared;
    s->upper = sqrt(squared);
    s->done = decided(s);
    if (s->done)
        return;
    aim(s);
    set_limit(s);
}

void mote_stream_choose(mote_stream_search *s)
{
    const double size = fmax(s->options.length, s->upper);
    s->scale = ldexp(1, -ilogb(size));
    s->origin = mote_scale(mote_add(s->best.witness[0], s->best.witness[1]), 0.5);
}

/* Bounds the coordinates of both bodies. */
static mote_status set_margin(mote_stream_search *s)
{
    double largest[3] = {0, 0, 0};
    for (int b = 0; b < 2; ++b) {
        mote_stream_side *side = &s->side[b];
        const mote_stream_body *body = side->body;
        const mote_vec3 d = mote_scale(mote_sub(body->origin, s->origin), s->scale);
        const double offset[3] = {d.x, d.y, d.z};
        for (size_t k = 0; k < 3; ++k) {
            const double low = fabs((double)body->root.low[k] + offset[k]);
            const double high = fabs((double)body->root.high[k] + offset[k]);
            largest[k] = fmax(largest[k], fmax(fmax(low, high), fabs(offset[k])));
            side->offset[k] = (float)offset[k];
        }
    }
    const double bound = 1.0001 * sqrt(largest[0] * largest[0] + largest[1] * largest[1] +
                                       largest[2] * largest[2]);
    if (!(bound < FARTHEST))
        return mote_fail(
            MOTE_EINVAL,
            "the positions are more than 10^18 times as far apart as the larger of "
            "L, %g, and the distance; check their unit",
            s->options.length);
    s->margin = MARGIN * fmax(bound, LEAST_BOUND);
    s->noise = 0x1p-48 * bound;
    for (size_t k = 0; k < 3; ++k)
        s->loose[k] = (float)(s->margin * (1 + 0x1p-20));
    return MOTE_OK;
}

mote_status mote_stream_prove(mote_stream_search *s, bool leapt)
{
    mote_status status = set_margin(s);
    if (status != MOTE_OK)
        return status;
    if (leapt)
        mote_stream_find_anew(s);
    mote_stream_set_best(s, s->best.squared);
    if (s->done)
        return MOTE_OK;
    set_axes(s);
    mote_stream_traverse(s);
    return MOTE_OK;
}

void mote_stream_write(const mote_stream_search *s, mote_stream_memory *memory,
                       mote_certificate_answer *answer)
{
    double lower = 0;
    if (!s->done) {
        const double aim = (s->upper - s->slack) * s->scale * (1 - 1e-13);
        lower = s->unvisited < s->limit ? s->unvisited : s->limit;
        lower = ((lower < aim ? lower : aim) - 3 * s->noise) / s->scale;
    }
    *answer = (mote_certificate_answer){.distance = s->upper,
                                        .lower = lower > 0 ? lower : 0,
                                        .witness = {s->best.witness[0], s->best.witness[1]},
                                        .stopped = s->stopped,
                                        .counters = s->counters};
    for (int k = 0; k < 2; ++k)
        answer->counters.positions += s->side[k].lazy.evaluated - s->side[k].evaluated;
    memcpy(memory->last, s->best.triangle, sizeof memory->last);
    memory->distance = s->upper;
    memory->has_last = s->options.coherent;
}
