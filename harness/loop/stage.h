/* What a simulation asks in each step: the method's answers for near bodies, and those of the
   exact method beside it. Private to harness/loop. */
#ifndef MOTE_HARNESS_STAGE_H
#define MOTE_HARNESS_STAGE_H

#include "harness/loop/simulation.h"

/* Near pairs with answers, in pair order; each answer has a distance, a contact or both, and
   `contact` is always set. Valid until the next question. */
typedef struct mote_stage_pairs {
    const mote_near_pair *pairs;
    size_t count;
} mote_stage_pairs;

typedef struct mote_stage mote_stage;

/* MOTE_EUNSUPPORTED, naming the scenario and the body or shape, where only positions are given.
 */
mote_status mote_stage_refuse_given(const mote_subject *subject);

/* Everything is borrowed; masses are per shape. MOTE_EUNSUPPORTED as above. MOTE_EINVAL for a
   tolerance above the distance at which bodies count as near. */
mote_status mote_stage_create(const mote_subject *subject, const mote_method_choice *choice,
                              const mote_simulation_options *options, const mote_mass *masses,
                              mote_stage **stage);
void mote_stage_destroy(mote_stage *stage); /* NULL is allowed */

/* Starts a simulation with a fresh method. */
mote_status mote_stage_restart(mote_stage *stage, const mote_simulation_start *start);

/* The bodies of step k, deformed as the scenario says; vertices are NULL. */
const mote_body_state *mote_stage_show(mote_stage *stage, uint32_t k,
                                       const mote_rigid_state *states);

/* The same for states that the caller keeps until the next question. moved: of two bodies, the
   most by which they can have approached since those shown before; infinite: unknown. */
const mote_body_state *mote_stage_see(mote_stage *stage, const mote_body_state *states,
                                      double moved);

/* Writes the weights of all bodies [count], in their own axes ([3][padded]; the padding is left
   as it is), so many frames after the beginning. Bodies shown before must be shown again. */
void mote_stage_weigh(mote_stage *stage, double frames, double *const *weights);

/* The method's answers for the bodies shown; its time is added to *ns. */
mote_status mote_stage_ask_method(mote_stage *stage, mote_stage_pairs *said, double *ns);

/* The exact method's answers; a near pair that is missing is not in contact. *asked is
   incremented if they had to be computed. *lower: a proven lower bound of the smallest
   distance, or 0. */
mote_status mote_stage_ask_truth(mote_stage *stage, mote_stage_pairs *truth, uint64_t *asked,
                                 double *lower);

/* The method's engine. */
const mote_engine *mote_stage_method(const mote_stage *stage);

#endif
