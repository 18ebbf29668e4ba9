/* The best configuration of each method on each scenario, from the rows of a run. */
#ifndef MOTE_HARNESS_TUNE_H
#define MOTE_HARNESS_TUNE_H

#include "harness/summary/summary.h"

#include <stdio.h>

/* The configurations of one method on the same frames, with the same accounting of
   deformation. */
typedef struct mote_tuned {
    const mote_summary_row *best, *worst; /* by total.median, of those compared */
    size_t configurations;                /* that succeeded */
    bool right; /* those compared are correct: no error above 1e-9 L, no missed or false
                   contact */
} mote_tuned;

/* Groups the rows of a summary, which are sorted by scene, caches and method, and compares
   within each group the correct configurations, or all of them if none is correct. Groups in
   which none succeeded are left out. The caller frees the array; it points into summary. */
mote_tuned *mote_tune_make(const mote_summary *summary, size_t *count);

/* {"schema": 1, "rows": [{"scenario", "fingerprint", "faces", "accounting", "cache", "method",
   "configuration", "parameters", "right", "configurations", "stride", "total_ns", "deform_ns",
   "update_ns", "query_ns" (medians), "worst": {"configuration", "total_ns"}}]} */
json_t *mote_tune_json(const mote_tuned *tuned, size_t count);

/* The configuration that directory/tune.json lists as the fastest correct one of the engines of
   others on a scenario with hot caches, as written after --method; "" if it lists none. fcl:
   of FCL's alone. MOTE_EIO or MOTE_EINVAL if the file cannot be read or has no rows;
   MOTE_EINVAL if the scenario is in none of them. The caller frees *configuration. */
mote_status mote_tune_best(const char *directory, const char *scenario, bool fcl,
                           char **configuration);

/* Ends each scene with the best engine of others and the best FCL. */
void mote_tune_print(const mote_tuned *tuned, size_t count, FILE *out);

#endif
