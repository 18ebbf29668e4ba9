/* Prints words in lines of limited length. */
#ifndef MOTE_HARNESS_WRAP_H
#define MOTE_HARNESS_WRAP_H

#include <stdio.h>

/* Prints words from the cursor's column `column` on, and a line end. Further lines begin at
   column `indent`. A word longer than a line is not broken. */
void mote_print_wrapped(const char *words, int column, int indent, int width, FILE *out);

#endif
