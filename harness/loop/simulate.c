#include "harness/loop/simulate.h"

#include "harness/base/memory.h"
#include "harness/base/statistics.h"
#include "harness/loop/between.h"
#include "harness/loop/simulate_state.h"

#include <stdlib.h>
#include <string.h>

/* Updates gaps for the near pairs: from the current answer if they are apart, otherwise the
   last known one. */
static void update_gaps(mote_simulation *s)
{
    size_t old = 0;
    s->next_gaps =
        mote_reserve(s->next_gaps, s->said.count, &s->next_capacity, sizeof *s->next_gaps);
    for (size_t k = 0; k < s->said.count; ++k) {
        const mote_near_pair *pair = &s->said.pairs[k];
        const mote_answer *a = &pair->answer;
        mote_simulation_gap *made = &s->next_gaps[k];
        *made = (mote_simulation_gap){.body = {pair->body[0], pair->body[1]}};
        while (old < s->gap_count && mote_pair_order(s->gaps[old].body, made->body) < 0)
            ++old;
        if (old < s->gap_count && mote_pair_order(s->gaps[old].body, made->body) == 0)
            *made = s->gaps[old];
        if (a->has_witness && a->has_distance && a->distance > 0 &&
            mote_distance_squared(a->witness[0], a->witness[1]) > 0) {
            made->known = true;
            memcpy(made->witness, a->witness, sizeof made->witness);
        }
    }
    mote_simulation_gap *block = s->gaps;
    const size_t capacity = s->gap_capacity;
    s->gaps = s->next_gaps;
    s->gap_capacity = s->next_capacity;
    s->next_gaps = block;
    s->next_capacity = capacity;
    s->gap_count = s->said.count;
}

static mote_status respond(mote_simulation *s, const mote_simulation_gap *along)
{
    const mote_simulator *simulator = s->simulator;
    if (!along->known)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s reports a contact of bodies %u and %u but has given no witness "
                         "points of them: there is no normal to respond along",
                         simulator->choice.text, along->body[0] + 1, along->body[1] + 1);
    const mote_mass *mass[2];
    mote_rigid_state *state[2];
    for (int b = 0; b < 2; ++b) {
        mass[b] = &simulator->masses[simulator->shape_of[along->body[b]]];
        state[b] = &s->states[along->body[b]];
    }
    mote_impact impact;
    const mote_vec3 point = mote_scale(mote_add(along->witness[0], along->witness[1]), 0.5);
    const mote_vec3 normal = mote_sub(along->witness[1], along->witness[0]);
    const mote_status status =
        mote_respond(mass, point, normal, simulator->options.restitution, state, &impact);
    if (status == MOTE_OK) {
        s->result.responses += impact.approaching;
        s->lost.energy += impact.energy;
    }
    return status;
}

/* A mote_contact_depth for two bodies as currently shown. */
static mote_status depth_of(void *context, const uint32_t body[2], double above, double *depth)
{
    mote_simulation *s = context;
    mote_simulator *simulator = s->simulator;
    uint32_t shape[2];
    mote_status status = MOTE_OK;
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        shape[i] = simulator->shape_of[body[i]];
        if (!simulator->deform[shape[i]])
            status =
                mote_deform_create(simulator->shapes[shape[i]], &simulator->deform[shape[i]]);
        if (status == MOTE_OK)
            mote_deform_all(simulator->deform[shape[i]], &s->shown[body[i]],
                            simulator->world[i]);
    }
    if (status != MOTE_OK)
        return status;
    mote_penetration **made =
        &simulator->penetrations[(size_t)shape[0] * simulator->bodies.shape_count + shape[1]];
    if (!*made)
        status = mote_penetration_create(simulator->shapes[shape[0]]->mesh,
                                         simulator->shapes[shape[1]]->mesh, made);
    if (status == MOTE_OK)
        *depth = mote_penetration_depth(*made, simulator->world[0], simulator->world[1], above);
    return status;
}

/* Reflects a coordinate of the velocity at a wall. */
static void bounce(mote_simulation *s, double mass, double centre, double room,
                   double *velocity, double *lost)
{
    if (!((centre > room && *velocity > 0) || (centre < -room && *velocity < 0)))
        return;
    *lost += 2 * mass * *velocity;
    *velocity = -*velocity;
    ++s->result.bounces;
}

void mote_simulation_bounce(mote_simulation *s)
{
    const mote_simulator *simulator = s->simulator;
    const mote_vec3 *room = &simulator->room;
    mote_vec3 *lost = &s->lost.momentum;
    for (uint32_t i = 0; i < simulator->bodies.count; ++i) {
        const double mass = simulator->masses[simulator->shape_of[i]].mass;
        mote_rigid_state *state = &s->states[i];
        bounce(s, mass, state->centre.x, room->x, &state->velocity.x, &lost->x);
        bounce(s, mass, state->centre.y, room->y, &state->velocity.y, &lost->y);
        bounce(s, mass, state->centre.z, room->z, &state->velocity.z, &lost->z);
    }
}

static mote_status move_on(mote_simulation *s, uint32_t k)
{
    const mote_simulator *simulator = s->simulator;
    mote_status status = MOTE_OK;
    if (simulator->between)
        return mote_between_fly(simulator->between, s, k);
    for (uint32_t i = 0; i < simulator->bodies.count && status == MOTE_OK; ++i)
        status = mote_rigid_step(&simulator->masses[simulator->shape_of[i]], simulator->gravity,
                                 simulator->options.time_step, &s->states[i]);
    mote_simulation_bounce(s);
    return status;
}

static mote_status check_apart(const mote_simulation *s)
{
    const mote_simulator *simulator = s->simulator;
    for (size_t k = 0; k < s->truth.count; ++k) {
        const mote_near_pair *pair = &s->truth.pairs[k];
        if (pair->answer.contact)
            return mote_fail(MOTE_EINVAL,
                             "%s: bodies %u and %u start in contact (%g L apart), where no "
                             "normal is known; start them more than the tolerance of %g L "
                             "apart",
                             simulator->bodies.path, pair->body[0] + 1, pair->body[1] + 1,
                             pair->answer.distance / simulator->bodies.length,
                             simulator->options.tolerance);
    }
    return MOTE_OK;
}

static bool some_contact(const mote_stage_pairs *list)
{
    for (size_t k = 0; k < list->count; ++k) {
        if (list->pairs[k].answer.contact)
            return true;
    }
    return false;
}

static mote_status watch(const mote_simulation *s, uint32_t k)
{
    if (!s->start->watch)
        return MOTE_OK;
    const mote_simulator *simulator = s->simulator;
    const mote_simulation_view view = {.step = k,
                                       .states = s->shown,
                                       .said = s->said.pairs,
                                       .said_count = s->said.count,
                                       .method = mote_stage_method(simulator->stage),
                                       .contact = some_contact(&s->said),
                                       .truth = some_contact(&s->truth)};
    return s->start->watch(s->start->context, &view);
}

mote_status mote_simulation_look(mote_simulation *s, uint32_t step)
{
    const mote_status status =
        mote_contact_runs_step(&s->runs, s->looks++, s->truth.pairs, s->truth.count,
                               s->said.pairs, s->said.count, depth_of, s);
    return status == MOTE_OK && step != UINT32_MAX ? watch(s, step) : status;
}

static mote_status look_at_step(mote_simulation *s, uint32_t k)
{
    mote_stage *stage = s->simulator->stage;
    s->shown = mote_stage_show(stage, k, s->states);
    mote_status status = mote_stage_ask_method(stage, &s->said, &s->result.query_ns);
    if (status == MOTE_OK)
        status = mote_stage_ask_truth(stage, &s->truth, &s->result.truth_asked, &s->lower);
    if (status == MOTE_OK && k == 0)
        status = check_apart(s);
    return status == MOTE_OK ? mote_simulation_look(s, k) : status;
}

/* One step: the truth, the method's answers, the response. */
static mote_status step(mote_simulation *s, uint32_t k)
{
    mote_between *between = s->simulator->between;
    mote_status status = MOTE_OK;
    if (!between)
        status = look_at_step(s, k);
    else
        status = mote_between_begin(between, s, k);
    if (status == MOTE_OK && between && k == 0)
        status = check_apart(s);
    if (status != MOTE_OK || s->simulator->options.within == MOTE_STEPS_CONTINUOUS)
        return status;
    s->result.near_pairs += (double)s->said.count;
    update_gaps(s);
    for (size_t p = 0; p < s->said.count && status == MOTE_OK; ++p) {
        /* A long step may end where two bodies intersect that were never near before: they go
           on as they are, which is what sampled steps are to show. */
        if (s->said.pairs[p].answer.contact && (s->gaps[p].known || !between))
            status = respond(s, &s->gaps[p]);
    }
    return status;
}

/* Whether the two bodies are far enough apart and separating. */
static bool is_over(const mote_simulation *s)
{
    if (!(s->start->apart > 0) || s->lower <= s->start->apart)
        return false;
    const mote_rigid_state *a = &s->states[0], *b = &s->states[1];
    return mote_dot(mote_sub(b->centre, a->centre), mote_sub(b->velocity, a->velocity)) >= 0;
}

static mote_status loop(mote_simulation *s, mote_rigid_state *trace)
{
    const mote_simulator *simulator = s->simulator;
    const size_t count = simulator->bodies.count;
    const mote_drift_bodies watched = {s->states,         s->start->states,
                                       simulator->masses, simulator->shape_of,
                                       (uint32_t)count,   simulator->gravity};
    mote_drift_note(&s->drift, &watched, &s->lost, 0);
    for (uint32_t k = 0;; ++k) {
        if (trace)
            memcpy(trace + k * count, s->states, count * sizeof *trace);
        s->result.steps = k;
        mote_status status = step(s, k);
        if (status != MOTE_OK)
            return status;
        mote_drift_note(&s->drift, &watched, &s->lost, k * simulator->options.time_step);
        if (k == s->start->steps || is_over(s))
            return MOTE_OK;
        status = move_on(s, k);
        if (status != MOTE_OK)
            return status;
    }
}

static mote_simulation_result result_of(mote_simulation *s)
{
    mote_simulation_result result = s->result;
    const double length = s->simulator->bodies.length, steps = (double)result.steps + 1;
    mote_contact_runs_end(&s->runs);
    result.contact_steps = s->runs.contact_steps;
    result.missed_steps = s->runs.missed_steps;
    result.false_steps = s->runs.false_steps;
    result.approaches = s->runs.approaches;
    result.passes = s->runs.passes;
    result.deep_passes = s->runs.deep_passes;
    result.intersections = s->runs.intersections;
    result.delay_sum = s->runs.delay_sum;
    result.delay_max = s->runs.delay_max;
    result.depth_max = s->runs.depth_max / length;
    result.depth_passes = s->runs.depth_passes / length;
    result.energy_drift = s->drift.energy;
    result.momentum_drift = s->drift.momentum;
    const bool kept = !(mote_length(s->simulator->gravity) > 0) && result.bounces == 0;
    result.angular_drift = kept ? s->drift.angular : MOTE_NONE;
    result.near_pairs /= steps;
    result.query_ns /= steps;
    return result;
}

mote_status mote_simulator_run(mote_simulator *simulator, const mote_simulation_start *start,
                               mote_rigid_state *trace, mote_simulation_result *result)
{
    mote_status status = mote_stage_restart(simulator->stage, start);
    if (status != MOTE_OK)
        return status;
    if (simulator->between)
        mote_between_restart(simulator->between);
    mote_simulation s = {.simulator = simulator, .start = start};
    s.runs.depth_unreported = start->depth_unreported;
    s.states = mote_copy(start->states, simulator->bodies.count * sizeof *s.states);
    status = loop(&s, trace);
    if (status == MOTE_OK)
        *result = result_of(&s);
    mote_contact_runs_free(&s.runs);
    free(s.states);
    free(s.gaps);
    free(s.next_gaps);
    return status;
}
