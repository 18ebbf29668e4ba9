#define _GNU_SOURCE /* MAP_ANONYMOUS, realpath, pipe2 */
#include "tests/faults/fault_points.h"

#include "harness/base/hash.h"

#include <dirent.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <unistd.h>

enum { POINTS_MAX = 16384, CALLERS = 4, DEEPEST = 48, SEEN = 1 << 16 };

typedef enum function {
    MALLOC,
    CALLOC,
    REALLOC,
    ALIGNED,
    OPEN,
    FOPEN,
    FCLOSE,
    FGETS,
    READ,
    WRITE,
    FSYNC,
    RENAME,
    MKDIR,
    FSTAT,
    STAT,
    OPENDIR,
    PIPE,
    PIPE2,
    FORK,
    POLL,
    WAITPID,
    READLINK,
    REALPATH,
    GETCWD,
    SOCKETPAIR,
    SEND,
    RECV,
    PREAD,
    UNAME,
    GETLOADAVG,
    FUNCTIONS
} function;

static const struct {
    const char *name;
    int error;        /* errno when it fails; 0: it does not */
    bool interrupted; /* may end with EINTR */
    bool transfers;   /* may transfer only a part */
} functions[FUNCTIONS] = {
    [MALLOC] = {"malloc", ENOMEM, false, false},
    [CALLOC] = {"calloc", ENOMEM, false, false},
    [REALLOC] = {"realloc", ENOMEM, false, false},
    [ALIGNED] = {"aligned_alloc", ENOMEM, false, false},
    [OPEN] = {"open", EMFILE, false, false},
    [FOPEN] = {"fopen", EMFILE, false, false},
    [FCLOSE] = {"fclose", ENOSPC, false, false},
    [FGETS] = {"fgets", EIO, false, false},
    [READ] = {"read", EIO, true, true},
    [WRITE] = {"write", ENOSPC, true, true},
    [FSYNC] = {"fsync", EIO, false, false},
    [RENAME] = {"rename", ENOSPC, false, false},
    [MKDIR] = {"mkdir", ENOSPC, false, false},
    [FSTAT] = {"fstat", EIO, false, false},
    [STAT] = {"stat", EIO, false, false},
    [OPENDIR] = {"opendir", EMFILE, false, false},
    [PIPE] = {"pipe", EMFILE, false, false},
    [PIPE2] = {"pipe2", EMFILE, false, false},
    [FORK] = {"fork", EAGAIN, false, false},
    [POLL] = {"poll", 0, true, false},
    [WAITPID] = {"waitpid", 0, true, false},
    [READLINK] = {"readlink", EACCES, false, false},
    [REALPATH] = {"realpath", EACCES, false, false},
    [GETCWD] = {"getcwd", EACCES, false, false},
    [SOCKETPAIR] = {"socketpair", EMFILE, false, false},
    [SEND] = {"send", ENOBUFS, false, false},
    [RECV] = {"recv", ENOMEM, true, false},
    [PREAD] = {"pread", EIO, true, true},
    [UNAME] = {"uname", EFAULT, false, false},
    [GETLOADAVG] = {"getloadavg", ENOENT, false, false},
};

typedef struct point {
    uint64_t stack;
    long call;
    function function;
} point;

/* What the process under test and its children report to the test. */
typedef struct shared {
    atomic_bool happened;
    atomic_size_t count;
    point points[POINTS_MAX];
} shared;

static shared *told;
static enum { IDLE, NOTING, FAILING } state;
static fault_mode mode_now;
static fault_kind kind_now;
static long calls, target; /* of this process and of its parents before the fork */
static uint64_t seen[SEEN];
static const char *program_path; /* what /proc/self/exe leads to, or NULL */
static bool noting; /* set while note() runs, so that its own calls are not noted */

extern const char __executable_start, etext;

/* Hash of the innermost callers in our own code. */
static uint64_t hash_stack(function f)
{
    void *frames[DEEPEST];
    const int depth = backtrace(frames, DEEPEST);
    uint64_t hash = mote_hash_word(MOTE_HASH_START, f);
    int ours = -3; /* this one, is_due and the function in libc's place */
    for (int i = 0; i < depth && ours < CALLERS; ++i) {
        const char *at = frames[i];
        if (at < &__executable_start || at >= &etext)
            continue;
        if (ours++ >= 0)
            hash = mote_hash_word(hash, (uintptr_t)frames[i]);
    }
    return hash | 1;
}

static void note(function f)
{
    noting = true;
    const uint64_t stack = hash_stack(f);
    size_t slot = stack % SEEN;
    while (seen[slot] && seen[slot] != stack)
        slot = (slot + 1) % SEEN;
    if (!seen[slot]) {
        seen[slot] = stack;
        const size_t index = atomic_fetch_add(&told->count, 1);
        if (index < POINTS_MAX)
            told->points[index] = (point){stack, calls, f};
    }
    noting = false;
}

static bool is_due(function f)
{
    if (state == IDLE || noting || (f <= ALIGNED) != (kind_now == FAULT_MEMORY))
        return false;
    ++calls;
    if (state == NOTING) {
        note(f);
        return false;
    }
    if (calls != target)
        return false;
    const bool can = mode_now == FAULT_FAIL        ? functions[f].error != 0
                     : mode_now == FAULT_INTERRUPT ? functions[f].interrupted
                                                   : functions[f].transfers;
    if (can)
        atomic_store(&told->happened, true);
    return can;
}

/* Whether the call fails; errno is then set. */
static bool fails(function f)
{
    if (!is_due(f))
        return false;
    errno = mode_now == FAULT_INTERRUPT ? EINTR : functions[f].error;
    return true;
}

/* Declares the replacement of libc's NAME as the linker expects it. */
#define WRAP(result, name, ...)                                                                \
    result __real_##name(__VA_ARGS__);                                                         \
    result __wrap_##name(__VA_ARGS__);                                                         \
    result __wrap_##name(__VA_ARGS__)

WRAP(void *, malloc, size_t size)
{
    return fails(MALLOC) ? NULL : __real_malloc(size);
}

WRAP(void *, calloc, size_t count, size_t size)
{
    return fails(CALLOC) ? NULL : __real_calloc(count, size);
}

WRAP(void *, realloc, void *old, size_t size)
{
    return fails(REALLOC) ? NULL : __real_realloc(old, size);
}

WRAP(void *, aligned_alloc, size_t alignment, size_t size)
{
    return fails(ALIGNED) ? NULL : __real_aligned_alloc(alignment, size);
}

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);

int __wrap_open(const char *path, int flags, ...)
{
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
    va_end(arguments);
    return fails(OPEN) ? -1 : __real_open(path, flags, mode);
}

WRAP(FILE *, fopen, const char *path, const char *how)
{
    return fails(FOPEN) ? NULL : __real_fopen(path, how);
}

WRAP(int, fclose, FILE *file)
{
    const bool failed = fails(FCLOSE);
    const int error = errno, closed = __real_fclose(file);
    if (failed)
        errno = error;
    return failed ? EOF : closed;
}

WRAP(char *, fgets, char *text, int size, FILE *file)
{
    return fails(FGETS) ? NULL : __real_fgets(text, size, file);
}

WRAP(ssize_t, read, int file, void *data, size_t size)
{
    if (mode_now == FAULT_SHORT)
        return __real_read(file, data, size > 1 && is_due(READ) ? 1 : size);
    return fails(READ) ? -1 : __real_read(file, data, size);
}

WRAP(ssize_t, write, int file, const void *data, size_t size)
{
    if (mode_now == FAULT_SHORT)
        return __real_write(file, data, size > 1 && is_due(WRITE) ? 1 : size);
    return fails(WRITE) ? -1 : __real_write(file, data, size);
}

/* Otherwise succeeds at once without a sync: no power is cut here, and a disk takes its
   time. */
WRAP(int, fsync, int file)
{
    (void)file;
    return fails(FSYNC) ? -1 : 0;
}

WRAP(int, rename, const char *from, const char *to)
{
    return fails(RENAME) ? -1 : __real_rename(from, to);
}

WRAP(int, mkdir, const char *path, mode_t mode)
{
    return fails(MKDIR) ? -1 : __real_mkdir(path, mode);
}

WRAP(int, fstat, int file, struct stat *info)
{
    return fails(FSTAT) ? -1 : __real_fstat(file, info);
}

WRAP(int, stat, const char *path, struct stat *info)
{
    return fails(STAT) ? -1 : __real_stat(path, info);
}

WRAP(DIR *, opendir, const char *path)
{
    return fails(OPENDIR) ? NULL : __real_opendir(path);
}

WRAP(int, pipe, int ends[2])
{
    return fails(PIPE) ? -1 : __real_pipe(ends);
}

WRAP(int, pipe2, int ends[2], int flags)
{
    return fails(PIPE2) ? -1 : __real_pipe2(ends, flags);
}

WRAP(pid_t, fork, void)
{
    return fails(FORK) ? -1 : __real_fork();
}

WRAP(int, poll, struct pollfd *watch, nfds_t count, int milliseconds)
{
    return fails(POLL) ? -1 : __real_poll(watch, count, milliseconds);
}

WRAP(pid_t, waitpid, pid_t pid, int *status, int options)
{
    return fails(WAITPID) ? -1 : __real_waitpid(pid, status, options);
}

WRAP(ssize_t, readlink, const char *path, char *text, size_t size)
{
    if (fails(READLINK))
        return -1;
    if (!program_path || strcmp(path, "/proc/self/exe") != 0)
        return __real_readlink(path, text, size);
    const size_t length = strlen(program_path);
    memcpy(text, program_path, length < size ? length : size);
    return (ssize_t)(length < size ? length : size);
}

WRAP(char *, realpath, const char *path, char *resolved)
{
    return fails(REALPATH) ? NULL : __real_realpath(path, resolved);
}

WRAP(char *, getcwd, char *path, size_t size)
{
    return fails(GETCWD) ? NULL : __real_getcwd(path, size);
}

WRAP(int, socketpair, int domain, int type, int protocol, int ends[2])
{
    return fails(SOCKETPAIR) ? -1 : __real_socketpair(domain, type, protocol, ends);
}

WRAP(ssize_t, send, int socket, const void *data, size_t size, int flags)
{
    return fails(SEND) ? -1 : __real_send(socket, data, size, flags);
}

WRAP(ssize_t, recv, int socket, void *data, size_t size, int flags)
{
    return fails(RECV) ? -1 : __real_recv(socket, data, size, flags);
}

WRAP(ssize_t, pread, int file, void *data, size_t size, off_t place)
{
    if (mode_now == FAULT_SHORT)
        return __real_pread(file, data, size > 1 && is_due(PREAD) ? 1 : size, place);
    return fails(PREAD) ? -1 : __real_pread(file, data, size, place);
}

WRAP(int, uname, struct utsname *system)
{
    return fails(UNAME) ? -1 : __real_uname(system);
}

WRAP(int, getloadavg, double averages[], int count)
{
    return fails(GETLOADAVG) ? -1 : __real_getloadavg(averages, count);
}

#ifdef MOTE_COVERAGE
/* A child's coverage counts must always be written. */
WRAP(void, __gcov_dump, void)
{
    state = IDLE;
    __real___gcov_dump();
}
#endif

static _Noreturn void be_work(const fault_work *work)
{
    static const int deadly[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    for (size_t i = 0; i < sizeof deadly / sizeof deadly[0]; ++i)
        (void)signal(deadly[i], SIG_DFL); /* the test framework would catch them here */
    const int out = __real_open(work->out, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const int error = __real_open(work->error, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (out < 0 || error < 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(error, STDERR_FILENO) < 0)
        exit(99);
    (void)close(out);
    (void)close(error);
    calls = 0;
    state = target ? FAILING : NOTING;
    const int status = work->run(work->context);
    state = IDLE;
    exit(status); /* runs the leak check */
}

static void run_work(const fault_work *work, fault_end *end)
{
    (void)fflush(NULL);
    atomic_store(&told->happened, false);
    const pid_t pid = __real_fork();
    if (pid == 0)
        be_work(work);
    int status = 0;
    while (pid > 0 && __real_waitpid(pid, &status, 0) < 0 && errno == EINTR)
        continue;
    end->status = pid > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    end->happened = atomic_load(&told->happened);
}

void fault_points_be(const char *program)
{
    program_path = program;
}

size_t fault_points_find(const fault_work *work, fault_kind kind, fault_end *end)
{
    if (!told)
        told =
            mmap(NULL, sizeof *told, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (told == MAP_FAILED)
        abort();
    atomic_store(&told->count, 0);
    mode_now = FAULT_NONE;
    kind_now = kind;
    target = 0;
    void *first[1];
    (void)backtrace(first, 1); /* loads the library that backtrace needs */
    run_work(work, end);
    if (atomic_load(&told->count) > POINTS_MAX)
        abort();
    return atomic_load(&told->count);
}

bool fault_points_run(const fault_work *work, fault_mode mode, size_t k, fault_end *end)
{
    const point *p = &told->points[k];
    if ((mode == FAULT_INTERRUPT && !functions[p->function].interrupted) ||
        (mode == FAULT_SHORT && !functions[p->function].transfers) ||
        (mode == FAULT_FAIL && !functions[p->function].error))
        return false;
    mode_now = mode;
    target = p->call;
    end->function = functions[p->function].name;
    end->call = p->call;
    run_work(work, end);
    return true;
}
