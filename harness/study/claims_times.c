/* The paper's claims about its own times and about hierarchies, i, k and l, and the required
   smallest ratios to FCL and to the best engine of others. Measured in cells, each in its own
   process. */
#include "harness/study/claims.h"

#include "harness/base/memory.h"
#include "harness/run/run.h"
#include "harness/summary/summary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PLAIN "fcl-aabb:seed=none,queue=2"
#define TUNED "fcl-aabb:seed=previous,queue=64"

/* One part of the run. */
typedef struct leg {
    const char *scenario;
    mote_cache cache;
    uint32_t first, last; /* 0, 0: all */
    const char *methods[6];
    const char *optional[8]; /* measured where their library was found */
} leg;

static const leg legs[] = {
    {"ww", MOTE_CACHE_HOT, 0, 0, {"particle-paper:n=5", PLAIN, TUNED}, {NULL}},
    {"ww", MOTE_CACHE_HOT, 949, 1492, {"fcl-obbrss"}, {NULL}},
    {"ww", MOTE_CACHE_EVICT, 950, 1249, {"particle-paper:n=5", PLAIN, TUNED}, {NULL}},
    {"tt",
     MOTE_CACHE_HOT,
     0,
     0,
     {"particle-paper:n=3", PLAIN, "fcl-obbrss:update=none"},
     {NULL}},
};

/* Frames near contact, in which engines at their best are asked the same as certified
   (docs/peers.md). */
#define ENGINES_DISTANCE                                                                       \
    {"certified", "fcl-aabb:seed=previous|none", "fcl-aabb:seed=previous,build=samples"},      \
    {                                                                                          \
        "coal-aabb:bound=full,seed=previous"                                                   \
    }
#define ENGINES_CONTACT                                                                        \
    {"certified", "fcl-aabb"},                                                                 \
    {                                                                                          \
        "ode:vertices=double|single", "bullet-gimpact:stop=no|yes", "coal-aabb",               \
            "coal-aabb:contact=distance,bound=full,seed=previous", "embree-contact"            \
    }

static const leg engine_legs[] = {
    {"ww", MOTE_CACHE_HOT, 1201, 1400, ENGINES_DISTANCE},
    {"mv", MOTE_CACHE_HOT, 301, 500, ENGINES_DISTANCE},
    {"tt-distance",
     MOTE_CACHE_HOT,
     201,
     400,
     {"certified", "fcl-rss:update=none,build=rest|samples",
      "fcl-obbrss:update=none,build=rest|samples"},
     {"coal-rss:update=none", "coal-kios:update=none", "coal-obbrss:update=none"}},
    {"ww-contact", MOTE_CACHE_HOT, 1201, 1400, ENGINES_CONTACT},
    {"mv-contact", MOTE_CACHE_HOT, 301, 500, ENGINES_CONTACT},
    {"tt",
     MOTE_CACHE_HOT,
     201,
     400,
     {"certified", "fcl-obb:update=none,build=rest|samples", "fcl-obbrss:update=none"},
     {"ode:update=none,vertices=double|single", "bullet-gimpact:update=none,stop=yes",
      "coal-obb:update=none", "coal-rss:update=none", "coal-obbrss:update=none"}},
};

#define ENGINE_LEGS (sizeof engine_legs / sizeof engine_legs[0])

/* Adds a leg's methods, and of the optional ones those that this build has. */
static mote_status choose(const leg *l, mote_choices *choices)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < 6 && l->methods[i] && status == MOTE_OK; ++i)
        status = mote_choices_add(choices, l->methods[i], NULL);
    for (size_t i = 0; i < 8 && l->optional[i] && status == MOTE_OK; ++i) {
        char *name = mote_duplicate(l->optional[i]);
        name[strcspn(name, ":")] = '\0';
        if (mote_method_find(name))
            status = mote_choices_add(choices, l->optional[i], NULL);
        free(name);
    }
    return status;
}

static mote_status run_leg(const mote_study *study, const leg *l)
{
    mote_choices choices = {0};
    mote_status status = choose(l, &choices);
    static char name[] = "claims";
    char *argv[] = {name, NULL};
    const mote_run_options options = {.scenarios = &l->scenario,
                                      .scenario_count = 1,
                                      .choices = &choices,
                                      .plan = {.replicates = study->quick ? 3 : 6,
                                               .first = l->first,
                                               .last = l->last,
                                               .seed = 1,
                                               .cache = l->cache},
                                      .directory = study->run,
                                      .timeout = 600,
                                      .argc = 1,
                                      .argv = argv};
    mote_run_outcome outcome;
    if (status == MOTE_OK)
        status = mote_run(&options, &outcome);
    if (status == MOTE_OK && outcome.failed > 0)
        status = mote_fail(MOTE_EIO, "%zu cells of %s failed; see their reason in %s/cells",
                           outcome.failed, l->scenario, study->run);
    mote_choices_free(&choices);
    return status;
}

/* Measures what is missing, then reads the whole run; done once. */
static mote_status measure(mote_study *study, const mote_summary **summary)
{
    *summary = &study->summary;
    if (study->summarised)
        return MOTE_OK;
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < sizeof legs / sizeof legs[0] && status == MOTE_OK; ++i)
        status = run_leg(study, &legs[i]);
    for (size_t i = 0; i < ENGINE_LEGS && status == MOTE_OK; ++i)
        status = run_leg(study, &engine_legs[i]);
    if (status == MOTE_OK)
        status = mote_summary_make(study->run, &study->summary);
    study->summarised = status == MOTE_OK;
    return status;
}

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

typedef double (*cell_value)(const mote_stored_cell *cell);

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

static double mean_total(const mote_stored_cell *cell)
{
    return mote_statistics_mean(cell->total_ns, cell->frames);
}

static double quantile_total(const mote_stored_cell *cell, double share)
{
    double *work = mote_copy(cell->total_ns, cell->frames * sizeof *work);
    mote_statistics_sort(work, cell->frames);
    const double quantile = mote_statistics_quantile(work, cell->frames, share);
    free(work);
    return quantile;
}

static double median_total(const mote_stored_cell *cell)
{
    return quantile_total(cell, 0.5);
}

static double p95_total(const mote_stored_cell *cell)
{
    return quantile_total(cell, 0.95);
}

static double worst_total(const mote_stored_cell *cell)
{
    return quantile_total(cell, 1);
}

/* Heap held by the method, without tables and vertices of full deformation. */
static double own_bytes(const mote_stored_cell *cell)
{
    return mote_stored_number(cell, "heap_live_bytes") -
           mote_stored_number(cell, "deform_bytes");
}

/* Collects the values of a row's replicates that ran well. */
static size_t values_of(const mote_summary_row *row, cell_value value, double *values)
{
    size_t count = 0;
    for (size_t r = 0; r < row->replicates && count < MOTE_STUDY_SEEDS; ++r) {
        if (row->cells[r].status == MOTE_CELL_OK)
            values[count++] = value(&row->cells[r]);
    }
    return count;
}

static mote_estimate estimate_of(const mote_summary_row *row, cell_value value)
{
    double values[MOTE_STUDY_SEEDS] = {0};
    return mote_estimate_ratio(values, values_of(row, value, values));
}

/* The mean over replicates of over's value / under's value. */
static mote_estimate ratio_of(const mote_summary_row *over, const mote_summary_row *under,
                              cell_value value)
{
    double a[MOTE_STUDY_SEEDS] = {0}, b[MOTE_STUDY_SEEDS] = {0};
    const size_t first = values_of(over, value, a), second = values_of(under, value, b);
    const size_t count = first < second ? first : second;
    for (size_t r = 0; r < count; ++r)
        a[r] /= b[r];
    return mote_estimate_ratio(a, count);
}

/* A current machine runs one thread about this many times faster than the paper's Pentium 4 at
   2.53 GHz; a smaller ratio would show the machine, not the method. */
#define MACHINE 20

/* The slowest frame of the active interval: the maximum over frames of the median over
   replicates, so that interruptions by other programs do not count, with the interval over its
   replicates. MOTE_NONE if no frame was measured there. */
static mote_estimate slowest_frame(const mote_summary_row *row)
{
    mote_estimate slowest = {MOTE_NONE, {MOTE_NONE, MOTE_NONE}};
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
        mote_statistics_sort(times, count);
        const double median = mote_statistics_quantile(times, count, 0.5);
        if (count > 0 && !(median <= slowest.value)) {
            slowest.value = median;
            slowest.interval = mote_statistics_sign_interval(times, count);
        }
    }
    return slowest;
}

static void add_time(const mote_summary_row *row, const char *scene, bool maximum,
                     double paper_ms, mote_claim *claim)
{
    const mote_estimate e = maximum ? slowest_frame(row) : estimate_of(row, active_mean);
    const char *what = maximum ? "maximum" : "average";
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
        "twentieth of the paper's time, which is about how much faster the machine is";
    const mote_summary *summary;
    mote_status status = measure(study, &summary);
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
    mote_status status = measure(study, &summary);
    if (status != MOTE_OK)
        return status;
    const mote_summary_row *particles = NULL, *tree;
    status = find_row(summary, "ww", MOTE_CACHE_HOT, "particle-paper:n=5", &particles);
    for (size_t i = 0; i < 2 && status == MOTE_OK; ++i) {
        status = find_row(summary, "ww", MOTE_CACHE_HOT, trees[i], &tree);
        if (status != MOTE_OK)
            break;
        mote_claim_add(claim, ratio_of(tree, particles, own_bytes), "x",
                       "%s / particles, n = 5, bytes", trees[i]);
        mote_claim_require(claim, MOTE_AT_LEAST, 10, 2);
        mote_claim_add(claim, estimate_of(tree, own_bytes), "B", "%s", trees[i]);
    }
    if (status == MOTE_OK)
        mote_claim_add(claim, estimate_of(particles, own_bytes), "B", "particles, n = 5");
    return status;
}

static mote_status add_update(const mote_summary *summary, const char *label, mote_claim *claim)
{
    const mote_summary_row *row;
    mote_status status = find_row(summary, "ww", MOTE_CACHE_HOT, label, &row);
    if (status != MOTE_OK)
        return status;
    mote_claim_add(claim, estimate_of(row, update_share), "",
                   "W-W, %s: share of a frame that is deformation and refit", label);
    mote_claim_require(claim, MOTE_AT_LEAST, 0.5, 0.25);
    mote_claim_add(claim, estimate_of(row, refit_share), "",
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
    mote_claim_add(claim, ratio_of(refitted, rigid, median_total), "x",
                   "rigid T-T: fcl-aabb refitted / fcl-obbrss without refit, median");
    mote_claim_require(claim, MOTE_AT_LEAST, 2, 1.1);
    mote_claim_add(claim, ratio_of(particles, rigid, median_total), "x",
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
    mote_status status = measure(study, &summary);
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
    double paired[MOTE_STUDY_SEEDS] = {0};
    size_t count = 0;
    for (size_t r = 0; r < ours->replicates && r < theirs->replicates; ++r) {
        if (ours->cells[r].status == MOTE_CELL_OK && theirs->cells[r].status == MOTE_CELL_OK &&
            count < MOTE_STUDY_SEEDS)
            paired[count++] = paired_ratio(&theirs->cells[r], &ours->cells[r]);
    }
    const char *caches = mote_cache_names[cache];
    mote_claim_add(claim, mote_estimate_ratio(paired, count), "x",
                   "%s, caches %s, frame by frame", label, caches);
    if (least == least)
        mote_claim_require(claim, MOTE_AT_LEAST, least, least);
    mote_claim_add(claim, ratio_of(theirs, ours, mean_total), "x",
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
    mote_status status = measure(study, &summary);
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

/* The row of a leg's certified query: of its frames alone. */
static mote_status find_certified(const mote_summary *summary, const leg *l,
                                  const mote_summary_row **found)
{
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (row->status == MOTE_CELL_OK && strcmp(row->method, "certified") == 0 &&
            strcmp(row->scenario, l->scenario) == 0 && row->frame_range[0] == l->first &&
            row->frame_range[1] == l->last) {
            *found = row;
            return MOTE_OK;
        }
    }
    return mote_fail(MOTE_ENUMERIC, "no result of certified on %s", l->scenario);
}

/* The row that competes with ours on the same frames and takes least by a value; NULL without
   any. */
static const mote_summary_row *least_of(const mote_summary *summary,
                                        const mote_summary_row *ours, cell_value value,
                                        bool (*competes)(const mote_summary_row *))
{
    const mote_summary_row *least = NULL;
    double best = MOTE_NONE;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (row->status != MOTE_CELL_OK || !mote_summary_same_block(row, ours) ||
            mote_summary_by_frames(row, ours) != 0 || !mote_summary_is_right_engine(row) ||
            (competes && !competes(row)))
            continue;
        const double time = estimate_of(row, value).value;
        if (!(time >= best)) {
            best = time;
            least = row;
        }
    }
    return least;
}

/* What an engine has to be slower by on a leg's frames, by the median and by the mean. */
typedef struct rival_bounds {
    double median, mean; /* MOTE_NONE: reported only */
} rival_bounds;

static mote_status add_engines(const mote_summary *summary, const leg *l, rival_bounds bounds,
                               mote_claim *claim)
{
    const struct {
        const char *name;
        cell_value value;
        double least;
    } statistics[] = {{"median", median_total, bounds.median},
                      {"mean", mean_total, bounds.mean},
                      {"95th percentile", p95_total, MOTE_NONE},
                      {"worst frame", worst_total, MOTE_NONE}};
    const mote_summary_row *ours = NULL;
    mote_status status = find_certified(summary, l, &ours);
    for (size_t k = 0; k < 4 && status == MOTE_OK; ++k) {
        const mote_summary_row *best = least_of(summary, ours, statistics[k].value, NULL);
        if (!best)
            return mote_fail(MOTE_ENUMERIC, "no result of an engine of others on %s",
                             l->scenario);
        mote_claim_add(claim, ratio_of(best, ours, statistics[k].value), "x", "%s, %s: %s",
                       l->scenario, statistics[k].name, best->label);
        if (statistics[k].least == statistics[k].least)
            mote_claim_require(claim, MOTE_AT_LEAST, statistics[k].least, statistics[k].least);
    }
    if (status != MOTE_OK)
        return status;
    const mote_summary_row *fcl = least_of(summary, ours, median_total, mote_summary_is_fcl);
    if (fcl)
        mote_claim_add(claim, ratio_of(fcl, ours, median_total), "x",
                       "%s, median: best FCL, %s", l->scenario, fcl->label);
    return MOTE_OK;
}

/* The engine_legs first .. first + 2, which ask the same. */
static mote_status add_question(mote_study *study, size_t first, const rival_bounds bounds[3],
                                mote_claim *claim)
{
    const mote_summary *summary;
    mote_status status = measure(study, &summary);
    for (size_t i = 0; i < 3 && status == MOTE_OK; ++i)
        status = add_engines(summary, &engine_legs[first + i], bounds[i], claim);
    return status;
}

mote_status mote_claim_best_engine_distance(mote_study *study, mote_claim *claim)
{
    claim->id = "r6";
    claim->section = "5";
    claim->claim = "asked for distances, certified is faster than every engine of others: on "
                   "W-W 40 times, on M-V 6 times, on rigid T-T 4 times, by median and mean";
    claim->measured =
        "the fastest engine's time / certified's, deformation and refit included; "
        "200 frames near contact; the fastest by each statistic";
    static const rival_bounds bounds[] = {{40, 40}, {6, 6}, {4, 4}};
    return add_question(study, 0, bounds, claim);
}

mote_status mote_claim_best_engine_contact(mote_study *study, mote_claim *claim)
{
    claim->id = "r7";
    claim->section = "5";
    claim->claim =
        "asked for contacts, certified is faster than every engine of others: on W-W "
        "40 times, on M-V 6 times, by median and mean; on rigid T-T by the mean";
    claim->measured =
        "the fastest engine's time / certified's, deformation and refit included; "
        "200 frames near contact; the fastest by each statistic";
    static const rival_bounds bounds[] = {{40, 40}, {6, 6}, {MOTE_NONE, 1}};
    return add_question(study, 3, bounds, claim);
}
