/* What `mote simulate` tells. */
#ifndef MOTE_HARNESS_SIMULATE_PRINT_H
#define MOTE_HARNESS_SIMULATE_PRINT_H

#include "harness/loop/simulation.h"

#include <stdio.h>

/* As JSON to out: scenario is the name that it is shown by; MOTE_EINVAL where that is not
 * UTF-8. */
mote_status mote_simulation_json(const char *scenario, uint32_t bodies,
                                 const mote_method_choice *choice,
                                 const mote_simulation_result *result, FILE *out);

/* As lines for people. */
void mote_simulation_print(const char *scenario, uint32_t bodies,
                           const mote_method_choice *choice,
                           const mote_simulation_result *result, FILE *out);

#endif
