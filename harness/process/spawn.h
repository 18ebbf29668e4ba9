/* Running other programs, without a shell. */
#ifndef MOTE_HARNESS_SPAWN_H
#define MOTE_HARNESS_SPAWN_H

#include "core/base/status.h"

#include <stddef.h>

/* Runs argv[0] (searched in PATH) with argv, ended by NULL, in directory (NULL: this one) and
   waits. It runs in an English UTF-8 locale, whatever the user's is: we parse what git and
   valgrind print, and gnuplot warns where it cannot write a figure's text. Its standard output
   is kept in output (size bytes, cut, ended by a 0 byte; trailing line ends taken off) and its
   standard error dropped; when output is NULL, both go where ours go. MOTE_EIO when it cannot
   be run or ends with another status than 0. */
mote_status mote_spawn(const char *const argv[], const char *directory, char *output,
                       size_t size);

/* Likewise, but nothing that it writes is shown; after a failure it stands in the error's text,
   on one line. */
mote_status mote_spawn_quiet(const char *const argv[], const char *directory);

#endif
