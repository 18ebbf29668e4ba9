/* The history of accepted references: results/history.csv, a line for each row of each
 * reference. */
#ifndef MOTE_HARNESS_HISTORY_H
#define MOTE_HARNESS_HISTORY_H

#include "core/base/status.h"

/* Adds the rows of the run in directory to the file, which is made if missing: date, commit,
   why, row, time, ratio, counts, bytes, error. why may not be empty. */
mote_status mote_history_add(const char *file, const char *directory, const char *why);

/* Draws the file's series, one a row, their times relative to the first, change points marked,
   to results/history.svg and .png beside it. A change point: more than 5 %, and more than three
   times what the series usually moves from one reference to the next. MOTE_EINVAL with the line
   when the file is not one that mote wrote. */
mote_status mote_history_draw(const char *file);

#endif
