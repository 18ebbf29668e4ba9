/* Quiet times of rows, and what rows differ by when nothing changed; used by summary.c. */
#ifndef MOTE_HARNESS_SUMMARY_QUIET_H
#define MOTE_HARNESS_SUMMARY_QUIET_H

#include "harness/summary/summary.h"

/* Fills row->quiet; reference may be NULL. */
mote_status mote_summary_quiet(mote_summary_row *row, const mote_summary_row *reference);

#endif
