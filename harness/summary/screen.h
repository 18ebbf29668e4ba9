/* A summary on one screen per scenario: the first thing to read on a terminal. */
#ifndef MOTE_HARNESS_SCREEN_H
#define MOTE_HARNESS_SCREEN_H

#include "harness/summary/summary.h"

#include <stdio.h>

/* No line is longer, unless a name is. */
#define MOTE_SCREEN_WIDTH 100

/* The largest number of rows shown per block and accounting. */
#define MOTE_SCREEN_ROWS 20

/* For each block and accounting, the best rows: those that stand for their method and those on
   the front of time against error, which are marked; sorted by time. If there are more than
   MOTE_SCREEN_ROWS, the least accurate ones that stand for no method are omitted. Below a
   block: the meaning of marks and ratios, the rows that failed, the number of omitted rows.
   Columns are those of MOTE_VIEW_SCREEN. */
void mote_screen_print(const mote_summary *summary, FILE *out);

/* For each block and accounting, every row with the mean, the 95th percentile and the worst
   frame beside the median, sorted by the median, and below it which engine of others without a
   wrong answer, and which of FCL's, is best by each of these four. Rows of these best engines
   by the median are marked. Columns are those of MOTE_VIEW_ENGINES. */
void mote_screen_engines(const mote_summary *summary, FILE *out);

#endif
