/* The figures of a simulation: as JSON, read back from it, as lines for people, and combined
   over several replicates. */
#ifndef MOTE_HARNESS_SIMULATE_PRINT_H
#define MOTE_HARNESS_SIMULATE_PRINT_H

#include "harness/loop/simulation.h"

#include <jansson.h>
#include <stdio.h>

/* {"scenario", "method", "bodies", "steps", ...}; scenario and method are the displayed names.
   NULL if one is not UTF-8. The caller decrefs. */
json_t *mote_simulation_json(const char *scenario, uint32_t bodies, const char *method,
                             const mote_simulation_result *result);

/* Reads the figures of such an object; false if one is missing or invalid. */
bool mote_simulation_read(const json_t *object, mote_simulation_result *result);

/* Adds a replicate's figures to those of others (zeroed before the first): sums counts, keeps
   the largest depths, drifts and delays, and weights means by steps. */
void mote_simulation_add(mote_simulation_result *sum, const mote_simulation_result *replicate);

/* Prints an object with 17 digits and decrefs it; MOTE_EINVAL if it is NULL. */
mote_status mote_simulation_put(json_t *object, FILE *out);

/* Prints lines for people. */
void mote_simulation_print(const char *scenario, uint32_t bodies, const char *method,
                           const mote_simulation_result *result, FILE *out);

#endif
