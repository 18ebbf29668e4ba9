/* The paper's claims about its own times and about hierarchies, i, k and l, and the required
   smallest ratio to FCL. */
#include "harness/study/claims.h"

#include "harness/base/memory.h"
#include "harness/study/claims_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Finds the row of a method, of the longest and earliest range of frames; MOTE_ENUMERIC if
 * there is none. */
static mote_status find_row(const mote_summary *summary, const char *scenario, mote_cache cache,
                            const char *label, const mote_summary_row **found)
{
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (row->status == MOTE_CELL_OK && row->times_comparable &&
            strcmp(row->scenario, scenario) == 0 &&
            strcmp(row->cache, mote_cache_names[cache]) == 0 &&
            strcmp(row->label, label) == 0) {
            *found = row;
            return MOTE_OK;
        }
    }
    return mote_fail(MOTE_ENUMERIC, "no result of %s on %s", label, scenario);
}

static double active_mean(const mote_stored_cell *cell)
{
    double sum = 0, count = 0;
    for (size_t k = 0; k < cell->frames; ++k) {
        const bool in =
            cell->frame[k] >= cell->active_first && cell->frame[k] <= cell->active_last;
        sum += in ? cell->total_ns[k] : 0;
        count += in ? 1 : 0;
    }
    return sum / count * 1e-6;
}

static double update_share(const mote_stored_cell *cell)
{
    double update = 0, total = 0;
    for (size_t k = 0; k < cell->frames; ++k) {
        update += cell->deform_ns[k] + cell->update_ns[k];
        total += cell->total_ns[k];
    }
    return update / total;
}

static double refit_share(const mote_stored_cell *cell)
{
    double update = 0, total = 0;
    for (size_t k = 0; k < cell->frames; ++k) {
        update += cell->update_ns[k];
        total += cell->update_ns[k] + cell->query_ns[k];
    }
    return update / total;
}

/* Heap held by the method, without tables and vertices of full deformation. */
static double own_bytes(const mote_stored_cell *cell)
{
    return mote_stored_number(cell, "heap_live_bytes") -
           mote_stored_number(cell, "deform_bytes");
}

/* A current machine runs one thread about this many times faster than the paper's Pentium 4 at
   2.53 GHz, an estimate; a smaller ratio would show the machine, not the method. */
#define MACHINE 20

/* The slowest frame of the active interval, in ms: the maximum over frames of the median over
   replicates, so that interruptions by other programs do not count. MOTE_NONE if no frame was
   measured there. There is no interval: that of the frame's median would ignore that the frame
   was chosen for it. Replicates start from places of their own, a frame that is slow in most is
   fast in others, and so it even reached below the mean of all frames. */
static double slowest_frame(const mote_summary_row *row)
{
    double slowest = MOTE_NONE;
    for (size_t k = 0; k < row->first->frames; ++k) {
        double times[MOTE_STUDY_SEEDS] = {0};
        size_t count = 0;
        const uint32_t frame = row->first->frame[k];
        if (frame < row->first->active_first || frame > row->first->active_last)
            continue;
        for (size_t r = 0; r < row->replicates && count < MOTE_STUDY_SEEDS; ++r) {
            const mote_stored_cell *cell = &row->cells[r];
            if (k < cell->frames && cell->frame[k] == frame)
                times[count++] = cell->total_ns[k] * 1e-6;
        }
        slowest = fmax(slowest, mote_statistics_median(times, count)); /* ignores MOTE_NONE */
    }
    return slowest;
}

static void add_time(const mote_summary_row *row, const char *scene, bool slowest,
                     double paper_ms, mote_claim *claim)
{
    const mote_estimate e =
        slowest ? mote_estimate_alone(slowest_frame(row)) : mote_row_estimate(row, active_mean);
    const char *what =
        slowest ? "slowest frame of it, median over processes" : "mean of the active interval";
    mote_claim_add(claim, e, "ms", "%s, %s (paper: %g ms, %.0f times as long)", scene, what,
                   paper_ms, paper_ms / e.value);
    mote_claim_require(claim, MOTE_AT_MOST, paper_ms / MACHINE, paper_ms);
}

mote_status mote_claim_times(mote_study *study, mote_claim *claim)
{
    claim->id = "i";
    claim->section = "5";
    claim->claim =
        "T-T, n = 3: below 1 ms on average, 11 ms at most; W-W, n = 5: 12.67 ms and 47 "
        "ms";
    claim->measured =
        "time of a query, all deformation included, processes of their own; holds: at most a "
        "twentieth of the paper's time, since we estimate that a processor of today is 20 "
        "times "
        "as fast as the paper's";
    const mote_summary *summary;
    mote_status status = mote_claims_run(study, &summary);
    if (status != MOTE_OK)
        return status;
    const mote_summary_row *w, *t;
    status = find_row(summary, "ww", MOTE_CACHE_HOT, "particle-paper:n=5", &w);
    if (status == MOTE_OK)
        status = find_row(summary, "tt", MOTE_CACHE_HOT, "particle-paper:n=3", &t);
    if (status != MOTE_OK)
        return status;
    add_time(w, "W-W, n = 5", false, 12.67, claim);
    add_time(w, "W-W, n = 5", true, 47, claim);
    add_time(t, "T-T, n = 3", false, 1, claim);
    add_time(t, "T-T, n = 3", true, 11, claim);
    return MOTE_OK;
}

mote_status mote_claim_hierarchy_memory(mote_study *study, mote_claim *claim)
{
    claim->id = "k";
    claim->section = "2";
    claim->claim = "hierarchies cost memory that particles do not need";
    claim->measured = "live heap after the run, W-W of 11,920 triangles each, mesh, field and "
                      "tables of deformation left out";
    static const char *const trees[] = {"fcl-aabb", "fcl-obbrss"};
    const mote_summary *summary;
    mote_status status = mote_claims_run(study, &summary);
    if (status != MOTE_OK)
        return status;
    const mote_summary_row *particles = NULL, *tree;
    status = find_row(summary, "ww", MOTE_CACHE_HOT, "particle-paper:n=5", &particles);
    for (size_t i = 0; i < 2 && status == MOTE_OK; ++i) {
        status = find_row(summary, "ww", MOTE_CACHE_HOT, trees[i], &tree);
        if (status != MOTE_OK)
            break;
        mote_claim_add(claim, mote_row_ratio(tree, particles, own_bytes), "x",
                       "%s / particles, n = 5, bytes", trees[i]);
        mote_claim_require(claim, MOTE_AT_LEAST, 10, 2);
        mote_claim_add(claim, mote_row_estimate(tree, own_bytes), "B", "%s", trees[i]);
    }
    if (status == MOTE_OK)
        mote_claim_add(claim, mote_row_estimate(particles, own_bytes), "B", "particles, n = 5");
    return status;
}

static mote_status add_update(const mote_summary *summary, const char *label, mote_claim *claim)
{
    const mote_summary_row *row;
    mote_status status = find_row(summary, "ww", MOTE_CACHE_HOT, label, &row);
    if (status != MOTE_OK)
        return status;
    mote_claim_add(claim, mote_row_estimate(row, update_share), "",
                   "W-W, %s: share of a frame that is deformation and refit", label);
    mote_claim_require(claim, MOTE_AT_LEAST, 0.5, 0.25);
    mote_claim_add(claim, mote_row_estimate(row, refit_share), "",
                   "W-W, %s: share of refit, vertices given", label);
    return MOTE_OK;
}

/* Rigid T-T: oriented trees are transformed in place, axis-aligned ones are refitted. */
static mote_status add_rigid(const mote_summary *summary, mote_claim *claim)
{
    const mote_summary_row *refitted, *rigid, *particles;
    mote_status status = find_row(summary, "tt", MOTE_CACHE_HOT, "fcl-aabb", &refitted);
    if (status == MOTE_OK)
        status = find_row(summary, "tt", MOTE_CACHE_HOT, "fcl-obbrss:update=none", &rigid);
    if (status == MOTE_OK)
        status = find_row(summary, "tt", MOTE_CACHE_HOT, "particle-paper:n=3", &particles);
    if (status != MOTE_OK)
        return status;
    mote_claim_add(claim, mote_row_ratio(refitted, rigid, mote_cell_median), "x",
                   "rigid T-T: fcl-aabb refitted / fcl-obbrss without refit, median");
    mote_claim_require(claim, MOTE_AT_LEAST, 2, 1.1);
    mote_claim_add(claim, mote_row_ratio(particles, rigid, mote_cell_median), "x",
                   "rigid T-T: particles, n = 3 / fcl-obbrss without refit");
    return MOTE_OK;
}

mote_status mote_claim_hierarchy_update(mote_study *study, mote_claim *claim)
{
    claim->id = "l";
    claim->section = "1";
    claim->claim = "hierarchies become inefficient when they must be updated at each step";
    claim->measured =
        "share of FCL's time that keeps its trees up to date, deforming W-W; rigid "
        "T-T with and without refit";
    static const char *const deforming[] = {"fcl-aabb", "fcl-aabb:queue=64,seed=previous",
                                            "fcl-obbrss"};
    const mote_summary *summary;
    mote_status status = mote_claims_run(study, &summary);
    if (status != MOTE_OK)
        return status;
    for (size_t i = 0; i < 3 && status == MOTE_OK; ++i)
        status = add_update(summary, deforming[i], claim);
    return status == MOTE_OK ? add_rigid(summary, claim) : status;
}

/* The paired median over common frames of theirs / ours; MOTE_NONE if there are none. */
static double paired_ratio(const mote_stored_cell *theirs, const mote_stored_cell *ours)
{
    double *ratios = mote_allocate(theirs->frames, sizeof *ratios);
    size_t count = 0;
    for (size_t i = 0, k = 0; i < theirs->frames; ++i) {
        while (k < ours->frames && ours->frame[k] < theirs->frame[i])
            ++k;
        if (k < ours->frames && ours->frame[k] == theirs->frame[i])
            ratios[count++] = theirs->total_ns[i] / fmax(ours->total_ns[k], 1);
    }
    const double median = count > 0 ? mote_statistics_median(ratios, count) : MOTE_NONE;
    free(ratios);
    return median;
}

/* Adds how many times longer FCL takes than the particles in one setting: frame by frame, and
   by the sums over all frames. */
static mote_status add_ratio(const mote_summary *summary, mote_cache cache, const char *label,
                             double least, mote_claim *claim)
{
    const mote_summary_row *ours, *theirs;
    mote_status status = find_row(summary, "ww", cache, "particle-paper:n=5", &ours);
    if (status == MOTE_OK)
        status = find_row(summary, "ww", cache, label, &theirs);
    if (status != MOTE_OK)
        return status;
    mote_cell_pair pairs[MOTE_STUDY_SEEDS];
    double paired[MOTE_STUDY_SEEDS] = {0};
    const size_t count = mote_row_pairs(theirs, ours, pairs);
    for (size_t i = 0; i < count; ++i)
        paired[i] = paired_ratio(pairs[i].over, pairs[i].under);
    const char *caches = mote_cache_names[cache];
    mote_claim_add(claim, mote_estimate_ratio(paired, count), "x",
                   "%s, caches %s, frame by frame", label, caches);
    if (least == least)
        mote_claim_require(claim, MOTE_AT_LEAST, least, least);
    mote_claim_add(claim, mote_row_ratio(theirs, ours, mote_cell_mean), "x",
                   "%s, caches %s, sum of all frames", label, caches);
    return MOTE_OK;
}

mote_status mote_claim_faster_than_fcl(mote_study *study, mote_claim *claim)
{
    claim->id = "r3";
    claim->section = "5";
    claim->claim =
        "n = 5 on W-W is at least 200 times below FCL AABB, and 150 below it with queue "
        "and seed";
    claim->measured =
        "FCL's time / particles', deformation and refit included, all frames, one run";
    const mote_summary *summary;
    mote_status status = mote_claims_run(study, &summary);
    if (status != MOTE_OK)
        return status;
    static const struct {
        const char *label;
        double least;
    } cases[] = {{"fcl-aabb", 200}, {"fcl-aabb:queue=64,seed=previous", 150}};
    for (int c = 0; c < 2 && status == MOTE_OK; ++c)
        status = add_ratio(summary, MOTE_CACHE_HOT, cases[c].label, cases[c].least, claim);
    for (int c = 0; c < 2 && status == MOTE_OK; ++c)
        status = add_ratio(summary, MOTE_CACHE_EVICT, cases[c].label, MOTE_NONE, claim);
    return status;
}
