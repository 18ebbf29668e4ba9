/* Makes each call of libc fail once, wherever the code under test makes one.

   The work under test (a command of the program, say) first runs in a process of its own while
   every place that calls for files or processes, or for memory, is noted. A place is a function
   of libc together with the four innermost callers in our own code. Then the work runs again
   for each place, and there the call fails, is interrupted by a signal (EINTR), or transfers
   one byte only. The linker replaces libc's functions by ours (--wrap: see
   tests/CMakeLists.txt); jansson gets our allocation functions. Children of the work are
   included. */
#ifndef MOTE_TESTS_FAULT_POINTS_H
#define MOTE_TESTS_FAULT_POINTS_H

#include <stdbool.h>
#include <stddef.h>

typedef enum fault_mode {
    FAULT_NONE,
    FAULT_FAIL,      /* no space, no such process; no memory */
    FAULT_INTERRUPT, /* EINTR, for the calls that a signal can interrupt */
    FAULT_SHORT      /* read and write move one byte */
} fault_mode;

typedef struct fault_work {
    int (*run)(void *context); /* its result is the exit status, below 100 */
    void *context;
    const char *out, *error; /* files that its standard output and error go to */
} fault_work;

typedef struct fault_end {
    int status;           /* exit status, or -1 when a signal ended it */
    bool happened;        /* the call was made, and failed */
    const char *function; /* that failed, by name */
    long call;            /* its number */
} fault_end;

/* From now on /proc/self/exe names this program. The path must remain valid. */
void fault_points_be(const char *program);

typedef enum fault_kind { FAULT_CALLS, FAULT_MEMORY } fault_kind;

/* Runs the work in a child without a fault and notes its places of that kind; returns their
   number and sets end to how it ended. */
size_t fault_points_find(const fault_work *work, fault_kind kind, fault_end *end);

/* Runs the work with the fault at place k; false when there is no fault of that mode there. */
bool fault_points_run(const fault_work *work, fault_mode mode, size_t k, fault_end *end);

#endif
