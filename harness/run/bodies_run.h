/* A run of scenarios of several bodies: every method over each, one process at a time. */
#ifndef MOTE_HARNESS_BODIES_RUN_H
#define MOTE_HARNESS_BODIES_RUN_H

#include "harness/run/bodies_row.h"

typedef struct mote_bodies_run_options {
    const char *const *scenarios;
    size_t scenario_count;
    const char *const *methods; /* as mote_bodies_choice_read takes them; none: all forms */
    size_t method_count;
    mote_bodies_options measure; /* directory and replicate are filled in by the run */
    uint32_t replicates;
    const char *directory;
    bool dry_run; /* print what would be measured */
    int argc;     /* the command line, for the manifest */
    char **argv;
} mote_bodies_run_options;

/* Measures, prints a line a cell to stderr and the table to stdout, writes
   directory/bodies.json and the records. The contacts of the first of these that was measured
   count as true: fcl-aabb with every body refitted, fcl-aabb, aabb-tree, certified. *failed:
   cells that crashed or were out of time. Errors as mote_run's. */
mote_status mote_bodies_run(const mote_bodies_run_options *options, size_t *failed);

/* One scenario by every choice: rows[choice_count * replicates] in the order of measuring, with
   references. For the study. */
mote_status mote_bodies_run_scenario(const mote_bodies *bodies,
                                     const mote_bodies_choice *choices, size_t choice_count,
                                     uint32_t replicates, const mote_bodies_options *options,
                                     mote_bodies_row *rows);

#endif
