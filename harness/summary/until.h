/* A run that adds replicates until its times are as precise as requested. */
#ifndef MOTE_HARNESS_UNTIL_H
#define MOTE_HARNESS_UNTIL_H

#include "harness/run/run.h"

/* mote_run, then further replicates until the interval of every row's median total time lies
   within `share` of the median on both sides, or options->budget is spent; rows that ratios are
   relative to get a replicate whenever another row does. Finally reports the widest interval on
   stderr. options->further and context are not used. */
mote_status mote_run_until(const mote_run_options *options, double share,
                           mote_run_outcome *outcome);

#endif
