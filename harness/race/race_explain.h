/* Explains the verdict of a row by answers, counts and instructions. */
#ifndef MOTE_HARNESS_RACE_EXPLAIN_H
#define MOTE_HARNESS_RACE_EXPLAIN_H

#include "harness/race/race.h"

/* Makes both programs count the instructions of the rows that are faster or slower, over their
   first frames, with `mote instructions` (callgrind: seconds per row). Rows for which that
   fails get none, and say why; temporary files are removed. */
void mote_race_count_instructions(const mote_race_options *options, mote_race *race);

/* Sets `what` of every row from its results. */
void mote_race_explain(mote_race *race);

#endif
