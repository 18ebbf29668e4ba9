#include "harness/loop/replicates.h"

#include "harness/base/clock.h"
#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/loop/simulate.h"
#include "harness/loop/simulate_print.h"
#include "harness/process/crew.h"
#include "harness/process/manifest.h"
#include "harness/run/progress.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Simulation t is replicate t / methods + 1 of method t % methods: replicates outermost. The
   tasks of one crew are the simulations from first on. */
typedef struct work {
    const mote_replicates *plan;
    size_t first;
    bool *skipped; /* [tasks]: stored by an earlier run, or not wanted */
} work;

static const char *scenario_of(const mote_replicates *plan)
{
    return mote_subject_facts_of(plan->subject).name;
}

static const mote_method_choice *choice_of(const mote_replicates *plan, size_t task)
{
    return &plan->choices->items[task % plan->choices->count];
}

static uint32_t replicate_of(const mote_replicates *plan, size_t task)
{
    return (uint32_t)(task / plan->choices->count) + 1;
}

static void program_text(const mote_replicates *plan, char text[MOTE_PROGRAM_SIZE])
{
    (void)snprintf(text, MOTE_PROGRAM_SIZE, "%016" PRIx64, plan->program);
}

/* Everything that determines a result. The caller decrefs. */
static json_t *identity(const mote_replicates *plan, size_t task)
{
    const mote_simulation_options *o = &plan->options;
    const mote_method_choice *choice = choice_of(plan, task);
    const uint32_t replicate = replicate_of(plan, task);
    char fingerprint[20], faces[20], program[MOTE_PROGRAM_SIZE];
    (void)snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, plan->subject->fingerprint);
    (void)snprintf(faces, sizeof faces, "%016" PRIx64, plan->subject->faces);
    program_text(plan, program);
    return json_pack(
        "{s:s, s:s, s:s, s:o, s:i, s:I, s:I, s:f, s:f, s:f, s:f, s:i, s:[f,f,f], s:s, s:b}",
        "fingerprint", fingerprint, "faces", faces, "method", choice->method->name,
        "parameters", mote_choice_json(choice, plan->subject->bodies != NULL), "replicate",
        (int)replicate, "seed", (json_int_t)mote_replicate_seed(plan->seed, false, replicate),
        "steps_asked", (json_int_t)plan->steps, "density", o->density, "restitution",
        o->restitution, "tolerance", o->tolerance, "time_step", o->time_step, "within",
        (int)o->within, "gravity", o->gravity.x, o->gravity.y, o->gravity.z, "program", program,
        "alone", plan->jobs == 1);
}

/* A simulation's identity with the names that are shown. The caller decrefs. */
static json_t *describe(const mote_replicates *plan, size_t task)
{
    json_t *object = identity(plan, task);
    (void)json_object_set_new(object, "scenario", json_string(scenario_of(plan)));
    (void)json_object_set_new(object, "method", json_string(choice_of(plan, task)->text));
    return object;
}

/* "simulations/letters-particle-r2-0123456789abcdef.json"; the caller frees it. */
static char *file_name(const mote_replicates *plan, size_t task)
{
    json_t *object = identity(plan, task);
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    const uint64_t hash = mote_hash_text(text);
    char *name =
        mote_format("simulations/%.20s-%.28s-r%u-%016" PRIx64 ".json", scenario_of(plan),
                    choice_of(plan, task)->method->name, replicate_of(plan, task), hash);
    for (char *c = strchr(name, '/') + 1; *c; ++c) {
        if (!isalnum((unsigned char)*c) && *c != '-' && *c != '.')
            *c = '_';
    }
    free(text);
    json_decref(object);
    return name;
}

/* The stored result of a task, or NULL; the caller decrefs. */
static json_t *recall(const mote_replicates *plan, size_t task)
{
    char *name = file_name(plan, task);
    json_t *object = NULL;
    mote_simulation_result result;
    if (mote_record_read_json(plan->directory, name, &object) != MOTE_OK)
        object = NULL;
    free(name);
    const char *status = json_string_value(json_object_get(object, "status"));
    if (status && (strcmp(status, "ok") != 0 || mote_simulation_read(object, &result)))
        return object;
    json_decref(object); /* damaged */
    return NULL;
}

/* Stores a result, or why there is none. */
static mote_status keep(const mote_replicates *plan, size_t task,
                        const mote_simulation_result *result, const char *status,
                        const char *reason)
{
    char machine[MOTE_MACHINE_SIZE];
    mote_machine_name(machine, sizeof machine);
    const uint32_t bodies = mote_subject_facts_of(plan->subject).bodies;
    json_t *object = json_pack("{s:i, s:s, s:s, s:I}", "schema", 1, "status", status, "machine",
                               machine, "bodies", (json_int_t)bodies);
    json_t *what = describe(plan, task);
    (void)json_object_update(object, what);
    json_decref(what);
    if (reason)
        (void)json_object_set_new(object, "reason", json_string(reason));
    json_t *figures = NULL;
    if (result)
        figures = mote_simulation_json(scenario_of(plan), bodies, choice_of(plan, task)->text,
                                       result);
    if (figures)
        (void)json_object_update(object, figures);
    json_decref(figures);
    char *name = file_name(plan, task);
    const mote_status done = mote_record_json(plan->directory, name, object);
    free(name);
    return done;
}

static mote_status create(const mote_replicates *plan, size_t task, mote_simulator **simulator)
{
    return mote_simulator_create(plan->subject, choice_of(plan, task), &plan->options,
                                 simulator);
}

typedef struct task_context {
    const mote_replicates *plan;
    size_t task;
} task_context;

/* In the child: sends the result. */
static mote_status simulate(void *context, int output)
{
    const task_context *t = context;
    mote_simulator *simulator = NULL;
    mote_simulation_result result;
    mote_status status = create(t->plan, t->task, &simulator);
    if (status == MOTE_OK) {
        mote_simulation_start start = mote_simulation_start_of(simulator);
        start.seed = mote_replicate_seed(t->plan->seed, false, replicate_of(t->plan, t->task));
        if (t->plan->steps > 0)
            start.steps = t->plan->steps;
        status = mote_simulator_run(simulator, &start, NULL, &result);
    }
    mote_simulator_destroy(simulator);
    return status == MOTE_OK ? mote_child_put(output, &result, sizeof result) : status;
}

static mote_status start_task(void *context, size_t task, mote_child *child)
{
    const work *w = context;
    task_context t = {w->plan, w->first + task};
    const mote_child_limits limits = {.output_bytes = sizeof(mote_simulation_result)};
    return w->skipped[task] ? MOTE_OK : mote_child_start(simulate, &t, limits, child);
}

static mote_status finish_task(void *context, size_t task, mote_child *child, double seconds)
{
    const work *w = context;
    const size_t which = w->first + task;
    const bool done = child->end == MOTE_CHILD_DONE && child->status == MOTE_OK &&
                      child->size == sizeof(mote_simulation_result);
    const char *how = done ? "ok" : "crashed";
    mote_simulation_result result;
    if (done)
        memcpy(&result, child->output, sizeof result);
    else if (child->end == MOTE_CHILD_DONE &&
             (child->status == MOTE_EINVAL || child->status == MOTE_ENOMEM))
        return mote_fail(child->status, "%s", child->text);
    else if (child->end == MOTE_CHILD_DONE && child->status == MOTE_EUNSUPPORTED)
        how = "unsupported";
    (void)fprintf(stderr, "%s %s r%u: %s%s%s, %.1f s\n", scenario_of(w->plan),
                  choice_of(w->plan, which)->text, replicate_of(w->plan, which), how,
                  done ? "" : ": ", done ? "" : child->text, seconds);
    return keep(w->plan, which, done ? &result : NULL, how, done ? NULL : child->text);
}

mote_status mote_replicates_check(const mote_replicates *plan)
{
    mote_status status = MOTE_OK;
    for (size_t m = 0; m < plan->choices->count && status == MOTE_OK; ++m) {
        mote_simulator *simulator = NULL;
        status = create(plan, m, &simulator);
        mote_simulator_destroy(simulator);
    }
    return status;
}

static bool is_stored(const mote_replicates *plan, size_t task)
{
    json_t *object = recall(plan, task);
    json_decref(object);
    return object != NULL;
}

/* Simulates the replicates first .. last that are not stored, of the wanted methods (NULL:
   all). */
static mote_status simulate_missing(const mote_replicates *plan, uint32_t first, uint32_t last,
                                    const bool *wanted)
{
    const size_t methods = plan->choices->count, tasks = (last - first + 1) * methods;
    work w = {plan, (first - 1) * methods, mote_allocate(tasks, sizeof *w.skipped)};
    size_t done = 0;
    for (size_t task = 0; task < tasks; ++task) {
        const bool stored = is_stored(plan, w.first + task);
        w.skipped[task] = stored || (wanted && !wanted[task % methods]);
        done += stored;
    }
    if (!wanted)
        (void)fprintf(stderr, "plan: %zu simulations, %zu of them done\n", tasks, done);
    const mote_crew crew = {.tasks = tasks,
                            .places = plan->jobs,
                            .context = &w,
                            .start = start_task,
                            .finish = finish_task};
    const mote_status status = mote_crew_run(&crew);
    free(w.skipped);
    return status;
}

/* Whether a row is of a method of the plan, asked the same. */
static bool is_asked(const mote_replicates *plan, size_t m, const mote_simulations_row *row)
{
    json_t *object = describe(plan, m);
    json_t *question = mote_simulation_question(object);
    const bool same = json_equal(row->question, question);
    json_decref(question);
    json_decref(object);
    return same;
}

/* The half width of the interval of a method's time, as a share of it: infinite if there is
   none yet, 0 if more replicates would not help. */
static double width_of(const mote_replicates *plan, size_t m, const mote_simulations *list)
{
    double width = 0;
    for (size_t i = 0; i < list->count; ++i) {
        const mote_simulations_row *row = &list->rows[i];
        if (row->done > 0 && row->failed == 0 && is_asked(plan, m, row))
            width = mote_statistics_half_width(row->query_ns, row->interval);
    }
    return width;
}

void mote_replicates_count(const mote_replicates *plan, const mote_simulations *list,
                           size_t *all, size_t *failed)
{
    for (size_t i = 0; i < list->count; ++i) {
        const mote_simulations_row *row = &list->rows[i];
        bool asked = false;
        for (size_t m = 0; m < plan->choices->count && !asked; ++m)
            asked = is_asked(plan, m, row);
        *all += asked ? (size_t)row->done + row->failed : 0;
        *failed += asked ? row->failed : 0;
    }
}

/* Adds replicates of the methods whose time is not precise enough, until there are none or the
   time is spent. */
static mote_status add_replicates(const mote_replicates *plan)
{
    const size_t methods = plan->choices->count;
    const uint64_t start = mote_clock_ns();
    bool *wanted = mote_allocate(methods, sizeof *wanted);
    uint32_t replicates = plan->replicates;
    double widest = 0, round = 0;
    mote_status status = MOTE_OK;
    char program[MOTE_PROGRAM_SIZE];
    program_text(plan, program);
    while (status == MOTE_OK) {
        mote_simulations list = {0};
        status = mote_simulations_read_of(plan->directory, program, &list);
        widest = 0;
        for (size_t m = 0; m < methods && status == MOTE_OK; ++m) {
            const double width = width_of(plan, m, &list);
            wanted[m] = width > plan->share;
            widest = fmax(widest, width);
        }
        mote_simulations_free(&list);
        const double spent = (double)(mote_clock_ns() - start) * 1e-9;
        if (status != MOTE_OK || !(widest > plan->share) || spent + round > plan->budget ||
            replicates == MOTE_REPLICATES_MAX)
            break;
        ++replicates;
        status = simulate_missing(plan, replicates, replicates, wanted);
        round = (double)(mote_clock_ns() - start) * 1e-9 - spent;
    }
    free(wanted);
    if (status == MOTE_OK)
        mote_progress_precision(replicates, widest, plan->share);
    return status;
}

mote_status mote_replicates_run(const mote_replicates *plan)
{
    char *folder = mote_format("%s/simulations", plan->directory);
    const bool is_new = access(plan->directory, F_OK) != 0;
    mote_status status = mote_directory_make(folder);
    if (status == MOTE_OK)
        status = simulate_missing(plan, 1, plan->replicates, NULL);
    if (status == MOTE_OK && plan->share > 0)
        status = add_replicates(plan);
    if (status != MOTE_OK && rmdir(folder) == 0 && is_new) /* nothing was stored */
        (void)rmdir(plan->directory);
    free(folder);
    return status;
}
