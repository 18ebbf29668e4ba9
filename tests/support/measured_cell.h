/* One cell measured in a process of its own, from start to end. */
#ifndef MOTE_TESTS_MEASURED_CELL_H
#define MOTE_TESTS_MEASURED_CELL_H

#include "harness/run/cell_process.h"

static inline mote_status measure_cell(const mote_cell *cell,
                                       const mote_process_options *options, mote_cell_end *end)
{
    mote_child child;
    size_t index;
    mote_status status = mote_cell_start(cell, options, &child);
    if (status == MOTE_OK)
        status = mote_child_wait(&child, 1, &index);
    return status == MOTE_OK ? mote_cell_finish(cell, options, &child, end) : status;
}

#endif
