#define _DEFAULT_SOURCE /* flock, getloadavg */
#include "harness/run.h"

#include "harness/cell_process.h"
#include "harness/manifest.h"
#include "harness/measure.h"
#include "harness/record.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* What walking 32 MB between frames costs, roughly; only for the estimate. */
#define EVICT_SECONDS 5e-3

/* A load average before anything is measured that is worth a warning. */
#define BUSY_LOAD 0.7

/* What is known of a cell of the plan. */
typedef struct prospect {
    bool done;
    bool failed;    /* done, and crashed or out of time */
    double seconds; /* expected */
} prospect;

typedef struct run {
    const mote_run_options *options;
    mote_process_options process;
    mote_subject *subjects;
    mote_plan plan;
    prospect *prospects; /* [plan.count] */
    int lock;            /* descriptor, or -1 */
} run;

static volatile sig_atomic_t stop_asked;

static void ask_to_stop(int signal_number)
{
    (void)signal_number;
    stop_asked = 1;
}

static void watch_signals(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = ask_to_stop;
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
}

static mote_status load_subjects(run *r)
{
    size_t count = r->options->scenario_count;
    r->subjects = calloc(count + 1, sizeof *r->subjects);
    if (!r->subjects)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu scenarios", count);
    for (size_t i = 0; i < count; ++i) {
        mote_subject *subject = &r->subjects[i];
        mote_status status = mote_scenario_load(r->options->scenarios[i], &subject->scenario);
        if (status == MOTE_OK)
            status = mote_scenario_fingerprint(subject->scenario, &subject->fingerprint);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

/* What an earlier run stored of this cell; false when it has to be measured. */
static bool stored(const run *r, size_t index)
{
    mote_cell *cell = &r->plan.cells[index];
    char name[MOTE_CELL_ID_SIZE + 16];
    (void)snprintf(name, sizeof name, "cells/%s.json", cell->id);
    json_t *object = NULL;
    if (mote_record_read_json(r->options->directory, name, &object) != MOTE_OK)
        return false;
    const char *status = json_string_value(json_object_get(object, "status"));
    json_int_t stride = json_integer_value(json_object_get(object, "stride"));
    bool whole = status && stride >= 1 && stride <= UINT32_MAX;
    if (whole) {
        cell->stride = (uint32_t)stride;
        prospect *known = &r->prospects[index];
        known->done = true;
        known->failed = strcmp(status, mote_cell_status_names[MOTE_CELL_CRASHED]) == 0 ||
                        strcmp(status, mote_cell_status_names[MOTE_CELL_TIMEOUT]) == 0;
    }
    json_decref(object);
    return whole;
}

/* All cells of one configuration on one scenario run with the same stride: the one already
   stored, or the one that the probe asks for. */
static bool same_configuration(const mote_cell *a, const mote_cell *b)
{
    return a->subject == b->subject && a->choice == b->choice;
}

static uint32_t choose_stride(const mote_cell *cell, double frame_seconds)
{
    if (cell->choice->method->traits(cell->choice->values).keeps_state)
        return 1;
    if (cell->stride_asked != MOTE_STRIDE_AUTO)
        return cell->stride_asked;
    return frame_seconds * 1e9 > MOTE_STRIDE_SLOW_NS ? MOTE_STRIDE_SLOW : 1;
}

static double expected_seconds(const mote_cell *cell, const mote_forecast *forecast)
{
    double frames = (double)((cell->last - cell->first) / cell->stride + 1);
    double frame =
        forecast->frame_seconds + (cell->cache == MOTE_CACHE_EVICT ? EVICT_SECONDS : 0);
    return forecast->build_seconds + frames * frame;
}

/* Runs a few frames of the cell's configuration: refuses bad parameters before anything is
   written, and sets stride and expected time for all cells of the configuration. */
static mote_status probe_configuration(run *r, size_t index)
{
    mote_forecast forecast = {0};
    mote_cell_status ended;
    mote_status status = mote_cell_probe(&r->plan.cells[index], &r->process, &ended, &forecast);
    if (status != MOTE_OK)
        return status;
    uint32_t stride = choose_stride(&r->plan.cells[index], forecast.frame_seconds);
    for (size_t i = 0; i < r->plan.count; ++i) {
        mote_cell *cell = &r->plan.cells[i];
        if (!same_configuration(cell, &r->plan.cells[index]))
            continue;
        if (r->prospects[i].done)
            stride = cell->stride;
        else
            cell->stride = stride;
        r->prospects[i].seconds = expected_seconds(cell, &forecast);
    }
    return MOTE_OK;
}

static mote_status look_ahead(run *r)
{
    r->prospects = calloc(r->plan.count + 1, sizeof *r->prospects);
    if (!r->prospects)
        return mote_fail(MOTE_ENOMEM, "no memory for a plan of %zu cells", r->plan.count);
    for (size_t i = 0; i < r->plan.count && !r->options->force; ++i)
        (void)stored(r, i);
    for (size_t i = 0; i < r->plan.count; ++i) {
        bool first = !r->prospects[i].done;
        for (size_t k = 0; first && k < i; ++k)
            first = r->prospects[k].done ||
                    !same_configuration(&r->plan.cells[k], &r->plan.cells[i]);
        mote_status status = first ? probe_configuration(r, i) : MOTE_OK;
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

static double seconds_left(const run *r, size_t from)
{
    double seconds = 0;
    for (size_t i = from; i < r->plan.count; ++i)
        seconds += r->prospects[i].done ? 0 : r->prospects[i].seconds;
    return seconds;
}

static void duration_text(double seconds, char *text, size_t size)
{
    if (seconds < 100)
        (void)snprintf(text, size, "%.0f s", seconds);
    else
        (void)snprintf(text, size, "%.0f min", seconds / 60);
}

static void print_plan(const run *r)
{
    size_t done = 0;
    for (size_t i = 0; i < r->plan.count; ++i)
        done += r->prospects[i].done ? 1 : 0;
    char left[32];
    duration_text(seconds_left(r, 0), left, sizeof left);
    (void)fprintf(stderr, "plan: %zu cells, %zu of them done, about %s\n", r->plan.count, done,
                  left);
    if (!r->options->dry_run)
        return;
    for (size_t i = 0; i < r->plan.count; ++i) {
        const mote_cell *cell = &r->plan.cells[i];
        (void)fprintf(stderr, "  %s %s replicate %u, frames %u-%u, stride %u, %s, %s%.1f s\n",
                      cell->subject->scenario->name, cell->choice->text, cell->replicate,
                      cell->first, cell->last, cell->stride, mote_cache_names[cell->cache],
                      r->prospects[i].done ? "done, not again " : "", r->prospects[i].seconds);
    }
}

/* Takes away what an interrupted write left beside the cells. */
static void sweep_parts(const char *cells)
{
    DIR *folder = opendir(cells);
    if (!folder)
        return;
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        size_t length = strlen(entry->d_name);
        if (length > 5 && strcmp(entry->d_name + length - 5, ".part") == 0)
            (void)unlinkat(dirfd(folder), entry->d_name, 0);
    }
    (void)closedir(folder);
}

static mote_status open_directory(run *r)
{
    const char *directory = r->options->directory;
    char *cells = mote_format("%s/cells", directory);
    char *lock = mote_format("%s/.lock", directory);
    mote_status status = cells && lock ? mote_directory_make(cells)
                                       : mote_fail(MOTE_ENOMEM, "no memory for a name");
    if (status == MOTE_OK) {
        r->lock = open(lock, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
        if (r->lock < 0)
            status = mote_fail(MOTE_EIO, "%s: %s; name a directory that can be written to",
                               lock, strerror(errno));
        else if (flock(r->lock, LOCK_EX | LOCK_NB) != 0)
            status = mote_fail(MOTE_EIO,
                               "%s: another run is measuring into it; wait for its end, or "
                               "name another directory",
                               directory);
    }
    if (status == MOTE_OK)
        sweep_parts(cells);
    free(cells);
    free(lock);
    return status;
}

static mote_status load_truth(run *r)
{
    for (size_t i = 0; i < r->options->scenario_count; ++i) {
        mote_subject *subject = &r->subjects[i];
        mote_status status = mote_truth_load_or_compute(subject->scenario,
                                                        r->options->directory, &subject->truth);
        if (status != MOTE_OK)
            return status;
        if (subject->truth->fingerprint != subject->fingerprint)
            return mote_fail(MOTE_ENUMERIC, "%s: two computations of its frames differ",
                             subject->scenario->name);
    }
    return MOTE_OK;
}

static void print_progress(const run *r, size_t index, mote_cell_status status,
                           const char *reason, double seconds)
{
    const mote_cell *cell = &r->plan.cells[index];
    char left[32];
    duration_text(seconds_left(r, index + 1), left, sizeof left);
    bool terminal = isatty(STDERR_FILENO) == 1;
    bool ok = status == MOTE_CELL_OK;
    (void)fprintf(stderr, "%s[%zu/%zu] %s %s r%u %s: %s%s%s, %.1f s, %s left%s",
                  terminal ? "\r\033[K" : "", index + 1, r->plan.count,
                  cell->subject->scenario->name, cell->choice->text, cell->replicate,
                  mote_cache_names[cell->cache], mote_cell_status_names[status], ok ? "" : ": ",
                  ok ? "" : reason, seconds, left,
                  terminal && ok && index + 1 < r->plan.count ? "" : "\n");
}

static void warn_of_load(void)
{
    double load;
    if (getloadavg(&load, 1) == 1 && load > BUSY_LOAD)
        (void)fprintf(stderr, "warning: the machine is busy (load %.1f); times will be noisy\n",
                      load);
}

static mote_status measure(run *r, mote_run_outcome *outcome)
{
    for (size_t i = 0; i < r->plan.count; ++i) {
        prospect *known = &r->prospects[i];
        if (!known->done) {
            char reason[400];
            mote_cell_status ended;
            uint64_t start = mote_clock_ns();
            mote_status status = mote_cell_measure(&r->plan.cells[i], &r->process, &ended,
                                                   reason, sizeof reason);
            if (status != MOTE_OK)
                return status;
            known->done = true;
            known->failed = ended == MOTE_CELL_CRASHED || ended == MOTE_CELL_TIMEOUT;
            print_progress(r, i, ended, reason, (double)(mote_clock_ns() - start) * 1e-9);
        }
        outcome->failed += known->failed ? 1 : 0;
    }
    return MOTE_OK;
}

static void close_run(run *r)
{
    for (size_t i = 0; r->subjects && i < r->options->scenario_count; ++i) {
        mote_truth_destroy(r->subjects[i].truth);
        mote_scenario_destroy(r->subjects[i].scenario);
    }
    free(r->subjects);
    free(r->prospects);
    free(r->plan.cells);
    if (r->lock >= 0)
        (void)close(r->lock);
}

static mote_status prepare(run *r)
{
    mote_plan_options plan = r->options->plan;
    mote_status status = mote_program_hash(&plan.program);
    r->process.program = plan.program;
    if (status == MOTE_OK)
        status = load_subjects(r);
    if (status == MOTE_OK)
        status = mote_plan_make(&plan, r->subjects, r->options->scenario_count,
                                r->options->choices, &r->plan);
    if (status == MOTE_OK)
        status = look_ahead(r);
    if (status == MOTE_OK)
        print_plan(r);
    return status;
}

mote_status mote_run(const mote_run_options *options, mote_run_outcome *outcome)
{
    run r = {.options = options, .lock = -1};
    r.process.directory = options->directory;
    r.process.timeout = options->timeout;
    r.process.core = mote_process_core();
    r.process.stop = &stop_asked;
    mote_run_outcome none = {0};
    *outcome = none;
    watch_signals();
    mote_status status = prepare(&r);
    outcome->cells = r.plan.count;
    if (status == MOTE_OK && !options->dry_run) {
        status = open_directory(&r);
        if (status == MOTE_OK)
            status = mote_manifest_write(options->directory, r.process.program,
                                         options->plan.seed, options->argc, options->argv);
        if (status == MOTE_OK)
            status = load_truth(&r);
        if (status == MOTE_OK) {
            outcome->started = true;
            warn_of_load();
            status = measure(&r, outcome);
        }
    }
    close_run(&r);
    return status;
}
