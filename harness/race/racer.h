/* One of the two programs of a race while it runs: a process that answers lines
   (harness/race/protocol.h). It ends with this process. */
#ifndef MOTE_HARNESS_RACER_H
#define MOTE_HARNESS_RACER_H

#include "core/base/random.h"
#include "harness/base/file.h"

#include <sys/types.h>

/* Zero-initialise; `pid` is 0 where none runs. */
typedef struct mote_racer {
    pid_t pid;
    const char *program; /* borrowed; names it in errors */
    int to, from;
    double timeout; /* seconds that an answer may take */
    mote_text text; /* what has arrived; begins with the last answer's line */
} mote_racer;

/* Runs `program race-child`, pinned to a core (-1: not), with an environment, stack and heap
   offset of random sizes, and hears its greeting. MOTE_EIO when it cannot be run or is older
   than race-child, MOTE_EINVAL when it speaks another format. */
mote_status mote_racer_start(const char *program, int core, double timeout, mote_random *random,
                             mote_racer *racer);

/* Sends a request, a line without its end, and waits for the answer: *answer is what follows
   "ok" and its tab, lives in the racer until the next request, and may be written to.
   MOTE_EUNSUPPORTED with the racer's reason where it says no; MOTE_EIO when it has ended, took
   too long, or its answer cannot be read (it is then stopped), and when a signal asked this
   process to stop (harness/process/child.h). */
mote_status mote_racer_ask(mote_racer *racer, char **answer, const char *format, ...)
    MOTE_PRINTF(3, 4);

/* Ends it and waits until it is gone. One that does not run is allowed. */
void mote_racer_stop(mote_racer *racer);

#endif
