/* What explains the verdict of a row: answers, counts, instructions. */
#ifndef MOTE_HARNESS_RACE_EXPLAIN_H
#define MOTE_HARNESS_RACE_EXPLAIN_H

#include "harness/race/race.h"

/* Has both programs count the instructions of the rows that are faster or slower, over their
   first frames, by `mote instructions` (callgrind: seconds a row). Rows where that fails stay
   without them; nothing is left behind. */
void mote_race_count_instructions(const mote_race_options *options, mote_race *race);

/* Sets `what` of every row, from what is known of it. */
void mote_race_explain(mote_race *race);

#endif
