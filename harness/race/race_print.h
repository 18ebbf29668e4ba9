/* A race as a table and as JSON (results/schema/race.json). */
#ifndef MOTE_HARNESS_RACE_PRINT_H
#define MOTE_HARNESS_RACE_PRINT_H

#include "harness/race/race.h"

#include <jansson.h>
#include <stdio.h>

void mote_race_print(const mote_race_options *options, const mote_race *race, FILE *out);

/* The caller decrefs; NULL if a name is not UTF-8. labels: names of A and B, or NULL for the
   programs' paths. */
json_t *mote_race_json(const mote_race_options *options, const mote_race *race,
                       const char *const labels[2]);

#endif
