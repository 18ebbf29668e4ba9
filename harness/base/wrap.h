/* Words in lines that are not longer than asked for. */
#ifndef MOTE_HARNESS_WRAP_H
#define MOTE_HARNESS_WRAP_H

#include <stdio.h>

/* Prints words from column `column` on, where the cursor stands, and a line end. Further lines
   begin at column `indent`. A word that is longer than a line is not broken. */
void mote_print_wrapped(const char *words, int column, int indent, int width, FILE *out);

#endif
