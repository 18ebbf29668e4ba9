/* A running program of a race: a process that answers lines (harness/race/protocol.h). It ends
   with this process. */
#ifndef MOTE_HARNESS_RACER_H
#define MOTE_HARNESS_RACER_H

#include "core/base/random.h"
#include "harness/base/file.h"

#include <sys/types.h>

/* Zero-initialise; `pid` is 0 if no process runs. */
typedef struct mote_racer {
    pid_t pid;
    const char *program; /* borrowed; names it in errors */
    int to, from;
    double timeout; /* seconds that an answer may take */
    mote_text text; /* received data; begins with the last answer's line */
} mote_racer;

/* Runs `program race-child`, which measures on a core (-1: on any), with an environment, a
   stack offset and a heap offset of random sizes, and with the --allow, --strict and --plugin
   that this program was given. MOTE_EIO if it cannot be run. */
mote_status mote_racer_start(const char *program, int core, double timeout, mote_random *random,
                             mote_racer *racer);

/* Waits for its greeting; nothing may be asked before. MOTE_EIO if it is older than race-child,
   MOTE_EINVAL if it uses another format. */
mote_status mote_racer_greet(mote_racer *racer);

/* Sends a request, a line without its end; mote_racer_hear must follow before the next.
   MOTE_EIO if the racer has ended. */
mote_status mote_racer_send(mote_racer *racer, const char *format, ...) MOTE_PRINTF(2, 3);

/* Waits for the answer to a request: *answer is the text after "ok" and its tab, is valid until
   the next request, and may be modified. MOTE_EUNSUPPORTED with the racer's reason if it
   says no; MOTE_EIO if it has ended, took too long, or its answer cannot be read (it is then
   stopped), and if a signal asked this process to stop (harness/process/child.h). */
mote_status mote_racer_hear(mote_racer *racer, char **answer);

/* Sends a request and waits for its answer. Errors of both. */
mote_status mote_racer_ask(mote_racer *racer, char **answer, const char *format, ...)
    MOTE_PRINTF(3, 4);

/* Stops the process and waits until it has ended. Does nothing if none runs. */
void mote_racer_stop(mote_racer *racer);

#endif
