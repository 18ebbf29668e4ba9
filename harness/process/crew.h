/* Tasks shared out to child processes, several at a time. */
#ifndef MOTE_HARNESS_CREW_H
#define MOTE_HARNESS_CREW_H

#include "harness/process/child.h"

#include <stdint.h>

typedef struct mote_crew {
    size_t tasks;    /* numbered from 0, begun in this order */
    uint32_t places; /* processes at a time, 1 .. MOTE_CHILDREN_MAX */
    void *context;   /* passed to both functions */

    /* Starts the child of a task, or leaves its pid 0 if there is nothing to do. */
    mote_status (*start)(void *context, size_t task, mote_child *child);

    /* Called when a child has ended, to read its output, which is freed afterwards. seconds:
       how long it ran. */
    mote_status (*finish)(void *context, size_t task, mote_child *child, double seconds);

    /* Called several times a second while waiting for children; may be NULL. */
    void (*meanwhile)(void *context);
} mote_crew;

/* Runs all tasks to their end. Returns the first failure of a function, or MOTE_EIO if a signal
   asked to stop (mote_child_heed_signals); children still running are then ended. */
mote_status mote_crew_run(const mote_crew *crew);

#endif
