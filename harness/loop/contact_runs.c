#include "harness/loop/contact_runs.h"

#include "harness/base/memory.h"

#include <stdlib.h>

/* The pair of these bodies at or after *place, which advances to it; NULL: none. */
static const mote_near_pair *pair_of(const mote_near_pair *pairs, size_t count, size_t *place,
                                     const uint32_t body[2])
{
    while (*place < count && mote_pair_order(pairs[*place].body, body) < 0)
        ++*place;
    return *place < count && mote_pair_order(pairs[*place].body, body) == 0 ? &pairs[*place]
                                                                            : NULL;
}

static void end_run(mote_contact_runs *runs, const mote_contact_run *run)
{
    ++runs->approaches;
    runs->intersections += run->intersects;
    runs->depth_max = fmax(runs->depth_max, run->depth);
    if (run->reported)
        return;
    ++runs->passes;
    runs->deep_passes += run->depth > 0;
    runs->depth_passes = fmax(runs->depth_passes, run->depth);
}

/* Counts a true contact. */
static mote_status count_contact(mote_contact_runs *runs, uint32_t k,
                                 const mote_near_pair *truth, bool said, mote_contact_run *run,
                                 mote_contact_depth depth, void *context)
{
    ++runs->contact_steps;
    runs->missed_steps += !said;
    if (said && !run->reported) {
        const uint64_t delay = k - run->began;
        run->reported = true;
        runs->delay_sum += delay;
        runs->delay_max = delay > runs->delay_max ? delay : runs->delay_max;
    }
    const bool apart = truth->answer.distance > 0; /* then no vertex is inside */
    run->intersects = run->intersects || !apart;
    if (apart || (runs->depth_unreported && run->reported))
        return MOTE_OK;
    return depth(context, truth->body, run->depth, &run->depth);
}

/* Counts contacts that only the method reports. */
static void count_false(mote_contact_runs *runs, const mote_near_pair *truth,
                        size_t truth_count, const mote_near_pair *said, size_t said_count)
{
    size_t place = 0;
    for (size_t k = 0; k < said_count; ++k) {
        const mote_near_pair *real = pair_of(truth, truth_count, &place, said[k].body);
        runs->false_steps += said[k].answer.contact && !(real && real->answer.contact);
    }
}

mote_status mote_contact_runs_step(mote_contact_runs *runs, uint32_t k,
                                   const mote_near_pair *truth, size_t truth_count,
                                   const mote_near_pair *said, size_t said_count,
                                   mote_contact_depth depth, void *context)
{
    size_t old = 0, place = 0, count = 0;
    mote_status status = MOTE_OK;
    runs->next =
        mote_reserve(runs->next, truth_count, &runs->next_capacity, sizeof *runs->next);
    for (size_t i = 0; i < truth_count && status == MOTE_OK; ++i) {
        const mote_near_pair *pair = &truth[i];
        if (!pair->answer.contact)
            continue;
        for (; old < runs->count && mote_pair_order(runs->current[old].body, pair->body) < 0;
             ++old)
            end_run(runs, &runs->current[old]);
        mote_contact_run *run = &runs->next[count++];
        *run = (mote_contact_run){.body = {pair->body[0], pair->body[1]}, .began = k};
        if (old < runs->count && mote_pair_order(runs->current[old].body, pair->body) == 0)
            *run = runs->current[old++];
        const mote_near_pair *other = pair_of(said, said_count, &place, pair->body);
        status =
            count_contact(runs, k, pair, other && other->answer.contact, run, depth, context);
    }
    for (; old < runs->count && status == MOTE_OK; ++old)
        end_run(runs, &runs->current[old]);
    mote_contact_run *block = runs->current;
    const size_t capacity = runs->current_capacity;
    runs->current = runs->next;
    runs->current_capacity = runs->next_capacity;
    runs->next = block;
    runs->next_capacity = capacity;
    runs->count = count;
    count_false(runs, truth, truth_count, said, said_count);
    return status;
}

void mote_contact_runs_end(mote_contact_runs *runs)
{
    for (size_t k = 0; k < runs->count; ++k)
        end_run(runs, &runs->current[k]);
    runs->count = 0;
}

void mote_contact_runs_free(mote_contact_runs *runs)
{
    free(runs->current);
    free(runs->next);
    *runs = (mote_contact_runs){.count = 0};
}
