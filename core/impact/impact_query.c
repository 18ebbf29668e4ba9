/* Conservative advancement on the certified distance, by speeds alone or by sweeps.

   At a time t the certified query proves that the surfaces, as they are rounded, are at least
   `lower` apart, so that those of the path are at least lower - noise apart, and none of their
   points comes nearer than the tolerance before it has covered the rest of the way at the
   bounded speed. Twice the noise is left out, so that the distance as it is rounded stays above
   the tolerance too. Times are rounded by at most 2^-52, in which a point covers 2^-52 times
   the number of pieces times its speed in one: 2^-48 of that is left out.

   Where no more than that is left, nothing is proven further on, though the bodies are likely
   to touch soon. From there the search only looks: see look_beyond. */
#include "core/impact/impact_state.h"

#include <string.h>

/* A direction counts where so much of the distance is proven, and the witnesses, rounded by
   2^-53 of their coordinates, are so many of these apart. */
#define NORMAL_PART 0.9
#define NORMAL_LEAST 0x1p-46

static bool is_direction_certain(const mote_certificate_answer *at)
{
    const double size =
        fmax(mote_largest_coordinate(at->witness[0]), mote_largest_coordinate(at->witness[1]));
    return at->lower >= NORMAL_PART * at->distance && at->distance >= NORMAL_LEAST * size;
}

/* The direction between the witnesses. Where rounding hides it, that of an earlier look is
   kept; of a first look any direction does. */
static void set_normal(mote_impact_search *s)
{
    const bool first = !(mote_length_squared(s->found.normal) > 0);
    if (!(s->at.distance > 0) || (!first && !is_direction_certain(&s->at)))
        return;
    const mote_vec3 n = mote_sub(s->at.witness[1], s->at.witness[0]);
    const double inverse = 1 / mote_length(n);
    if (inverse < HUGE_VAL)
        s->found.normal = mote_scale(n, inverse);
    else if (first)
        s->found.normal = mote_vec3_make(1, 0, 0);
}

/* Makes a certified query at a time; false where the bodies are apart by more than the
   tolerance. */
static bool touch_at(mote_impact_search *s, double time)
{
    const mote_impact_question *q = s->question;
    for (int i = 0; i < 2; ++i)
        mote_impact_state(s, i, time, s->weights[i], &s->frame.body[i]);
    ++s->frame.number;
    mote_certificate_query(s->certificate, &s->frame, NULL, -1, &s->at);
    ++s->found.iterations;
    mote_counters *sum = &s->found.counters;
#define ADD(name) sum->name += s->at.counters.name;
    MOTE_COUNTERS(ADD)
    MOTE_COUNTERS_MORE(ADD)
#undef ADD
    set_normal(s);
    return s->at.distance <= q->tolerance;
}

/* What is left of the proven distance at a time, for the bodies to cover. */
static double gap_at(mote_impact_search *s, mote_place place)
{
    const mote_impact_question *q = s->question;
    const mote_impact_rate *rate = mote_impact_rate_of(s, place.piece);
    return (s->at.lower - q->tolerance) * (1 - 0x1p-40) - 2 * rate->noise -
           0x1p-48 * q->path[0]->count * rate->speed;
}

/* The time before which no point covers the gap from `time` on, at most end; -1 where there is
   no gap. */
static double covered_at(mote_impact_search *s, double time, double gap)
{
    const uint32_t count = s->question->path[0]->count;
    mote_place at = mote_path_place(s->question->path[0], time);
    if (!(gap > 0))
        return -1;
    for (;;) {
        const mote_impact_rate *rate = mote_impact_rate_of(s, at.piece);
        const double needed = rate->speed * (1 - at.u);
        if (needed >= gap) {
            const double until = (at.piece + (at.u + gap / rate->speed)) / count;
            return fmin(fmax(until, time), s->question->end);
        }
        gap -= needed;
        ++at.piece;
        at.u = 0;
        if (at.piece == count || (double)at.piece / count >= s->question->end)
            return s->question->end;
    }
}

/* The time until which the last answer, of `time`, proves the bodies to be apart; at most end.
 */
static double proven_until(mote_impact_search *s, double time)
{
    return covered_at(s, time, gap_at(s, mote_path_place(s->question->path[0], time)));
}

/* The same backwards; at least begin. */
static double proven_since(mote_impact_search *s, double time)
{
    const uint32_t count = s->question->path[0]->count;
    mote_place at = mote_path_place(s->question->path[0], time);
    double gap = gap_at(s, at);
    if (!(gap > 0))
        return time;
    for (;;) {
        const mote_impact_rate *rate = mote_impact_rate_of(s, at.piece);
        const double needed = rate->speed * at.u;
        if (needed >= gap) {
            const double since = (at.piece + (at.u - gap / rate->speed)) / count;
            return fmax(fmin(since, time), s->question->begin);
        }
        gap -= needed;
        if (at.piece == 0 || (double)at.piece / count <= s->question->begin)
            return s->question->begin;
        --at.piece;
        at.u = 1;
    }
}

static void end_with(mote_impact_search *s, mote_impact_outcome outcome, double from, double to)
{
    s->found.outcome = outcome;
    s->found.from = from;
    s->found.to = to;
    s->found.distance = s->at.distance;
    s->found.witness[0] = s->at.witness[0];
    s->found.witness[1] = s->at.witness[1];
}

/* Near an impact steps become short: asks ahead, the bracket's width from where the proof has
   come to. Returns whether the bodies touch at *time, the time of the last answer, up to which
   all is proven if they do not. */
static bool touch_ahead(mote_impact_search *s, double reached, double *time)
{
    *time = fmin(reached + s->options.resolution, s->question->end);
    if (touch_at(s, *time))
        return true;
    if (proven_since(s, *time) <= reached)
        return false;
    *time = reached;
    return touch_at(s, reached);
}

/* A sweep takes as long as some ten certified queries. It is made after `patience` steps by
   speeds alone, and again at once as long as it gains this many times what they would. */
#define GAIN_LEAST 3
#define WAIT_AFTER 4

/* The time up to which the last answer, of `time`, shows the bodies to be apart: by speeds
   alone `reached`, or by a sweep if it is time for one. */
static double sweep_at_times(mote_impact_search *s, double time, double reached)
{
    if (s->wait > 0) {
        --s->wait;
        return reached;
    }
    const double until = mote_impact_swept_until(s, time);
    if (until - time < GAIN_LEAST * (reached - time))
        s->wait = WAIT_AFTER;
    return fmax(reached, until);
}

/* Looks are as far apart as an eighth of the time since the proof or the piece ended, unless
   speeds allow more: so a bracket is wider by no more than that than it has to be. */
#define LOOK_PART 0.125

/* Times differ by at least this. */
#define LOOK_LEAST 0x1p-50

/* The time of the next look after one at `time`, where the proof ended at `from`. */
static double next_look(mote_impact_search *s, double from, double time)
{
    const mote_impact_question *q = s->question;
    const uint32_t count = q->path[0]->count;
    const uint32_t piece = mote_path_place(q->path[0], time).piece;
    const double begin = fmax(from, (double)piece / count);
    const double wider = fmin(time + LOOK_PART * (time - begin), (piece + 1.0) / count);
    const double by_speed = covered_at(s, time, s->at.lower - q->tolerance);
    return fmin(fmax(fmax(wider, by_speed), time + LOOK_LEAST), q->end);
}

/* Rounding hides what is left of the gap at `from`, the time of the last answer. Looks at later
   moments until the bodies touch, which ends the bracket, or are proven to be apart again: then
   they only grazed. */
static void look_beyond(mote_impact_search *s, double from)
{
    const mote_vec3 normal = s->found.normal;
    end_with(s, MOTE_IMPACT_GRAZING, from, from);
    double time = from;
    bool apart = false;
    while (!apart && time < s->question->end) {
        if (s->found.iterations >= s->options.iterations) {
            s->found.outcome = MOTE_IMPACT_UNDECIDED;
            time = from;
            break;
        }
        time = next_look(s, from, time);
        if (touch_at(s, time)) {
            end_with(s, MOTE_IMPACT_FOUND, from, time);
            return;
        }
        apart = gap_at(s, mote_path_place(s->question->path[0], time)) > 0;
    }
    s->found.to = time;
    s->found.normal = normal;
}

static void search_for_impact(mote_impact_search *s)
{
    const mote_impact_question *q = s->question;
    double time = q->begin, reached = time;
    bool touching = touch_at(s, time);
    while (!touching) {
        reached = proven_until(s, time);
        if (reached > time && reached < q->end)
            reached = sweep_at_times(s, time, reached);
        if (reached >= q->end) {
            end_with(s, MOTE_IMPACT_NONE, q->end, q->end);
            return;
        }
        if (!(reached > time)) {
            look_beyond(s, time);
            return;
        }
        if (s->found.iterations >= s->options.iterations) {
            end_with(s, MOTE_IMPACT_UNDECIDED, time, time);
            return;
        }
        if (reached - time < 0.5 * s->options.resolution) {
            touching = touch_ahead(s, reached, &time);
            continue;
        }
        time = reached;
        touching = touch_at(s, time);
    }
    end_with(s, MOTE_IMPACT_FOUND, reached, time);
}

mote_status mote_impact_query(mote_impact_search *search, const mote_impact_question *question,
                              mote_impact_found *found)
{
    const mote_status status = mote_impact_check(search, question);
    if (status != MOTE_OK)
        return status;
    search->question = question;
    search->wait = search->options.patience;
    memset(&search->found, 0, sizeof search->found);
    for (uint32_t k = 0; k < question->path[0]->count; ++k)
        search->rates[k].known = false;
    for (int i = 0; i < 2; ++i) {
        if (search->lines[i])
            mote_lines_begin(search->lines[i]);
    }
    search_for_impact(search);
    *found = search->found;
    return MOTE_OK;
}
