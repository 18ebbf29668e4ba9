/* The run of the claims on times: its cells, each in its own process, and values of its rows.
 */
#ifndef MOTE_HARNESS_CLAIMS_RUN_H
#define MOTE_HARNESS_CLAIMS_RUN_H

#include "harness/study/study.h"

/* Measures what is missing of the run, then reads it; done once a study, which owns *summary.
   MOTE_EIO with study->cell_failed if a cell failed. */
mote_status mote_claims_run(mote_study *study, const mote_summary **summary);

/* A value of a replicate. */
typedef double (*mote_cell_value)(const mote_stored_cell *cell);

/* Of a replicate's total times over all frames, in nanoseconds. */
double mote_cell_median(const mote_stored_cell *cell);
double mote_cell_mean(const mote_stored_cell *cell);
double mote_cell_p95(const mote_stored_cell *cell);
double mote_cell_worst(const mote_stored_cell *cell);

/* Two rows' replicates of one number, which the run measured one after the other. */
typedef struct mote_cell_pair {
    const mote_stored_cell *over, *under;
} mote_cell_pair;

/* The pairs of replicates that ran well in both rows; returns how many. */
size_t mote_row_pairs(const mote_summary_row *over, const mote_summary_row *under,
                      mote_cell_pair pairs[MOTE_STUDY_SEEDS]);

/* The geometric mean of a row's value over the replicates that ran well, and of the ratio of
   two rows' values over their pairs of replicates. */
mote_estimate mote_row_estimate(const mote_summary_row *row, mote_cell_value value);
mote_estimate mote_row_ratio(const mote_summary_row *over, const mote_summary_row *under,
                             mote_cell_value value);

#endif
