/* Repeated simulations of several methods, each in its own process, stored in
   DIRECTORY/simulations/ID.json as soon as it ends, and not repeated if that file exists.
   Replicates differ by the method's seed and in time. */
#ifndef MOTE_HARNESS_REPLICATES_H
#define MOTE_HARNESS_REPLICATES_H

#include "harness/base/statistics.h"
#include "harness/loop/simulation.h"
#include "harness/run/plan.h"

typedef struct mote_replicates {
    const mote_subject *subject; /* with its fingerprint */
    const char *scenario;        /* its displayed name */
    const mote_choices *choices;
    mote_simulation_options options;
    uint32_t steps;      /* 0: all frames of the scenario */
    uint64_t seed;       /* replicate k, from 1, has seed + k - 1 */
    uint32_t replicates; /* 1 .. MOTE_REPLICATES_MAX */
    uint32_t jobs;       /* at a time, 1 .. MOTE_CHILDREN_MAX */
    uint64_t program;    /* mote_program_hash */
    const char *directory;
} mote_replicates;

/* The combined results of a method's replicates. */
typedef struct mote_replicates_row {
    uint32_t done, failed;      /* replicates; the rest are unsupported */
    char *unsupported;          /* why, or NULL */
    mote_simulation_result sum; /* see mote_simulation_add */
    double query_ns;            /* median over replicates of the mean time per step */
    mote_confidence interval;   /* of it */
} mote_replicates_row;

/* Runs the missing simulations and sets rows [choices->count]. Invalid input, such as bodies
   that start in contact, ends everything with MOTE_EINVAL; a crash, or a method that cannot
   answer, is stored as that replicate's result. MOTE_EIO also if a signal asked to stop. */
mote_status mote_replicates_run(const mote_replicates *plan, mote_replicates_row **rows);
void mote_replicates_free(mote_replicates_row *rows, size_t count); /* NULL is allowed */

/* DIRECTORY/simulations.json: {"schema": 1, "scenario", "fingerprint", "bodies", "rows":
   [...]}, a row has the keys of `mote simulate --json` and "replicates", "replicates_failed",
   "query_ns_low", "query_ns_high"; without a result it has no figures, and "unsupported" if the
   method cannot answer. The caller decrefs. */
json_t *mote_replicates_json(const mote_replicates *plan, const mote_replicates_row *rows);

#endif
