/* Work done in a child process: what it allocates, leaks, crashes on or waits for for ever does
   not reach the parent. */
#ifndef MOTE_HARNESS_CHILD_H
#define MOTE_HARNESS_CHILD_H

#include "core/status.h"

#include <stddef.h>

typedef struct mote_child_limits {
    double seconds;      /* the child is ended after this long; 0: no limit */
    size_t memory_bytes; /* of address space beyond what the parent has; 0: no limit */
    size_t output_bytes; /* of output at most */
} mote_child_limits;

/* What the child does. It hands back bytes with mote_child_put. */
typedef mote_status (*mote_child_work)(void *context, int output);

/* Runs work in a child process that ends with its parent. Returns its status, its error text
   becoming ours; MOTE_EIO when it crashed, was out of time, or said too much: the text then
   begins with `what`. *output (unless NULL) is what it put, freed by the caller. */
mote_status mote_child_run(const char *what, mote_child_work work, void *context,
                           mote_child_limits limits, char **output, size_t *size);

/* Sends bytes to the parent; MOTE_EIO when it does not listen. */
mote_status mote_child_put(int output, const void *data, size_t size);

#endif
