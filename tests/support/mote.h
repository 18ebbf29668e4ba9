/* Runs the program as a user does, in the test's folder. */
#ifndef MOTE_TESTS_MOTE_H
#define MOTE_TESTS_MOTE_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Output of the last run: standard output and error. */
extern char said[1 << 20];

/* Runs `mote LINE` through a shell, with the line formatted as by printf; returns the exit
   status. A line that ends with >/dev/null leaves the errors only. */
int mote(const char *format, ...) MOTE_PRINTF(1, 2);

/* The same, but the run must end with this status and print this text. */
void mote_expect(int status, const char *says, const char *format, ...) MOTE_PRINTF(3, 4);

/* Whether valgrind is installed. */
bool has_valgrind(void);

#endif
