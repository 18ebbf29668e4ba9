#define _DEFAULT_SOURCE /* flock, nanosleep */
#include "harness/run/run.h"

#include "harness/process/crew.h"
#include "harness/run/cell_process.h"
#include "harness/process/load.h"
#include "harness/process/manifest.h"
#include "harness/run/measure.h"
#include "harness/run/progress.h"
#include "harness/run/sweep.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

/* Approximate cost of reading 32 MB between frames; only for the estimate. */
#define EVICT_SECONDS 5e-3

/* Warns if other processes use more cores than this before the measurement starts. */
#define BUSY_CORES 0.3

/* How long to wait for a lock: 1 s. */
#define LOCK_TRIES 20
#define LOCK_PAUSE_NS 50000000

/* The forecast for a cell of the plan. */
typedef struct prospect {
    bool done;
    double seconds; /* expected */
} prospect;

typedef struct run {
    const mote_run_options *options;
    mote_process_options process;
    mote_subject *subjects;
    mote_plan plan;
    prospect *prospects; /* [plan.count] */
    size_t begun;        /* the first cell that was measured */
    size_t done;         /* cells of the plan */
    size_t failed;       /* of the done cells */
    size_t measured;     /* of the done cells, by this run */
    uint32_t replicates; /* planned and further ones */
    int lock;            /* descriptor, or -1 */
    bool locked;
    bool output_failed; /* the directory cannot be written because of the disk, not its name */
    mote_progress progress;
    size_t current;     /* the cell started last */
    uint64_t began_ns;  /* when that cell was started */
    uint64_t opened_ns; /* when the first cell was started */
} run;

/* Asks for impacts where steps are given. */
static mote_status ask_impacts(const mote_plan_options *plan, mote_subject *subject)
{
    mote_status status = MOTE_OK;
    if (plan->step_count > 0 && subject->bodies)
        return mote_fail(MOTE_EINVAL, "%s: impacts are asked of two bodies; it has %u",
                         subject->bodies->name, subject->bodies->count);
    for (uint32_t k = 0; k < plan->step_count && status == MOTE_OK; ++k)
        status = mote_scenario_ask_impacts(subject->scenario, plan->steps[k]);
    return status;
}

static mote_status load_subjects(run *r)
{
    size_t count = r->options->scenario_count;
    r->subjects = mote_allocate(count, sizeof *r->subjects);
    for (size_t i = 0; i < count; ++i) {
        if (mote_child_stop_asked())
            return mote_child_stopped(NULL);
        mote_status status = mote_subject_open(r->options->scenarios[i], &r->subjects[i]);
        if (status == MOTE_OK)
            status = ask_impacts(&r->options->plan, &r->subjects[i]);
        if (status == MOTE_OK)
            status = mote_subject_identify(&r->subjects[i]);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

/* Whether an earlier result stays: not if it exceeded a limit that is larger now. */
static bool stays(const json_t *object, double timeout)
{
    const double limit = mote_number_at(object, "timeout_seconds");
    return !(limit > 0) || (timeout > 0 && timeout <= limit);
}

/* Looks up an earlier result for this cell. */
static void look_up(run *r, size_t index)
{
    mote_cell *cell = &r->plan.cells[index];
    char name[MOTE_CELL_ID_SIZE + 16];
    (void)snprintf(name, sizeof name, "cells/%s.json", cell->id);
    json_t *object = NULL;
    if (mote_record_read_json(r->options->directory, name, &object) != MOTE_OK)
        return;
    const char *status = json_string_value(json_object_get(object, "status"));
    json_int_t stride = json_integer_value(json_object_get(object, "stride"));
    const bool whole = status && stride >= 1 && stride <= UINT32_MAX;
    if (whole && stays(object, r->options->timeout)) {
        const double seconds = mote_number_at(object, "wall_seconds");
        cell->stride = (uint32_t)stride;
        r->prospects[index].done = true;
        r->prospects[index].seconds = seconds > 0 ? seconds : 0; /* of further replicates */
        r->done += 1;
        r->failed += strcmp(status, mote_cell_status_names[MOTE_CELL_CRASHED]) == 0 ||
                             strcmp(status, mote_cell_status_names[MOTE_CELL_TIMEOUT]) == 0
                         ? 1
                         : 0;
    }
    json_decref(object);
}

/* Whether two cells must use the same stride: those of one configuration on one scenario. */
static bool same_configuration(const mote_cell *a, const mote_cell *b)
{
    return a->subject == b->subject && a->choice == b->choice && a->step == b->step;
}

static uint32_t choose_stride(const mote_cell *cell, double frame_seconds)
{
    if (cell->step > 0) /* one question begins where the last one ended */
        return cell->stride_asked != MOTE_STRIDE_AUTO ? cell->stride_asked : cell->step;
    if (mote_cell_needs_every_frame(cell))
        return 1;
    if (cell->stride_asked != MOTE_STRIDE_AUTO)
        return cell->stride_asked;
    return frame_seconds * 1e9 > MOTE_STRIDE_SLOW_NS ? MOTE_STRIDE_SLOW : 1;
}

static double expected_seconds(const mote_cell *cell, const mote_forecast *forecast)
{
    const uint32_t frames = mote_cell_rows(cell);
    double frame =
        forecast->frame_seconds + (cell->cache == MOTE_CACHE_EVICT ? EVICT_SECONDS : 0);
    return forecast->build_seconds + frames * frame;
}

/* The stride for the cells of a configuration that are still to be measured: that of a cell
   that is done, wherever it stands in the plan, or the one that the probe suggests. */
static uint32_t common_stride(const run *r, const mote_cell *probed, double frame_seconds)
{
    for (size_t i = 0; i < r->plan.count; ++i) {
        if (r->prospects[i].done && same_configuration(&r->plan.cells[i], probed))
            return r->plan.cells[i].stride;
    }
    return choose_stride(probed, frame_seconds);
}

/* Runs a few frames of the cell's configuration, so that bad parameters are rejected before
   anything is written; sets the stride and the expected time for all cells of the
   configuration. */
static mote_status probe_configuration(run *r, size_t index)
{
    mote_forecast forecast = {0};
    const mote_cell *probed = &r->plan.cells[index];
    mote_status status = mote_cell_probe(probed, &r->process, &forecast);
    if (status != MOTE_OK)
        return mote_fail(status, "%s on %s: %s", probed->choice->text,
                         mote_subject_facts_of(probed->subject).name, mote_error_text());
    const uint32_t stride = common_stride(r, probed, forecast.frame_seconds);
    for (size_t i = 0; i < r->plan.count; ++i) {
        mote_cell *cell = &r->plan.cells[i];
        if (!same_configuration(cell, probed))
            continue;
        if (!r->prospects[i].done)
            cell->stride = stride;
        r->prospects[i].seconds = expected_seconds(cell, &forecast);
    }
    return MOTE_OK;
}

/* Reports preparation, before anything is measured. */
static void tell_preparing(run *r, const char *what, const mote_subject *subject)
{
    char *text = mote_format("%s %s", what, mote_subject_facts_of(subject).name);
    mote_progress_say(&r->progress, text);
    free(text);
}

static mote_status look_ahead(run *r)
{
    r->prospects = mote_allocate(r->plan.count, sizeof *r->prospects);
    for (size_t i = 0; i < r->plan.count && !r->options->force; ++i)
        look_up(r, i);
    for (size_t i = 0; i < r->plan.count; ++i) {
        bool first = !r->prospects[i].done;
        for (size_t k = 0; first && k < i; ++k)
            first = r->prospects[k].done ||
                    !same_configuration(&r->plan.cells[k], &r->plan.cells[i]);
        if (first)
            tell_preparing(r, "trying every configuration on", r->plan.cells[i].subject);
        const mote_status status = first ? probe_configuration(r, i) : MOTE_OK;
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

static double seconds_since(uint64_t start_ns)
{
    return (double)(mote_clock_ns() - start_ns) * 1e-9;
}

static double seconds_left(const run *r)
{
    double seconds = 0;
    for (size_t i = 0; i < r->plan.count; ++i)
        seconds += r->prospects[i].done ? 0 : r->prospects[i].seconds;
    return seconds / r->process.jobs;
}

static void duration_text(double seconds, char *text, size_t size)
{
    if (seconds < 100)
        (void)snprintf(text, size, "%.0f s", seconds);
    else
        (void)snprintf(text, size, "%.0f min", seconds / 60);
}

/* "step 10, ", or "" where no impacts are asked for. */
#define STEP_TEXT 24
static const char *step_text(const mote_cell *cell, char text[STEP_TEXT])
{
    text[0] = '\0';
    if (cell->step > 0)
        (void)snprintf(text, STEP_TEXT, "step %u, ", cell->step);
    return text;
}

/* A stride that does not hold must not seem to. */
static void print_unstrided(const run *r)
{
    mote_text names = {.data = NULL};
    mote_plan_unstrided(&r->plan, &names);
    if (names.size > 0)
        (void)fprintf(
            stderr,
            "--stride %u does not hold for what keeps state from frame to frame, which "
            "is measured in every frame: %s\n",
            r->options->plan.stride, names.data);
    free(names.data);
}

static void print_plan(const run *r)
{
    char left[32];
    duration_text(seconds_left(r), left, sizeof left);
    (void)fprintf(stderr, "plan: %zu cells, %zu of them done, about %s\n", r->plan.count,
                  r->done, left);
    if (r->process.jobs > 1)
        (void)fprintf(stderr,
                      "%u cells at a time: their times are marked as not comparable, and no "
                      "ratio is made of them\n",
                      r->process.jobs);
    print_unstrided(r);
    if (!r->options->dry_run)
        return;
    for (size_t i = 0; i < r->plan.count; ++i) {
        const mote_cell *cell = &r->plan.cells[i];
        char step[STEP_TEXT];
        (void)fprintf(stderr, "  %s %s replicate %u, frames %u-%u, stride %u, %s%s, %s%.1f s\n",
                      mote_subject_facts_of(cell->subject).name, cell->choice->text,
                      cell->replicate, cell->first, cell->last, cell->stride,
                      step_text(cell, step), mote_cache_names[cell->cache],
                      r->prospects[i].done ? "done, not again " : "", r->prospects[i].seconds);
    }
}

/* Opens and locks the directory. After a run was killed, its child holds the lock until the
   kernel has ended it. */
static mote_status take_lock(run *r, const char *path)
{
    const struct timespec pause = {0, LOCK_PAUSE_NS};
    r->lock = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (r->lock < 0) {
        int error = errno;
        r->output_failed = error != EACCES;
        return mote_fail(MOTE_EIO, "%s: %s; name a directory that can be written to", path,
                         strerror(error));
    }
    for (int tries = 1; flock(r->lock, LOCK_EX | LOCK_NB) != 0; ++tries) {
        if (tries == LOCK_TRIES)
            return mote_fail(MOTE_EIO,
                             "%s: another run is measuring into it; wait for its end, or "
                             "name another directory",
                             r->options->directory);
        (void)nanosleep(&pause, NULL);
    }
    r->locked = true;
    return MOTE_OK;
}

static mote_status open_directory(run *r)
{
    const char *directory = r->options->directory;
    char *cells = mote_format("%s/cells", directory);
    char *lock = mote_format("%s/.lock", directory);
    mote_status status = mote_directory_make(cells);
    /* Whether the disk is full or read-only, as opposed to an impossible name or a missing
       permission. */
    r->output_failed =
        status == MOTE_EIO && errno != ENOTDIR && errno != ENOENT && errno != EACCES;
    if (status == MOTE_OK)
        status = take_lock(r, lock);
    if (status == MOTE_OK)
        mote_run_sweep(directory);
    free(cells);
    free(lock);
    return status;
}

static mote_status load_truth(run *r)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < r->options->scenario_count && status == MOTE_OK; ++i) {
        mote_subject *subject = &r->subjects[i];
        if (subject->bodies)
            continue;
        if (mote_subject_asks_impacts(subject)) {
            tell_preparing(r, "impacts of", subject);
            status =
                mote_impact_truth_load_or_compute(subject->scenario, subject->fingerprint,
                                                  r->options->directory, &subject->impacts);
            continue;
        }
        tell_preparing(r, "exact distances of", subject);
        status = mote_truth_load_or_compute_known(subject->scenario, subject->fingerprint,
                                                  r->options->directory, &subject->truth);
    }
    return status;
}

/* "[3/84] ww particle:n=8 r2 hot" */
static char *cell_text(const run *r, const mote_cell *cell)
{
    char step[STEP_TEXT];
    return mote_format("[%zu/%zu] %s %s %sr%u %s", r->done, r->plan.count,
                       mote_subject_facts_of(cell->subject).name, cell->choice->text,
                       step_text(cell, step), cell->replicate, mote_cache_names[cell->cache]);
}

/* Reports the end of a cell. A failure stays on the terminal. */
static void tell_end(run *r, const mote_cell *cell, const mote_cell_end *end, double seconds)
{
    char left[32];
    duration_text(seconds_left(r), left, sizeof left);
    const bool ok = end->status == MOTE_CELL_OK;
    char *which = cell_text(r, cell);
    char *text =
        mote_format("%s: %s%s%s, %.1f s, %s left", which, mote_cell_status_names[end->status],
                    ok ? "" : ": ", ok ? "" : end->reason, seconds, left);
    if (ok)
        mote_progress_cell(&r->progress, text);
    else
        mote_progress_keep(&r->progress, text);
    free(text);
    free(which);
}

/* Reports during measurement: the cell started last, and the estimated remaining time. */
static void tell_current(void *context)
{
    run *r = context;
    if (!mote_progress_is_due(&r->progress))
        return;
    char left[32];
    const prospect *current = &r->prospects[r->current];
    const double spent = fmin(seconds_since(r->began_ns), current->done ? 0 : current->seconds);
    duration_text(seconds_left(r) - spent / r->process.jobs, left, sizeof left);
    char *which = cell_text(r, &r->plan.cells[r->current]);
    char *text = mote_format("%s, %s left", which, left);
    mote_progress_say(&r->progress, text);
    free(text);
    free(which);
}

static void tell_total(run *r)
{
    char took[32];
    duration_text(seconds_since(r->opened_ns), took, sizeof took);
    char *text = mote_format("%zu cells measured in %s", r->measured, took);
    if (r->progress.terminal && r->measured > 0)
        mote_progress_keep(&r->progress, text);
    free(text);
}

static void warn_of_load(const run *r)
{
    double busy = r->done < r->plan.count ? mote_busy_cores() : 0;
    if (busy > BUSY_CORES)
        (void)fprintf(
            stderr,
            "warning: the machine is busy (others use %.1f cores, load %.1f); times will "
            "be noisy\n",
            busy, mote_load_average());
}

static mote_status start_cell(void *context, size_t task, mote_child *child)
{
    run *r = context;
    const size_t index = r->begun + task;
    if (r->prospects[index].done)
        return MOTE_OK;
    r->current = index;
    r->began_ns = mote_clock_ns();
    tell_current(r);
    return mote_cell_start(&r->plan.cells[index], &r->process, child);
}

static mote_status finish_cell(void *context, size_t task, mote_child *child, double seconds)
{
    run *r = context;
    const mote_cell *cell = &r->plan.cells[r->begun + task];
    mote_cell_end end;
    const mote_status status = mote_cell_finish(cell, &r->process, child, &end);
    if (status != MOTE_OK)
        return status;
    r->prospects[r->begun + task].done = true;
    r->done += 1;
    r->measured += 1;
    r->failed += end.status == MOTE_CELL_CRASHED || end.status == MOTE_CELL_TIMEOUT ? 1 : 0;
    tell_end(r, cell, &end, seconds);
    return MOTE_OK;
}

/* Measures the cells from first on that are not done. */
static mote_status measure(run *r, size_t first)
{
    const mote_crew crew = {.tasks = r->plan.count - first,
                            .places = r->process.jobs,
                            .context = r,
                            .start = start_cell,
                            .finish = finish_cell,
                            .meanwhile = tell_current};
    r->begun = first;
    return mote_crew_run(&crew);
}

/* Appends a replicate of a cell to the plan, which has room for it. */
static void add_replicate(run *r, size_t of, uint32_t replicate)
{
    size_t index = r->plan.count++;
    r->plan.cells[index] = r->plan.cells[of];
    r->plan.cells[index].replicate = replicate;
    mote_cell_name(&r->plan.cells[index], r->process.program);
    prospect fresh = {.seconds = r->prospects[of].seconds};
    r->prospects[index] = fresh;
    if (!r->options->force)
        look_up(r, index);
}

static void make_room(run *r, size_t more)
{
    const size_t count = r->plan.count + more;
    r->plan.cells = mote_resize(r->plan.cells, count, sizeof *r->plan.cells);
    r->prospects = mote_resize(r->prospects, count, sizeof *r->prospects);
}

/* Plans a further replicate of each wanted configuration among the first `base` cells; *planned
   is their number. */
static mote_status plan_replicate(run *r, size_t base, uint32_t replicate, size_t *planned)
{
    bool *wanted = mote_allocate(base, sizeof *wanted);
    make_room(r, base);
    const mote_status status =
        r->options->further(r->options->context, r->plan.cells, base, wanted);
    *planned = 0;
    for (size_t k = 0; k < base && status == MOTE_OK; ++k) {
        const size_t i = (k + replicate - 1) % base; /* in the rotated order of the plan */
        if (r->plan.cells[i].replicate != 1 || !wanted[i])
            continue;
        add_replicate(r, i, replicate);
        ++*planned;
    }
    free(wanted);
    return status;
}

/* Adds replicates until no more are wanted, or time runs out. */
static mote_status add_replicates(run *r)
{
    const size_t base = r->plan.count;
    const uint64_t start = mote_clock_ns();
    mote_status status = MOTE_OK;
    while (status == MOTE_OK && r->replicates < MOTE_REPLICATES_MAX) {
        const size_t before = r->plan.count, done = r->done, failed = r->failed;
        size_t planned;
        status = plan_replicate(r, base, r->replicates + 1, &planned);
        const double spent = (double)(mote_clock_ns() - start) * 1e-9;
        if (status != MOTE_OK || planned == 0 || spent + seconds_left(r) > r->options->budget) {
            r->plan.count = before;
            r->done = done; /* without what is stored of this replicate */
            r->failed = failed;
            break;
        }
        status = measure(r, before);
        r->replicates += status == MOTE_OK ? 1 : 0;
    }
    return status;
}

static void close_run(run *r)
{
    for (size_t i = 0; r->subjects && i < r->options->scenario_count; ++i)
        mote_subject_free(&r->subjects[i]);
    free(r->subjects);
    free(r->prospects);
    free(r->plan.cells);
    if (r->lock >= 0)
        (void)close(r->lock);
}

static mote_status prepare(run *r)
{
    mote_plan_options plan = r->options->plan;
    mote_plan made = {0};
    mote_status status = mote_program_hash(&plan.program);
    r->process.program = plan.program;
    r->process.jobs = plan.jobs > 1 ? plan.jobs : 1;
    if (status == MOTE_OK)
        status = load_subjects(r);
    if (status == MOTE_OK)
        status = mote_plan_make(
            &plan, r->subjects, r->options->scenario_count, r->options->choices,
            r->options->scene_choices ? r->options->scene_choices : r->options->choices, &made);
    r->plan = made;
    if (status == MOTE_OK)
        status = look_ahead(r);
    mote_progress_end(&r->progress);
    if (status == MOTE_OK)
        print_plan(r);
    return status;
}

/* Measures the plan and any replicates added to it. */
static mote_status carry_out(run *r, mote_run_outcome *outcome)
{
    const mote_run_options *options = r->options;
    mote_status status = open_directory(r);
    outcome->started = status == MOTE_OK || r->output_failed;
    if (status == MOTE_OK)
        status = mote_manifest_write(options->directory, r->process.program, options->plan.seed,
                                     options->argc, options->argv);
    if (status == MOTE_OK)
        status = load_truth(r);
    mote_progress_end(&r->progress);
    r->opened_ns = mote_clock_ns();
    if (status == MOTE_OK) {
        warn_of_load(r);
        status = measure(r, 0);
    }
    if (status == MOTE_OK && options->further)
        status = add_replicates(r);
    mote_progress_end(&r->progress);
    if (status == MOTE_OK)
        tell_total(r);
    if (status != MOTE_OK && r->locked)
        mote_run_sweep(options->directory); /* of processes that were ended */
    return status;
}

mote_status mote_run(const mote_run_options *options, mote_run_outcome *outcome)
{
    run r = {.options = options,
             .replicates = options->plan.replicates,
             .lock = -1,
             .progress = mote_progress_begin(options->progress)};
    r.process.directory = options->directory;
    r.process.timeout = options->timeout;
    /* Cells that run at once are not pinned. */
    r.process.core = options->plan.jobs > 1 ? -1 : mote_process_core();
    mote_run_outcome none = {0};
    *outcome = none;
    mote_status status = prepare(&r);
    /* Nothing has been written so far, and a signal ends the program at once: loading a large
       scenario takes many seconds. */
    mote_child_heed_signals();
    if (status == MOTE_OK && !options->dry_run)
        status = carry_out(&r, outcome);
    outcome->started = outcome->started || mote_child_stop_asked();
    outcome->cells = r.plan.count;
    outcome->failed = r.failed;
    outcome->replicates = r.replicates;
    close_run(&r);
    return status;
}
