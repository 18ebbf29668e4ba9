#define _GNU_SOURCE /* sched_setaffinity, getloadavg */
#include "harness/cell_process.h"

#include "harness/measure.h"
#include "harness/statistics.h"

#include <errno.h>
#include <poll.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* How often a waiting parent looks for a signal that asked it to stop. */
#define POLL_MS 200

#define PROBE_FRAMES 3

/* What a child tells its parent before it ends. */
typedef struct message {
    mote_cell_status cell;
    mote_status status; /* an error that ends the whole run, or MOTE_OK */
    mote_forecast forecast;
    bool refused; /* the method said that its input is wrong */
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

static void pin(int core)
{
    cpu_set_t set;
    CPU_ZERO(&set);
    if (core < 0)
        return;
    CPU_SET((size_t)core, &set);
    (void)sched_setaffinity(0, sizeof set, &set);
}

/* Three quarters of the machine; not where a sanitizer reserves address space. */
static void limit_memory(void)
{
    struct rlimit none = {0, 0};
    (void)setrlimit(RLIMIT_CORE, &none);
    long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    if (!mote_heap_read().counted || pages <= 0 || size <= 0)
        return;
    rlim_t bytes = (rlim_t)pages * (rlim_t)size / 4 * 3;
    struct rlimit limit = {bytes, bytes};
    (void)setrlimit(RLIMIT_AS, &limit);
}

static double load_average(void)
{
    double load = 0;
    return getloadavg(&load, 1) == 1 ? load : 0;
}

/* The core's clock, in MHz; 0 where the kernel does not say. */
static double core_clock(int core)
{
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[512];
    double mhz = 0;
    for (int seen = -1; file && fgets(line, sizeof line, file);) {
        seen += strncmp(line, "processor", 9) == 0 ? 1 : 0;
        if ((core < 0 || seen == core) && sscanf(line, "cpu MHz : %lf", &mhz) == 1)
            break;
    }
    if (file)
        (void)fclose(file);
    return mhz;
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
    mote_status status = mote_measure_cell(cell, PROBE_FRAMES, &result);
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

static void child_measure(const mote_cell *cell, const mote_process_options *options,
                          message *told)
{
    mote_cell_result result;
    double load = load_average(), clock_mhz = core_clock(options->core);
    uint64_t start = mote_clock_ns();
    mote_status status = mote_measure_cell(cell, 0, &result);
    if (status != MOTE_OK) {
        child_fail(told, status);
        return;
    }
    result.core = options->core;
    result.load[0] = load;
    result.load[1] = load_average();
    result.clock_mhz[0] = clock_mhz;
    result.clock_mhz[1] = core_clock(options->core);
    result.wall_seconds = (double)(mote_clock_ns() - start) * 1e-9;
    told->status = mote_cell_record(cell, &result, options->program, options->directory);
    if (told->status != MOTE_OK)
        (void)snprintf(told->text, sizeof told->text, "%s", mote_error_text());
    mote_cell_result_free(&result);
}

_Noreturn static void child(const mote_cell *cell, const mote_process_options *options,
                            bool probe, int out, pid_t parent)
{
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(1); /* the parent died before the line above */
    (void)signal(SIGINT, SIG_DFL);
    (void)signal(SIGTERM, SIG_DFL);
    limit_memory();
    pin(options->core);
    message told = {.cell = MOTE_CELL_OK};
    if (probe)
        child_probe(cell, &told);
    else
        child_measure(cell, options, &told);
    ssize_t put = write(out, &told, sizeof told);
    _exit(put == (ssize_t)sizeof told ? 0 : 1);
}

typedef enum wait_end { WAIT_TOLD, WAIT_SILENT, WAIT_TIMEOUT, WAIT_STOPPED } wait_end;

/* Waits until the child has told its message, ended, or run out of time. */
static wait_end wait_for_message(int in, const mote_process_options *options, message *told)
{
    uint64_t start = mote_clock_ns();
    for (;;) {
        struct pollfd ready = {.fd = in, .events = POLLIN};
        int count = poll(&ready, 1, POLL_MS);
        if (options->stop && *options->stop)
            return WAIT_STOPPED;
        if (count > 0) {
            ssize_t got = read(in, told, sizeof *told);
            if (got < 0 && errno == EINTR)
                continue;
            return got == (ssize_t)sizeof *told ? WAIT_TOLD : WAIT_SILENT;
        }
        if (options->timeout > 0 && (double)(mote_clock_ns() - start) * 1e-9 > options->timeout)
            return WAIT_TIMEOUT;
    }
}

static void describe_death(int wait_status, message *told)
{
    told->cell = MOTE_CELL_CRASHED;
    if (WIFSIGNALED(wait_status))
        (void)snprintf(told->text, sizeof told->text, "ended by signal %d (%s)",
                       WTERMSIG(wait_status), strsignal(WTERMSIG(wait_status)));
    else
        (void)snprintf(told->text, sizeof told->text, "ended with status %d and no answer",
                       WEXITSTATUS(wait_status));
}

/* Runs a child to its end, whichever it is. */
static mote_status run_child(const mote_cell *cell, const mote_process_options *options,
                             bool probe, message *told)
{
    int ends[2];
    if (pipe(ends) != 0)
        return mote_fail(MOTE_EIO, "no pipe for a cell: %s", strerror(errno));
    (void)fflush(NULL);
    pid_t parent = getpid();
    pid_t pid = fork();
    if (pid == 0) {
        (void)close(ends[0]);
        child(cell, options, probe, ends[1], parent);
    }
    int error = errno;
    (void)close(ends[1]);
    if (pid < 0) {
        (void)close(ends[0]);
        return mote_fail(MOTE_EIO, "no process for a cell: %s", strerror(error));
    }
    wait_end end = wait_for_message(ends[0], options, told);
    (void)close(ends[0]);
    if (end == WAIT_TIMEOUT || end == WAIT_STOPPED)
        (void)kill(pid, SIGKILL);
    int wait_status = 0;
    while (waitpid(pid, &wait_status, 0) < 0 && errno == EINTR) {
    }
    if (end == WAIT_STOPPED)
        return mote_fail(MOTE_EIO, "stopped by a signal; run the same command again to go on");
    if (end == WAIT_SILENT)
        describe_death(wait_status, told);
    if (end == WAIT_TIMEOUT) {
        told->cell = MOTE_CELL_TIMEOUT;
        (void)snprintf(told->text, sizeof told->text, "ended after %g s", options->timeout);
    }
    if (end == WAIT_TOLD && told->status != MOTE_OK)
        return mote_fail(told->status, "%s", told->text);
    return MOTE_OK;
}

mote_status mote_cell_measure(const mote_cell *cell, const mote_process_options *options,
                              mote_cell_status *status, char *reason, size_t size)
{
    message told = {.cell = MOTE_CELL_OK};
    mote_status ran = run_child(cell, options, false, &told);
    if (ran != MOTE_OK)
        return ran;
    if (told.cell != MOTE_CELL_OK) {
        ran = mote_cell_record_failure(cell, told.cell, told.text, options->program,
                                       options->directory);
        if (ran != MOTE_OK)
            return ran;
    }
    *status = told.cell;
    (void)snprintf(reason, size, "%s", told.text);
    return MOTE_OK;
}

mote_status mote_cell_probe(const mote_cell *cell, const mote_process_options *options,
                            mote_cell_status *status, mote_forecast *forecast)
{
    message told = {.cell = MOTE_CELL_OK};
    mote_status ran = run_child(cell, options, true, &told);
    if (ran != MOTE_OK)
        return ran;
    if (told.refused)
        return mote_fail(MOTE_EINVAL, "%s", told.text);
    *status = told.cell;
    *forecast = told.forecast;
    return MOTE_OK;
}
