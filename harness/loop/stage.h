/* What a closed loop of two bodies and one of many do not share: how the scenario deforms
   the bodies, which of them are near, and what answers for those. For two bodies no near
   pairs have to be found, and the truth is not computed while they are far apart. Private to
   harness/loop. */
#ifndef MOTE_HARNESS_STAGE_H
#define MOTE_HARNESS_STAGE_H

#include "harness/loop/simulation.h"

/* Near pairs with answers, in the order of pairs; each answer has a distance, a contact or
   both, and `contact` is set in either case. Valid until the next question. */
typedef struct mote_stage_pairs {
    const mote_near_pair *pairs;
    size_t count;
} mote_stage_pairs;

/* state: what create made. */
typedef struct mote_stage_kind {
    void (*destroy)(void *state); /* NULL is allowed */
    /* Starts a simulation, with the method anew. */
    mote_status (*restart)(void *state, const mote_simulation_start *start);
    /* The bodies of step k, deformed as the scenario says; vertices are NULL. */
    const mote_body_state *(*show)(void *state, uint32_t k, const mote_rigid_state *states);
    /* The method's answers for the bodies shown; its time is added to *ns. */
    mote_status (*ask_method)(void *state, mote_stage_pairs *said, double *ns);
    /* The exact method's; a near pair that is missing is not in contact. *asked is
       incremented where it had to be computed. *lower: a proven lower bound of the smallest
       distance, 0 where there is none. */
    mote_status (*ask_truth)(void *state, mote_stage_pairs *truth, uint64_t *asked,
                             double *lower);
    /* Of a method that has them, after ask_method: the probe of two bodies; else NULL. */
    const mote_engine *(*probe)(const void *state);
} mote_stage_kind;

/* Of two bodies with masses[2]. Everything is borrowed. */
extern const mote_stage_kind mote_stage_pair;
mote_status mote_stage_pair_create(const mote_scenario *scenario,
                                   const mote_method_choice *choice,
                                   const mote_simulation_options *options,
                                   const mote_mass *masses, void **state);

/* Of many, masses of the shapes. MOTE_EINVAL also for a tolerance above `near`. */
extern const mote_stage_kind mote_stage_scene;
mote_status mote_stage_scene_create(const mote_bodies *bodies, const mote_method_choice *choice,
                                    const mote_simulation_options *options,
                                    const mote_mass *masses, void **state);

#endif
