#include "harness/process/spawn.h"

#include "harness/base/file.h"
#include "harness/process/stop.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

_Noreturn void mote_spawn_become(const char *const argv[])
{
    /* execvp does not write to its arguments; POSIX keeps the non-const type for old
       callers. */
    union {
        const char *const *given;
        char *const *wanted;
    } arguments = {.given = argv};
    (void)execvp(argv[0], arguments.wanted);
    _exit(MOTE_SPAWN_NOT_RUN);
}

int mote_spawn_wait(pid_t pid)
{
    int status = 0;
    while (waitpid(pid, &status, 0) < 0) {
        if (errno != EINTR)
            return -1;
    }
    return status;
}

/* out: receives its output, and with errors_too its errors; -1: both go where ours go. */
static _Noreturn void run(const char *const argv[], const char *directory, int out,
                          bool errors_too)
{
    if (directory && chdir(directory) != 0)
        _exit(MOTE_SPAWN_NOT_RUN);
    if (out >= 0 && dup2(out, STDOUT_FILENO) < 0)
        _exit(MOTE_SPAWN_NOT_RUN);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (out >= 0 && dup2(errors_too ? out : nowhere, STDERR_FILENO) < 0)
        _exit(MOTE_SPAWN_NOT_RUN);
    (void)setenv("LC_ALL", "C.UTF-8", 1);
    mote_spawn_become(argv);
}

/* Reads to the end; keeps as much as fits. */
static void keep_output(int in, char *output, size_t size)
{
    size_t used = 0;
    char block[4096];
    for (;;) {
        ssize_t got = read(in, block, sizeof block);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            break;
        size_t fits = size - 1 - used < (size_t)got ? size - 1 - used : (size_t)got;
        memcpy(output + used, block, fits);
        used += fits;
    }
    while (used > 0 && output[used - 1] == '\n')
        --used;
    output[used] = '\0';
}

#define PAUSE_MS_MAX 50

/* Waits until a program has ended. A signal that asks us to stop meanwhile ends it: looking for
   one again and again misses none, as a wait could that the signal comes just before. */
static int wait_or_stop(pid_t pid, bool was_asked)
{
    int status = 0;
    long pause_ms = 1;
    pid_t ended;
    while ((ended = waitpid(pid, &status, WNOHANG)) == 0 || (ended < 0 && errno == EINTR)) {
        const struct timespec pause = {0, pause_ms * 1000000};
        if (!was_asked && mote_child_stop_asked())
            (void)kill(pid, SIGTERM);
        (void)nanosleep(&pause, NULL);
        pause_ms = pause_ms < PAUSE_MS_MAX ? pause_ms + 1 : PAUSE_MS_MAX;
    }
    return ended == pid ? status : -1;
}

static mote_status spawn(const char *const argv[], const char *directory, char *output,
                         size_t size, bool errors_too)
{
    int ends[2] = {-1, -1};
    if (output && pipe(ends) != 0)
        return mote_fail(MOTE_EIO, "%s: no pipe: %s", argv[0], strerror(errno));
    (void)fflush(NULL);
    const bool was_asked = mote_child_stop_asked();
    pid_t pid = fork();
    if (pid == 0)
        run(argv, directory, ends[1], errors_too);
    int error = errno;
    if (output) {
        (void)close(ends[1]);
        if (pid > 0)
            keep_output(ends[0], output, size);
        (void)close(ends[0]);
    }
    if (pid < 0)
        return mote_fail(MOTE_EIO, "%s: no process: %s", argv[0], strerror(error));
    const int status = wait_or_stop(pid, was_asked);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return MOTE_OK;
    if (WIFEXITED(status) && WEXITSTATUS(status) == MOTE_SPAWN_NOT_RUN)
        return mote_fail(MOTE_EIO, "%s: cannot be run; is it installed?", argv[0]);
    return mote_fail(MOTE_EIO, "%s: ended with status %d", argv[0],
                     WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
}

mote_status mote_spawn(const char *const argv[], const char *directory, char *output,
                       size_t size)
{
    return spawn(argv, directory, output, size, false);
}

mote_status mote_spawn_quiet(const char *const argv[], const char *directory)
{
    char said[4096] = "";
    const mote_status status = spawn(argv, directory, said, sizeof said, true);
    if (status == MOTE_OK || !said[0])
        return status;
    for (char *p = said; *p; ++p)
        *p = *p == '\n' ? ' ' : *p;
    char *error = mote_format("%s", mote_error_text());
    (void)mote_fail(status, "%s: %s", error, said);
    free(error);
    return status;
}
