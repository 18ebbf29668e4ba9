/* Quiet times of rows, and what rows differ by when nothing changed. */
#ifndef MOTE_HARNESS_SUMMARY_QUIET_H
#define MOTE_HARNESS_SUMMARY_QUIET_H

#include "harness/summary/summary_row.h"

/* Fills row->quiet; reference may be NULL. */
void mote_summary_quiet(mote_summary_row *row, const mote_summary_row *reference);

/* How much rows differ from themselves when nothing changed, as a share (0.03: 3 %), exceeded
   by one row in ten: the first half of the replicates against the second, quiet times
   where there are enough replicates, else medians. MOTE_NONE when no row has two replicates.
   Part of mote_summary_make. */
double mote_summary_noise_floor(const mote_summary_row *rows, size_t count);

/* Sets smallest_change of each row, from its quiet times where there are enough replicates,
   else its processes; relative to fcl-aabb where the row has a ratio. Returns what nine rows
   in ten do not exceed. Part of mote_summary_make. */
double mote_summary_smallest_change(mote_summary_row *rows, size_t count);

#endif
