/* A run: a directory of cells with a manifest, measured one process at a time, going on where
   it stopped. */
#ifndef MOTE_HARNESS_RUN_H
#define MOTE_HARNESS_RUN_H

#include "harness/run/plan.h"

typedef struct mote_run_options {
    const char *const *scenarios; /* names or paths */
    size_t scenario_count;
    const mote_choices *choices;
    mote_plan_options plan; /* program is filled in by the run */
    const char *directory;
    double timeout;     /* seconds a cell; 0: none */
    bool dry_run;       /* print the plan, measure and write nothing */
    bool force;         /* measure also what is there already */
    double until_share; /* > 0: replicates are added to those planned until every median's
                           interval is within this share of it to both sides */
    double budget;      /* seconds for that */
    int argc;           /* the command line, for the manifest */
    char **argv;
} mote_run_options;

typedef struct mote_run_outcome {
    size_t cells;  /* in the plan */
    size_t failed; /* of these, crashed or out of time, now or earlier */
    bool started;  /* an error is one of the disk or a signal, and not of the input */
} mote_run_outcome;

/* Loads the scenarios, prints the plan to stderr and measures what is not yet there.
   MOTE_EINVAL for a bad scenario, range or a parameter that a method refuses, before anything
   is written; MOTE_EIO for a directory that cannot be written or is in use by another run, a
   full disk, SIGINT or SIGTERM: finished cells stay whole. *outcome is written also then. */
mote_status mote_run(const mote_run_options *options, mote_run_outcome *outcome);

#endif
