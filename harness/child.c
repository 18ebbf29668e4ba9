#include "harness/child.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* The child's last words, after its output. */
typedef struct last_words {
    uint32_t status;
    char text[1024];
} last_words;

typedef struct received {
    char *data;
    size_t size, capacity;
} received;

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

/* Pages that this process has mapped, in bytes: a limit on top of it leaves room to work. */
static size_t mapped_bytes(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file) {
        if (fscanf(file, "%lu", &pages) != 1)
            pages = 0;
        (void)fclose(file);
    }
    return (size_t)pages * (size_t)sysconf(_SC_PAGESIZE);
}

static void be_child(mote_child_work work, void *context, size_t memory_bytes, pid_t parent,
                     int output)
{
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(1);
    if (memory_bytes > 0) {
        const rlim_t bytes = mapped_bytes() + memory_bytes;
        const struct rlimit limit = {bytes, bytes};
        (void)setrlimit(RLIMIT_AS, &limit);
    }
    const struct rlimit no_core = {0, 0};
    (void)setrlimit(RLIMIT_CORE, &no_core);
    last_words last;
    memset(&last, 0, sizeof last);
    last.status = (uint32_t)work(context, output);
    if (last.status != MOTE_OK)
        (void)snprintf(last.text, sizeof last.text, "%s", mote_error_text());
    (void)mote_child_put(output, &last, sizeof last);
    _exit(0);
}

static double seconds_now(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool append(received *all, const char *data, size_t size, size_t limit)
{
    if (all->size + size > limit)
        return false;
    if (all->size + size > all->capacity) {
        size_t capacity = 2 * (all->size + size);
        char *grown = realloc(all->data, capacity);
        if (!grown)
            return false;
        all->data = grown;
        all->capacity = capacity;
    }
    memcpy(all->data + all->size, data, size);
    all->size += size;
    return true;
}

/* Reads until the child closes its end. False, with *why, when it has to be ended instead. */
static bool receive(int input, mote_child_limits limits, received *all, const char **why)
{
    static char block[1 << 16];
    const double end = seconds_now() + limits.seconds;
    for (;;) {
        int wait_ms = -1;
        if (limits.seconds > 0) {
            double left = end - seconds_now();
            wait_ms = left > 0 ? (int)(left * 1000) + 1 : 0;
        }
        struct pollfd watch = {.fd = input, .events = POLLIN};
        int ready = poll(&watch, 1, wait_ms);
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready <= 0) {
            *why = "took too long";
            return false;
        }
        ssize_t got = read(input, block, sizeof block);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return true;
        if (!append(all, block, (size_t)got, limits.output_bytes + sizeof(last_words))) {
            *why = "gave more than fits";
            return false;
        }
    }
}

/* The result of a child that ended by itself. */
static mote_status conclude(const char *what, int ended, received *all)
{
    if (WIFSIGNALED(ended))
        return mote_fail(MOTE_EIO, "%s: crashed (signal %d)", what, WTERMSIG(ended));
    last_words last;
    if (all->size < sizeof last)
        return mote_fail(MOTE_EIO, "%s: ended without an answer", what);
    all->size -= sizeof last;
    memcpy(&last, all->data + all->size, sizeof last);
    if (last.status != MOTE_OK)
        return mote_fail((mote_status)last.status, "%s", last.text);
    return MOTE_OK;
}

mote_status mote_child_run(const char *what, mote_child_work work, void *context,
                           mote_child_limits limits, char **output, size_t *size)
{
    int ends[2];
    if (pipe(ends) != 0)
        return mote_fail(MOTE_EIO, "%s: no pipe: %s", what, strerror(errno));
    (void)fflush(NULL); /* or the child would print it again */
    pid_t parent = getpid();
    pid_t child = fork();
    if (child == 0) {
        (void)close(ends[0]);
        be_child(work, context, limits.memory_bytes, parent, ends[1]);
    }
    (void)close(ends[1]);
    if (child < 0) {
        (void)close(ends[0]);
        return mote_fail(MOTE_EIO, "%s: no process: %s", what, strerror(errno));
    }
    received all = {0};
    const char *why = NULL;
    bool finished = receive(ends[0], limits, &all, &why);
    (void)close(ends[0]);
    if (!finished)
        (void)kill(child, SIGKILL);
    int ended = 0;
    while (waitpid(child, &ended, 0) < 0 && errno == EINTR)
        continue;
    mote_status status =
        finished ? conclude(what, ended, &all) : mote_fail(MOTE_EIO, "%s: %s", what, why);
    if (status == MOTE_OK && output) {
        *output = all.data;
        *size = all.size;
    } else {
        free(all.data);
    }
    return status;
}
