/* The process of a cell: forked from a parent that holds the scenario, pinned, with limits and
   a timeout. */
#ifndef MOTE_HARNESS_CELL_PROCESS_H
#define MOTE_HARNESS_CELL_PROCESS_H

#include "harness/run/cell.h"
#include "harness/process/child.h"

/* The result of a probe, which runs a few frames and stores nothing. */
typedef struct mote_forecast {
    double build_seconds;
    double frame_seconds; /* median over its frames of deform, update and query together */
} mote_forecast;

/* How to run cells. Zero-initialise; core -1: not pinned. */
typedef struct mote_process_options {
    const char *directory; /* the run's */
    uint64_t program;      /* mote_program_hash */
    double timeout;        /* seconds; 0: none */
    int core;
    uint32_t jobs; /* cells that run at once and share memory; 0 means 1 */
} mote_process_options;

/* How a cell ended. */
typedef struct mote_cell_end {
    mote_cell_status status;
    char reason[400]; /* one line; empty when ok */
} mote_cell_end;

/* Starts the process of a cell; it writes the cell's files when it ends. */
mote_status mote_cell_start(const mote_cell *cell, const mote_process_options *options,
                            mote_child *child);

/* Reads what an ended child reported of its cell. If the cell did not complete, writes the
   cell's files here. The child is released. An error status means that nothing more can be
   measured: a full disk. */
mote_status mote_cell_finish(const mote_cell *cell, const mote_process_options *options,
                             mote_child *child, mote_cell_end *end);

/* Runs the first frames of a cell in a child and times them; nothing is stored. All 0 if it
   fails before that. MOTE_EINVAL with the method's text if the method rejects its input (n
   above the vertex count). */
mote_status mote_cell_probe(const mote_cell *cell, const mote_process_options *options,
                            mote_forecast *forecast);

/* A core to pin to: the last one allowed; -1 when unknown. */
int mote_process_core(void);

/* Pins this process to a core; -1 does nothing. */
void mote_process_pin(int core);

#endif
