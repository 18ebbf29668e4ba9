/* One query of the tracker: how far the bodies have moved, what is searched, and what is kept
   for the next query. */
#include "core/particle/tracker_state.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Relative motion since the last query, in units of L, from which on only the minima of that
   query are used. With n = 8 on ww, comb and fast-25, half and twice of this gave as many
   exact frames. */
#define COLD_MOTION 0.1

/* n seeds of each body are launched for every such relative motion, in units of L. Measured
   with n = 8: half of this evaluates 13 % more positions on ww for no more exact frames; twice
   of this loses 0.6 % of the exact frames on ww and 10 % on comb. */
#define ROUND_MOTION 0.2

/* All nodes around the nearest pair are leapt to for every such relative motion, in units of
   the mean distance of neighbouring nodes. Measured with n = 8 on ww and comb: half and twice
   of this change the share of exact frames by 0.014 at most, and positions by 5 %. */
#define LEAP_MOTION 0.75

/* Adds the motion since the last query to the total and to the launches and leaps that are due.
 */
static void add_motion(mote_request *r, double motion)
{
    mote_tracker *t = r->tracker;
    if (!isfinite(motion)) /* as far as nothing is known: it would be added for good */
        motion = t->length;
    const double part = motion / (ROUND_MOTION * t->length);
    r->cold = motion >= COLD_MOTION * t->length;
    t->travelled += motion;
    for (int b = 0; b < 2; ++b) {
        mote_tracked_body *body = &t->body[b];
        body->due = fmin(body->due + part * body->count, body->count);
        const double spacing = LEAP_MOTION * body->levels->level[body->seed_level].spacing;
        body->leaps_due =
            fmin(body->leaps_due + motion / spacing * MOTE_NEAR_MAX, MOTE_NEAR_MAX);
    }
}

/* An exact check only looks for pairs of faces that are nearer than a bound by 1e-12 of it:
   this one lets it find those that are just as far, and those that meet. */
static double just_beyond(double squared)
{
    return squared * (1 + 1e-11) + DBL_MIN;
}

static void remember(mote_request *r)
{
    mote_tracker *t = r->tracker;
    if (r->best->squared < HUGE_VAL) {
        t->last.known = true;
        memcpy(t->last.triangle, r->best->triangle, sizeof t->last.triangle);
        memcpy(t->last.vertex, r->best->vertex, sizeof t->last.vertex);
    }
    if (mote_found_enough(r))
        return; /* there was no full search: the minima of the last one are kept */
    t->pair_count = 0;
    for (uint32_t i = 0; i < t->pairs.count && i < t->options.track; ++i)
        t->pair[t->pair_count++] = t->pairs.list[i];
}

void mote_tracker_query(mote_tracker *tracker, const mote_frame *frame, bool use_given,
                        double worth_squared, double enough_squared, mote_counters *counters,
                        mote_refined *best)
{
    mote_request r = {.tracker = tracker,
                      .worth_squared = just_beyond(worth_squared),
                      .enough_squared = enough_squared,
                      .nearest_squared = HUGE_VAL,
                      .counters = counters,
                      .best = best};
    uint64_t before = 0;
    if (tracker->particles)
        mote_particles_begin(tracker->particles, frame, use_given);
    for (int b = 0; b < 2; ++b) {
        mote_tracked_body *body = &tracker->body[b];
        before += body->lazy->evaluated;
        if (!tracker->particles)
            mote_lazy_begin(body->lazy, &frame->body[b], use_given);
        r.lazy[b] = body->lazy;
        r.ground[b] = mote_ground_of(body->lazy, body->levels);
    }
    *best = (mote_refined){.squared = HUGE_VAL};
    tracker->pairs.count = 0;
    add_motion(&r, mote_coherence_motion(&tracker->coherence, frame, use_given));
    if (tracker->last.known && !r.cold)
        mote_tracker_refine_last(&r);
    if (!mote_found_enough(&r))
        mote_tracker_search(&r);
    remember(&r);
    counters->positions +=
        tracker->body[0].lazy->evaluated + tracker->body[1].lazy->evaluated - before;
}

size_t mote_tracker_particles(const mote_tracker *tracker, int body, mote_vec3 *positions,
                              size_t capacity)
{
    const mote_nearest_pair *last = &tracker->last;
    mote_lazy *lazy = tracker->body[body].lazy;
    size_t count = 0;
    if (last->known) {
        if (count < capacity)
            positions[count] = mote_lazy_position(lazy, last->vertex[body]);
        ++count;
    }
    for (uint32_t i = 0; i < tracker->pair_count; ++i) {
        const mote_pair *pair = &tracker->pair[i];
        if (memcmp(pair->vertex, last->vertex, sizeof pair->vertex) == 0)
            continue;
        if (count < capacity)
            positions[count] = mote_lazy_position(lazy, pair->vertex[body]);
        ++count;
    }
    return count;
}
