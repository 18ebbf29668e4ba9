/* mote simulate SCENARIO --method NAME[:...]: the closed loop on the command line, once or,
   with a directory, several times. */
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/base/record.h"
#include "harness/base/statistics.h"
#include "harness/command/command.h"
#include "harness/loop/film.h"
#include "harness/loop/replicates.h"
#include "harness/loop/simulate.h"
#include "harness/loop/simulate_print.h"
#include "harness/loop/trace.h"
#include "harness/process/child.h"
#include "harness/process/manifest.h"

#include <stdlib.h>

typedef struct request {
    const char *scenario, *trace, *film, *out;
    mote_choices choices;
    bool json;
    double density, restitution, tolerance, time_step; /* MOTE_NONE: the default */
    mote_vec3 gravity;
    uint64_t steps, seed; /* steps 0: all frames */
    uint64_t replicates, jobs;
    int argc;
    char **argv;
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

/* Simulates, and draws the film if requested. */
static mote_status run(const request *wish, mote_simulator *simulator, mote_rigid_state *trace,
                       mote_simulation_start *start, mote_simulation_result *result)
{
    mote_film *film = NULL;
    mote_status status = MOTE_OK;
    if (wish->film)
        status = mote_film_create(simulator, wish->choices.items[0].text, start->steps,
                                  wish->film, &film);
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

/* The result must not be mixed into a trace or a film that goes to standard output. */
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
    mote_status status =
        mote_simulator_create(subject, &wish->choices.items[0], &options, &simulator);
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
                                  (uint32_t)result.steps + 1, &options, wish->trace);
    FILE *out = result_stream(wish);
    const mote_method_choice *choice = &wish->choices.items[0];
    if (status == MOTE_OK && wish->json)
        status = mote_simulation_put(
            mote_simulation_json(wish->scenario, bodies, choice, &result), out);
    else if (status == MOTE_OK)
        mote_simulation_print(wish->scenario, bodies, choice, &result, out);
    free(trace);
    mote_simulator_destroy(simulator);
    return status;
}

/* Prints each method's figures and the interval of its time. */
static void print_rows(const mote_replicates *plan, const mote_replicates_row *rows)
{
    const uint32_t bodies = mote_subject_facts_of(plan->subject).bodies;
    for (size_t m = 0; m < plan->choices->count; ++m) {
        const mote_replicates_row *row = &rows[m];
        const mote_method_choice *choice = &plan->choices->items[m];
        if (row->done == 0) {
            (void)printf("%s, %s: %s%s\n", plan->scenario, choice->text,
                         row->unsupported ? "unsupported: " : "every replicate failed",
                         row->unsupported ? row->unsupported : "");
            continue;
        }
        mote_simulation_print(plan->scenario, bodies, choice, &row->sum, stdout);
        (void)printf("replicates %u, failed %u; median time a step %.3g us", row->done,
                     row->failed, row->query_ns / 1e3);
        if (!isnan(row->interval.low))
            (void)printf(" (%.3g to %.3g)", row->interval.low / 1e3, row->interval.high / 1e3);
        (void)printf("\n");
    }
}

/* Prints and writes the results of the replicates; returns the exit status. */
static int report(const request *wish, const mote_replicates *plan,
                  const mote_replicates_row *rows)
{
    uint32_t failed = 0;
    for (size_t m = 0; m < plan->choices->count; ++m)
        failed += rows[m].failed;
    json_t *root = mote_replicates_json(plan, rows);
    mote_status status =
        mote_record_json(plan->directory, "simulations.json", json_incref(root));
    if (status == MOTE_OK && wish->json)
        status = mote_simulation_put(json_incref(root), stdout);
    else if (status == MOTE_OK)
        print_rows(plan, rows);
    json_decref(root);
    if (status != MOTE_OK)
        return mote_command_fail();
    if (failed == 0)
        return mote_command_finish(MOTE_EXIT_DONE);
    (void)fprintf(stderr, "mote: %u of %zu simulations failed; see their reason in %s/%s\n",
                  failed, plan->choices->count * plan->replicates, plan->directory,
                  "simulations");
    return mote_command_finish(MOTE_EXIT_CELL_FAILED);
}

/* Simulates several methods or replicates, storing results in a directory. */
static int simulate_replicates(const request *wish, mote_subject *subject)
{
    mote_replicates plan = {.subject = subject,
                            .scenario = wish->scenario,
                            .choices = &wish->choices,
                            .options = mote_default_simulation_options(subject),
                            .steps = (uint32_t)wish->steps,
                            .seed = wish->seed,
                            .replicates = (uint32_t)wish->replicates,
                            .jobs = (uint32_t)wish->jobs,
                            .directory = wish->out};
    mote_replicates_row *rows = NULL;
    set_options(wish, &plan.options);
    mote_status status = mote_subject_identify(subject);
    if (status == MOTE_OK)
        status = mote_program_hash(&plan.program);
    mote_child_heed_signals();
    if (status == MOTE_OK)
        status = mote_replicates_run(&plan, &rows);
    if (status == MOTE_OK)
        status = mote_manifest_write(plan.directory, plan.program, plan.seed, wish->argc,
                                     wish->argv);
    const int code = status == MOTE_OK ? report(wish, &plan, rows) : mote_command_fail();
    mote_replicates_free(rows, plan.choices->count);
    return code;
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
    {"method", "NAME[:key=a|b,...]",
     "the method that says where bodies touch; with --out it may be repeated; no default"},
    {"json", NULL, "as JSON (default: as text)"},
    {"steps", "K", "1 to 1000000 (default: all frames of the scenario)"},
    {"seed", "S", "of the method; each further replicate adds 1 (default: 1)"},
    {"density", "D", "of all bodies (default: 1)"},
    {"restitution", "E", "0: no rebound, 1: no energy is lost (default: 1)"},
    {"tolerance", "T",
     "distance of a contact, in L (default: the scenario's, or 0.005 where that is 0)"},
    {"gravity", "X,Y,Z", "in L a frame squared (default: 0,0,0)"},
    {"time-step", "H", "frames a step (default: 1)"},
    {"trace", "FILE.json", "write the motion as a scenario (default: not written)"},
    {"film", "FILE.gif", "draw the motion (default: not drawn)"},
    {"replicates", "R",
     "1 to 1000 simulations of each method; above 1 with --out (default: 1)"},
    {"out", "DIR",
     "keep each simulation in DIR/simulations, where a run that was stopped goes on (default: "
     "not kept)"},
    {"jobs", "J", "1 to 256 simulations at a time (default: 1)"},
    {NULL, NULL, NULL}};
enum {
    OPTION_METHOD,
    OPTION_JSON,
    OPTION_STEPS,
    OPTION_SEED,
    OPTION_DENSITY,
    OPTION_RESTITUTION,
    OPTION_TOLERANCE,
    OPTION_GRAVITY,
    OPTION_TIME_STEP,
    OPTION_TRACE,
    OPTION_FILM,
    OPTION_REPLICATES,
    OPTION_OUT,
    OPTION_JOBS
};

static bool read_number(const char *value, double *number)
{
    return mote_read_real(value, -1e300, 1e300, number);
}

/* Reads a valid value into wish and returns NULL; otherwise returns what would be valid. */
static const char *read_value(request *wish, int option, const char *value)
{
    static const char number[] = "give a number";
    switch (option) {
    case OPTION_JSON:
        wish->json = true;
        return NULL;
    case OPTION_STEPS:
        return mote_read_unsigned(value, 1, MOTE_SIMULATION_STEPS_MAX, &wish->steps)
                   ? NULL
                   : "give a number of steps from 1 to 1000000";
    case OPTION_SEED:
        return mote_read_unsigned(value, 0, UINT64_MAX, &wish->seed) ? NULL
                                                                     : "give a whole number";
    case OPTION_DENSITY:
        return read_number(value, &wish->density) ? NULL : number;
    case OPTION_RESTITUTION:
        return read_number(value, &wish->restitution) ? NULL : number;
    case OPTION_TOLERANCE:
        return read_number(value, &wish->tolerance) ? NULL : "give a number, of L";
    case OPTION_GRAVITY:
        return read_vector(value, &wish->gravity) ? NULL : "give x,y,z, in L a frame squared";
    case OPTION_TIME_STEP:
        return read_number(value, &wish->time_step) ? NULL : "give a number, of frames";
    case OPTION_TRACE:
        wish->trace = value;
        return NULL;
    case OPTION_FILM:
        wish->film = value;
        return NULL;
    case OPTION_REPLICATES:
        return mote_read_unsigned(value, 1, MOTE_REPLICATES_MAX, &wish->replicates)
                   ? NULL
                   : "give a number from 1 to 1000";
    case OPTION_OUT:
        wish->out = value;
        return NULL;
    default:
        return mote_read_unsigned(value, 1, MOTE_CHILDREN_MAX, &wish->jobs)
                   ? NULL
                   : "give a number from 1 to 256";
    }
}

/* Describes options that cannot be combined; NULL if there are none. */
static const char *clash(const request *wish)
{
    if (!wish->out && (wish->replicates > 1 || wish->jobs > 1))
        return "--replicates and --jobs keep what they simulate: name a directory with --out";
    if (!wish->out && wish->choices.count > 1)
        return "one method at a time, or --out DIR to keep the results of several";
    if (wish->out && (wish->trace || wish->film))
        return "--trace and --film are of one simulation; leave out --out";
    if (wish->out && wish->seed > MOTE_SEED_MAX)
        return "--seed: with --out a number of at most 62 bits";
    return NULL;
}

/* MOTE_EXIT_DONE, or an exit status after a line on stderr. */
static int read_arguments(int argc, char **argv, request *wish)
{
    mote_option_reader reader = mote_option_begin(mote_options_simulate, argc, argv);
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        const char *wrong = NULL;
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN && wish->scenario)
            return mote_command_usage("simulate", "%s: one scenario at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            wish->scenario = value;
        else if (option == OPTION_METHOD) {
            if (mote_choices_add(&wish->choices, value, NULL) != MOTE_OK)
                return mote_command_fail();
        } else
            wrong = read_value(wish, option, value);
        if (wrong)
            return mote_command_usage("simulate", "--%s %s: %s",
                                      mote_options_simulate[option].name, value, wrong);
    }
    if (!wish->scenario || wish->choices.count == 0)
        return mote_command_usage("simulate", "something is missing; write `mote simulate "
                                              "SCENARIO --method NAME`");
    const char *wrong = clash(wish);
    return wrong ? mote_command_usage("simulate", "%s", wrong) : MOTE_EXIT_DONE;
}

static int execute(const request *wish)
{
    mote_subject subject = {0};
    mote_status status = mote_subject_open(wish->scenario, &subject);
    int code = MOTE_EXIT_DONE;
    if (status == MOTE_OK && wish->out)
        code = simulate_replicates(wish, &subject);
    else if (status == MOTE_OK)
        status = simulate(wish, &subject);
    mote_subject_free(&subject);
    if (status != MOTE_OK)
        return mote_command_fail();
    return wish->out ? code : mote_command_finish(MOTE_EXIT_DONE);
}

int mote_command_simulate(int argc, char **argv)
{
    request wish = {.density = MOTE_NONE,
                    .restitution = MOTE_NONE,
                    .tolerance = MOTE_NONE,
                    .time_step = MOTE_NONE,
                    .seed = 1,
                    .replicates = 1,
                    .jobs = 1,
                    .argc = argc,
                    .argv = argv};
    int code = read_arguments(argc, argv, &wish);
    if (code == MOTE_EXIT_DONE)
        code = execute(&wish);
    mote_choices_free(&wish.choices);
    return code;
}
