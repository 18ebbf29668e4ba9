/* Selects the rows of a summary to show first: those that no other row dominates, and one for
   each method. */
#ifndef MOTE_HARNESS_DOMINANCE_H
#define MOTE_HARNESS_DOMINANCE_H

#include "harness/summary/summary_row.h"

/* Whether a dominates b. Both are measured (mote_summary_row_measured) on the same frames of
   one scene, with the same accounting of deformation; a is certainly faster: its interval lies
   below b's, so there are at least two replicates; and a is no worse in the 99th percentile of
   the error, the largest error, and the shares of exact frames, and of frames with missed
   and with false contacts. Errors up to MOTE_EXACT_ERROR are equal. */
bool mote_dominates(const mote_summary_row *a, const mote_summary_row *b);

/* Sets dominated_by of each row to the fastest row that dominates it, and sets on_front. Part
   of mote_summary_make. Cost O(count^2). */
void mote_find_dominated(mote_summary_row *rows, size_t count);

/* Sets stands_for_method of each row. Of a method's rows in one block and accounting, it is the
   fastest without a wrong contact and with an error of at most MOTE_CLOSE_ERROR at the 99th
   percentile, if distances were asked; if no row is that good, the one with the smallest
   share of wrong contacts, then the smallest error. Part of mote_summary_make. Cost O(count^2).
 */
#define MOTE_CLOSE_ERROR 0.01
void mote_find_method_rows(mote_summary_row *rows, size_t count);

#endif
