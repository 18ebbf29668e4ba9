/* How long the step of a sweep is: no longer than is of use. Where the bend alone would close
   the gap, no direction helps; turns by more than a radian are left to the next step. */
#include "core/impact/impact_state.h"

#include <math.h>

/* Paths of which pieces join with kinks above this part of the speed are swept piece by piece.
 */
#define KINK_MOST 1e-10

/* What is known of a step: bounds over all pieces that it touches. */
typedef struct step {
    double length; /* in pieces */
    double acceleration, speed, kink, noise;
} step;

/* The longest step from a place on in which the bend stays below the gap. */
static step step_from(mote_impact_search *s, mote_place at, double gap)
{
    const double end = s->question->end * s->question->path[0]->count;
    step chosen = {.length = 0};
    double most = end - (at.piece + at.u);
    for (uint32_t k = at.piece; k < s->question->path[0]->count; ++k) {
        const double before = k > at.piece ? k - (at.piece + at.u) : 0;
        if (before >= most) /* what is beyond the end of the question may not be there */
            return chosen;
        const mote_impact_rate *rate = mote_impact_rate_of(s, k);
        if (k > at.piece && rate->kink > KINK_MOST * rate->speed)
            return chosen;
        const double acceleration = fmax(chosen.acceleration, rate->acceleration);
        double allowed = sqrt(2 * gap / acceleration);
        if (rate->turn > 0)
            allowed = fmin(allowed, 1 / rate->turn);
        if (k > at.piece && allowed <= before)
            return chosen;
        most = fmin(most, allowed);
        chosen.acceleration = acceleration;
        chosen.speed = fmax(chosen.speed, rate->speed);
        chosen.noise = fmax(chosen.noise, rate->noise);
        chosen.kink += k > at.piece ? rate->kink : 0;
        chosen.length = fmin(most, k + 1 - (at.piece + at.u));
    }
    return chosen;
}

double mote_impact_swept_until(mote_impact_search *s, double time)
{
    const mote_impact_question *q = s->question;
    const uint32_t count = q->path[0]->count;
    const mote_place at = mote_path_place(q->path[0], time);
    if (s->body[0].field->numbers > 0 || s->body[1].field->numbers > 0)
        return time; /* not of the form of positions: speeds alone */
    const step chosen = step_from(s, at, s->at.lower - q->tolerance);
    if (!(chosen.length > 0))
        return time;
    for (int i = 0; i < 2; ++i)
        mote_impact_velocity(s, i, at, chosen.length, s->speeds[i], &s->sweep.side[i].state);
    /* kinks and the rounding of times: see impact_query.c */
    const double spare =
        2 * chosen.noise + chosen.kink * chosen.length + 0x1p-48 * count * chosen.speed;
    if (!(s->at.lower - q->tolerance > spare)) /* each gap is to be above 0 at the start */
        return time;
    const double bend = 0.5 * chosen.acceleration * chosen.length * chosen.length;
    const double part =
        mote_sweep_query(&s->sweep, s->found.normal, q->tolerance + spare, bend);
    s->found.counters.box_tests += s->sweep.box_tests;
    s->found.counters.leaf_pairs += s->sweep.leaf_pairs;
    s->found.counters.triangle_tests += s->sweep.triangle_tests;
    const double until = (at.piece + (at.u + part * chosen.length)) / count;
    return until >= q->end || (part >= 1 && at.piece + at.u + chosen.length >= q->end * count)
               ? q->end
               : until;
}
