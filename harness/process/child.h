/* Runs work in a child process, so its leaks, crashes and endless loops do not affect the
   parent. A child ends with its parent. It ignores the signals that ask the parent to stop
   (SIGINT, SIGTERM). */
#ifndef MOTE_HARNESS_CHILD_H
#define MOTE_HARNESS_CHILD_H

#include "core/base/status.h"
#include "harness/process/stop.h"

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

typedef struct mote_child_limits {
    double seconds;      /* the child is ended after this long; 0: no limit */
    size_t memory_bytes; /* of address space beyond what the parent has; 0, or where /proc does
                            not say what that is: no limit */
    size_t output_bytes; /* of output at most */
    bool confined;       /* it changes no files: see harness/process/confine.h */
} mote_child_limits;

/* The child's work. It sends bytes to the parent with mote_child_put. */
typedef mote_status (*mote_child_work)(void *context, int output);

typedef enum mote_child_end {
    MOTE_CHILD_RUNNING,
    MOTE_CHILD_DONE,    /* its work returned: see status */
    MOTE_CHILD_CRASHED, /* it ended before that */
    MOTE_CHILD_TIMEOUT, /* it was ended: out of time */
    MOTE_CHILD_TOO_MUCH /* it was ended: its output exceeded output_bytes */
} mote_child_end;

/* A child process, or none where pid is 0. Zero-initialise. */
typedef struct mote_child {
    pid_t pid;
    int input;       /* where its output arrives */
    double deadline; /* by the monotonic clock; 0: none */
    size_t limit;    /* of output */
    mote_child_end end;
    mote_status status; /* of its work, when DONE */
    char text[1024];    /* the error of its work, how it crashed, or why it was ended */
    char *output;       /* what it sent; mote_child_release frees it */
    size_t size, capacity;
} mote_child;

/* Starts a child. MOTE_EIO when no process can be created. context need not outlive the
   call. */
mote_status mote_child_start(mote_child_work work, void *context, mote_child_limits limits,
                             mote_child *child);

/* At most this many children are waited for at once. */
#define MOTE_CHILDREN_MAX 256

/* Waits until one of children [count] has ended or was ended for its limits; *index is which.
   Its end, status, text and output are then set, and its pid is 0. At least one must be
   running. MOTE_EIO if a signal asked to stop; all have then been ended. */
mote_status mote_child_wait(mote_child *children, size_t count, size_t *index);

/* The same, but waits at most a fifth of a second; *ended: whether one has ended. */
mote_status mote_child_look(mote_child *children, size_t count, size_t *index, bool *ended);

/* Ends the children that are running. */
void mote_child_stop(mote_child *children, size_t count);

/* Frees the output. */
void mote_child_release(mote_child *child);

/* Runs work in a child to its end. Returns its status and takes over its error text; MOTE_EIO
   if it crashed, ran out of time, or sent too much: the text then begins with `what`. *output
   (unless NULL) is what it sent, freed by the caller. */
mote_status mote_child_run(const char *what, mote_child_work work, void *context,
                           mote_child_limits limits, char **output, size_t *size);

/* Sends bytes to the parent; MOTE_EIO if the parent no longer reads. */
mote_status mote_child_put(int output, const void *data, size_t size);

#endif
