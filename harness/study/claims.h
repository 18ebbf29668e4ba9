/* The experiments on the paper's claims a to m, on the closed loop, and on the requirements for
   this implementation. Each measures the values of one claim; text and thresholds are in the
   experiment's file. */
#ifndef MOTE_HARNESS_CLAIMS_H
#define MOTE_HARNESS_CLAIMS_H

#include "harness/study/study.h"

#define MOTE_CLAIMS(X)                                                                         \
    X(contact_point)    /* a */                                                                \
    X(passing_through)  /* b */                                                                \
    X(convex_parts)     /* c */                                                                \
    X(longest_route)    /* d */                                                                \
    X(almost_at_rest)   /* e */                                                                \
    X(initial_places)   /* f */                                                                \
    X(complexity)       /* g */                                                                \
    X(distant_cache)    /* h */                                                                \
    X(times)            /* i */                                                                \
    X(few_particles)    /* j */                                                                \
    X(hierarchy_memory) /* k */                                                                \
    X(hierarchy_update) /* l */                                                                \
    X(deformed_parts)   /* m */                                                                \
    X(closed_loop)      /* dynamics */

/* What must hold on any machine, whatever the paper says. */
#define MOTE_REQUIREMENTS(X)                                                                   \
    X(exact_shares)                                                                            \
    X(no_missed_contact)                                                                       \
    X(faster_than_fcl)                                                                         \
    X(no_allocation)                                                                           \
    X(bodies_swapped)                                                                          \
    X(best_engine_distance)                                                                    \
    X(best_engine_contact)

/* mote_claim_NAME: fills claim, which is zero-initialised; the caller frees it, even after a
   failure. */
#define MOTE_CLAIM_DECLARE(name)                                                               \
    mote_status mote_claim_##name(mote_study *study, mote_claim *claim);
MOTE_CLAIMS(MOTE_CLAIM_DECLARE)
MOTE_REQUIREMENTS(MOTE_CLAIM_DECLARE)
#undef MOTE_CLAIM_DECLARE

/* Measures every claim and requirement, prints the results, and writes claims.json and
   requirements.json. *met: all requirements are met. */
mote_status mote_claims_measure(mote_study *study, bool *met);

#endif
