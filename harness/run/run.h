/* A run: a directory of cells with a manifest, each cell measured in its own process. An
   interrupted run can be continued. */
#ifndef MOTE_HARNESS_RUN_H
#define MOTE_HARNESS_RUN_H

#include "harness/run/plan.h"

/* Called when all planned replicates are measured, and after each further one: sets `wanted`
   for each of the plan's cells [count] that needs one more replicate. The run ends when none
   does. */
typedef mote_status (*mote_run_further)(void *context, const mote_cell *cells, size_t count,
                                        bool *wanted);

typedef struct mote_run_options {
    const char *const *scenarios; /* names or paths */
    size_t scenario_count;
    const mote_choices *choices;       /* for scenarios of two bodies */
    const mote_choices *scene_choices; /* for those of more; NULL: the same */
    mote_plan_options plan;            /* program is set by the run */
    const char *directory;
    double timeout;  /* seconds per cell; 0: none */
    double progress; /* off a terminal, seconds between two progress lines; 0: a line per
                        cell */
    bool dry_run;    /* print the plan; measure and write nothing */
    bool force;      /* measure stored cells again */
    mote_run_further further; /* NULL: no more replicates than planned */
    void *context;            /* for further */
    double budget;            /* seconds for further replicates */
    int argc;                 /* the command line, for the manifest */
    char **argv;
} mote_run_options;

typedef struct mote_run_outcome {
    size_t cells;        /* in the plan */
    size_t failed;       /* crashed or timed out, now or earlier */
    uint32_t replicates; /* measured, including further ones */
    bool started;        /* the error comes from the disk or a signal, not from the input */
} mote_run_outcome;

/* Loads the scenarios, prints the plan to stderr and measures the missing cells. MOTE_EINVAL
   for a bad scenario or range or a parameter that a method rejects, before anything is written;
   MOTE_EIO for a directory that cannot be written or is in use by another run, a full disk,
   SIGINT or SIGTERM: finished cells stay complete. *outcome is written even then. */
mote_status mote_run(const mote_run_options *options, mote_run_outcome *outcome);

#endif
