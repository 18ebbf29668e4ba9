/* Measuring a cell of more than two bodies: the part of harness/run/measure.h that differs
   from a pair's. */
#ifndef MOTE_HARNESS_MEASURE_SCENE_H
#define MOTE_HARNESS_MEASURE_SCENE_H

#include "harness/run/cell_pairs.h"

typedef struct mote_scene_session mote_scene_session;

/* Builds the frames and the engine. Everything is borrowed. */
mote_status mote_scene_session_create(const mote_cell *cell, mote_scene_session **session);
void mote_scene_session_destroy(mote_scene_session *session); /* NULL is allowed */

/* Queries at most `rows` frames, or fewer when the cell's budget is spent, and sets
   result->rows [rows], row_count and frames_wall_ns. between (unless NULL) is called with
   context before each frame, outside of all times. pairs (unless NULL) receives the near
   pairs. */
mote_status mote_scene_session_run(mote_scene_session *session, size_t rows,
                                   void (*between)(void *context), void *context,
                                   const mote_cell_pairs *pairs, mote_cell_result *result);

#endif
