/* Quiet times of rows, and how much rows differ when nothing changed. */
#ifndef MOTE_HARNESS_SUMMARY_QUIET_H
#define MOTE_HARNESS_SUMMARY_QUIET_H

#include "harness/summary/summary_row.h"

/* Fills in row->quiet and row->least; reference may be NULL. */
void mote_summary_quiet(mote_summary_row *row, const mote_summary_row *reference);

/* How much rows differ from themselves when nothing changed, as a share (0.03: 3 %) that one
   row in ten exceeds: the first half of the replicates against the second, by quiet times if
   there are enough replicates, otherwise by medians. MOTE_NONE if no row has two replicates.
   Part of mote_summary_make. */
double mote_summary_noise_floor(const mote_summary_row *rows, size_t count);

/* Sets smallest_change of each row, from its quiet times if there are enough replicates,
   otherwise from its processes; relative to fcl-aabb if the row has a ratio. Returns the value
   that nine rows in ten do not exceed. Part of mote_summary_make. */
double mote_summary_smallest_change(mote_summary_row *rows, size_t count);

#endif
