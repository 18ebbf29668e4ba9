/* The required smallest ratios to the best engine of others. */
#include "harness/study/claims.h"

#include "harness/base/memory.h"
#include "harness/study/claims_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The run asks certified in the frames in which it asks the engines, and in no others. */
static mote_status find_certified(const mote_summary *summary, const char *scenario,
                                  const mote_summary_row **found)
{
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (row->status == MOTE_CELL_OK && strcmp(row->method, "certified") == 0 &&
            strcmp(row->scenario, scenario) == 0) {
            *found = row;
            return MOTE_OK;
        }
    }
    return mote_fail(MOTE_ENUMERIC, "no result of certified on %s", scenario);
}

/* A value of the times of frames, each the median over replicates, so that interruptions by
   other programs do not count. */
static double quiet_value(const mote_summary_row *row, mote_cell_value value)
{
    mote_stored_cell quiet = *row->first;
    double *times = mote_allocate(quiet.frames, sizeof *times);
    for (size_t k = 0; k < quiet.frames; ++k) {
        double at[MOTE_STUDY_SEEDS] = {0};
        size_t count = 0;
        for (size_t r = 0; r < row->replicates && count < MOTE_STUDY_SEEDS; ++r) {
            const mote_stored_cell *cell = &row->cells[r];
            if (cell->status == MOTE_CELL_OK && k < cell->frames &&
                cell->frame[k] == quiet.frame[k])
                at[count++] = cell->total_ns[k];
        }
        times[k] = mote_statistics_median(at, count);
    }
    quiet.total_ns = times;
    const double found = value(&quiet);
    free(times);
    return found;
}

/* A statistic of the times of frames. */
typedef struct statistic {
    const char *name;
    mote_cell_value value;
    bool quiet; /* compared by quiet_value; otherwise replicate by replicate */
} statistic;

static const statistic median = {"median", mote_cell_median, false};

/* How many times as long a row takes as ours. */
static mote_estimate ratio_of(const mote_summary_row *row, const mote_summary_row *ours,
                              const statistic *by)
{
    if (!by->quiet)
        return mote_row_ratio(row, ours, by->value);
    return mote_estimate_alone(quiet_value(row, by->value) / quiet_value(ours, by->value));
}

/* The row that competes with ours on the same frames with the least ratio, which is set; NULL
   without any. */
static const mote_summary_row *least_of(const mote_summary *summary,
                                        const mote_summary_row *ours, const statistic *by,
                                        bool (*competes)(const mote_summary_row *),
                                        mote_estimate *least_ratio)
{
    const mote_summary_row *least = NULL;
    *least_ratio = mote_estimate_alone(HUGE_VAL);
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (row->status != MOTE_CELL_OK || !mote_summary_same_block(row, ours) ||
            mote_summary_by_frames(row, ours) != 0 || !mote_summary_is_right_engine(row) ||
            (competes && !competes(row)))
            continue;
        const mote_estimate found = ratio_of(row, ours, by);
        if (found.value < least_ratio->value) {
            *least_ratio = found;
            least = row;
        }
    }
    return least;
}

static const char measured[] =
    "an engine's time / certified's, deformation and refit included, 200 frames near contact, "
    "of "
    "the engine with the least ratio; median: of the medians of processes, geometric mean over "
    "processes; others: each frame by its median over processes";

/* By how much engines have to be slower on a scenario, by the median and by the mean. */
typedef struct rivalry {
    const char *scenario;
    double median, mean; /* MOTE_NONE: reported only */
} rivalry;

static mote_status add_engines(const mote_summary *summary, const rivalry *r, mote_claim *claim)
{
    const struct {
        statistic by;
        double least;
    } statistics[] = {{median, r->median},
                      {{"mean", mote_cell_mean, true}, r->mean},
                      {{"95th percentile", mote_cell_p95, true}, MOTE_NONE},
                      {{"worst frame", mote_cell_worst, true}, MOTE_NONE}};
    const mote_summary_row *ours = NULL;
    mote_estimate ratio;
    mote_status status = find_certified(summary, r->scenario, &ours);
    for (size_t k = 0; k < 4 && status == MOTE_OK; ++k) {
        const mote_summary_row *best = least_of(summary, ours, &statistics[k].by, NULL, &ratio);
        if (!best)
            return mote_fail(MOTE_ENUMERIC, "no result of an engine of others on %s",
                             r->scenario);
        mote_claim_add(claim, ratio, "x", "%s, %s: %s", r->scenario, statistics[k].by.name,
                       best->label);
        if (statistics[k].least == statistics[k].least)
            mote_claim_require(claim, MOTE_AT_LEAST, statistics[k].least, statistics[k].least);
    }
    if (status != MOTE_OK)
        return status;
    const mote_summary_row *fcl = least_of(summary, ours, &median, mote_summary_is_fcl, &ratio);
    if (fcl)
        mote_claim_add(claim, ratio, "x", "%s, median: best FCL, %s", r->scenario, fcl->label);
    return MOTE_OK;
}

static mote_status add_all(mote_study *study, const rivalry *all, size_t count,
                           mote_claim *claim)
{
    const mote_summary *summary;
    mote_status status = mote_claims_run(study, &summary);
    for (size_t i = 0; i < count && status == MOTE_OK; ++i)
        status = add_engines(summary, &all[i], claim);
    return status;
}

mote_status mote_claim_best_engine_distance(mote_study *study, mote_claim *claim)
{
    claim->id = "r6";
    claim->section = "5";
    claim->claim = "asked for distances, certified is faster than every engine of others: on "
                   "W-W 40 times, on M-V 6 times, on rigid T-T 4 times, by median and mean";
    claim->measured = measured;
    static const rivalry all[] = {{"ww", 40, 40}, {"mv", 6, 6}, {"tt-distance", 4, 4}};
    return add_all(study, all, 3, claim);
}

mote_status mote_claim_best_engine_contact(mote_study *study, mote_claim *claim)
{
    claim->id = "r7";
    claim->section = "5";
    claim->claim =
        "asked for contacts, certified is faster than every engine of others: on W-W "
        "40 times, on M-V 6 times, by median and mean; on rigid T-T by the mean";
    claim->measured = measured;
    static const rivalry all[] = {
        {"ww-contact", 40, 40}, {"mv-contact", 6, 6}, {"tt", MOTE_NONE, 1}};
    return add_all(study, all, 3, claim);
}
