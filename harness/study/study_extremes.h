/* Every method on every numerical extreme: errors, verdicts, times. */
#ifndef MOTE_HARNESS_STUDY_EXTREMES_H
#define MOTE_HARNESS_STUDY_EXTREMES_H

#include "core/base/status.h"

#include <stdbool.h>

/* Runs all families (quick: some of each) and prints a line per scene. Writes
   DIRECTORY/extremes.json, extremes.csv, extremes.md (every answer that was not right, with its
   size) and figures/extremes.dat, .svg and .png. *met: no method crashed, hung or gave a NaN,
   and none of ours was wrong. About 15 minutes, quick 1. */
mote_status mote_study_extremes(const char *directory, bool quick, bool *met);

#endif
