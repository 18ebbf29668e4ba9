/* Answers queries of several bodies, step by step: by the certified scene, by the controls,
   or by any method of the contract, pair by pair. */
#ifndef MOTE_HARNESS_BODIES_ENGINE_H
#define MOTE_HARNESS_BODIES_ENGINE_H

#include "harness/scene/bodies.h"
#include "harness/base/method_choice.h"

/* Checks that a choice ("certified:threads=2", "fcl-aabb:refit=every",
   "particle:n=8,threads=2,ahead=3") works with several bodies: MOTE_EUNSUPPORTED for a
   method that does not, for keys that are not for it, and for its own parameters where only
   the defaults are supported. */
mote_status mote_bodies_choice_check(const mote_method_choice *choice);

/* A near pair of a step. */
typedef struct mote_bodies_pair {
    uint32_t body[2]; /* body[0] < body[1] */
    uint32_t steps;   /* number of steps that the pair has been near without a break */
    mote_answer answer;
} mote_bodies_pair;

/* The times of a step, in nanoseconds, and its counts. */
typedef struct mote_bodies_step {
    uint64_t bounds_ns; /* boxes of all bodies from deformed roots */
    uint64_t deform_ns; /* all vertices of the bodies in near pairs, or of all */
    uint64_t update_ns; /* refits */
    uint64_t broad_ns;  /* near pairs by the boxes */
    uint64_t query_ns;  /* answers, and states of pairs that come and go */
    size_t pairs, fresh, contacts;
    mote_counters counters;
    uint64_t allocations;
} mote_bodies_step;

typedef struct mote_bodies_engine mote_bodies_engine;

/* Checks the choice and does what is done once. bodies are borrowed. seed is for methods
   that draw random numbers, the same for every pair. MOTE_EUNSUPPORTED where the method
   cannot answer what is asked. */
mote_status mote_bodies_engine_create(const mote_bodies *bodies,
                                      const mote_method_choice *choice, uint64_t seed,
                                      mote_bodies_engine **engine);
void mote_bodies_engine_destroy(mote_bodies_engine *engine); /* NULL is allowed */

/* Answers for the near pairs of a frame [bodies->count]. */
mote_status mote_bodies_engine_step(mote_bodies_engine *engine, const mote_body_state *states,
                                    mote_bodies_step *step);

/* The pairs of the last step, ascending; valid until the next one. */
const mote_bodies_pair *mote_bodies_engine_pairs(const mote_bodies_engine *engine,
                                                 size_t *count);

#endif
