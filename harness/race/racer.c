#define _GNU_SOURCE /* pipe2 */
#include "harness/race/racer.h"

#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/process/child.h"
#include "harness/process/spawn.h"
#include "harness/race/protocol.h"
#include "harness/run/own_words.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Interval at which a waiting parent checks for a signal that asked it to stop. */
#define POLL_MS 200
/* A page: the environment lies above the stack, so its size moves everything below it. */
#define ENVIRONMENT_BYTES 4096
#define STACK_BYTES 4096
#define HEAP_BYTES 65536
/* How long a process that has closed its output may take to end. */
#define GRACE_SECONDS 1.0

static double seconds_now(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The command line of a child; everything it needs is made before the fork. */
typedef struct start {
    const char *program;
    char core[16], stack[16], heap[16];
    char padding[ENVIRONMENT_BYTES + 1];
    pid_t parent;
    int in, out;
} start;

static start plan(const char *program, int core, mote_random *random)
{
    start s = {.program = program, .parent = getpid()};
    (void)snprintf(s.core, sizeof s.core, "%d", core + 1);
    (void)snprintf(s.stack, sizeof s.stack, "%d", (int)mote_random_below(random, STACK_BYTES));
    (void)snprintf(s.heap, sizeof s.heap, "%d", (int)mote_random_below(random, HEAP_BYTES));
    memset(s.padding, 'x', (size_t)mote_random_below(random, ENVIRONMENT_BYTES));
    return s;
}

static _Noreturn void be_racer(const start *s)
{
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != s->parent || dup2(s->in, STDIN_FILENO) < 0 ||
        dup2(s->out, STDOUT_FILENO) < 0)
        _exit(MOTE_SPAWN_NOT_RUN);
    /* Everything it has to say is in its answers. */
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (dup2(nowhere, STDERR_FILENO) < 0 || setenv("MOTE_RACE_PADDING", s->padding, 1) != 0)
        _exit(MOTE_SPAWN_NOT_RUN);
    enum { WORDS = 7 };
    const char *const words[WORDS] = {"race-child", "--core", s->core, "--stack",
                                      s->stack,     "--heap", s->heap};
    const char *argv[1 + WORDS + MOTE_OWN_WORDS_MAX + 1] = {s->program};
    argv[mote_own_words_add(words, WORDS, argv, 1)] = NULL;
    mote_spawn_become(argv);
}

static mote_status launch(const start *plan_made, mote_racer *racer)
{
    int to[2], from[2];
    start s = *plan_made;
    if (pipe2(to, O_CLOEXEC) != 0)
        return mote_fail(MOTE_EIO, "%s: no pipe: %s", s.program, strerror(errno));
    if (pipe2(from, O_CLOEXEC) != 0) {
        const int error = errno;
        (void)close(to[0]);
        (void)close(to[1]);
        return mote_fail(MOTE_EIO, "%s: no pipe: %s", s.program, strerror(error));
    }
    s.in = to[0];
    s.out = from[1];
    (void)fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0)
        be_racer(&s);
    const int error = errno;
    (void)close(to[0]);
    (void)close(from[1]);
    if (pid < 0) {
        (void)close(to[1]);
        (void)close(from[0]);
        return mote_fail(MOTE_EIO, "%s: no process: %s", s.program, strerror(error));
    }
    racer->pid = pid;
    racer->to = to[1];
    racer->from = from[0];
    return MOTE_OK;
}

void mote_racer_stop(mote_racer *racer)
{
    if (racer->pid > 0) {
        (void)close(racer->to);
        (void)close(racer->from);
        (void)kill(racer->pid, SIGKILL);
        (void)mote_spawn_wait(racer->pid);
    }
    free(racer->text.data);
    *racer = (mote_racer){0};
}

/* Stops a racer that cannot continue, and fails with what happened. */
static mote_status fail_stopped(mote_racer *racer, const char *what)
{
    const char *program = racer->program;
    mote_racer_stop(racer);
    return mote_fail(MOTE_EIO, "%s: %s", program, what);
}

/* Waits for the process, which has closed its end, and fails with how it ended. */
static mote_status fail_ended(mote_racer *racer)
{
    int ended = 0;
    const char *program = racer->program;
    const double deadline = seconds_now() + GRACE_SECONDS;
    const struct timespec moment = {.tv_nsec = 1000000};
    while (waitpid(racer->pid, &ended, WNOHANG) == 0) {
        if (seconds_now() > deadline)
            return fail_stopped(racer, "closed its output and went on");
        (void)nanosleep(&moment, NULL);
    }
    (void)close(racer->to);
    (void)close(racer->from);
    racer->pid = 0;
    mote_racer_stop(racer);
    if (WIFSIGNALED(ended))
        return mote_fail(MOTE_EIO, "%s: ended by signal %d (%s)", program, WTERMSIG(ended),
                         strsignal(WTERMSIG(ended)));
    return mote_fail(MOTE_EIO, "%s: ended with status %d", program, WEXITSTATUS(ended));
}

/* Reads what has arrived; *ended: the other end is closed. */
static void receive(mote_racer *racer, bool *ended)
{
    static char block[1 << 16];
    const ssize_t got = read(racer->from, block, sizeof block - 1);
    *ended = got == 0 || (got < 0 && errno != EINTR);
    if (got <= 0)
        return;
    block[got] = '\0';
    if (strlen(block) != (size_t)got)
        *ended = true; /* not text: nothing after it can be read */
    mote_text_add(&racer->text, "%s", block);
}

/* Waits for a line; a 0 byte replaces its end. */
static mote_status hear(mote_racer *racer, char **line)
{
    const double deadline = seconds_now() + racer->timeout;
    racer->text.size = 0;
    if (racer->text.data)
        racer->text.data[0] = '\0';
    for (;;) {
        char *first = racer->text.data;
        char *end = first && racer->text.size > 0 ? strchr(first, '\n') : NULL;
        bool ended = false;
        if (end && end[1] == '\0') {
            *end = '\0';
            *line = first;
            return MOTE_OK;
        }
        if (end || racer->text.size > MOTE_RACE_LINE)
            return fail_stopped(racer, "an answer that cannot be read");
        if (mote_child_stop_asked()) {
            mote_racer_stop(racer);
            return mote_fail(MOTE_EIO, "stopped by a signal");
        }
        struct pollfd watch = {.fd = racer->from, .events = POLLIN};
        const int ready = poll(&watch, 1, POLL_MS);
        if (ready > 0)
            receive(racer, &ended);
        if (ended)
            return fail_ended(racer);
        if (ready == 0 && seconds_now() > deadline)
            return fail_stopped(racer, "took too long to answer; --timeout allows more");
    }
}

MOTE_PRINTF(2, 0)
static mote_status send_line(mote_racer *racer, const char *format, va_list arguments)
{
    char line[8192];
    const int size = vsnprintf(line, sizeof line - 1, format, arguments);
    if ((size_t)size >= sizeof line - 1)
        return mote_fail(MOTE_EINVAL, "%s: names that are too long", racer->program);
    line[size] = '\n';
    return mote_child_put(racer->to, line, (size_t)size + 1) == MOTE_OK ? MOTE_OK
                                                                        : fail_ended(racer);
}

mote_status mote_racer_send(mote_racer *racer, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const mote_status status = send_line(racer, format, arguments);
    va_end(arguments);
    return status;
}

mote_status mote_racer_hear(mote_racer *racer, char **answer)
{
    char *heard = NULL;
    const mote_status status = hear(racer, &heard);
    if (status != MOTE_OK)
        return status;
    assert(heard);
    if (strncmp(heard, "no\t", 3) == 0)
        return mote_fail(MOTE_EUNSUPPORTED, "%s", heard + 3);
    if (strncmp(heard, "ok\t", 3) != 0)
        return fail_stopped(racer, "an answer that cannot be read");
    *answer = heard + 3;
    return MOTE_OK;
}

mote_status mote_racer_ask(mote_racer *racer, char **answer, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const mote_status status = send_line(racer, format, arguments);
    va_end(arguments);
    return status == MOTE_OK ? mote_racer_hear(racer, answer) : status;
}

static mote_status check_greeting(mote_racer *racer, const char *greeting)
{
    assert(greeting);
    const char *program = racer->program;
    uint64_t format = 0;
    const size_t length = strlen(MOTE_RACE_GREETING "\t");
    const bool known = strncmp(greeting, MOTE_RACE_GREETING "\t", length) == 0 &&
                       mote_read_unsigned(greeting + length, 1, UINT32_MAX, &format);
    if (known && format == MOTE_RACE_FORMAT)
        return MOTE_OK;
    mote_racer_stop(racer);
    if (known)
        return mote_fail(MOTE_EINVAL,
                         "%s: speaks format %d of races, and this program format %d; race two "
                         "builds of one format",
                         program, (int)format, MOTE_RACE_FORMAT);
    return mote_fail(MOTE_EINVAL, "%s: does not speak as a racer does; name a build of mote",
                     program);
}

mote_status mote_racer_start(const char *program, int core, double timeout, mote_random *random,
                             mote_racer *racer)
{
    const start s = plan(program, core, random);
    *racer = (mote_racer){.program = program, .timeout = timeout};
    if (access(program, X_OK) != 0)
        return mote_fail(MOTE_EIO, "%s: cannot be run: %s", program, strerror(errno));
    return launch(&s, racer);
}

mote_status mote_racer_greet(mote_racer *racer)
{
    char *greeting = NULL;
    const mote_status status = hear(racer, &greeting);
    if (status != MOTE_OK && !mote_child_stop_asked()) {
        char said[256];
        (void)snprintf(said, sizeof said, "%s", mote_error_text());
        return mote_fail(MOTE_EIO,
                         "%s before its greeting; a build from before `mote race` cannot be "
                         "raced: name a newer one",
                         said);
    }
    return status == MOTE_OK ? check_greeting(racer, greeting) : status;
}
