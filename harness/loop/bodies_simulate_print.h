/* What `mote simulate` tells of several bodies. */
#ifndef MOTE_HARNESS_BODIES_SIMULATE_PRINT_H
#define MOTE_HARNESS_BODIES_SIMULATE_PRINT_H

#include "harness/loop/bodies_simulate.h"

/* As JSON, with the keys of two bodies' and "bodies", "near_pairs", "bounces". MOTE_ENOMEM. */
mote_status mote_bodies_simulation_json(const mote_bodies *bodies,
                                        const mote_method_choice *choice,
                                        const mote_bodies_simulation *result);

/* As lines for people. */
void mote_bodies_simulation_print(const mote_bodies *bodies, const mote_method_choice *choice,
                                  const mote_bodies_simulation *result);

#endif
