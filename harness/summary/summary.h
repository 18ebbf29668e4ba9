/* The summary of a run: one row a configuration, from its cells alone. */
#ifndef MOTE_HARNESS_SUMMARY_H
#define MOTE_HARNESS_SUMMARY_H

#include "harness/summary/summary_row.h"

/* Clock and bookkeeping in a timed call, medians over the cells; MOTE_NONE when not stored. */
typedef struct mote_overhead {
    double clock_ns; /* subtracted from every time */
    double left_ns;  /* what is left then */
    double share;    /* of that, at most, in the fastest median total; a frame has up to three
                        timed calls, with time 0 where there is none */
} mote_overhead;

typedef struct mote_summary {
    mote_stored stored;     /* none where the rows were read from a summary.json */
    json_t *document;       /* that file, in which the rows' texts are; else NULL */
    mote_summary_row *rows; /* by scene (mote_summary_by_scene), frames, method, n */
    size_t count;
    double noise_floor; /* mote_summary_noise_floor in summary_quiet.h */
    mote_overhead overhead;
    double smallest_change; /* of rows, not exceeded by nine in ten; MOTE_NONE without any */
} mote_summary;

/* Reads a run directory and computes its rows. The caller frees *summary. */
mote_status mote_summary_make(const char *directory, mote_summary *summary);
/* The same of what is whole: a cell that cannot be read is left out, and a line of damaged. */
mote_status mote_summary_make_whole(const char *directory, mote_text *damaged,
                                    mote_summary *summary);
void mote_summary_free(mote_summary *summary);

/* Whether rows were measured on more than one machine. Those of different machines are never
   put into one row nor compared. */
bool mote_summary_machines_differ(const mote_summary *summary);

#endif
