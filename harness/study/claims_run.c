#include "harness/study/claims_run.h"

#include "harness/base/memory.h"
#include "harness/run/run.h"

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

static mote_status run_leg(mote_study *study, const leg *l)
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
    mote_run_outcome outcome = {0};
    if (status == MOTE_OK)
        status = mote_run(&options, &outcome);
    study->cell_failed =
        outcome.failed > 0 || (status != MOTE_OK && outcome.started); /* as in `mote run` */
    if (status == MOTE_OK && outcome.failed > 0)
        status = mote_fail(MOTE_EIO, "%zu cells of %s failed; see their reason in %s/cells",
                           outcome.failed, l->scenario, study->run);
    mote_choices_free(&choices);
    return status;
}

mote_status mote_claims_run(mote_study *study, const mote_summary **summary)
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

double mote_cell_mean(const mote_stored_cell *cell)
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

double mote_cell_median(const mote_stored_cell *cell)
{
    return quantile_total(cell, 0.5);
}

double mote_cell_p95(const mote_stored_cell *cell)
{
    return quantile_total(cell, 0.95);
}

double mote_cell_worst(const mote_stored_cell *cell)
{
    return quantile_total(cell, 1);
}

size_t mote_row_pairs(const mote_summary_row *over, const mote_summary_row *under,
                      mote_cell_pair pairs[MOTE_STUDY_SEEDS])
{
    size_t count = 0;
    for (size_t r = 0; r < over->replicates && count < MOTE_STUDY_SEEDS; ++r) {
        const mote_stored_cell *cell = &over->cells[r];
        const mote_stored_cell *other = mote_summary_replicate(under, cell->replicate);
        if (mote_stored_ran(cell) && other)
            pairs[count++] = (mote_cell_pair){cell, other};
    }
    return count;
}

mote_estimate mote_row_estimate(const mote_summary_row *row, mote_cell_value value)
{
    double values[MOTE_STUDY_SEEDS] = {0};
    size_t count = 0;
    for (size_t r = 0; r < row->replicates && count < MOTE_STUDY_SEEDS; ++r) {
        if (mote_stored_ran(&row->cells[r]))
            values[count++] = value(&row->cells[r]);
    }
    return mote_estimate_ratio(values, count);
}

mote_estimate mote_row_ratio(const mote_summary_row *over, const mote_summary_row *under,
                             mote_cell_value value)
{
    mote_cell_pair pairs[MOTE_STUDY_SEEDS];
    double ratios[MOTE_STUDY_SEEDS] = {0};
    const size_t count = mote_row_pairs(over, under, pairs);
    for (size_t i = 0; i < count; ++i)
        ratios[i] = value(pairs[i].over) / value(pairs[i].under);
    return mote_estimate_ratio(ratios, count);
}
