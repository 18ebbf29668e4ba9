/* What `mote simulate` tells. */
#ifndef MOTE_HARNESS_SIMULATE_PRINT_H
#define MOTE_HARNESS_SIMULATE_PRINT_H

#include "harness/loop/simulation.h"

/* As JSON on stdout: scenario is the name that it is shown by. */
void mote_simulation_json(const char *scenario, uint32_t bodies,
                          const mote_method_choice *choice,
                          const mote_simulation_result *result);

/* As lines for people. */
void mote_simulation_print(const char *scenario, uint32_t bodies,
                           const mote_method_choice *choice,
                           const mote_simulation_result *result);

#endif
