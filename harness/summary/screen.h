/* A summary on one screen a scenario: what is read first, on a terminal. */
#ifndef MOTE_HARNESS_SCREEN_H
#define MOTE_HARNESS_SCREEN_H

#include "harness/summary/summary.h"

#include <stdio.h>

/* No line is longer, but for a name that is. */
#define MOTE_SCREEN_WIDTH 100

/* Rows of one block and one accounting that are shown at most. */
#define MOTE_SCREEN_ROWS 20

/* For each block, and in it for each accounting, the best rows: those that stand for their
   method and those on the front of time against error, which are marked; sorted by time. Of
   more than MOTE_SCREEN_ROWS the least accurate that stand for no method are left out. Below a
   block: what the marks and ratios mean, which rows ended badly, how many more there are.
   Columns are those of MOTE_VIEW_SCREEN. */
void mote_screen_print(const mote_summary *summary, FILE *out);

#endif
