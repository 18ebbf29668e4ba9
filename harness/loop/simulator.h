/* The bodies of a simulation with their masses, and the methods that answer for them. */
#ifndef MOTE_HARNESS_SIMULATOR_H
#define MOTE_HARNESS_SIMULATOR_H

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

/* Its fields are for harness/loop only. */
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

/* Makes the masses of the scenario's bodies, the method, and the exact method beside it:
   certified, or aabb-tree if certified itself is tested. MOTE_EINVAL for an open mesh, which
   has no volume, and for options out of range; for many bodies also for a tolerance above
   `near`. Everything but the options is borrowed. */
mote_status mote_simulator_create(const mote_subject *subject, const mote_method_choice *choice,
                                  const mote_simulation_options *options,
                                  mote_simulator **simulator);
void mote_simulator_destroy(mote_simulator *simulator); /* NULL is allowed */

mote_simulated mote_simulator_bodies(const mote_simulator *simulator);

/* The masses of the shapes; of two bodies, those of each body. */
const mote_mass *mote_simulator_masses(const mote_simulator *simulator);

/* The scenario's own start: poses of frame 1, its velocities or those that lead from frame 1 to
   frame 2; steps until the last frame, at most MOTE_SIMULATION_STEPS_MAX. Its states live as
   long as the simulator. */
mote_simulation_start mote_simulation_start_of(const mote_simulator *simulator);

#endif
