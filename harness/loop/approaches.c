#include "harness/loop/approaches.h"

#include "core/base/random.h"
#include "core/base/turn.h"

#include <stdio.h>
#include <string.h>

/* Uniform over all rotations (Shoemake 1992). */
static mote_quaternion random_turn(mote_random *random)
{
    const double part = mote_random_unit(random);
    double s, c, t, d;
    mote_turn(mote_random_unit(random), &s, &c);
    mote_turn(mote_random_unit(random), &t, &d);
    const double a = sqrt(1 - part), b = sqrt(part);
    return (mote_quaternion){b * d, a * s, a * c, b * t};
}

static double radius_of(const mote_mesh *mesh, mote_vec3 centre)
{
    double most = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        most = fmax(most, mote_distance_squared(mesh->positions[v], centre));
    return sqrt(most);
}

mote_simulation_start mote_approach_draw(const mote_scenario *scenario, const mote_mass *masses,
                                         uint32_t index, mote_rigid_state states[2])
{
    mote_random random = {MOTE_APPROACH_SEED + index};
    const double length = scenario->length;
    const double radian = 3.14159265358979323846 / 180;
    const double range = log(MOTE_APPROACH_FASTEST / MOTE_APPROACH_SLOWEST);
    const double speed =
        length * MOTE_APPROACH_SLOWEST * exp(range * mote_random_unit(&random));
    memset(states, 0, 2 * sizeof *states);
    mote_simulation_start start = {.states = states,
                                   .seed = index + 1,
                                   .apart = MOTE_APPROACH_APART * length,
                                   .depth_unreported = true};
    start.first = 1 + (uint32_t)mote_random_below(&random, scenario->frames);
    for (int i = 0; i < 2; ++i) {
        states[i].turn = random_turn(&random);
        const double turning = MOTE_APPROACH_DEGREES * radian * mote_random_unit(&random);
        states[i].angular_momentum = mote_rigid_angular_momentum(
            &masses[i], &states[i], mote_scale(mote_random_direction(&random), turning));
    }
    const mote_vec3 from = mote_random_direction(&random);
    mote_vec3 aside = mote_cross(from, mote_random_direction(&random));
    aside = mote_scale(aside, MOTE_APPROACH_ASIDE * length * sqrt(mote_random_unit(&random)));
    const double far = radius_of(scenario->body[0].mesh, masses[0].centre) +
                       radius_of(scenario->body[1].mesh, masses[1].centre) +
                       MOTE_APPROACH_CLEAR * length;
    states[1].centre = mote_add_scaled(aside, far, from);
    states[1].velocity = mote_scale(from, -speed);
    const double steps = ceil(2 * far / speed);
    start.steps = steps < MOTE_APPROACH_STEPS ? (uint32_t)steps : MOTE_APPROACH_STEPS;
    return start;
}

static void add_result(mote_approaches *sum, const mote_simulation_result *r)
{
    ++sum->trials;
    sum->approaches += r->approaches > 0;
    sum->passes_through += r->passes > 0;
    sum->deep_passes_through += r->deep_passes > 0;
    sum->intersecting += r->intersections > 0;
    sum->contact_runs += r->approaches;
    sum->contact_runs_passed += r->passes;
    sum->steps += r->steps + 1;
    sum->contact_steps += r->contact_steps;
    sum->missed_steps += r->missed_steps;
    sum->false_steps += r->false_steps;
    sum->responses += r->responses;
    sum->impacts += r->impacts;
    sum->floor_pushes += r->pushes;
    sum->floor_unproven += r->unproven;
    sum->truth_asked += r->truth_asked;
    sum->delay_sum += r->delay_sum;
    sum->delay_max = r->delay_max > sum->delay_max ? r->delay_max : sum->delay_max;
    sum->max_penetration_unreported = fmax(sum->max_penetration_unreported, r->depth_max);
    sum->max_penetration_passes = fmax(sum->max_penetration_passes, r->depth_passes);
    sum->energy_drift = fmax(sum->energy_drift, r->energy_drift);
    sum->momentum_drift = fmax(sum->momentum_drift, r->momentum_drift);
    sum->angular_momentum_drift = fmax(sum->angular_momentum_drift, r->angular_drift);
    sum->query_ns += r->query_ns * ((double)r->steps + 1);
}

mote_status mote_approaches_simulate(mote_scenario *scenario, const mote_approaches_plan *plan,
                                     mote_approaches *sum)
{
    mote_method_choice choice;
    mote_simulator *simulator = NULL;
    const mote_subject subject = {.scenario = scenario};
    mote_simulation_options options = mote_default_simulation_options(&subject);
    options.time_step = plan->step;
    options.within = plan->within;
    const uint32_t wanted = plan->wanted;
    mote_status status = mote_method_choice_read(plan->method, &choice);
    if (status == MOTE_OK)
        status = mote_simulator_create(&subject, &choice, &options, &simulator);
    mote_approaches made = {0};
    for (uint32_t i = 0; status == MOTE_OK && made.approaches < wanted && i < 4 * wanted; ++i) {
        mote_rigid_state states[2];
        mote_simulation_start start =
            mote_approach_draw(scenario, mote_simulator_masses(simulator), i, states);
        start.steps = (uint32_t)ceil(start.steps / plan->step);
        start.depth_unreported = plan->within != MOTE_STEPS_CONTINUOUS;
        mote_simulation_result result;
        status = mote_simulator_run(simulator, &start, NULL, &result);
        if (status == MOTE_OK)
            add_result(&made, &result);
        else
            status = mote_fail(status, "%s, %s, approach %u: %s", scenario->name, plan->method,
                               i + 1, mote_error_text());
    }
    mote_simulator_destroy(simulator);
    if (status != MOTE_OK)
        return status;
    if (made.steps > 0)
        made.query_ns /= (double)made.steps;
    *sum = made;
    return MOTE_OK;
}

double mote_approaches_share(const mote_approaches *sum)
{
    if (sum->approaches == 0)
        return MOTE_NONE;
    return (double)sum->passes_through / (double)sum->approaches;
}

mote_confidence mote_approaches_interval(const mote_approaches *sum)
{
    return mote_statistics_share_interval((double)sum->passes_through, (double)sum->approaches);
}

double mote_approaches_delay(const mote_approaches *sum)
{
    const uint64_t reported = sum->contact_runs - sum->contact_runs_passed;
    return reported > 0 ? (double)sum->delay_sum / (double)reported : MOTE_NONE;
}

json_t *mote_approaches_json(const mote_approaches *sum)
{
    json_t *object = json_object();
#define PUT_COUNT(name)                                                                        \
    (void)json_object_set_new(object, #name, json_integer((json_int_t)sum->name));
#define PUT_FIGURE(name) (void)json_object_set_new(object, #name, json_real(sum->name));
    MOTE_APPROACHES_COUNTS(PUT_COUNT)
    MOTE_APPROACHES_FIGURES(PUT_FIGURE)
#undef PUT_COUNT
#undef PUT_FIGURE
    return object;
}

/* A stored count above this is invalid. */
#define COUNT_MAX ((json_int_t)1 << 53)

static bool read_count(const json_t *value, uint64_t *count)
{
    const json_int_t number = json_integer_value(value);
    *count = (uint64_t)number;
    return json_is_integer(value) && number >= 0 && number <= COUNT_MAX;
}

bool mote_approaches_read(const json_t *object, mote_approaches *sum)
{
    bool whole = true;
#define GET_COUNT(name) whole = read_count(json_object_get(object, #name), &sum->name) && whole;
#define GET_FIGURE(name)                                                                       \
    whole = whole && json_is_number(json_object_get(object, #name));                           \
    sum->name = json_number_value(json_object_get(object, #name));
    MOTE_APPROACHES_COUNTS(GET_COUNT)
    MOTE_APPROACHES_FIGURES(GET_FIGURE)
#undef GET_COUNT
#undef GET_FIGURE
    /* Shares and means are computed from these. */
    return whole && sum->passes_through <= sum->approaches &&
           sum->contact_runs_passed <= sum->contact_runs;
}
