/* Measuring one cell in this process: frame by frame, deform, update and query timed apart. */
#ifndef MOTE_HARNESS_MEASURE_H
#define MOTE_HARNESS_MEASURE_H

#include "harness/run/cell.h"

/* Monotonic, nanoseconds. */
uint64_t mote_clock_ns(void);

/* What a reading of the clock adds to a time that it ends: the median of many. */
uint64_t mote_clock_cost_ns(void);

/* What is left in a timed call of clock and bookkeeping once mote_clock_cost_ns (clock_ns) has
   been subtracted: measured with a method that does nothing. May be below 0. */
double mote_overhead_ns(uint64_t clock_ns);

/* Builds the method and runs it over the cell's frames, at most frame_limit of them (0: all).
   The method's own failure is returned with its text, the frame named. Nothing is allocated
   between frames. Free the result with mote_cell_result_free; core, load and wall_seconds are
   left 0. */
mote_status mote_measure_cell(const mote_cell *cell, size_t frame_limit,
                              mote_cell_result *result);

void mote_cell_result_free(mote_cell_result *result);

#endif
