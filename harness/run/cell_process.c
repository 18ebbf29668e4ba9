#define _GNU_SOURCE /* sched_setaffinity */
#include "harness/run/cell_process.h"

#include "harness/process/load.h"
#include "harness/run/measure.h"
#include "harness/base/statistics.h"

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Frames that a probe asks about; for more than two bodies one, the slowest, in which all pairs
   are new. */
#define PROBE_FRAMES 3

/* What a child reports to its parent before it ends. */
typedef struct message {
    mote_cell_status cell;
    mote_forecast forecast;
    bool refused; /* the method rejected its input */
    char text[400];
} message;

int mote_process_core(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0)
        return -1;
    for (size_t core = CPU_SETSIZE; core-- > 0;) {
        if (CPU_ISSET(core, &set))
            return (int)core;
    }
    return -1;
}

void mote_process_pin(int core)
{
    cpu_set_t set;
    CPU_ZERO(&set);
    if (core < 0)
        return;
    CPU_SET((size_t)core, &set);
    (void)sched_setaffinity(0, sizeof set, &set);
}

/* Three quarters of the machine's memory, divided among the jobs; no limit if a sanitizer
   reserves address space. */
static size_t memory_limit(uint32_t jobs)
{
    long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    if (!mote_heap_read().counted || pages <= 0 || size <= 0)
        return 0;
    return (size_t)pages * (size_t)size / 4 * 3 / (jobs ? jobs : 1);
}

static void child_fail(message *told, mote_status status)
{
    if (status == MOTE_EUNSUPPORTED)
        told->cell = MOTE_CELL_UNSUPPORTED;
    else
        told->cell = MOTE_CELL_CRASHED;
    told->refused = status == MOTE_EINVAL;
    (void)snprintf(told->text, sizeof told->text, "%s", mote_error_text());
}

static void child_probe(const mote_cell *cell, message *told)
{
    mote_cell_result result;
    mote_status status =
        mote_measure_cell(cell, cell->subject->bodies ? 1 : PROBE_FRAMES, &result);
    if (status != MOTE_OK) {
        child_fail(told, status);
        return;
    }
    double frames[PROBE_FRAMES];
    for (size_t i = 0; i < result.row_count; ++i) {
        const mote_cell_row *row = &result.rows[i];
        frames[i] = (double)(row->deform_ns + row->update_ns + row->query_ns) * 1e-9;
    }
    told->forecast.build_seconds = (double)result.build_ns * 1e-9;
    told->forecast.frame_seconds = mote_statistics_median(frames, result.row_count);
    mote_cell_result_free(&result);
}

/* Whether a cell needs more than one core. */
static bool has_threads(const mote_cell *cell)
{
    const double *keys = cell->choice->scene;
    return keys[MOTE_SCENE_THREADS] > 1 || keys[MOTE_SCENE_AHEAD] > 0;
}

/* An error status ends the whole run: results cannot be written. */
static mote_status child_measure(const mote_cell *cell, const mote_process_options *options,
                                 message *told)
{
    mote_cell_result result;
    double load = mote_load_average(), clock_mhz = mote_core_clock(options->core);
    uint64_t start = mote_clock_ns();
    mote_cell_pairs pairs = {.file = NULL};
    mote_status status = MOTE_OK;
    if (cell->subject->bodies)
        status = mote_cell_pairs_open(cell, options->directory, &pairs);
    if (status != MOTE_OK)
        return status;
    status = mote_measure_cell_and_pairs(cell, 0, &pairs, &result);
    if (status != MOTE_OK) {
        child_fail(told, status);
        return mote_cell_pairs_close(&pairs, false);
    }
    result.core = has_threads(cell) ? -1 : options->core;
    result.load[0] = load;
    result.load[1] = mote_load_average();
    result.clock_mhz[0] = clock_mhz;
    result.clock_mhz[1] = mote_core_clock(options->core);
    result.wall_seconds = (double)(mote_clock_ns() - start) * 1e-9;
    status = mote_cell_pairs_close(&pairs, true);
    if (status == MOTE_OK)
        status = mote_cell_record(cell, &result, options->program, options->directory);
    mote_cell_result_free(&result);
    return status;
}

/* The child's task, in its own copy of the parent's memory. */
typedef struct task {
    const mote_cell *cell;
    const mote_process_options *options;
    bool probe;
} task;

static mote_status work(void *context, int output)
{
    const task *t = context;
    message told;
    memset(&told, 0, sizeof told);
    if (!has_threads(t->cell))
        mote_process_pin(t->options->core);
    mote_status status = MOTE_OK;
    if (t->probe)
        child_probe(t->cell, &told);
    else
        status = child_measure(t->cell, t->options, &told);
    return status == MOTE_OK ? mote_child_put(output, &told, sizeof told) : status;
}

static mote_status start(const mote_cell *cell, const mote_process_options *options, bool probe,
                         mote_child *child)
{
    task t = {cell, options, probe};
    const mote_child_limits limits = {.seconds = options->timeout,
                                      .memory_bytes = memory_limit(options->jobs),
                                      .output_bytes = sizeof(message)};
    mote_status status = mote_child_start(work, &t, limits, child);
    if (status == MOTE_OK)
        return MOTE_OK;
    char text[256];
    (void)snprintf(text, sizeof text, "%s", mote_error_text());
    return mote_fail(status, "%s: %s", cell->id, text);
}

/* Reads the child's report, or derives the result from how the child ended. */
static mote_status listen(const mote_process_options *options, mote_child *child, message *told)
{
    mote_status status = MOTE_OK;
    memset(told, 0, sizeof *told);
    if (child->end == MOTE_CHILD_TIMEOUT) {
        told->cell = MOTE_CELL_TIMEOUT;
        (void)snprintf(told->text, sizeof told->text, "ended after %g s", options->timeout);
    } else if (child->end == MOTE_CHILD_DONE && child->status != MOTE_OK) {
        status = mote_fail(child->status, "%s", child->text);
    } else if (child->end == MOTE_CHILD_DONE && child->size == sizeof *told) {
        memcpy(told, child->output, sizeof *told);
    } else {
        told->cell = MOTE_CELL_CRASHED;
        (void)snprintf(told->text, sizeof told->text, "%.*s", (int)sizeof told->text - 1,
                       child->text);
    }
    mote_child_release(child);
    return status;
}

mote_status mote_cell_start(const mote_cell *cell, const mote_process_options *options,
                            mote_child *child)
{
    return start(cell, options, false, child);
}

mote_status mote_cell_finish(const mote_cell *cell, const mote_process_options *options,
                             mote_child *child, mote_cell_end *end)
{
    message told;
    mote_status status = listen(options, child, &told);
    const mote_cell_failure failure = {told.cell, told.text,
                                       told.cell == MOTE_CELL_TIMEOUT ? options->timeout : 0};
    if (status == MOTE_OK && told.cell != MOTE_CELL_OK)
        status = mote_cell_record_failure(cell, &failure, options->program, options->directory);
    if (status != MOTE_OK)
        return status;
    end->status = told.cell;
    memcpy(end->reason, told.text, sizeof end->reason);
    return MOTE_OK;
}

mote_status mote_cell_probe(const mote_cell *cell, const mote_process_options *options,
                            mote_forecast *forecast)
{
    mote_child child;
    message told;
    size_t index;
    mote_status status = start(cell, options, true, &child);
    if (status == MOTE_OK)
        status = mote_child_wait(&child, 1, &index);
    if (status == MOTE_OK)
        status = listen(options, &child, &told);
    if (status == MOTE_OK && told.refused)
        status = mote_fail(MOTE_EINVAL, "%s", told.text);
    if (status == MOTE_OK)
        *forecast = told.forecast;
    return status;
}
