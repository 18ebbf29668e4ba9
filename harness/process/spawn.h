/* Runs other programs, without a shell. */
#ifndef MOTE_HARNESS_SPAWN_H
#define MOTE_HARNESS_SPAWN_H

#include "core/base/status.h"

#include <stddef.h>
#include <sys/types.h>

/* The exit status of a process that could not become another program. */
#define MOTE_SPAWN_NOT_RUN 127

/* Runs argv[0] (searched in PATH) with argv, ended by NULL, in directory (NULL: the current
   one) and waits. It runs in an English UTF-8 locale, whatever the user's is: we parse what git
   and valgrind print, and gnuplot warns if it cannot write a figure's text. Its standard output
   is stored in output (cut to size bytes, ended by a 0 byte, trailing line ends removed) and
   its standard error dropped; if output is NULL, both go where ours go. A signal that asks us
   to stop meanwhile (mote_child_heed_signals) ends it. MOTE_EIO if it cannot be run or its exit
   status is not 0. */
mote_status mote_spawn(const char *const argv[], const char *directory, char *output,
                       size_t size);

/* The same, but nothing it writes is shown; after a failure its output is in the error's text,
   on one line. */
mote_status mote_spawn_quiet(const char *const argv[], const char *directory);

/* Waits until a child process has ended; returns its wait status, or -1 if it is none of ours.
 */
int mote_spawn_wait(pid_t pid);

/* In a child process: becomes the program argv[0] (searched in PATH), or ends with
   MOTE_SPAWN_NOT_RUN. */
_Noreturn void mote_spawn_become(const char *const argv[]);

#endif
