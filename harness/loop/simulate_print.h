/* The figures of a simulation: as JSON, read back from it, as lines for people, and those of
   several replicates as one. */
#ifndef MOTE_HARNESS_SIMULATE_PRINT_H
#define MOTE_HARNESS_SIMULATE_PRINT_H

#include "harness/loop/simulation.h"

#include <jansson.h>
#include <stdio.h>

/* {"scenario", "method", "bodies", "steps", ...}; scenario is the name that it is shown by.
   NULL where that is not UTF-8. The caller decrefs. */
json_t *mote_simulation_json(const char *scenario, uint32_t bodies,
                             const mote_method_choice *choice,
                             const mote_simulation_result *result);

/* Reads the figures of such an object; false where one is missing or cannot be right. */
bool mote_simulation_read(const json_t *object, mote_simulation_result *result);

/* Adds a replicate's figures to those of others (zeroed before the first): counts are summed,
   the largest of depths, drifts and delays is kept, and means are weighted by steps. */
void mote_simulation_add(mote_simulation_result *sum, const mote_simulation_result *replicate);

/* Prints an object with 17 digits, which is decrefed; MOTE_EINVAL where it is NULL. */
mote_status mote_simulation_put(json_t *object, FILE *out);

/* As lines for people. */
void mote_simulation_print(const char *scenario, uint32_t bodies,
                           const mote_method_choice *choice,
                           const mote_simulation_result *result, FILE *out);

#endif
