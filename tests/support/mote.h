/* Running the program as a user runs it, from the test's folder. */
#ifndef MOTE_TESTS_MOTE_H
#define MOTE_TESTS_MOTE_H

#include "core/base/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the last one said: standard output and error. */
extern char said[1 << 20];

/* `mote LINE` through a shell, the line as printf makes it; returns the exit status. A line
   that ends with >/dev/null leaves the errors only. */
int mote(const char *format, ...) MOTE_PRINTF(1, 2);

/* The same, which must end with this status and say this. */
void mote_expect(int status, const char *says, const char *format, ...) MOTE_PRINTF(3, 4);

#endif
