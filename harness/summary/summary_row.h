/* The figures of one row of a summary; used by summary.c. */
#ifndef MOTE_HARNESS_SUMMARY_ROW_H
#define MOTE_HARNESS_SUMMARY_ROW_H

#include "harness/summary/summary.h"

/* Fills a row from its cells [replicates], all but the ratios. */
mote_status mote_summary_row_make(const mote_stored_cell *cells, size_t replicates,
                                  mote_summary_row *row);

/* Median total over the frames first .. last of all replicates; MOTE_NONE without any. */
mote_status mote_summary_median_within(const mote_summary_row *row, uint32_t first,
                                       uint32_t last, double *median);

/* Which part of a frame's time is compared. */
typedef enum mote_part { MOTE_PART_TOTAL, MOTE_PART_GIVEN } mote_part;

/* Frees what the row holds. */
void mote_summary_row_free(mote_summary_row *row);

/* Fills the ratios of the row's processes to other's, replicate by replicate. */
mote_status mote_summary_process_ratios(mote_summary_row *row, const mote_summary_row *other);

/* The paired ratio of other's time to row's, frame by frame within a replicate; both have
 * status ok. */
mote_status mote_summary_ratio(const mote_summary_row *row, const mote_summary_row *other,
                               mote_part part, mote_ratio *ratio);

#endif
