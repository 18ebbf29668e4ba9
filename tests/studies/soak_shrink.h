/* Makes a failing scenario small. */
#ifndef MOTE_TESTS_SOAK_SHRINK_H
#define MOTE_TESTS_SOAK_SHRINK_H

#include "tests/studies/soak_judge.h"

#include <jansson.h>

/* Removes what the failure does not need (frames, fields, motions, triangles, factors) and
   leaves the smallest scenario that still fails in *scenario, and its file at path. plant: as
   in soak_judge; its frame follows the cuts. Judges the scenario some tens of times. */
mote_status soak_shrink(json_t *scenario, const char *path, soak_plant *plant,
                        soak_verdict *verdict);

#endif
