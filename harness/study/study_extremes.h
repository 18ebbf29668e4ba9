/* Every method on every numerical extreme: errors, verdicts, times. */
#ifndef MOTE_HARNESS_STUDY_EXTREMES_H
#define MOTE_HARNESS_STUDY_EXTREMES_H

#include "core/base/status.h"

#include <stdbool.h>

typedef struct mote_extremes_wish {
    bool quick;         /* some of each family */
    const char *method; /* the name of a known method; NULL: every method */
    const char *family; /* the name of a family; NULL: every family */
} mote_extremes_wish;

/* Runs the families and prints a line per scene. Writes DIRECTORY/extremes.json, extremes.csv,
   extremes.md (every answer that was not right, with its size) and figures/extremes.dat, .svg
   and .png. *met: no method crashed, hung or gave a NaN, and none of ours was wrong. All takes
   about 15 minutes, quick 1. */
mote_status mote_study_extremes(const char *directory, const mote_extremes_wish *wish,
                                bool *met);

#endif
