/* The process of a cell: forked from a parent that holds the scenario, pinned, limited, timed
 * out. */
#ifndef MOTE_HARNESS_CELL_PROCESS_H
#define MOTE_HARNESS_CELL_PROCESS_H

#include "harness/cell.h"

#include <signal.h>

/* What a probe found: a few frames, nothing stored. */
typedef struct mote_forecast {
    double build_seconds;
    double frame_seconds; /* the median of its frames, all told */
} mote_forecast;

/* How to run cells. Zero-initialise; core -1: not pinned. */
typedef struct mote_process_options {
    const char *directory; /* the run's */
    uint64_t program;      /* mote_program_hash */
    double timeout;        /* seconds; 0: none */
    int core;
    const volatile sig_atomic_t *stop; /* set by a signal: end the cell and return MOTE_EIO */
} mote_process_options;

/* Measures one cell in a child and waits for it. *status says how it ended; its files are
   written by the child when it ran to its end, by the parent otherwise, and reason (size bytes,
   may be empty) tells why. An error status means that nothing more can be measured: no process,
   a full disk, a signal. */
mote_status mote_cell_measure(const mote_cell *cell, const mote_process_options *options,
                              mote_cell_status *status, char *reason, size_t size);

/* Runs the first frames of a cell in a child and says what they cost. *status as above, nothing
   is stored. MOTE_EINVAL with the method's text when it refuses its input (n above the vertex
   count). */
mote_status mote_cell_probe(const mote_cell *cell, const mote_process_options *options,
                            mote_cell_status *status, mote_forecast *forecast);

/* A core to pin to: the last of those allowed; -1 when unknown. */
int mote_process_core(void);

#endif
