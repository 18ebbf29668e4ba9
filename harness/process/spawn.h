/* Running other programs, without a shell. */
#ifndef MOTE_HARNESS_SPAWN_H
#define MOTE_HARNESS_SPAWN_H

#include "core/base/status.h"

#include <stddef.h>

/* Runs argv[0] (searched in PATH) with argv, ended by NULL, in directory (NULL: this one) and
   waits. It talks English and UTF-8, whatever the user's locale: git and valgrind are read by
   us, and gnuplot warns where a figure's text cannot be written. Its standard output is kept in
   output (size bytes, cut, ended by a 0 byte; trailing line ends taken off) or, when output is
   NULL, goes where ours goes. MOTE_EIO when it cannot be run or ends with another status than
   0. */
mote_status mote_spawn(const char *const argv[], const char *directory, char *output,
                       size_t size);

#endif
