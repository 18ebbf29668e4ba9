/* What a simulator holds. Its fields are for harness/loop only; others go by simulator.h. */
#ifndef MOTE_HARNESS_SIMULATOR_STATE_H
#define MOTE_HARNESS_SIMULATOR_STATE_H

#include "core/body/deform.h"
#include "harness/loop/penetration.h"
#include "harness/loop/stage.h"

/* What is simulated. Each of two bodies has its own shape; many share some. Borrowed from the
   simulator. */
typedef struct mote_simulated {
    const char *name, *path; /* of the scenario */
    double length;           /* L */
    uint32_t count, shape_count;
    const mote_body *const *shapes;
    const uint32_t *shape_of; /* [count] */
} mote_simulated;

typedef struct mote_simulator {
    mote_simulated bodies;
    const mote_body **shapes;
    uint32_t *shape_of;
    mote_method_choice choice;
    mote_simulation_options options;
    mote_vec3 gravity, room; /* absolute; room: half the edges of the box of middles */
    uint32_t frames;
    mote_mass *masses;               /* per shape */
    mote_rigid_state *start;         /* per body, from the scenario */
    mote_deform **deform;            /* per shape, made when depth is first measured */
    mote_penetration **penetrations; /* [shapes][shapes], made at the same time */
    mote_vec3 *world[2];             /* vertices, room for those of any shape */
    mote_stage *stage;
    struct mote_between *between; /* NULL: steps are whole */
} mote_simulator;

#endif
