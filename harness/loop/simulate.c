#include "harness/loop/simulate.h"

#include "harness/scene/motion.h"
#include "harness/loop/penetration.h"
#include "harness/base/statistics.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

struct mote_simulator {
    const mote_scenario *scenario;
    mote_method_choice choice;
    mote_simulation_options options;
    mote_mass mass[2];
    double reach[2]; /* greatest distance of a rest vertex from the centre of mass */
    mote_probe *truth, *probe;
    mote_penetration *penetration;
    mote_frame_buffer *buffer;
    double *weights[2]; /* those of the frame, in world axes: x, y, z, [3][padded] */
    double *still[2];   /* the same in rest axes */
    double *before[2];  /* those of the frame before */
};

/* What a run knows from step to step. */
typedef struct run {
    mote_simulator *simulator;
    const mote_simulation_start *start;
    mote_rigid_state state[2], previous[2];
    mote_simulation_result *result;
    double lower;       /* of the true distance, proven */
    double lost;        /* energy lost in impacts */
    mote_answer answer; /* the method's last */
    bool has_normal;    /* witnesses of a separated frame are known */
    mote_vec3 witness[2];
    bool in_contact, reported; /* the run of contacts that goes on */
    uint32_t began;
    double depth; /* its deepest, absolute */
    double query_ns;
} run;

mote_simulation_options mote_default_simulation_options(const mote_scenario *scenario)
{
    const double own = scenario->tolerance / scenario->length;
    return (mote_simulation_options){
        .density = 1, .restitution = 1, .tolerance = own > 0 ? own : 0.005, .time_step = 1};
}

mote_status mote_simulation_options_check(const mote_simulation_options *options)
{
    if (!(options->tolerance > 0 && options->tolerance <= MOTE_SIMULATION_NEAR))
        return mote_fail(MOTE_EINVAL,
                         "contact tolerance %g L; give a number above 0 and at most %g",
                         options->tolerance, MOTE_SIMULATION_NEAR);
    if (!(options->restitution >= 0 && options->restitution <= 1))
        return mote_fail(MOTE_EINVAL, "restitution %g; give a number from 0 to 1",
                         options->restitution);
    if (!isfinite(mote_length(options->gravity)))
        return mote_fail(MOTE_EINVAL, "gravity is not finite");
    if (!(options->time_step > 0 && options->time_step <= MOTE_SIMULATION_STEP_MAX))
        return mote_fail(MOTE_EINVAL,
                         "time step %g frames; give a number above 0 and at most %g",
                         options->time_step, MOTE_SIMULATION_STEP_MAX);
    return MOTE_OK;
}

static mote_status weigh(mote_simulator *s, int i)
{
    const mote_mesh *mesh = s->scenario->body[i].mesh;
    const mote_status status = mote_mass_of_mesh(mesh, s->options.density, &s->mass[i]);
    if (status != MOTE_OK)
        return mote_fail(status, "%s: body %d cannot respond to a collision: %s",
                         s->scenario->path, i + 1, mote_error_text());
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        s->reach[i] =
            fmax(s->reach[i], mote_distance_squared(mesh->positions[v], s->mass[i].centre));
    s->reach[i] = sqrt(s->reach[i]);
    const size_t numbers = (size_t)3 * s->scenario->body[i].field->padded + 1;
    s->weights[i] = calloc(numbers, sizeof(double));
    s->still[i] = calloc(numbers, sizeof(double));
    s->before[i] = calloc(numbers, sizeof(double));
    if (!s->weights[i] || !s->still[i] || !s->before[i])
        return mote_fail(MOTE_ENOMEM, "no memory for a body's weights");
    return MOTE_OK;
}

static mote_status probe_for(mote_simulator *s, const mote_method_choice *choice, uint64_t seed,
                             mote_probe **probe)
{
    const mote_scenario *scenario = s->scenario;
    return mote_probe_create(&scenario->body[0], &scenario->body[1], choice, MOTE_ASK_DISTANCE,
                             s->options.tolerance * scenario->length, seed, probe);
}

mote_status mote_simulator_create(const mote_scenario *scenario,
                                  const mote_method_choice *choice,
                                  const mote_simulation_options *options,
                                  mote_simulator **simulator)
{
    mote_status status = mote_simulation_options_check(options);
    if (status != MOTE_OK)
        return status;
    mote_simulator *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a simulation");
    made->scenario = scenario;
    made->choice = *choice;
    made->options = *options;
    mote_method_choice exact;
    const bool certified = strcmp(choice->method->name, "certified") == 0;
    for (int i = 0; i < 2 && status == MOTE_OK; ++i)
        status = weigh(made, i);
    if (status == MOTE_OK)
        status = mote_penetration_create(scenario->body[0].mesh, scenario->body[1].mesh,
                                         &made->penetration);
    if (status == MOTE_OK)
        status = mote_frame_buffer_create(scenario, &made->buffer);
    if (status == MOTE_OK)
        status = mote_method_choice_read(certified ? "aabb-tree" : "certified", &exact);
    if (status == MOTE_OK)
        status = probe_for(made, &exact, 1, &made->truth);
    if (status == MOTE_OK)
        *simulator = made;
    else
        mote_simulator_destroy(made);
    return status;
}

void mote_simulator_destroy(mote_simulator *simulator)
{
    if (!simulator)
        return;
    for (int i = 0; i < 2; ++i) {
        free(simulator->weights[i]);
        free(simulator->still[i]);
        free(simulator->before[i]);
    }
    mote_probe_destroy(simulator->truth);
    mote_probe_destroy(simulator->probe);
    mote_penetration_destroy(simulator->penetration);
    mote_frame_buffer_destroy(simulator->buffer);
    free(simulator);
}

const mote_mass *mote_simulator_masses(const mote_simulator *simulator)
{
    return simulator->mass;
}

static mote_quaternion turn_at(const mote_body_motion *motion, double place)
{
    double q[4] = {1, 0, 0, 0};
    if (motion->rotation)
        mote_curve_evaluate(motion->rotation, place, q);
    return mote_quaternion_normalise((mote_quaternion){q[0], q[1], q[2], q[3]});
}

mote_simulation_start mote_simulation_start_of(const mote_simulator *simulator)
{
    const mote_scenario *scenario = simulator->scenario;
    const double steps = ceil((scenario->frames - 1.0) / simulator->options.time_step);
    mote_simulation_start start = {.first = 1, .seed = 1};
    start.steps = (uint32_t)fmin(fmax(steps, 1), MOTE_SIMULATION_STEPS_MAX);
    for (int i = 0; i < 2; ++i) {
        const mote_body_motion *motion = &scenario->motion->body[i];
        const mote_mass *mass = &simulator->mass[i];
        mote_rigid_state *state = &start.state[i];
        const mote_pose pose = mote_motion_pose(motion, scenario->motion->start);
        mote_vec3 velocity, spin;
        mote_scenario_velocity(scenario, i, &velocity, &spin);
        state->centre = mote_pose_apply(&pose, mass->centre);
        state->turn = turn_at(motion, scenario->motion->start);
        const mote_vec3 arm = mote_sub(state->centre, mote_pose_apply(&pose, motion->centre));
        state->velocity = mote_add(velocity, mote_cross(spin, arm));
        state->angular_momentum = mote_rigid_angular_momentum(mass, state, spin);
    }
    return start;
}

/* The place among the frames whose deformation step k shows: forwards, then backwards, and so
   on. */
static double shown_place(const run *r, uint32_t k)
{
    const mote_simulator *s = r->simulator;
    if (s->scenario->frames == 1)
        return 1;
    const double last = s->scenario->frames - 1.0;
    const double place = fmod(r->start->first - 1.0 + k * s->options.time_step, 2 * last);
    return 1 + (place <= last ? place : 2 * last - place);
}

/* The scenario's deformation at that place with the simulated poses. */
static mote_frame frame_of(run *r, uint32_t k)
{
    mote_simulator *s = r->simulator;
    mote_frame frame = *mote_scenario_frame_at(s->scenario, s->buffer, shown_place(r, k));
    frame.number = (uint64_t)k + 1;
    for (int i = 0; i < 2; ++i) {
        mote_body_state *body = &frame.body[i];
        const mote_mat3 shown = body->pose.rotation;
        const uint32_t padded = body->weights.padded, count = body->weights.count;
        double *still = s->before[i];
        s->before[i] = s->still[i];
        s->still[i] = still;
        body->pose = mote_rigid_pose(&s->mass[i], &r->state[i]);
        body->pose_changed = body->shape_changed = true;
        if (count == 0) {
            body->shape_changed = k == 0;
            continue;
        }
        double *world = s->weights[i];
        for (uint32_t j = 0; j < count; ++j) {
            const mote_vec3 w =
                mote_rotate_back(&shown, mote_vec3_make(body->weights.x[j], body->weights.y[j],
                                                        body->weights.z[j]));
            const mote_vec3 turned = mote_rotate(&body->pose.rotation, w);
            memcpy(&still[(size_t)3 * j], &w, sizeof w);
            world[j] = turned.x;
            world[padded + j] = turned.y;
            world[2 * padded + j] = turned.z;
        }
        body->weights.x = world;
        body->weights.y = world + padded;
        body->weights.z = world + 2 * (size_t)padded;
    }
    return frame;
}

/* The most that any point of body i has moved since the frame before: by its centre, by the
   turn, and by the deformation, basis functions being at most 1. */
static double moved(const run *r, int i)
{
    const mote_simulator *s = r->simulator;
    const mote_rigid_state *a = &r->previous[i], *b = &r->state[i];
    const mote_quaternion back = {a->turn.w, -a->turn.x, -a->turn.y, -a->turn.z};
    const mote_quaternion d = mote_quaternion_multiply(b->turn, back);
    const double chord = 2 * sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    double reach = s->reach[i], shape = 0;
    const mote_vec3 *now = (const mote_vec3 *)(const void *)s->still[i];
    const mote_vec3 *then = (const mote_vec3 *)(const void *)s->before[i];
    for (uint32_t j = 0; j < s->scenario->body[i].field->count; ++j) {
        reach += mote_length(then[j]);
        shape += mote_length(mote_sub(now[j], then[j]));
    }
    return mote_length(mote_sub(b->centre, a->centre)) + chord * reach + shape;
}

/* Of this thread's processor time: simulations run beside others. */
static double now_ns(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

/* What the method says, and the witnesses of the last separated frame. */
static mote_status ask_method(run *r, const mote_frame *frame, bool *contact)
{
    const mote_simulator *s = r->simulator;
    const double from = now_ns();
    const mote_status status = mote_probe_answer(s->probe, frame, &r->answer);
    r->query_ns += now_ns() - from;
    if (status != MOTE_OK)
        return status;
    const mote_answer answer = r->answer;
    if (!answer.has_contact && !answer.has_distance)
        return mote_fail(MOTE_EUNSUPPORTED, "%s says neither distance nor contact",
                         s->choice.text);
    *contact = answer.has_contact
                   ? answer.contact
                   : answer.distance <= s->options.tolerance * s->scenario->length;
    if (answer.has_witness && answer.has_distance && answer.distance > 0 &&
        mote_distance_squared(answer.witness[0], answer.witness[1]) > 0) {
        memcpy(r->witness, answer.witness, sizeof r->witness);
        r->has_normal = true;
    }
    return MOTE_OK;
}

/* Whether the bodies touch, by the exact method, where that is not known already. */
static mote_status ask_truth(run *r, const mote_frame *frame, bool *contact, double *distance)
{
    const mote_simulator *s = r->simulator;
    const double length = s->scenario->length;
    *contact = false;
    *distance = r->lower;
    if (r->lower > MOTE_SIMULATION_NEAR * length)
        return MOTE_OK;
    mote_answer answer = {0};
    const mote_status status = mote_probe_answer(s->truth, frame, &answer);
    if (status != MOTE_OK)
        return status;
    ++r->result->truth_asked;
    *distance = r->lower = answer.distance;
    *contact = answer.distance <= s->options.tolerance * length;
    return MOTE_OK;
}

static mote_status measure_depth(run *r, const mote_frame *frame)
{
    const mote_simulator *s = r->simulator;
    return mote_penetration_depth(s->penetration, mote_probe_vertices(s->truth, frame, 0),
                                  mote_probe_vertices(s->truth, frame, 1), r->depth, &r->depth);
}

static void end_contact(run *r)
{
    if (!r->in_contact)
        return;
    mote_simulation_result *result = r->result;
    const double depth = r->depth / r->simulator->scenario->length;
    ++result->approaches;
    if (!r->reported) {
        ++result->passes;
        result->deep_passes += depth > 0;
        result->depth_passes = fmax(result->depth_passes, depth);
    }
    result->depth_max = fmax(result->depth_max, depth);
    r->in_contact = false;
}

/* Books what truth and the method say of step k. */
static mote_status book(run *r, const mote_frame *frame, uint32_t k, bool truth, bool said,
                        double distance)
{
    mote_simulation_result *result = r->result;
    result->false_steps += said && !truth;
    if (!truth) {
        end_contact(r);
        return MOTE_OK;
    }
    if (!r->in_contact) {
        r->in_contact = true;
        r->reported = false;
        r->began = k;
        r->depth = 0;
    }
    ++result->contact_steps;
    result->missed_steps += !said;
    if (said && !r->reported) {
        const uint32_t delay = k - r->began;
        r->reported = true;
        result->delay_sum += delay;
        result->delay_max = delay > result->delay_max ? delay : result->delay_max;
    }
    /* Apart, no vertex is inside. */
    if (distance > 0 || (r->start->depth_unreported && r->reported))
        return MOTE_OK;
    return measure_depth(r, frame);
}

static mote_status respond(run *r)
{
    const mote_simulator *s = r->simulator;
    if (!r->has_normal)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s reports a contact but has given no witness points: there is no "
                         "normal to respond along",
                         s->choice.text);
    const mote_mass *const mass[2] = {&s->mass[0], &s->mass[1]};
    mote_rigid_state *const state[2] = {&r->state[0], &r->state[1]};
    const mote_vec3 point = mote_scale(mote_add(r->witness[0], r->witness[1]), 0.5);
    const mote_vec3 normal = mote_sub(r->witness[1], r->witness[0]);
    mote_impact impact;
    const mote_status status =
        mote_respond(mass, point, normal, s->options.restitution, state, &impact);
    if (status != MOTE_OK)
        return status;
    r->result->responses += impact.approaching;
    r->lost += impact.energy;
    return MOTE_OK;
}

/* What should stay as it is. */
typedef struct invariants {
    double energy, energy_size;
    mote_vec3 momentum, angular;
    double momentum_size, angular_size;
} invariants;

static invariants invariants_of(const run *r, double time)
{
    const mote_simulator *s = r->simulator;
    const mote_vec3 gravity = mote_scale(s->options.gravity, s->scenario->length);
    invariants sum = {.energy = r->lost};
    for (int i = 0; i < 2; ++i) {
        const mote_rigid_state *state = &r->state[i];
        const double m = s->mass[i].mass;
        const double kinetic = mote_rigid_kinetic_energy(&s->mass[i], state);
        const mote_vec3 fallen = mote_sub(state->centre, r->start->state[i].centre);
        sum.energy_size += kinetic;
        sum.energy += kinetic - m * mote_dot(gravity, fallen);
        sum.momentum =
            mote_add_scaled(sum.momentum, m, mote_add_scaled(state->velocity, -time, gravity));
        sum.angular = mote_add(
            sum.angular, mote_add(mote_scale(mote_cross(state->centre, state->velocity), m),
                                  state->angular_momentum));
        sum.momentum_size += m * mote_length(state->velocity);
        sum.angular_size += m * mote_length(state->centre) * mote_length(state->velocity) +
                            mote_length(state->angular_momentum);
    }
    return sum;
}

static void note_drift(run *r, invariants *first, uint32_t k)
{
    const invariants now = invariants_of(r, k * r->simulator->options.time_step);
    mote_simulation_result *result = r->result;
    first->energy_size = fmax(first->energy_size, now.energy_size);
    first->momentum_size = fmax(first->momentum_size, now.momentum_size);
    first->angular_size = fmax(first->angular_size, now.angular_size);
    if (first->energy_size > 0)
        result->energy_drift =
            fmax(result->energy_drift, fabs(now.energy - first->energy) / first->energy_size);
    if (first->momentum_size > 0)
        result->momentum_drift =
            fmax(result->momentum_drift,
                 mote_length(mote_sub(now.momentum, first->momentum)) / first->momentum_size);
    if (first->angular_size > 0)
        result->angular_drift =
            fmax(result->angular_drift,
                 mote_length(mote_sub(now.angular, first->angular)) / first->angular_size);
}

static mote_status move_on(run *r)
{
    const mote_simulator *s = r->simulator;
    const mote_vec3 gravity = mote_scale(s->options.gravity, s->scenario->length);
    mote_status status = MOTE_OK;
    memcpy(r->previous, r->state, sizeof r->previous);
    for (int i = 0; i < 2 && status == MOTE_OK; ++i)
        status = mote_rigid_step(&s->mass[i], gravity, s->options.time_step, &r->state[i]);
    return status;
}

/* One frame: what is, what the method says, what follows. */
static mote_status step(run *r, uint32_t k)
{
    const mote_frame frame = frame_of(r, k);
    if (k > 0)
        r->lower = fmax(0, r->lower - moved(r, 0) - moved(r, 1));
    bool said = false, truth = false;
    double distance = 0;
    mote_status status = ask_method(r, &frame, &said);
    if (status == MOTE_OK)
        status = ask_truth(r, &frame, &truth, &distance);
    if (status == MOTE_OK && k == 0 && truth)
        return mote_fail(MOTE_EINVAL,
                         "%s: the bodies start in contact (%g L apart), where no normal is "
                         "known; start them more than the tolerance of %g L apart",
                         r->simulator->scenario->path,
                         distance / r->simulator->scenario->length,
                         r->simulator->options.tolerance);
    if (status == MOTE_OK)
        status = book(r, &frame, k, truth, said, distance);
    const mote_simulation_view view = {.step = k,
                                       .frame = &frame,
                                       .said = &r->answer,
                                       .method = r->simulator->probe,
                                       .contact = said,
                                       .truth = truth};
    if (status == MOTE_OK && r->start->watch)
        status = r->start->watch(r->start->context, &view);
    if (status == MOTE_OK && said)
        status = respond(r);
    return status;
}

static bool is_over(const run *r)
{
    if (!(r->start->apart > 0) || r->lower <= r->start->apart)
        return false;
    const mote_vec3 between = mote_sub(r->state[1].centre, r->state[0].centre);
    return mote_dot(between, mote_sub(r->state[1].velocity, r->state[0].velocity)) >= 0;
}

static mote_status loop(run *r, mote_rigid_state (*trace)[2])
{
    mote_status status = MOTE_OK;
    invariants first = invariants_of(r, 0);
    uint32_t k = 0;
    for (;; ++k) {
        if (trace)
            memcpy(trace[k], r->state, sizeof r->state);
        status = step(r, k);
        if (status != MOTE_OK)
            return status;
        note_drift(r, &first, k);
        if (k == r->start->steps || is_over(r))
            break;
        status = move_on(r);
        if (status != MOTE_OK)
            return status;
    }
    end_contact(r);
    r->result->steps = k;
    r->result->query_ns = r->query_ns / (k + 1.0);
    if (mote_length(r->simulator->options.gravity) > 0)
        r->result->angular_drift = MOTE_NONE;
    return MOTE_OK;
}

mote_status mote_simulator_run(mote_simulator *simulator, const mote_simulation_start *start,
                               mote_rigid_state (*trace)[2], mote_simulation_result *result)
{
    mote_probe_destroy(simulator->probe);
    simulator->probe = NULL;
    mote_status status =
        probe_for(simulator, &simulator->choice, start->seed, &simulator->probe);
    if (status != MOTE_OK)
        return status;
    mote_simulation_result made = {0};
    run r = {.simulator = simulator, .start = start, .result = &made};
    memcpy(r.state, start->state, sizeof r.state);
    status = loop(&r, trace);
    if (status == MOTE_OK)
        *result = made;
    return status;
}
