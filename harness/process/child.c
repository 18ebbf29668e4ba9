#include "harness/process/child.h"

#include "harness/process/confine.h"
#include "harness/process/spawn.h"
#include "harness/base/clock.h"
#include "harness/base/memory.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* How often a waiting parent checks for a signal that asked it to stop. */
#define POLL_MS 200

/* A child that closed its end of the pipe ends at once, unless its work closed it. */
#define END_SECONDS 5

/* What the child sends last, after its output. */
typedef struct final_words {
    uint32_t status;
    char text[1024];
} final_words;

mote_status mote_child_put(int output, const void *data, size_t size)
{
    const char *from = data;
    while (size > 0) {
        ssize_t put = write(output, from, size);
        if (put < 0 && errno == EINTR)
            continue;
        if (put < 0)
            return mote_fail(MOTE_EIO, "a child's output was not read: %s", strerror(errno));
        from += put;
        size -= (size_t)put;
    }
    return MOTE_OK;
}

/* The bytes this process has mapped: a limit above that leaves room to work. 0: not known. */
static size_t mapped_bytes(void)
{
    char line[64] = "";
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file)
        return 0;
    const char *got = fgets(line, sizeof line, file);
    (void)fclose(file);
    return got ? strtoul(line, NULL, 10) * (size_t)sysconf(_SC_PAGESIZE) : 0;
}

static int parent_end; /* in a child: the pipe that the parent reads */

static _Noreturn void say_last_words(mote_status status, const char *text)
{
    final_words last;
    memset(&last, 0, sizeof last);
    last.status = (uint32_t)status;
    (void)snprintf(last.text, sizeof last.text, "%s", text);
    (void)mote_child_put(parent_end, &last, sizeof last);
    _exit(0);
}

/* When memory runs out, only the child ends, and reports that as its status. */
static void tell_parent(const char *text)
{
    say_last_words(MOTE_ENOMEM, text);
}

static _Noreturn void be_child(mote_child_work work, void *context,
                               const mote_child_limits *limits, pid_t parent, int output)
{
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(1); /* the parent ended before the prctl call */
    /* Ctrl-C reaches every process of the terminal's group: children ignore it and the parent
       ends them, so no cell is recorded as crashed. */
    (void)signal(SIGINT, SIG_IGN);
    (void)signal(SIGTERM, SIG_IGN);
    if (limits->confined)
        (void)mote_confine(); /* as far as this kernel supports it */
    const size_t mapped = limits->memory_bytes > 0 ? mapped_bytes() : 0;
    if (mapped > 0) {
        const rlim_t bytes = mapped + limits->memory_bytes;
        const struct rlimit limit = {bytes, bytes};
        (void)setrlimit(RLIMIT_AS, &limit);
    }
    const struct rlimit no_core = {0, 0};
    (void)setrlimit(RLIMIT_CORE, &no_core);
    parent_end = output;
    mote_out_of_memory_tell(tell_parent);
    const mote_status status = work(context, output);
    say_last_words(status, status == MOTE_OK ? "" : mote_error_text());
}

mote_status mote_child_start(mote_child_work work, void *context, mote_child_limits limits,
                             mote_child *child)
{
    int ends[2];
    mote_child none = {.input = -1};
    *child = none;
    if (pipe(ends) != 0)
        return mote_fail(MOTE_EIO, "no pipe: %s", strerror(errno));
    (void)fflush(NULL); /* or the child would print the buffers again */
    pid_t parent = getpid();
    pid_t pid = fork();
    if (pid == 0) {
        (void)close(ends[0]);
        be_child(work, context, &limits, parent, ends[1]);
    }
    int error = errno;
    (void)close(ends[1]);
    if (pid < 0) {
        (void)close(ends[0]);
        return mote_fail(MOTE_EIO, "no process: %s", strerror(error));
    }
    child->pid = pid;
    child->input = ends[0];
    child->deadline = limits.seconds > 0 ? mote_clock_seconds() + limits.seconds : 0;
    child->limit = limits.output_bytes + sizeof(final_words);
    return MOTE_OK;
}

static bool append(mote_child *child, const char *data, size_t size)
{
    if (child->size + size > child->limit)
        return false;
    child->output = mote_reserve(child->output, child->size + size, &child->capacity, 1);
    memcpy(child->output + child->size, data, size);
    child->size += size;
    return true;
}

/* Reads what has arrived. Returns RUNNING until the child closes its end of the pipe, then
   DONE. */
static mote_child_end receive(mote_child *child)
{
    static char block[1 << 16];
    ssize_t got = read(child->input, block, sizeof block);
    if (got < 0 && errno == EINTR)
        return MOTE_CHILD_RUNNING;
    if (got <= 0)
        return MOTE_CHILD_DONE;
    return append(child, block, (size_t)got) ? MOTE_CHILD_RUNNING : MOTE_CHILD_TOO_MUCH;
}

/* How a child that closed its end of the pipe ended, from its wait status. */
static void conclude(mote_child *child, int ended)
{
    final_words last;
    if (WIFSIGNALED(ended)) {
        child->end = MOTE_CHILD_CRASHED;
        (void)snprintf(child->text, sizeof child->text, "ended by signal %d (%s)",
                       WTERMSIG(ended), strsignal(WTERMSIG(ended)));
    } else if (child->size < sizeof last) {
        child->end = MOTE_CHILD_CRASHED;
        (void)snprintf(child->text, sizeof child->text, "ended with status %d and no answer",
                       WEXITSTATUS(ended));
    } else {
        child->size -= sizeof last;
        memcpy(&last, child->output + child->size, sizeof last);
        const bool sense = last.status <= MOTE_ENUMERIC &&
                           memchr(last.text, '\0', sizeof last.text) && WEXITSTATUS(ended) == 0;
        child->status = sense ? (mote_status)last.status : MOTE_EIO;
        (void)snprintf(child->text, sizeof child->text, "%s",
                       sense ? last.text : "ended with no answer that can be read");
        if (!sense)
            child->end = MOTE_CHILD_CRASHED;
    }
}

/* Whether a child has ended without being asked to; *ended: its wait status, then. */
static bool has_ended(const mote_child *child, int *ended)
{
    const double late = mote_clock_seconds() + END_SECONDS;
    const struct timespec pause = {0, 100000};
    pid_t pid;
    while ((pid = waitpid(child->pid, ended, WNOHANG)) != child->pid) {
        if ((pid < 0 && errno != EINTR) || mote_clock_seconds() > late)
            return false;
        (void)nanosleep(&pause, NULL);
    }
    return true;
}

static const char *why_ended(mote_child_end end)
{
    switch (end) {
    case MOTE_CHILD_TIMEOUT:
        return "took too long";
    case MOTE_CHILD_TOO_MUCH:
        return "returned more than is allowed";
    default:
        return "closed its output and went on";
    }
}

static void reap(mote_child *child, mote_child_end end)
{
    int ended = 0;
    (void)close(child->input);
    const bool by_itself = end == MOTE_CHILD_DONE && has_ended(child, &ended);
    if (!by_itself) {
        (void)kill(child->pid, SIGKILL);
        (void)mote_spawn_wait(child->pid);
    }
    child->pid = 0;
    child->input = -1;
    child->end = end;
    if (by_itself)
        conclude(child, ended);
    else
        (void)snprintf(child->text, sizeof child->text, "%s", why_ended(end));
    if (end == MOTE_CHILD_DONE && !by_itself)
        child->end = MOTE_CHILD_CRASHED;
}

void mote_child_stop(mote_child *children, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (children[i].pid > 0)
            reap(&children[i], MOTE_CHILD_TIMEOUT);
    }
}

void mote_child_release(mote_child *child)
{
    free(child->output);
    child->output = NULL;
    child->size = child->capacity = 0;
}

static bool is_late(const mote_child *child)
{
    return child->deadline > 0 && mote_clock_seconds() > child->deadline;
}

/* How long one poll may wait: until the next deadline or the next check for a signal. */
static int patience_ms(const mote_child *children, size_t count)
{
    double seconds = POLL_MS * 1e-3;
    for (size_t i = 0; i < count; ++i) {
        double left = children[i].deadline - mote_clock_seconds();
        if (children[i].pid > 0 && children[i].deadline > 0 && left < seconds)
            seconds = left > 0 ? left : 0;
    }
    return (int)(seconds * 1000) + 1;
}

mote_status mote_child_look(mote_child *children, size_t count, size_t *index, bool *ended)
{
    struct pollfd watch[MOTE_CHILDREN_MAX];
    *ended = false;
    for (size_t i = 0; i < count; ++i) {
        const struct pollfd input = {.fd = children[i].pid > 0 ? children[i].input : -1,
                                     .events = POLLIN};
        watch[i] = input;
    }
    int ready = poll(watch, count, patience_ms(children, count));
    if (mote_child_stop_asked()) {
        mote_child_stop(children, count);
        return mote_child_stopped(NULL);
    }
    for (size_t i = 0; i < count; ++i) {
        mote_child_end end = MOTE_CHILD_RUNNING;
        if (ready > 0 && watch[i].revents != 0)
            end = receive(&children[i]);
        else if (children[i].pid > 0 && is_late(&children[i]))
            end = MOTE_CHILD_TIMEOUT;
        if (end != MOTE_CHILD_RUNNING) {
            reap(&children[i], end);
            *index = i;
            *ended = true;
            return MOTE_OK;
        }
    }
    return MOTE_OK;
}

mote_status mote_child_wait(mote_child *children, size_t count, size_t *index)
{
    mote_status status = MOTE_OK;
    for (bool ended = false; status == MOTE_OK && !ended;)
        status = mote_child_look(children, count, index, &ended);
    return status;
}

mote_status mote_child_run(const char *what, mote_child_work work, void *context,
                           mote_child_limits limits, char **output, size_t *size)
{
    mote_child child;
    size_t index;
    mote_status status = mote_child_start(work, context, limits, &child);
    if (status != MOTE_OK) {
        char text[256];
        (void)snprintf(text, sizeof text, "%s", mote_error_text());
        return mote_fail(status, "%s: %s", what, text);
    }
    status = mote_child_wait(&child, 1, &index);
    if (status != MOTE_OK) {
        mote_child_release(&child);
        return status;
    }
    if (child.end == MOTE_CHILD_CRASHED)
        status = mote_fail(MOTE_EIO, "%s: crashed: %s", what, child.text);
    else if (child.end != MOTE_CHILD_DONE)
        status = mote_fail(MOTE_EIO, "%s: %s", what, child.text);
    else if (child.status != MOTE_OK)
        status = mote_fail(child.status, "%s", child.text);
    if (status == MOTE_OK && output) {
        *output = child.output;
        *size = child.size;
    } else {
        mote_child_release(&child);
    }
    return status;
}
