/* mote simulate SCENARIO --method NAME[:...]: the closed loop on the command line. */
#include "harness/loop/bodies_simulate_print.h"
#include "harness/loop/film.h"
#include "harness/base/json_print.h"
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/loop/simulate.h"
#include "harness/base/statistics.h"
#include "harness/loop/trace.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct request {
    const char *scenario, *method, *trace, *film;
    mote_method_choice choice;
    bool json;
    double density, restitution, tolerance, time_step; /* MOTE_NONE: the default */
    mote_vec3 gravity;
    uint64_t steps, seed; /* steps 0: all frames */
} request;

static json_t *number(double value)
{
    return isnan(value) ? json_null() : json_real(value);
}

static int print_json(const request *wish, const mote_simulation_result *r)
{
    json_t *root = json_pack(
        "{s:s, s:s, s:i, s:i, s:i, s:i, s:f, s:f, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:f}",
        "scenario", wish->scenario, "method", wish->choice.text, "steps", r->steps,
        "approaches", r->approaches, "passes_through", r->passes, "deep_passes_through",
        r->deep_passes, "max_penetration", r->depth_max, "max_penetration_passes",
        r->depth_passes, "contact_steps", r->contact_steps, "missed_steps", r->missed_steps,
        "false_steps", r->false_steps, "responses", r->responses, "delay_sum", r->delay_sum,
        "delay_max", r->delay_max, "truth_asked", r->truth_asked, "query_ns", r->query_ns);
    (void)json_object_set_new(root, "energy_drift", number(r->energy_drift));
    (void)json_object_set_new(root, "momentum_drift", number(r->momentum_drift));
    (void)json_object_set_new(root, "angular_momentum_drift", number(r->angular_drift));
    mote_text text = {0};
    mote_json_print(root, 17, &text);
    json_decref(root);
    if (text.failed) {
        free(text.data);
        (void)mote_fail(MOTE_ENOMEM, "no memory for a simulation's figures");
        return mote_command_fail();
    }
    (void)fputs(text.data, stdout);
    free(text.data);
    return MOTE_EXIT_DONE;
}

static void print_lines(const request *wish, const mote_simulation_result *r)
{
    (void)printf("%s, %s: %u steps, %.3g us each for the method\n", wish->scenario,
                 wish->choice.text, r->steps, r->query_ns / 1e3);
    (void)printf("approaches %u, passes through %u (%u of them with a vertex inside)\n",
                 r->approaches, r->passes, r->deep_passes);
    (void)printf("contact in %u steps, missed in %u, false in %u, delay %u at most\n",
                 r->contact_steps, r->missed_steps, r->false_steps, r->delay_max);
    (void)printf("responses %u, penetration at most %.3g L\n", r->responses, r->depth_max);
    (void)printf("drift: energy %.2g, momentum %.2g", r->energy_drift, r->momentum_drift);
    if (!isnan(r->angular_drift))
        (void)printf(", angular momentum %.2g", r->angular_drift);
    (void)printf("\n");
}

/* What the command line says over the defaults. */
static void take_wishes(const request *wish, mote_simulation_options *options)
{
    if (!isnan(wish->density))
        options->density = wish->density;
    if (!isnan(wish->restitution))
        options->restitution = wish->restitution;
    if (!isnan(wish->tolerance))
        options->tolerance = wish->tolerance;
    if (!isnan(wish->time_step))
        options->time_step = wish->time_step;
    options->gravity = wish->gravity;
}

static mote_status simulate(const request *wish, const mote_scenario *scenario,
                            mote_simulation_result *result)
{
    mote_simulation_options options = mote_default_simulation_options(scenario);
    take_wishes(wish, &options);
    mote_simulator *simulator;
    mote_status status = mote_simulator_create(scenario, &wish->choice, &options, &simulator);
    if (status != MOTE_OK)
        return status;
    mote_simulation_start start = mote_simulation_start_of(simulator);
    start.seed = wish->seed;
    if (wish->steps > 0)
        start.steps = (uint32_t)wish->steps;
    mote_rigid_state(*trace)[2] = NULL;
    if (wish->trace && !(trace = calloc((size_t)start.steps + 1, sizeof *trace)))
        status = mote_fail(MOTE_ENOMEM, "no memory for a trace of %u steps", start.steps);
    mote_film *film = NULL;
    if (status == MOTE_OK && wish->film)
        status = mote_film_create(scenario, wish->choice.text, start.steps, wish->film, &film);
    if (film) {
        start.watch = mote_film_watch;
        start.context = film;
    }
    if (status == MOTE_OK)
        status = mote_simulator_run(simulator, &start, trace, result);
    if (status == MOTE_OK && film)
        status = mote_film_draw(film);
    mote_film_destroy(film);
    if (status == MOTE_OK && trace)
        status = mote_trace_write(scenario, mote_simulator_masses(simulator),
                                  (const mote_rigid_state(*)[2])trace, result->steps + 1,
                                  &options, wish->trace);
    free(trace);
    mote_simulator_destroy(simulator);
    return status;
}

/* The same for a scenario of several bodies. */
static mote_status simulate_several(const request *wish)
{
    mote_method_choice choice;
    mote_bodies *bodies;
    mote_status status = mote_scene_choice_read(wish->method, &choice);
    if (status == MOTE_OK)
        status = mote_bodies_load(wish->scenario, &bodies);
    if (status != MOTE_OK)
        return status;
    const double own = bodies->tolerance / bodies->length;
    mote_simulation_options options = {
        .density = 1, .restitution = 1, .tolerance = own > 0 ? own : 0.005, .time_step = 1};
    take_wishes(wish, &options);
    const double frames = ceil((bodies->frames - 1.0) / options.time_step);
    const double steps = wish->steps > 0 ? (double)wish->steps
                                         : fmin(fmax(frames, 1), MOTE_SIMULATION_STEPS_MAX);
    mote_bodies_simulation result;
    status =
        mote_bodies_simulate(bodies, &choice, &options, (uint32_t)steps, wish->seed, &result);
    if (status == MOTE_OK && wish->json)
        status = mote_bodies_simulation_json(bodies, &choice, &result);
    else if (status == MOTE_OK)
        mote_bodies_simulation_print(bodies, &choice, &result);
    mote_bodies_destroy(bodies);
    return status;
}

static bool read_vector(const char *text, mote_vec3 *v)
{
    double value[3];
    if (!mote_read_triple(text, value))
        return false;
    *v = (mote_vec3){value[0], value[1], value[2]};
    return isfinite(mote_length(*v));
}

const mote_option mote_options_simulate[] = {
    {"method", "NAME[:key=value,...]", "the method that says where bodies touch; no default"},
    {"json", NULL, "as JSON"},
    {"steps", "K", "1 to 1000000 (default: all frames of the scenario)"},
    {"seed", "S", "of the method, for two bodies (default: 1)"},
    {"density", "D", "of all bodies (default: 1)"},
    {"restitution", "E", "0: no rebound, 1: no energy is lost (default: 1)"},
    {"tolerance", "T",
     "distance of a contact, in L (default: the scenario's, or 0.005 where that is 0)"},
    {"gravity", "X,Y,Z", "in L a frame squared (default: 0,0,0)"},
    {"time-step", "H", "frames a step (default: 1)"},
    {"trace", "FILE.json",
     "write the motion as a scenario, for two bodies (default: not written)"},
    {"film", "FILE.gif", "draw the motion, for two bodies (default: not drawn)"},
    {NULL, NULL, NULL}};

/* False, told on stderr, when the value is not right for the option. */
static bool read_option(request *wish, int option, const char *value)
{
    static const char *const wanted[] = {"",
                                         "",
                                         "give a number of steps from 1 to 1000000",
                                         "give a whole number",
                                         "give a number",
                                         "give a number",
                                         "give a number, of L",
                                         "give x,y,z, in L a frame squared",
                                         "give a number, of frames",
                                         "",
                                         ""};
    bool good = true;
    switch (option) {
    case 0:
        wish->method = value;
        break;
    case 1:
        wish->json = true;
        break;
    case 2:
        good = mote_read_unsigned(value, 1, MOTE_SIMULATION_STEPS_MAX, &wish->steps);
        break;
    case 3:
        good = mote_read_unsigned(value, 0, UINT64_MAX, &wish->seed);
        break;
    case 4:
        good = mote_read_real(value, -1e300, 1e300, &wish->density);
        break;
    case 5:
        good = mote_read_real(value, -1e300, 1e300, &wish->restitution);
        break;
    case 6:
        good = mote_read_real(value, -1e300, 1e300, &wish->tolerance);
        break;
    case 7:
        good = read_vector(value, &wish->gravity);
        break;
    case 8:
        good = mote_read_real(value, -1e300, 1e300, &wish->time_step);
        break;
    case 9:
        wish->trace = value;
        break;
    default:
        wish->film = value;
    }
    if (!good)
        (void)mote_command_usage("simulate", "--%s %s: %s", mote_options_simulate[option].name,
                                 value, wanted[option]);
    return good;
}

int mote_command_simulate(int argc, char **argv)
{
    mote_option_reader reader = {mote_options_simulate, 11, argc, argv, 0};
    request wish = {.density = MOTE_NONE,
                    .restitution = MOTE_NONE,
                    .tolerance = MOTE_NONE,
                    .time_step = MOTE_NONE,
                    .seed = 1};
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN && wish.scenario)
            return mote_command_usage("simulate", "%s: one scenario at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            wish.scenario = value;
        else if (!read_option(&wish, option, value))
            return MOTE_EXIT_USAGE;
    }
    if (!wish.scenario || !wish.method)
        return mote_command_usage("simulate", "something is missing; write `mote simulate "
                                              "SCENARIO --method NAME`");
    if (mote_bodies_is(wish.scenario)) {
        if (wish.trace || wish.film)
            return mote_command_usage("simulate",
                                      "--trace and --film are for two bodies; leave them out");
        return simulate_several(&wish) == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE)
                                                  : mote_command_fail();
    }
    mote_scenario *scenario;
    if (mote_method_choice_read(wish.method, &wish.choice) != MOTE_OK ||
        mote_scenario_load(wish.scenario, &scenario) != MOTE_OK)
        return mote_command_fail();
    mote_simulation_result result;
    const mote_status status = simulate(&wish, scenario, &result);
    mote_scenario_destroy(scenario);
    if (status != MOTE_OK)
        return mote_command_fail();
    int code = MOTE_EXIT_DONE;
    if (wish.json)
        code = print_json(&wish, &result);
    else
        print_lines(&wish, &result);
    return mote_command_finish(code);
}
