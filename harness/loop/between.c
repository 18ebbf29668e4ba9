#include "harness/loop/between.h"

#include "core/impact/impact_scene.h"
#include "harness/base/memory.h"
#include "harness/loop/flight.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* An impact, where the proof of a distance above the tolerance ends, counts as a contact in
   truth if the distance is at most this many tolerances. */
#define WIDER 1.01

/* A distance of a pair above this part of the tolerance is more than what rounding leaves of
   it. */
#define CLEAR 1.001

/* The part of the tolerance below which a pair is no longer kept apart by proof. */
#define LEAST 1e-6

/* Frames over which the speed of an impact is measured. */
#define INSTANT 1e-3

/* A push opens this part of the tolerance in a floor's time, and each one that follows within
   the floor twice as much as the one before, up to so many times. */
#define PUSH 0.125
#define DOUBLINGS 8

/* A pair that has come to an impact, until it is apart again. */
typedef struct touching {
    uint32_t body[2];
    double last;      /* time of the last impact, in frames */
    uint32_t impacts; /* in this step */
    uint32_t pushes;  /* one after the other */
} touching;

struct mote_between {
    const mote_simulator *simulator;
    mote_flight *flight;
    mote_impact_scene *impacts; /* NULL: steps are sampled */
    double tolerance, floor;    /* absolute; in frames */
    bool shown;                 /* since the start of the simulation */
    touching *touching;         /* in pair order */
    size_t touching_count, touching_room;
    mote_impact_exception *exceptions; /* [touching_count] */
    size_t exception_room;
    mote_near_pair *said, *truth;
    size_t said_room, truth_room;
};

mote_status mote_between_create(const mote_simulator *simulator, mote_between **between)
{
    const mote_simulation_options *o = &simulator->options;
    *between = NULL;
    if (o->within == MOTE_STEPS_WHOLE)
        return MOTE_OK;
    mote_between *made = mote_allocate(1, sizeof *made);
    const mote_simulated *bodies = &simulator->bodies;
    made->simulator = simulator;
    made->flight = mote_flight_create(simulator, o->time_step);
    made->tolerance = o->tolerance * bodies->length;
    made->floor = fmin(MOTE_SIMULATION_FLOOR, o->time_step);
    mote_impact_options options = mote_default_impact_options(bodies->length);
    options.pieces = mote_flight_pieces_max(made->flight);
    mote_status status = MOTE_OK;
    if (o->within == MOTE_STEPS_CONTINUOUS)
        status = mote_impact_scene_create(bodies->shapes, bodies->shape_count, bodies->shape_of,
                                          bodies->count, &options, &made->impacts);
    if (status == MOTE_OK)
        *between = made;
    else
        mote_between_destroy(made);
    return status;
}

void mote_between_destroy(mote_between *between)
{
    if (!between)
        return;
    mote_impact_scene_destroy(between->impacts);
    mote_flight_destroy(between->flight);
    free(between->touching);
    free(between->exceptions);
    free(between->said);
    free(between->truth);
    free(between);
}

void mote_between_restart(mote_between *between)
{
    between->shown = false;
    between->touching_count = 0;
    mote_flight_restart(between->flight);
}

static void show(mote_between *b, mote_simulation *s, double part)
{
    const mote_body_state *states = mote_flight_show(b->flight, part);
    double moved = HUGE_VAL;
    if (b->shown && b->simulator->bodies.count == 2)
        moved = mote_flight_moved(b->flight);
    b->shown = true;
    s->shown = mote_stage_see(b->simulator->stage, states, moved);
}

/* The place of a pair among those that touch, or where it would be. */
static size_t place_of(const mote_between *b, const uint32_t body[2])
{
    size_t k = 0;
    while (k < b->touching_count && mote_pair_order(b->touching[k].body, body) < 0)
        ++k;
    return k;
}

static bool is_at(const mote_between *b, size_t k, const uint32_t body[2])
{
    return k < b->touching_count && mote_pair_order(b->touching[k].body, body) == 0;
}

/* Whether a pair is in contact by the truth. */
static bool in_contact(const mote_simulation *s, const uint32_t body[2])
{
    for (size_t k = 0; k < s->truth.count; ++k) {
        if (mote_pair_order(s->truth.pairs[k].body, body) == 0)
            return s->truth.pairs[k].answer.contact;
    }
    return false;
}

/* Sets what is said to the pairs that have an impact now, and those that have not come apart
   since their last one. */
static void say(mote_between *b, mote_simulation *s, double now)
{
    size_t count = 0;
    b->said = mote_reserve(b->said, b->touching_count, &b->said_room, sizeof *b->said);
    for (size_t k = 0; k < b->touching_count; ++k) {
        const touching *t = &b->touching[k];
        if (now > t->last && !in_contact(s, t->body))
            continue;
        b->said[count] = (mote_near_pair){.body = {t->body[0], t->body[1]}};
        b->said[count].answer.has_contact = b->said[count].answer.contact = true;
        ++count;
    }
    s->said = (mote_stage_pairs){b->said, count};
}

/* Asks for the truth and compares. */
static mote_status look(mote_between *b, mote_simulation *s, double part, double now, bool ask)
{
    mote_stage *stage = b->simulator->stage;
    mote_status status = MOTE_OK;
    show(b, s, part);
    s->said.count = 0;
    if (!b->impacts && ask)
        status = mote_stage_ask_method(stage, &s->said, &s->result.query_ns);
    if (status == MOTE_OK)
        status = mote_stage_ask_truth(stage, &s->truth, &s->result.truth_asked, &s->lower);
    if (status != MOTE_OK)
        return status;
    b->truth = mote_reserve(b->truth, s->truth.count, &b->truth_room, sizeof *b->truth);
    for (size_t k = 0; k < s->truth.count; ++k) {
        b->truth[k] = s->truth.pairs[k];
        const uint32_t *body = b->truth[k].body;
        const size_t t = place_of(b, body);
        const bool impact = is_at(b, t, body) && !(now > b->touching[t].last);
        b->truth[k].answer.contact =
            b->truth[k].answer.distance <= (impact ? WIDER : 1) * b->tolerance;
    }
    s->truth.pairs = b->truth;
    if (b->impacts)
        say(b, s, now);
    const double whole = round(now);
    return mote_simulation_look(s, fabs(now - whole) < 1e-9 ? (uint32_t)whole : UINT32_MAX);
}

/* Looks between two parts of the flight, both left out. */
static mote_status look_within(mote_between *b, mote_simulation *s, double begun,
                               double duration, double until)
{
    const double end = until * duration - 1e-9;
    mote_status status = MOTE_OK;
    double next = (floor((begun + 1e-9) * MOTE_SIMULATION_LOOKS) + 1) / MOTE_SIMULATION_LOOKS;
    for (; next - begun < end && status == MOTE_OK; next += 1.0 / MOTE_SIMULATION_LOOKS)
        status = look(b, s, (next - begun) / duration, next, false);
    return status;
}

/* The distance of a pair at a part of the flight. */
static mote_status distance_at(const mote_between *b, const uint32_t body[2], double part,
                               mote_impact_found *found)
{
    return mote_impact_scene_pair(b->impacts, mote_flight_paths(b->flight), body, part, part, 0,
                                  found);
}

/* Chooses the tolerances of the pairs that touch, and forgets those that are apart. *window:
   the part of the flight for which they hold. */
static mote_status choose_tolerances(mote_between *b, mote_simulation *s, double now,
                                     double duration, double *window)
{
    const double most = 16 + 4 * b->simulator->options.time_step / b->floor;
    const double part = fmin(1, b->floor / duration);
    size_t kept = 0;
    b->exceptions = mote_reserve(b->exceptions, b->touching_count, &b->exception_room,
                                 sizeof *b->exceptions);
    for (size_t k = 0; k < b->touching_count; ++k) {
        const touching *t = &b->touching[k];
        mote_impact_exception *e = &b->exceptions[kept];
        mote_impact_found at;
        const mote_status status = distance_at(b, t->body, 0, &at);
        if (status != MOTE_OK)
            return status;
        *e = (mote_impact_exception){{t->body[0], t->body[1]}, b->tolerance};
        if (at.distance < CLEAR * b->tolerance) {
            e->tolerance = at.distance / 2;
            *window = fmin(*window, part);
        } else if (now - t->last > b->floor) {
            continue;
        }
        if (at.distance < LEAST * b->tolerance || t->impacts > most) {
            e->tolerance = -1;
            *window = fmin(*window, part);
            ++s->result.unproven;
        }
        b->touching[kept++] = *t;
    }
    b->touching_count = kept;
    return MOTE_OK;
}

/* The earliest impact of the flight; until: where it begins, or what is proven. */
static mote_status find_impact(mote_between *b, mote_simulation *s, double now, double duration,
                               double *until, mote_impact_scene_found *found)
{
    mote_status status = choose_tolerances(b, s, now, duration, until);
    const mote_impact_scene_question question = {.paths = mote_flight_paths(b->flight),
                                                 .begin = 0,
                                                 .end = *until,
                                                 .tolerance = b->tolerance,
                                                 .exceptions = b->exceptions,
                                                 .exception_count = b->touching_count};
    if (status == MOTE_OK)
        status = mote_impact_scene_query(b->impacts, &question, found);
    if (status == MOTE_OK)
        *until = found->impact.from;
    return status;
}

/* The speed at which a pair's gap closes at a part of the flight, by its distances, so that
   deformation counts. */
static mote_status closing_at(const mote_between *b, const uint32_t body[2], double part,
                              double duration, double *speed)
{
    const double instant = INSTANT / duration;
    const double from = fmax(0, fmin(part, 1 - instant)), to = fmin(1, from + instant);
    mote_impact_found first, second;
    mote_status status = distance_at(b, body, from, &first);
    if (status == MOTE_OK)
        status = distance_at(b, body, to, &second);
    if (status == MOTE_OK)
        *speed = (first.distance - second.distance) / ((to - from) * duration);
    return status;
}

/* Enters an impact. */
static touching *enter(mote_between *b, const uint32_t body[2], double now)
{
    const size_t k = place_of(b, body);
    if (!is_at(b, k, body)) {
        b->touching = mote_reserve(b->touching, b->touching_count + 1, &b->touching_room,
                                   sizeof *b->touching);
        memmove(&b->touching[k + 1], &b->touching[k],
                (b->touching_count - k) * sizeof *b->touching);
        ++b->touching_count;
        b->touching[k] = (touching){.body = {body[0], body[1]}, .last = -HUGE_VAL};
    }
    touching *t = &b->touching[k];
    t->pushes = now - t->last < b->floor ? t->pushes + 1 : 0;
    t->last = now;
    ++t->impacts;
    return t;
}

/* Changes the motion of two bodies by their impact. speed: at which the gap closes; pushes: how
   many impacts have followed each other within the floor. */
static mote_status answer(mote_between *b, mote_simulation *s,
                          const mote_impact_scene_found *found, double speed, uint32_t pushes)
{
    const mote_simulator *simulator = s->simulator;
    const double e = simulator->options.restitution;
    const mote_vec3 n = found->impact.normal;
    const mote_vec3 point =
        mote_scale(mote_add(found->impact.witness[0], found->impact.witness[1]), 0.5);
    const mote_mass *mass[2];
    mote_rigid_state *state[2];
    double along[2];
    bool rigid = true;
    for (int i = 0; i < 2; ++i) {
        const uint32_t body = found->body[i], shape = simulator->shape_of[body];
        mass[i] = &simulator->masses[shape];
        state[i] = &s->states[body];
        along[i] = mote_velocity_along(mass[i], state[i], mote_sub(point, state[i]->centre), n);
        rigid = rigid && simulator->shapes[shape]->field->count == 0;
    }
    const double closing = along[0] - along[1];
    double own = rigid ? 0 : speed - closing; /* of the surfaces */
    if (pushes > 0) {
        const double opens = ldexp(PUSH, pushes - 1 < DOUBLINGS ? (int)pushes - 1 : DOUBLINGS);
        const double least = fmax(closing + own, 0) + opens * b->tolerance / b->floor;
        own = fmax(own, least / (1 + e) - closing);
    }
    mote_impact impact;
    const mote_status status = mote_respond_deforming(mass, point, n, e, own, state, &impact);
    if (status == MOTE_OK) {
        s->result.responses += impact.approaching;
        s->lost.energy += impact.energy;
        s->result.pushes += pushes > 0;
    }
    return status;
}

/* The impact at the end of the flight, `now`. */
static mote_status take_impact(mote_between *b, mote_simulation *s,
                               const mote_impact_scene_found *found, double now,
                               double duration)
{
    touching *t = enter(b, found->body, now);
    double speed = 0;
    ++s->result.impacts;
    mote_status status = look(b, s, found->impact.from, now, false);
    mote_flight_end(b->flight, found->impact.from, s->states);
    if (!(mote_length(found->impact.normal) > 0)) { /* they intersect: there is no direction */
        t->impacts = UINT32_MAX / 2;
        return status;
    }
    if (status == MOTE_OK)
        status = closing_at(b, found->body, found->impact.from, duration, &speed);
    return status == MOTE_OK ? answer(b, s, found, speed, t->pushes) : status;
}

static double now_ns(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

/* One flight: to the end of the step, an impact or a wall. */
static mote_status fly_once(mote_between *b, mote_simulation *s, double now, double duration,
                            double *until)
{
    const bool whole = duration >= b->simulator->options.time_step;
    mote_impact_scene_found found = {.impact.outcome = MOTE_IMPACT_NONE};
    mote_status status = mote_flight_plan(b->flight, s->states, now, duration);
    if (status != MOTE_OK)
        return status;
    *until = mote_flight_wall(b->flight);
    if (b->impacts) {
        const double before = now_ns();
        status = find_impact(b, s, now, duration, until, &found);
        s->result.query_ns += now_ns() - before;
        s->result.near_pairs += whole ? (double)found.near_pairs : 0;
    }
    if (status == MOTE_OK)
        status = look_within(b, s, now, duration, *until);
    if (status == MOTE_OK && found.impact.outcome != MOTE_IMPACT_NONE)
        return take_impact(b, s, &found, now + *until * duration, duration);
    mote_flight_end(b->flight, *until, s->states);
    return status;
}

mote_status mote_between_begin(mote_between *between, mote_simulation *s, uint32_t k)
{
    const double step = between->simulator->options.time_step;
    const mote_status status = mote_flight_plan(between->flight, s->states, k * step, step);
    if (status == MOTE_OK)
        return look(between, s, 0, k * step, true);
    return status;
}

mote_status mote_between_fly(mote_between *between, mote_simulation *s, uint32_t k)
{
    const double step = between->simulator->options.time_step;
    double done = 0;
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < between->touching_count; ++i)
        between->touching[i].impacts = 0;
    while (done < step * (1 - 1e-12) && status == MOTE_OK) {
        double until = 1;
        status = fly_once(between, s, k * step + done, step - done, &until);
        done = until < 1 ? done + until * (step - done) : step;
        mote_simulation_bounce(s);
    }
    return status;
}
