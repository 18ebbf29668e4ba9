/* Command lines of the program, run in a directory of their own while each place where they
   call libc fails once: an error of the right kind with a text, or all went well without;
   nothing leaked (under AddressSanitizer), nothing half-written. Interrupted and partial calls
   change nothing. */
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

/* The program is one installed there from now on, bin/mote: share/mote has the plots of the
   sources, and empty folders for page, datasets and datasets/scenarios. */
bool fault_lines_install(void);

bool fault_lines_write(const char *name, const char *text);

/* Runs lines without a fault; false when one does not end with 0. */
bool fault_lines_run(const fault_line *list, size_t count);

/* Each place of each line that calls for files and processes; the test fails where an end is
   not as it should be. `out` is removed before each. */
void fault_lines_fail(const fault_line *list, size_t count);

/* The same for each place that asks for memory: the program says so in one line and ends with
   MOTE_EXIT_OUT_OF_MEMORY, unless it goes without. */
void fault_lines_exhaust(const fault_line *list, size_t count);

#define FAIL_EACH(list) fault_lines_fail(list, sizeof(list) / sizeof(list)[0])
#define EXHAUST_EACH(list) fault_lines_exhaust(list, sizeof(list) / sizeof(list)[0])

#endif
