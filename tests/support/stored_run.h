/* Each test works in a run's directory of its own and writes the run's files itself. */
#ifndef MOTE_TESTS_STORED_RUN_H
#define MOTE_TESTS_STORED_RUN_H

#include "harness/summary/stored.h"
#include "tests/support/mote.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdint.h>

#include <math.h>

static inline void write_cell(stored_cell cell)
{
    stored_cell_put(".", cell);
}

#define ROWS                                                                                   \
    "1,1,2,3,0.5,0,0,0,7\n2,1,2,3,0.25,1e-3,0,0,7\n3,1,2,3,0,0,1,1,7\n4,1,2,3,0,0,1,1,7\n"

static inline void refused(const char *change, const char *says)
{
    mote_stored stored;
    if (mote_stored_read(".", NULL, &stored) != MOTE_EINVAL || !strstr(mote_error_text(), says))
        fail_msg("%s: not \"%s\" but \"%s\"", change, says, mote_error_text());
}

static inline void about(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fabs(expected)))
        fail_msg("%.17g, not %.17g", value, expected);
}

TEST_EACH(folder_next, NULL);

#endif
