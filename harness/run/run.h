/* A run: a directory of cells with a manifest, measured one process at a time. A run that
   was stopped can be continued. */
#ifndef MOTE_HARNESS_RUN_H
#define MOTE_HARNESS_RUN_H

#include "harness/run/plan.h"

/* Called when all planned replicates are measured, and again after each further one: sets
   `wanted` for each of the plan's cells [count] that needs one more replicate. The run ends
   when none does. */
typedef mote_status (*mote_run_further)(void *context, const mote_cell *cells, size_t count,
                                        bool *wanted);

typedef struct mote_run_options {
    const char *const *scenarios; /* names or paths */
    size_t scenario_count;
    const mote_choices *choices;       /* for scenarios of two bodies */
    const mote_choices *scene_choices; /* for those of more; NULL: the same */
    mote_plan_options plan;            /* program is filled in by the run */
    const char *directory;
    double timeout;  /* seconds a cell; 0: none */
    double progress; /* where stderr is no terminal: seconds between two lines of it; 0:
                        a line a cell */
    bool dry_run;    /* print the plan, measure and write nothing */
    bool force;      /* measure cells again that are stored already */
    mote_run_further further; /* or NULL: no more replicates than planned */
    void *context;            /* that it is called with */
    double budget;            /* seconds for further replicates */
    int argc;                 /* the command line, for the manifest */
    char **argv;
} mote_run_options;

typedef struct mote_run_outcome {
    size_t cells;        /* in the plan */
    size_t failed;       /* of these, crashed or out of time, now or earlier */
    uint32_t replicates; /* measured, further ones included */
    bool started;        /* the error is one of the disk or a signal, not of the input */
} mote_run_outcome;

/* Loads the scenarios, prints the plan to stderr and measures what is not yet there.
   MOTE_EINVAL for a bad scenario, range or a parameter that a method refuses, before anything
   is written; MOTE_EIO for a directory that cannot be written or is in use by another run, a
   full disk, SIGINT or SIGTERM: finished cells stay whole. *outcome is written also then. */
mote_status mote_run(const mote_run_options *options, mote_run_outcome *outcome);

#endif
