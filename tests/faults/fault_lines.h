/* Runs command lines of the program in a directory of their own while each place where they
   call libc fails once. Each run must either report the right kind of error with a text or
   succeed anyway; it must leak nothing (under AddressSanitizer) and leave nothing half-written.
   Interrupted and partial calls must change nothing. */
#ifndef MOTE_TESTS_FAULT_LINES_H
#define MOTE_TESTS_FAULT_LINES_H

#include "harness/command/command.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct fault_line {
    const char *text; /* the command's */
    int (*run)(int argc, char **argv);
    int status; /* without a fault */
} fault_line;

#define LINE(command, rest, status)                                                            \
    {                                                                                          \
#command rest, mote_command_##command, status                                          \
    }

/* Fills the working directory with meshes (a.obj), scenarios (s.json, b.json) and programs that
 * stand for gnuplot, valgrind and git. */
bool fault_lines_open(void);
int fault_lines_close(void); /* a test group's end */

/* From now on the program appears to be installed there as bin/mote: share/mote has the plots
   of the sources, and empty folders for page, datasets and datasets/scenarios. */
bool fault_lines_install(void);

bool fault_lines_write(const char *name, const char *text);

/* Runs the lines without a fault; false when one does not end with 0. */
bool fault_lines_run(const fault_line *list, size_t count);

/* Fails each place where a line calls for files or processes; the test fails where a run ends
   wrongly. `out` is removed before each run. */
void fault_lines_fail(const fault_line *list, size_t count);

/* The same for each place that allocates memory: the program must say so in one line and end
   with MOTE_EXIT_OUT_OF_MEMORY, unless it can do without. */
void fault_lines_exhaust(const fault_line *list, size_t count);

#define FAIL_EACH(list) fault_lines_fail(list, sizeof(list) / sizeof(list)[0])
#define EXHAUST_EACH(list) fault_lines_exhaust(list, sizeof(list) / sizeof(list)[0])

#endif
