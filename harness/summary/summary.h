/* The summary of a run: one row per configuration, from its cells alone. */
#ifndef MOTE_HARNESS_SUMMARY_H
#define MOTE_HARNESS_SUMMARY_H

#include "harness/summary/summary_row.h"

/* The overhead of clock and bookkeeping in a timed call, medians over the cells; MOTE_NONE if
   not stored. */
typedef struct mote_overhead {
    double clock_ns; /* subtracted from every time */
    double left_ns;  /* remaining after that */
    double share;    /* largest share of left_ns in the fastest median total; a frame has up to
                        three timed calls, and none for a part with time 0 */
} mote_overhead;

typedef struct mote_summary {
    mote_stored stored;     /* empty if the rows were read from a summary.json */
    json_t *document;       /* that file, which contains the rows' texts; otherwise NULL */
    mote_summary_row *rows; /* by scene (mote_summary_by_scene), frames, method, n */
    size_t count;
    double noise_floor; /* mote_summary_noise_floor in summary_quiet.h */
    mote_overhead overhead;
    double smallest_change; /* of nine in ten rows, at most; MOTE_NONE without any */
} mote_summary;

/* Reads a run directory and computes its rows. The caller frees *summary. */
mote_status mote_summary_make(const char *directory, mote_summary *summary);
/* The same for complete cells only: a cell that cannot be read is left out and added to damaged
   as a line. */
mote_status mote_summary_make_whole(const char *directory, mote_text *damaged,
                                    mote_summary *summary);
void mote_summary_free(mote_summary *summary);

/* Whether rows were measured on more than one machine. Cells of different machines are never
   combined in a row nor compared. */
bool mote_summary_machines_differ(const mote_summary *summary);

#endif
