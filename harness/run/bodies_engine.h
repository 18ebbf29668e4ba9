/* What answers for several bodies, step by step: the certified scene, the controls, or any
   method of the contract, pair by pair. */
#ifndef MOTE_HARNESS_BODIES_ENGINE_H
#define MOTE_HARNESS_BODIES_ENGINE_H

#include "harness/scene/bodies.h"
#include "harness/base/method_choice.h"

/* Which bodies a hierarchy is refitted for. */
typedef enum mote_refit {
    MOTE_REFIT_NEAR, /* those in a near pair, by the bounds of deformed roots */
    MOTE_REFIT_EVERY /* every body, each step: near pairs by the roots of the trees */
} mote_refit;

/* How several bodies are asked about: "certified:threads=2", "fcl-aabb:refit=every",
   "particle:n=8,threads=2,ahead=3". */
typedef struct mote_bodies_choice {
    mote_method_choice method;
    mote_refit refit; /* of fcl-aabb and aabb-tree */
    uint32_t threads; /* that pairs are shared out to */
    uint32_t ahead;   /* frames that a thread of its own moves and deforms ahead; 0: none */
    char text[256];   /* as given */
} mote_bodies_choice;

/* Reads a choice; the keys refit, threads and ahead are taken out, the rest is the method's.
   MOTE_EINVAL with what would be right; MOTE_EUNSUPPORTED for a method without a form for
   several bodies, for threads where the library does not allow them, and for keys that it does
   not have here. */
mote_status mote_bodies_choice_read(const char *text, mote_bodies_choice *choice);

/* A near pair of a step. */
typedef struct mote_bodies_pair {
    uint32_t body[2]; /* body[0] < body[1] */
    uint32_t steps;   /* that it has been near for without a break */
    mote_answer answer;
} mote_bodies_pair;

/* What a step cost, in nanoseconds, and what came of it. */
typedef struct mote_bodies_step {
    uint64_t bounds_ns; /* boxes of all bodies from deformed roots */
    uint64_t deform_ns; /* all vertices of the bodies looked at */
    uint64_t update_ns; /* refits */
    uint64_t broad_ns;  /* near pairs by the boxes */
    uint64_t query_ns;  /* answers, and states of pairs that come and go */
    size_t pairs, fresh, contacts;
    mote_counters counters;
    uint64_t allocations;
} mote_bodies_step;

typedef struct mote_bodies_engine mote_bodies_engine;

/* Builds what is built once. bodies are borrowed. MOTE_EUNSUPPORTED where the method cannot
   answer what is asked. */
mote_status mote_bodies_engine_create(const mote_bodies *bodies,
                                      const mote_bodies_choice *choice,
                                      mote_bodies_engine **engine);
void mote_bodies_engine_destroy(mote_bodies_engine *engine); /* NULL is allowed */

/* Answers for the near pairs of a frame [bodies->count]. */
mote_status mote_bodies_engine_step(mote_bodies_engine *engine, const mote_body_state *states,
                                    mote_bodies_step *step);

/* The pairs of the last step, ascending; valid until the next one. */
const mote_bodies_pair *mote_bodies_engine_pairs(const mote_bodies_engine *engine,
                                                 size_t *count);

#endif
