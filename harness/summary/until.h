/* A run that adds replicates until its times are as certain as asked for. */
#ifndef MOTE_HARNESS_UNTIL_H
#define MOTE_HARNESS_UNTIL_H

#include "harness/run/run.h"

/* mote_run, then further replicates until the interval of every row's median total time lies
   within `share` of it to both sides, or options->budget is spent; rows that ratios are taken
   to get a replicate whenever another one does. Says on stderr how wide the widest is in the
   end. options->further and context are not used. */
mote_status mote_run_until(const mote_run_options *options, double share,
                           mote_run_outcome *outcome);

#endif
