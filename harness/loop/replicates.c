#include "harness/loop/replicates.h"

#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/loop/simulate.h"
#include "harness/loop/simulate_print.h"
#include "harness/process/crew.h"
#include "harness/process/manifest.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A fixed seed, so the same data give the same intervals. */
#define INTERVAL_SEED 1

/* Task t is replicate t / methods + 1 of method t % methods: replicates outermost. */
typedef struct work {
    const mote_replicates *plan;
    bool *there; /* [tasks]: stored by an earlier run */
} work;

static const mote_method_choice *choice_of(const mote_replicates *plan, size_t task)
{
    return &plan->choices->items[task % plan->choices->count];
}

static uint32_t replicate_of(const mote_replicates *plan, size_t task)
{
    return (uint32_t)(task / plan->choices->count) + 1;
}

static size_t task_count(const mote_replicates *plan)
{
    return plan->choices->count * plan->replicates;
}

/* Everything that determines a result. The caller decrefs. */
static json_t *identity(const mote_replicates *plan, size_t task)
{
    const mote_simulation_options *o = &plan->options;
    const mote_method_choice *choice = choice_of(plan, task);
    const uint32_t replicate = replicate_of(plan, task);
    char fingerprint[20], program[20];
    (void)snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, plan->subject->fingerprint);
    (void)snprintf(program, sizeof program, "%016" PRIx64, plan->program);
    return json_pack(
        "{s:s, s:s, s:o, s:i, s:I, s:I, s:f, s:f, s:f, s:f, s:[f,f,f], s:s, s:b}",
        "fingerprint", fingerprint, "method", choice->method->name, "parameters",
        mote_choice_json(choice, plan->subject->bodies != NULL), "replicate", (int)replicate,
        "seed", (json_int_t)mote_replicate_seed(plan->seed, false, replicate), "steps_asked",
        (json_int_t)plan->steps, "density", o->density, "restitution", o->restitution,
        "tolerance", o->tolerance, "time_step", o->time_step, "gravity", o->gravity.x,
        o->gravity.y, o->gravity.z, "program", program, "alone", plan->jobs == 1);
}

/* "simulations/letters-particle-r2-0123456789abcdef.json"; the caller frees it. */
static char *file_name(const mote_replicates *plan, size_t task)
{
    json_t *object = identity(plan, task);
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    const uint64_t hash = text ? mote_hash_text(text) : 0;
    char *name =
        mote_format("simulations/%.20s-%.28s-r%u-%016" PRIx64 ".json",
                    mote_subject_facts_of(plan->subject).name,
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
    json_t *object = json_pack("{s:i, s:s, s:s, s:s}", "schema", 1, "status", status, "machine",
                               machine, "scenario", plan->scenario);
    json_t *what = identity(plan, task);
    (void)json_object_update(object, what);
    json_decref(what);
    if (reason)
        (void)json_object_set_new(object, "reason", json_string(reason));
    json_t *figures = NULL;
    if (result)
        figures =
            mote_simulation_json(plan->scenario, mote_subject_facts_of(plan->subject).bodies,
                                 choice_of(plan, task), result);
    if (figures)
        (void)json_object_update(object, figures); /* "method" is now as requested */
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
    task_context t = {w->plan, task};
    const mote_child_limits limits = {.output_bytes = sizeof(mote_simulation_result)};
    return w->there[task] ? MOTE_OK : mote_child_start(simulate, &t, limits, child);
}

static mote_status finish_task(void *context, size_t task, mote_child *child, double seconds)
{
    const work *w = context;
    const bool done = child->end == MOTE_CHILD_DONE && child->status == MOTE_OK &&
                      child->size == sizeof(mote_simulation_result);
    const char *how = done ? "ok" : "crashed";
    mote_simulation_result result;
    if (done)
        memcpy(&result, child->output, sizeof result);
    else if (child->end == MOTE_CHILD_DONE && child->status == MOTE_EINVAL)
        return mote_fail(MOTE_EINVAL, "%s", child->text);
    else if (child->end == MOTE_CHILD_DONE && child->status == MOTE_EUNSUPPORTED)
        how = "unsupported";
    (void)fprintf(stderr, "%s %s r%u: %s%s%s, %.1f s\n", w->plan->scenario,
                  choice_of(w->plan, task)->text, replicate_of(w->plan, task), how,
                  done ? "" : ": ", done ? "" : child->text, seconds);
    return keep(w->plan, task, done ? &result : NULL, how, done ? NULL : child->text);
}

/* Rejects invalid input before anything is written. */
static mote_status check_methods(const mote_replicates *plan)
{
    mote_status status = MOTE_OK;
    for (size_t m = 0; m < plan->choices->count && status == MOTE_OK; ++m) {
        mote_simulator *simulator = NULL;
        status = create(plan, m, &simulator);
        mote_simulator_destroy(simulator);
    }
    return status;
}

static mote_status simulate_missing(const mote_replicates *plan)
{
    work w = {plan, mote_allocate(task_count(plan), sizeof *w.there)};
    size_t there = 0;
    for (size_t task = 0; task < task_count(plan); ++task) {
        json_t *object = recall(plan, task);
        w.there[task] = object != NULL;
        there += w.there[task];
        json_decref(object);
    }
    (void)fprintf(stderr, "plan: %zu simulations, %zu of them done\n", task_count(plan), there);
    const mote_crew crew = {.tasks = task_count(plan),
                            .places = plan->jobs,
                            .context = &w,
                            .start = start_task,
                            .finish = finish_task};
    const mote_status status = mote_crew_run(&crew);
    free(w.there);
    return status;
}

/* Collects the row of method m from the files. */
static mote_replicates_row gather(const mote_replicates *plan, size_t m)
{
    mote_replicates_row row = {0};
    double *ns = mote_allocate(plan->replicates, sizeof *ns);
    mote_replicate *each = mote_allocate(plan->replicates, sizeof *each);
    for (uint32_t r = 0; r < plan->replicates; ++r) {
        json_t *object = recall(plan, r * plan->choices->count + m);
        mote_simulation_result result;
        const char *status = json_string_value(json_object_get(object, "status"));
        const char *reason = json_string_value(json_object_get(object, "reason"));
        if (mote_simulation_read(object, &result)) {
            mote_simulation_add(&row.sum, &result);
            ns[row.done] = result.query_ns;
            each[row.done] = (mote_replicate){&ns[row.done], 1};
            ++row.done;
        } else if (status && strcmp(status, "unsupported") == 0 && reason) {
            free(row.unsupported);
            row.unsupported = mote_duplicate(reason);
        } else {
            ++row.failed;
        }
        json_decref(object);
    }
    row.interval = mote_statistics_median_interval(each, row.done, true, INTERVAL_SEED);
    row.query_ns = row.done > 0 ? mote_statistics_median(ns, row.done) : MOTE_NONE;
    free(each);
    free(ns);
    return row;
}

mote_status mote_replicates_run(const mote_replicates *plan, mote_replicates_row **rows)
{
    char *folder = mote_format("%s/simulations", plan->directory);
    const bool is_new = access(plan->directory, F_OK) != 0;
    mote_status status = check_methods(plan);
    if (status == MOTE_OK)
        status = mote_directory_make(folder);
    if (status == MOTE_OK)
        status = simulate_missing(plan);
    if (status != MOTE_OK && rmdir(folder) == 0 && is_new) /* nothing was stored */
        (void)rmdir(plan->directory);
    free(folder);
    if (status != MOTE_OK)
        return status;
    *rows = mote_allocate(plan->choices->count, sizeof **rows);
    for (size_t m = 0; m < plan->choices->count; ++m)
        (*rows)[m] = gather(plan, m);
    return MOTE_OK;
}

void mote_replicates_free(mote_replicates_row *rows, size_t count)
{
    for (size_t m = 0; rows && m < count; ++m)
        free(rows[m].unsupported);
    free(rows);
}

static json_t *row_json(const mote_replicates *plan, size_t m, const mote_replicates_row *row)
{
    const mote_method_choice *choice = &plan->choices->items[m];
    const uint32_t bodies = mote_subject_facts_of(plan->subject).bodies;
    json_t *object = NULL;
    if (row->done > 0) {
        object = mote_simulation_json(plan->scenario, bodies, choice, &row->sum);
        (void)json_object_set_new(object, "query_ns", mote_json_number(row->query_ns));
        (void)json_object_set_new(object, "query_ns_low", mote_json_number(row->interval.low));
        (void)json_object_set_new(object, "query_ns_high",
                                  mote_json_number(row->interval.high));
    } else {
        object = json_pack("{s:s, s:s, s:I}", "scenario", plan->scenario, "method",
                           choice->text, "bodies", (json_int_t)bodies);
    }
    if (row->unsupported)
        (void)json_object_set_new(object, "unsupported", json_string(row->unsupported));
    (void)json_object_set_new(object, "replicates", json_integer(row->done));
    (void)json_object_set_new(object, "replicates_failed", json_integer(row->failed));
    return object;
}

json_t *mote_replicates_json(const mote_replicates *plan, const mote_replicates_row *rows)
{
    char fingerprint[20];
    json_t *list = json_array();
    (void)snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, plan->subject->fingerprint);
    for (size_t m = 0; m < plan->choices->count; ++m)
        (void)json_array_append_new(list, row_json(plan, m, &rows[m]));
    return json_pack("{s:i, s:s, s:s, s:I, s:o}", "schema", 1, "scenario", plan->scenario,
                     "fingerprint", fingerprint, "bodies",
                     (json_int_t)mote_subject_facts_of(plan->subject).bodies, "rows", list);
}
