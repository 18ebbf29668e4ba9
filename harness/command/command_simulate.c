/* mote simulate SCENARIO --method NAME[:...]: the closed loop on the command line. */
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/base/statistics.h"
#include "harness/command/command.h"
#include "harness/loop/film.h"
#include "harness/loop/simulate.h"
#include "harness/loop/simulate_print.h"
#include "harness/loop/trace.h"

#include <stdlib.h>

typedef struct request {
    const char *scenario, *method, *trace, *film;
    mote_method_choice choice;
    bool json;
    double density, restitution, tolerance, time_step; /* MOTE_NONE: the default */
    mote_vec3 gravity;
    uint64_t steps, seed; /* steps 0: all frames */
} request;

/* Options of the command line that replace the defaults. */
static void set_options(const request *wish, mote_simulation_options *options)
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

static mote_status load(request *wish, mote_subject *subject)
{
    const mote_status status = mote_bodies_is(wish->scenario)
                                   ? mote_scene_choice_read(wish->method, &wish->choice)
                                   : mote_method_choice_read(wish->method, &wish->choice);
    return status == MOTE_OK ? mote_subject_open(wish->scenario, subject) : status;
}

/* Simulates, and draws the film if one is asked for. */
static mote_status run(const request *wish, mote_simulator *simulator, mote_rigid_state *trace,
                       mote_simulation_start *start, mote_simulation_result *result)
{
    mote_film *film = NULL;
    mote_status status = MOTE_OK;
    if (wish->film)
        status =
            mote_film_create(simulator, wish->choice.text, start->steps, wish->film, &film);
    if (film) {
        start->watch = mote_film_watch;
        start->context = film;
    }
    if (status == MOTE_OK)
        status = mote_simulator_run(simulator, start, trace, result);
    if (status == MOTE_OK && film)
        status = mote_film_draw(film);
    mote_film_destroy(film);
    return status;
}

/* The result must not stand in a trace or a film that goes to standard output. */
static FILE *result_stream(const request *wish)
{
    const bool in_use = (wish->trace && mote_path_is_output(wish->trace)) ||
                        (wish->film && mote_path_is_output(wish->film));
    return in_use ? stderr : stdout;
}

static mote_status simulate(const request *wish, const mote_subject *subject)
{
    mote_simulation_options options = mote_default_simulation_options(subject);
    mote_simulator *simulator;
    mote_simulation_result result;
    set_options(wish, &options);
    mote_status status = mote_simulator_create(subject, &wish->choice, &options, &simulator);
    if (status != MOTE_OK)
        return status;
    const uint32_t bodies = mote_simulator_bodies(simulator).count;
    mote_simulation_start start = mote_simulation_start_of(simulator);
    start.seed = wish->seed;
    if (wish->steps > 0)
        start.steps = (uint32_t)wish->steps;
    mote_rigid_state *trace = NULL;
    if (wish->trace)
        trace = mote_allocate(((size_t)start.steps + 1) * bodies, sizeof *trace);
    status = run(wish, simulator, trace, &start, &result);
    if (status == MOTE_OK && trace)
        status = mote_trace_write(subject, mote_simulator_masses(simulator), trace,
                                  result.steps + 1, &options, wish->trace);
    FILE *out = result_stream(wish);
    if (status == MOTE_OK && wish->json)
        status = mote_simulation_json(wish->scenario, bodies, &wish->choice, &result, out);
    else if (status == MOTE_OK)
        mote_simulation_print(wish->scenario, bodies, &wish->choice, &result, out);
    free(trace);
    mote_simulator_destroy(simulator);
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
    {"json", NULL, "as JSON (default: as text)"},
    {"steps", "K", "1 to 1000000 (default: all frames of the scenario)"},
    {"seed", "S", "of the method (default: 1)"},
    {"density", "D", "of all bodies (default: 1)"},
    {"restitution", "E", "0: no rebound, 1: no energy is lost (default: 1)"},
    {"tolerance", "T",
     "distance of a contact, in L (default: the scenario's, or 0.005 where that is 0)"},
    {"gravity", "X,Y,Z", "in L a frame squared (default: 0,0,0)"},
    {"time-step", "H", "frames a step (default: 1)"},
    {"trace", "FILE.json", "write the motion as a scenario (default: not written)"},
    {"film", "FILE.gif", "draw the motion (default: not drawn)"},
    {NULL, NULL, NULL}};

/* False, after a line on stderr, when the value is wrong for the option. */
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
    mote_option_reader reader = mote_option_begin(mote_options_simulate, argc, argv);
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
    mote_subject subject = {0};
    mote_status status = load(&wish, &subject);
    if (status == MOTE_OK)
        status = simulate(&wish, &subject);
    mote_subject_free(&subject);
    return status == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}
