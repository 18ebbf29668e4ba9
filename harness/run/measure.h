/* Measures one cell in this process: frame by frame, with deform, update and query timed
   separately. */
#ifndef MOTE_HARNESS_MEASURE_H
#define MOTE_HARNESS_MEASURE_H

#include "harness/run/cell.h"
#include "harness/run/cell_pairs.h"
#include "harness/base/clock.h"

/* Builds the method and runs it over the cell's frames, at most frame_limit of them (0: all). A
   failure of the method is returned with its text and the frame. Nothing is allocated between
   frames of two bodies. Free the result with mote_cell_result_free; core, load and wall_seconds
   are left 0. */
mote_status mote_measure_cell(const mote_cell *cell, size_t frame_limit,
                              mote_cell_result *result);

/* The same; pairs (unless NULL) receives the near pairs of more than two bodies as they are
   found. */
mote_status mote_measure_cell_and_pairs(const mote_cell *cell, size_t frame_limit,
                                        const mote_cell_pairs *pairs, mote_cell_result *result);

void mote_cell_result_free(mote_cell_result *result);

/* A method built on a scenario and measured one frame at a time, in any order, by the same
   timed calls as a cell. */
typedef struct mote_measurement mote_measurement;

/* Builds the method of a cell; the cell is borrowed until close. MOTE_EINVAL and
   MOTE_EUNSUPPORTED with the method's text. */
mote_status mote_measurement_open(const mote_cell *cell, mote_measurement **measurement);

/* Runs a frame; `previous` (0: none) is the one run before it. Sets row. */
mote_status mote_measurement_frame(mote_measurement *measurement, uint32_t number,
                                   uint32_t previous, mote_cell_row *row);

/* The near pairs of the frame run last, ascending, with their answers; valid until the next. */
const mote_near_pair *mote_measurement_pairs(const mote_measurement *measurement,
                                             size_t *count);

void mote_measurement_close(mote_measurement *measurement); /* NULL is allowed */

#endif
