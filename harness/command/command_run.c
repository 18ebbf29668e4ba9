#include "harness/process/child.h"
#include "harness/command/command.h"
#include "harness/command/shard.h"
#include "harness/base/options.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/mesh/mesh_import.h"
#include "harness/run/run.h"
#include "harness/summary/screen.h"
#include "harness/summary/summary_json.h"
#include "harness/summary/table.h"
#include "harness/summary/until.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const mote_option mote_options_run[] = {
    {"method", "NAME[:key=a|b,...]",
     "a method, in one configuration for each combination of values; may be repeated (default: "
     "every method)"},
    {"particles", "1,2,4-8",
     "the numbers of particles for methods with a key n (default: the key's own)"},
    {"replicates", "K", "processes for each configuration, 1 to 1000 (default: 3)"},
    {"frames", "A-B", "measure these frames only, counted from 1 (default: all)"},
    {"out", "DIR", "the directory of the run (default: results/run)"},
    {"shard", "I/N",
     "every N-th scenario, from the I-th on (default: 1/1, or the task of a Slurm array)"},
    {"seed", "S", "the seed of all random numbers, below 2^62 (default: 0)"},
    {"timeout", "SECONDS", "a cell that takes longer is ended and recorded (default: 1800)"},
    {"cache", "hot|evict",
     "evict: walk over 32 MB between frames, so that caches are cold (default: hot)"},
    {"stride", "auto|K",
     "measure every K-th frame; methods that keep state from frame to frame, and scenes of "
     "more than two bodies, are measured in every one; auto: every 16th for slow methods "
     "without state (default: auto)"},
    {"step", "1,3,10,30,100",
     "ask for impacts, K frames at a time, once with each K (default: what the scenario asks)"},
    {"dry-run", NULL, "print the plan and measure nothing"},
    {"force", NULL, "measure finished cells again"},
    {"fixed-seed", NULL, "the same seed for every replicate (default: each has its own)"},
    {"jobs", "N", "cells at once, 1 to 256: for accuracy; times suffer (default: 1)"},
    {"until-ci", "2%",
     "add replicates until every interval is within this share of its median (default: none "
     "are added)"},
    {"budget", "SECONDS",
     "--until-ci stops then, and so does a cell of more than two bodies (default: 600)"},
    {"progress", "SECONDS",
     "if stderr is not a terminal: seconds between two lines of progress (default: 0, a line "
     "after each cell)"},
    {"no-summary", NULL,
     "only measure, for many runs into one directory; then `mote summarize DIR` (default: "
     "write summary.json and print the rows)"},
    {"strict", NULL, "refuse edges of more than two faces (default: cut them apart)"},
    {"pairs", "all|contacts",
     "which near pairs of more than two bodies are kept in cells/ID.pairs.csv (default: all)"},
    {"pair", "A.obj B.obj",
     "a scenario of two mesh files: 1,000 frames of approach, contact in 10 to 20 % of them, "
     "and parting, both deforming (default: none)"},
    {"direction", "X,Y,Z",
     "the direction in which B lies as seen from A, for --pair (default: searched for until "
     "they touch)"},
    {NULL, NULL, NULL}};
enum {
    OPTION_METHOD,
    OPTION_PARTICLES,
    OPTION_REPLICATES,
    OPTION_FRAMES,
    OPTION_OUT,
    OPTION_SHARD,
    OPTION_SEED,
    OPTION_TIMEOUT,
    OPTION_CACHE,
    OPTION_STRIDE,
    OPTION_STEP,
    OPTION_DRY_RUN,
    OPTION_FORCE,
    OPTION_FIXED_SEED,
    OPTION_JOBS,
    OPTION_UNTIL_CI,
    OPTION_BUDGET,
    OPTION_PROGRESS,
    OPTION_NO_SUMMARY,
    OPTION_STRICT,
    OPTION_PAIRS,
    OPTION_PAIR, /* one of the scenarios; parsed separately because it takes two values */
    OPTION_DIRECTION,
    OPTION_COUNT
};

#define DEFAULT_REPLICATES 3
#define DEFAULT_TIMEOUT 1800
#define DEFAULT_BUDGET 600

typedef struct request {
    mote_run_options run;
    const char **scenarios; /* [argc] */
    const char **methods;   /* [argc] */
    size_t method_count;
    const char *particles;
    mote_shard shard;
    const char *pair_files[2], *direction; /* of --pair and --direction, or NULL */
    char *pair;                            /* name of the scenario from these, or NULL */
    double until_share;                    /* from --until-ci; 0: not given */
    bool no_summary;
    mote_choices choices;
    mote_choices scene_choices;  /* for scenarios of more than two bodies */
    mote_choices impact_choices; /* for those that ask for impacts */
} request;

static bool read_cache(const char *text, mote_cache *cache)
{
    bool evict = strcmp(text, mote_cache_names[MOTE_CACHE_EVICT]) == 0;
    *cache = evict ? MOTE_CACHE_EVICT : MOTE_CACHE_HOT;
    return evict || strcmp(text, mote_cache_names[MOTE_CACHE_HOT]) == 0;
}

static bool read_count(const char *text, uint64_t maximum, uint32_t *value)
{
    uint64_t read;
    if (!mote_read_unsigned(text, 1, maximum, &read))
        return false;
    *value = (uint32_t)read;
    return true;
}

static bool read_stride(const char *text, uint32_t *stride)
{
    *stride = MOTE_STRIDE_AUTO;
    return strcmp(text, "auto") == 0 || read_count(text, UINT32_MAX, stride);
}

/* "1,3,10", ascending */
static bool read_steps(const char *text, mote_plan_options *plan)
{
    plan->step_count = 0;
    for (;; ++text) {
        const size_t length = strcspn(text, ",");
        char *one = mote_format("%.*s", (int)length, text);
        uint32_t step = 0;
        const bool good = plan->step_count < MOTE_STEPS_MAX &&
                          read_count(one, UINT32_MAX, &step) &&
                          (plan->step_count == 0 || step > plan->steps[plan->step_count - 1]);
        free(one);
        if (!good)
            return false;
        plan->steps[plan->step_count++] = step;
        text += length;
        if (*text == '\0')
            return true;
    }
}

static bool read_direction(const char *text, const char **direction)
{
    double xyz[3];
    *direction = text;
    return mote_read_direction(text, xyz);
}

/* False if the value is invalid; expected then says what would be valid. */
static bool set_option(request *q, int option, const char *value, const char **expected)
{
    mote_plan_options *plan = &q->run.plan;
    *expected = mote_options_run[option].value;
    switch (option) {
    case OPTION_METHOD:
        q->methods[q->method_count++] = value;
        return true;
    case OPTION_PARTICLES:
        q->particles = value;
        return true;
    case OPTION_REPLICATES:
        *expected = "a whole number from 1 to 1000";
        return read_count(value, MOTE_REPLICATES_MAX, &plan->replicates);
    case OPTION_OUT:
        q->run.directory = value;
        *expected = "a directory";
        return value[0] != '\0';
    case OPTION_SHARD:
        *expected = "I/N with 1 <= I <= N";
        return mote_shard_read(value, &q->shard);
    case OPTION_SEED:
        *expected = "a whole number below 2^62";
        return mote_read_unsigned(value, 0, MOTE_SEED_MAX, &plan->seed);
    case OPTION_TIMEOUT:
        *expected = "seconds, from 0.001 to 1e9";
        return mote_read_real(value, 1e-3, 1e9, &q->run.timeout);
    case OPTION_CACHE:
        return read_cache(value, &plan->cache);
    case OPTION_STRIDE:
        *expected = "auto, or a whole number from 1 to 4294967295";
        return read_stride(value, &plan->stride);
    case OPTION_STEP:
        *expected = "ascending whole numbers from 1 to 4294967295, 32 at most: 1,3,10,30,100";
        return read_steps(value, plan);
    case OPTION_FIXED_SEED:
        plan->fixed_seed = true;
        return true;
    case OPTION_JOBS:
        *expected = "a whole number from 1 to 256";
        return read_count(value, MOTE_CHILDREN_MAX, &plan->jobs);
    case OPTION_UNTIL_CI:
        *expected = "a percentage from 0.001% to 100%";
        return mote_read_percent(value, &q->until_share);
    case OPTION_BUDGET:
        *expected = "seconds, from 0 to 1e9";
        return mote_read_real(value, 0, 1e9, &q->run.budget);
    case OPTION_PROGRESS:
        *expected = "seconds, from 0 to 1e9";
        return mote_read_real(value, 0, 1e9, &q->run.progress);
    case OPTION_NO_SUMMARY:
        q->no_summary = true;
        return true;
    case OPTION_STRICT:
        mote_mesh_import_strictly();
        return true;
    case OPTION_PAIRS:
        plan->contacts_only = strcmp(value, "contacts") == 0;
        return plan->contacts_only || strcmp(value, "all") == 0;
    case OPTION_DIRECTION:
        *expected = "X,Y,Z, not all 0";
        return read_direction(value, &q->direction);
    case OPTION_FORCE:
        q->run.force = true;
        return true;
    default:
        q->run.dry_run = true;
        return true;
    }
}

static void add_scenario(request *q, const char *name)
{
    for (size_t i = 0; i < q->run.scenario_count; ++i) {
        if (strcmp(q->scenarios[i], name) == 0)
            return;
    }
    q->scenarios[q->run.scenario_count++] = name;
}

/* --pair A.obj B.obj, once */
static bool read_pair(request *q, mote_option_reader *reader, const char *first)
{
    if (q->pair_files[0] || reader->next >= reader->argc)
        return false;
    q->pair_files[0] = first;
    q->pair_files[1] = reader->argv[reader->next++];
    return true;
}

/* Adds the scenario from --pair and --direction. MOTE_EXIT_DONE, or an exit status after a line
   on stderr. */
static int add_pair(request *q, const char *command)
{
    if (!q->pair_files[0])
        return q->direction
                   ? mote_command_usage(command, "--direction is for --pair A.obj B.obj")
                   : MOTE_EXIT_DONE;
    q->pair = mote_scenario_pair_name(q->pair_files[0], q->pair_files[1], q->direction);
    add_scenario(q, q->pair);
    return MOTE_EXIT_DONE;
}

/* MOTE_EXIT_DONE, or MOTE_EXIT_USAGE after a line on stderr. */
static int read_arguments(int argc, char **argv, request *q)
{
    mote_option_reader reader = mote_option_begin(mote_options_run, argc, argv);
    for (;;) {
        const char *value, *expected;
        int option = mote_option_next(&reader, &value);
        if (option == MOTE_OPTION_END)
            break;
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN) {
            add_scenario(q, value);
        } else if (option == OPTION_PAIR) {
            if (!read_pair(q, &reader, value))
                return mote_command_usage(argv[0], "--pair %s: expected two mesh files, once",
                                          value);
        } else if (option == OPTION_FRAMES) {
            /* Frames beyond a scenario's end are found when it is loaded. */
            mote_plan_options *plan = &q->run.plan;
            if (mote_frames_argument(argv[0], "frames", value, &plan->first, &plan->last) !=
                MOTE_EXIT_DONE)
                return MOTE_EXIT_USAGE;
        } else if (!set_option(q, option, value, &expected)) {
            return mote_command_usage(argv[0], "--%s %s: expected %s",
                                      mote_options_run[option].name, value, expected);
        }
    }
    if (mote_particles_check(q->particles) != MOTE_OK)
        return mote_command_usage(argv[0], "--particles %s", mote_error_text());
    if (q->until_share > 0 && q->run.plan.jobs > 1)
        return mote_command_usage(argv[0], "--until-ci is for times, --jobs for accuracy; "
                                           "leave out one of them");
    const int code = add_pair(q, argv[0]);
    if (code != MOTE_EXIT_DONE)
        return code;
    if (q->run.scenario_count == 0)
        return mote_command_usage(argv[0], "no scenario; `mote list scenarios` shows them");
    return MOTE_EXIT_DONE;
}

/* The configurations requested, the same for all scenarios; by default every method that
   answers, and for more than two bodies every method in each of its forms. */
static mote_status expand_methods(request *q)
{
    static const char *const scene_ways[] = {
        "certified", "fcl-aabb:refit=every", "fcl-aabb",          "aabb-tree",
        "stream",    "particle:n=8",         "particle-paper:n=5"};
    const size_t ways = sizeof scene_ways / sizeof scene_ways[0];
    mote_status status = MOTE_OK;
    for (size_t i = 0; status == MOTE_OK && i < q->method_count; ++i)
        status = mote_choices_add(&q->choices, q->methods[i], q->particles);
    for (size_t i = 0; status == MOTE_OK && q->method_count == 0 && mote_method_at(i); ++i) {
        const char *name = mote_method_at(i)->name;
        const mote_impact_method *impact = mote_impact_method_find(name);
        if (impact)
            status = mote_choices_add(&q->impact_choices, name, q->particles);
        if (status == MOTE_OK && !(impact && impact->alone))
            status = mote_choices_add(&q->choices, name, q->particles);
    }
    for (size_t i = 0; status == MOTE_OK && q->method_count == 0 && i < ways; ++i)
        status = mote_choices_add(&q->scene_choices, scene_ways[i], q->particles);
    q->run.scene_choices = q->method_count == 0 ? &q->scene_choices : NULL;
    q->run.plan.impact_choices = q->method_count == 0 ? &q->impact_choices : NULL;
    return status;
}

/* Prints summary and table, even of an interrupted run. The whole table is wider than a
   terminal. */
static int report(const char *directory)
{
    mote_summary summary;
    if (mote_summary_make(directory, &summary) != MOTE_OK ||
        mote_summary_write(&summary, directory) != MOTE_OK)
        return mote_command_fail();
    if (isatty(STDOUT_FILENO) == 1) {
        mote_screen_print(&summary, stdout);
        (void)printf("every row and column: mote summarize %s\n", directory);
    } else {
        mote_table_print(&summary, stdout);
    }
    mote_summary_free(&summary);
    return mote_command_finish(MOTE_EXIT_DONE);
}

static int execute(request *q)
{
    if (expand_methods(q) != MOTE_OK)
        return mote_command_fail();
    q->run.plan.budget = q->run.budget;
    mote_run_outcome outcome;
    mote_status status = q->until_share > 0 ? mote_run_until(&q->run, q->until_share, &outcome)
                                            : mote_run(&q->run, &outcome);
    if (status != MOTE_OK) {
        const int code = mote_command_fail();
        return outcome.started && code == MOTE_EXIT_BAD_INPUT ? MOTE_EXIT_CELL_FAILED : code;
    }
    if (q->run.dry_run)
        return MOTE_EXIT_DONE;
    int code = q->no_summary ? MOTE_EXIT_DONE : report(q->run.directory);
    if (code == MOTE_EXIT_DONE && outcome.failed > 0) {
        (void)fprintf(stderr, "mote: %zu of %zu cells failed; see their reason in %s/cells\n",
                      outcome.failed, outcome.cells, q->run.directory);
        code = MOTE_EXIT_CELL_FAILED;
    }
    return code;
}

int mote_command_run(int argc, char **argv)
{
    request q = {.run = {.directory = "results/run",
                         .timeout = DEFAULT_TIMEOUT,
                         .budget = DEFAULT_BUDGET,
                         .plan = {.replicates = DEFAULT_REPLICATES},
                         .argc = argc,
                         .argv = argv}};
    q.scenarios = mote_allocate((size_t)argc + 1, sizeof *q.scenarios);
    q.methods = mote_allocate((size_t)argc + 1, sizeof *q.methods);
    q.run.scenarios = q.scenarios;
    q.run.choices = &q.choices;
    int code = read_arguments(argc, argv, &q);
    if (code == MOTE_EXIT_DONE && !mote_shard_of_task(argv[0], &q.shard))
        code = MOTE_EXIT_USAGE;
    q.run.scenario_count = mote_shard_keep(q.shard, q.scenarios, q.run.scenario_count);
    if (code == MOTE_EXIT_DONE)
        code = execute(&q);
    mote_choices_free(&q.choices);
    mote_choices_free(&q.scene_choices);
    mote_choices_free(&q.impact_choices);
    free(q.scenarios);
    free(q.methods);
    free(q.pair);
    return code;
}
