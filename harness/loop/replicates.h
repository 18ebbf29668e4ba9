/* Simulations of several methods, several times over: each in a process of its own, kept in
   DIRECTORY/simulations/ID.json as soon as it has ended, and not simulated again when it is
   there. Replicates differ by the method's seed and in time. */
#ifndef MOTE_HARNESS_REPLICATES_H
#define MOTE_HARNESS_REPLICATES_H

#include "harness/base/statistics.h"
#include "harness/loop/simulation.h"
#include "harness/run/plan.h"

typedef struct mote_replicates {
    const mote_subject *subject; /* with its fingerprint */
    const char *scenario;        /* the name that it is shown by */
    const mote_choices *choices;
    mote_simulation_options options;
    uint32_t steps;      /* 0: all frames of the scenario */
    uint64_t seed;       /* replicate k, from 1, has seed + k - 1 */
    uint32_t replicates; /* 1 .. MOTE_REPLICATES_MAX */
    uint32_t jobs;       /* at a time, 1 .. MOTE_CHILDREN_MAX */
    uint64_t program;    /* mote_program_hash */
    const char *directory;
} mote_replicates;

/* What the replicates of a method gave. */
typedef struct mote_replicates_row {
    uint32_t done, failed;      /* replicates; the others are unsupported */
    char *unsupported;          /* why, or NULL */
    mote_simulation_result sum; /* see mote_simulation_add */
    double query_ns;            /* median over replicates of the mean time a step */
    mote_confidence interval;   /* of it */
} mote_replicates_row;

/* Simulates what is missing and sets rows [choices->count]. What is wrong with the input, as
   bodies that start in contact, ends everything with MOTE_EINVAL; a crash, or a method that
   cannot answer, is kept as what a replicate gave. MOTE_EIO also when a signal asked to stop.
 */
mote_status mote_replicates_run(const mote_replicates *plan, mote_replicates_row **rows);
void mote_replicates_free(mote_replicates_row *rows, size_t count); /* NULL is allowed */

/* DIRECTORY/simulations.json: {"schema": 1, "scenario", "fingerprint", "bodies", "rows":
   [...]}, a row with the keys of `mote simulate --json` and "replicates", "replicates_failed",
   "query_ns_low", "query_ns_high"; one without a result has no figures, and "unsupported" where
   the method cannot answer. The caller decrefs. */
json_t *mote_replicates_json(const mote_replicates *plan, const mote_replicates_row *rows);

#endif
