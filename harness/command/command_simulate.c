/* mote simulate SCENARIO... --method NAME[:...]: the closed loop on the command line, once or,
   with a directory, several times. */
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/base/statistics.h"
#include "harness/command/command.h"
#include "harness/command/shard.h"
#include "harness/loop/film.h"
#include "harness/loop/replicates.h"
#include "harness/loop/simulate.h"
#include "harness/loop/simulate_print.h"
#include "harness/loop/trace.h"
#include "harness/process/child.h"
#include "harness/process/manifest.h"

#include <stdlib.h>

typedef struct request {
    const char **scenarios; /* [argc] */
    size_t scenario_count;
    const char *trace, *film, *out;
    mote_choices choices;
    mote_shard shard;
    bool json, sampled;
    double step;                                       /* MOTE_NONE: steps are whole */
    double density, restitution, tolerance, time_step; /* MOTE_NONE: the default */
    mote_vec3 gravity;
    uint64_t steps, seed; /* steps 0: all frames */
    uint64_t replicates, jobs;
    double share, budget; /* of --until-ci, 0: not given; and --budget */
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
    if (!isnan(wish->step)) {
        options->time_step = wish->step;
        options->within = wish->sampled ? MOTE_STEPS_SAMPLED : MOTE_STEPS_CONTINUOUS;
    }
}

/* How often a film sees the bodies: steps, or frames where they have paths within steps. */
static uint32_t watched(const request *wish, uint32_t steps)
{
    return isnan(wish->step) ? steps : (uint32_t)fmin(ceil(steps * wish->step), 4e9);
}

/* Makes the film of a simulation that is about to start, if one is requested. */
static mote_status start_film(const request *wish, mote_simulator *simulator,
                              mote_simulation_start *start, mote_film **film)
{
    if (!wish->film)
        return MOTE_OK;
    const mote_status status = mote_film_create(simulator, wish->choices.items[0].text,
                                                watched(wish, start->steps), wish->film, film);
    start->watch = mote_film_watch;
    start->context = *film;
    return status;
}

/* Simulates, writes the trace and draws the film, if requested. */
static mote_status run(const request *wish, const mote_subject *subject,
                       const mote_simulation_options *options, mote_simulator *simulator,
                       mote_simulation_result *result)
{
    const uint32_t bodies = mote_simulator_bodies(simulator).count;
    mote_simulation_start start = mote_simulation_start_of(simulator);
    start.seed = wish->seed;
    if (wish->steps > 0)
        start.steps = (uint32_t)wish->steps;
    mote_film *film = NULL;
    mote_rigid_state *trace = NULL;
    if (wish->trace)
        trace = mote_allocate(((size_t)start.steps + 1) * bodies, sizeof *trace);
    mote_status status = start_film(wish, simulator, &start, &film);
    if (status == MOTE_OK)
        status = mote_simulator_run(simulator, &start, trace, result);
    if (status == MOTE_OK && trace)
        status = mote_trace_write(subject, mote_simulator_masses(simulator), trace,
                                  (uint32_t)result->steps + 1, options, wish->trace);
    if (status == MOTE_OK && film)
        status = mote_film_draw(film);
    mote_film_destroy(film);
    free(trace);
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
    status = run(wish, subject, &options, simulator, &result);
    const uint32_t bodies = mote_simulator_bodies(simulator).count;
    FILE *out = result_stream(wish);
    const char *scenario = mote_subject_facts_of(subject).name;
    const char *method = wish->choices.items[0].text;
    if (status == MOTE_OK && wish->json)
        status =
            mote_simulation_put(mote_simulation_json(scenario, bodies, method, &result), out);
    else if (status == MOTE_OK)
        mote_simulation_print(scenario, bodies, method, &result, out);
    mote_simulator_destroy(simulator);
    return status;
}

/* Prints and writes what the directory keeps; returns the exit status, which depends only on
   what this command asked for. */
static int report(const request *wish, const mote_replicates *plans)
{
    mote_simulations list = {0};
    size_t failed = 0, all = 0;
    mote_status status = mote_simulations_read(wish->out, &list);
    if (status == MOTE_OK)
        status = mote_simulations_write(&list, wish->out);
    if (status == MOTE_OK && wish->json)
        status = mote_simulation_put(mote_simulations_json(&list), stdout);
    else if (status == MOTE_OK)
        mote_simulations_print(&list, stdout);
    for (size_t i = 0; i < wish->scenario_count; ++i)
        mote_replicates_count(&plans[i], &list, &all, &failed);
    mote_simulations_free(&list);
    if (status != MOTE_OK)
        return mote_command_fail();
    if (failed == 0)
        return mote_command_finish(MOTE_EXIT_DONE);
    (void)fprintf(stderr, "mote: %zu of %zu simulations failed; see their reason in %s/%s\n",
                  failed, all, wish->out, "simulations");
    return mote_command_finish(MOTE_EXIT_CELL_FAILED);
}

/* Opens the scenarios and makes a plan for each; nothing is written. */
static mote_status make_plans(const request *wish, uint64_t program, mote_subject *subjects,
                              mote_replicates *plans)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < wish->scenario_count && status == MOTE_OK; ++i) {
        status = mote_subject_load(wish->scenarios[i], &subjects[i]);
        if (status != MOTE_OK)
            break;
        plans[i] = (mote_replicates){.subject = &subjects[i],
                                     .choices = &wish->choices,
                                     .options = mote_default_simulation_options(&subjects[i]),
                                     .steps = (uint32_t)wish->steps,
                                     .seed = wish->seed,
                                     .replicates = (uint32_t)wish->replicates,
                                     .jobs = (uint32_t)wish->jobs,
                                     .program = program,
                                     .directory = wish->out,
                                     .share = wish->share,
                                     .budget = wish->budget};
        set_options(wish, &plans[i].options);
        status = mote_replicates_check(&plans[i]);
    }
    return status;
}

static mote_status simulate_plans(const request *wish, mote_subject *subjects,
                                  mote_replicates *plans)
{
    uint64_t program;
    mote_status status = mote_program_hash(&program);
    if (status == MOTE_OK)
        status = make_plans(wish, program, subjects, plans);
    mote_child_heed_signals();
    for (size_t i = 0; i < wish->scenario_count && status == MOTE_OK; ++i)
        status = mote_replicates_run(&plans[i]);
    if (status == MOTE_OK && wish->scenario_count == 0)
        status = mote_simulations_make(wish->out); /* a shard without a scenario */
    if (status == MOTE_OK)
        status = mote_manifest_write(wish->out, program, wish->seed, wish->argc, wish->argv);
    return status;
}

/* Simulates several scenarios, methods or replicates, storing results in a directory. */
static int simulate_replicates(const request *wish)
{
    mote_subject *subjects = mote_allocate(wish->scenario_count, sizeof *subjects);
    mote_replicates *plans = mote_allocate(wish->scenario_count, sizeof *plans);
    const mote_status status = simulate_plans(wish, subjects, plans);
    const int code = status == MOTE_OK ? report(wish, plans) : mote_command_fail();
    for (size_t i = 0; i < wish->scenario_count; ++i)
        mote_subject_free(&subjects[i]);
    free(subjects);
    free(plans);
    return code;
}

#define GRAVITY_MAX 1e154 /* its square is a double */

static bool read_gravity(const char *text, mote_vec3 *v)
{
    double value[3];
    if (!mote_read_triple(text, value))
        return false;
    *v = (mote_vec3){value[0], value[1], value[2]};
    return mote_length(*v) <= GRAVITY_MAX;
}

const mote_option mote_options_simulate[] = {
    {"method", "NAME[:key=a|b,...]",
     "the method that says where bodies touch; with --out it may be repeated; no default"},
    {"json", NULL, "as JSON (default: as text)"},
    {"steps", "K", "how many steps, 1 to 1000000 (default: all frames of the scenario)"},
    {"seed", "S",
     "the seed of the method's random numbers; each further replicate adds 1 (default: 1)"},
    {"density", "D", "the density of all bodies (default: 1)"},
    {"restitution", "E", "0: no rebound, 1: no energy is lost (default: 1)"},
    {"tolerance", "T",
     "distance of a contact, in L (default: the scenario's, or 0.005 where that is 0)"},
    {"gravity", "X,Y,Z", "the acceleration, in L per frame squared (default: 0,0,0)"},
    {"time-step", "H", "the length of a step, in frames (default: 1)"},
    {"step", "K",
     "steps of K frames, within which certified finds impacts, which are answered where they "
     "happen (default: contacts are looked for at the ends of steps)"},
    {"sampled", NULL,
     "with --step: look for contacts at the ends of steps, on the same paths (default: find "
     "impacts)"},
    {"trace", "FILE.json", "write the motion as a scenario (default: not written)"},
    {"film", "FILE.gif", "draw the motion (default: not drawn)"},
    {"replicates", "R",
     "1 to 1000 simulations of each method; above 1 with --out (default: 1)"},
    {"out", "DIR",
     "keep each simulation in DIR/simulations; the same command resumes what was stopped "
     "(default: not kept)"},
    {"jobs", "J", "1 to 256 simulations at a time (default: 1)"},
    {"shard", "I/N",
     "with --out: every N-th scenario, from the I-th on (default: 1/1, or the task of a Slurm "
     "array)"},
    {"until-ci", "2%",
     "with --out: add replicates until the interval of each method's time is within this share "
     "of its median (default: none are added)"},
    {"budget", "SECONDS", "--until-ci stops after this time (default: 600)"},
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
    OPTION_STEP,
    OPTION_SAMPLED,
    OPTION_TRACE,
    OPTION_FILM,
    OPTION_REPLICATES,
    OPTION_OUT,
    OPTION_JOBS,
    OPTION_SHARD,
    OPTION_UNTIL_CI,
    OPTION_BUDGET
};

#define DEFAULT_BUDGET 600

/* Reads a number above 0. */
static bool read_positive(const char *value, double maximum, double *number)
{
    return mote_read_real(value, 0, maximum, number) && *number > 0;
}

/* Reads a valid value into wish and returns NULL; otherwise returns what would be valid. */
static const char *read_value(request *wish, int option, const char *value)
{
    static const char frames[] = "give frames, above 0 and at most 1000";
    switch (option) {
    case OPTION_JSON:
        wish->json = true;
        return NULL;
    case OPTION_STEPS:
        return mote_read_unsigned(value, 1, MOTE_SIMULATION_STEPS_MAX, &wish->steps)
                   ? NULL
                   : "give a whole number from 1 to 1000000";
    case OPTION_SEED:
        return mote_read_unsigned(value, 0, UINT64_MAX, &wish->seed)
                   ? NULL
                   : "give a whole number below 2^64";
    case OPTION_DENSITY:
        return read_positive(value, 1e300, &wish->density)
                   ? NULL
                   : "give a number above 0 and at most 1e300";
    case OPTION_RESTITUTION:
        return mote_read_real(value, 0, 1, &wish->restitution) ? NULL
                                                               : "give a number from 0 to 1";
    case OPTION_TOLERANCE:
        return read_positive(value, MOTE_SIMULATION_NEAR, &wish->tolerance)
                   ? NULL
                   : "give L, above 0 and at most 0.05";
    case OPTION_GRAVITY:
        return read_gravity(value, &wish->gravity)
                   ? NULL
                   : "give x,y,z, in L per frame squared, at most 1e154 long";
    case OPTION_TIME_STEP:
        return read_positive(value, MOTE_SIMULATION_STEP_MAX, &wish->time_step) ? NULL : frames;
    case OPTION_STEP:
        return read_positive(value, MOTE_SIMULATION_STEP_MAX, &wish->step) ? NULL : frames;
    case OPTION_SAMPLED:
        wish->sampled = true;
        return NULL;
    case OPTION_TRACE:
        wish->trace = value;
        return NULL;
    case OPTION_FILM:
        wish->film = value;
        return NULL;
    case OPTION_REPLICATES:
        return mote_read_unsigned(value, 1, MOTE_REPLICATES_MAX, &wish->replicates)
                   ? NULL
                   : "give a whole number from 1 to 1000";
    case OPTION_OUT:
        wish->out = value;
        return NULL;
    case OPTION_SHARD:
        return mote_shard_read(value, &wish->shard) ? NULL : "give I/N with 1 <= I <= N";
    case OPTION_UNTIL_CI:
        return mote_read_percent(value, &wish->share) ? NULL
                                                      : "give a percentage from 0.001% to 100%";
    case OPTION_BUDGET:
        return mote_read_real(value, 0, 1e9, &wish->budget) ? NULL
                                                            : "give seconds, from 0 to 1e9";
    default:
        return mote_read_unsigned(value, 1, MOTE_CHILDREN_MAX, &wish->jobs)
                   ? NULL
                   : "give a whole number from 1 to 256";
    }
}

/* Describes options that cannot be combined; NULL if there are none. */
static const char *clash(const request *wish)
{
    if (!wish->out && (wish->replicates > 1 || wish->jobs > 1))
        return "--replicates and --jobs keep what they simulate: name a directory with --out";
    if (!wish->out && (wish->share > 0 || wish->shard.shards > 0))
        return "--until-ci and --shard keep what they simulate: name a directory with --out";
    if (!wish->out && wish->scenario_count > 1)
        return "one scenario at a time, or --out DIR to keep the results of several";
    if (!isnan(wish->step) && !isnan(wish->time_step))
        return "--step and --time-step both say how long a step is: leave out one of them";
    if (wish->sampled && isnan(wish->step))
        return "--sampled is about the paths within steps: say how long they are with --step K";
    if (wish->share > 0 && wish->jobs > 1)
        return "--until-ci is for times, --jobs for accuracy: leave out one of them";
    if (!wish->out && wish->choices.count > 1)
        return "one method at a time, or --out DIR to keep the results of several";
    if (wish->out && (wish->trace || wish->film))
        return "--trace and --film are of one simulation; leave out --out";
    if (wish->out && wish->seed > MOTE_SEED_MAX)
        return "--seed: with --out a whole number below 2^62";
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
        if (option == MOTE_OPTION_PLAIN)
            wish->scenarios[wish->scenario_count++] = value;
        else if (option == OPTION_METHOD) {
            if (mote_choices_add(&wish->choices, value, NULL) != MOTE_OK)
                return mote_command_fail();
        } else
            wrong = read_value(wish, option, value);
        if (wrong)
            return mote_command_usage("simulate", "--%s %s: %s",
                                      mote_options_simulate[option].name, value, wrong);
    }
    if (wish->scenario_count == 0 || wish->choices.count == 0)
        return mote_command_usage("simulate", "something is missing; write `mote simulate "
                                              "SCENARIO --method NAME`");
    const char *wrong = clash(wish);
    return wrong ? mote_command_usage("simulate", "%s", wrong) : MOTE_EXIT_DONE;
}

static int execute(request *wish)
{
    if (wish->out) {
        if (!mote_shard_of_task("simulate", &wish->shard))
            return MOTE_EXIT_USAGE;
        wish->scenario_count =
            mote_shard_keep(wish->shard, wish->scenarios, wish->scenario_count);
        return simulate_replicates(wish);
    }
    mote_subject subject = {0};
    mote_status status = mote_subject_open(wish->scenarios[0], &subject);
    if (status == MOTE_OK)
        status = simulate(wish, &subject);
    mote_subject_free(&subject);
    return status == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}

int mote_command_simulate(int argc, char **argv)
{
    request wish = {.scenarios = mote_allocate((size_t)argc + 1, sizeof *wish.scenarios),
                    .density = MOTE_NONE,
                    .restitution = MOTE_NONE,
                    .tolerance = MOTE_NONE,
                    .time_step = MOTE_NONE,
                    .step = MOTE_NONE,
                    .seed = 1,
                    .replicates = 1,
                    .jobs = 1,
                    .budget = DEFAULT_BUDGET,
                    .argc = argc,
                    .argv = argv};
    int code = read_arguments(argc, argv, &wish);
    if (code == MOTE_EXIT_DONE)
        code = execute(&wish);
    mote_choices_free(&wish.choices);
    free(wish.scenarios);
    return code;
}
