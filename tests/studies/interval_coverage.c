/* make test-statistics: how often intervals of the median, of a share and of an exponent cover
   it, and how often a comparison of a method with itself, or with one that takes 10 % longer,
   says faster or slower. The
   simulated processes have frames that depend on each other as real ones do: every process has
   a level of its own, all run the same frames, and neighbouring frames share their disturbance.
   Usage: interval_coverage [SETS]. */
#include "harness/base/options.h"
#include "harness/base/statistics.h"
#include "harness/study/study.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 150, MOST_REPLICATES = 20 };

#define LEVEL_SD 0.03    /* of a process, as the logarithm of time */
#define FRAME_SWING 0.40 /* of the scenario: some frames are harder */
#define NOISE_SD 0.05    /* of a frame */
#define NOISE_MEMORY 0.9 /* what a frame keeps of the disturbance of the one before */
#define MEDIAN_NS 4000.0

/* Symmetric around MEDIAN_NS in the logarithm, so that this is the true median. */
static void simulate(gsl_rng *random, double *values)
{
    double level = gsl_ran_gaussian(random, LEVEL_SD);
    double noise = gsl_ran_gaussian(random, NOISE_SD);
    for (int k = 0; k < FRAMES; ++k) {
        noise = NOISE_MEMORY * noise +
                gsl_ran_gaussian(random, NOISE_SD * sqrt(1 - NOISE_MEMORY * NOISE_MEMORY));
        double swing = FRAME_SWING * sin(6.283185307179586 * k / FRAMES);
        values[k] = MEDIAN_NS * exp(level + swing + noise);
    }
}

/* The share of data sets whose interval covers the true median. */
static mote_status cover(gsl_rng *random, size_t replicates, int sets, double *share)
{
    static double values[MOST_REPLICATES][FRAMES];
    int covered = 0;
    for (int set = 0; set < sets; ++set) {
        mote_replicate data[MOST_REPLICATES];
        for (size_t r = 0; r < replicates; ++r) {
            simulate(random, values[r]);
            data[r].values = values[r];
            data[r].count = FRAMES;
        }
        const mote_confidence interval =
            mote_statistics_median_interval(data, replicates, true, (uint64_t)set);
        covered += interval.low <= MEDIAN_NS && MEDIAN_NS <= interval.high ? 1 : 0;
    }
    *share = (double)covered / sets;
    return MOTE_OK;
}

/* The logarithm of the median of one simulated process. */
static double log_median(gsl_rng *random)
{
    double values[FRAMES];
    simulate(random, values);
    return log(mote_statistics_median(values, FRAMES));
}

/* The share of comparisons that say faster or slower at a floor of 2 %: of a method with one
   that takes `factor` times as long, with 10 replicates each. */
static double alarms_of(gsl_rng *random, double factor, int comparisons)
{
    int alarms = 0;
    for (int c = 0; c < comparisons; ++c) {
        double logs[10];
        for (int r = 0; r < 10; ++r)
            logs[r] = log(factor) + log_median(random) - log_median(random);
        mote_confidence interval = mote_statistics_t_interval(logs, 10);
        interval.low = exp(interval.low);
        interval.high = exp(interval.high);
        mote_verdict verdict =
            mote_statistics_verdict(exp(mote_statistics_mean(logs, 10)), interval,
                                    mote_statistics_t_test(logs, 10), 0.02);
        alarms += verdict == MOTE_VERDICT_FASTER || verdict == MOTE_VERDICT_SLOWER ? 1 : 0;
    }
    return (double)alarms / comparisons;
}

enum { CONTACTS = 5 };

/* The share of contacts missed by one start. Those of a start depend on each other: the chance
   to miss one differs from start to start (a beta distribution with this mean), or all share
   their fate. */
static double draw_start(gsl_rng *random, double mean, bool all)
{
    if (all)
        return gsl_rng_uniform(random) < mean ? 1 : 0;
    const double beta = 0.3, chance = gsl_ran_beta(random, beta * mean / (1 - mean), beta);
    return (double)gsl_ran_binomial(random, chance, CONTACTS) / CONTACTS;
}

/* The share of data sets whose interval covers the true share of contacts missed. */
static double cover_share(gsl_rng *random, size_t starts, double mean, bool all, int sets)
{
    int covered = 0;
    for (int set = 0; set < sets; ++set) {
        double sum = 0;
        for (size_t s = 0; s < starts; ++s)
            sum += draw_start(random, mean, all);
        const mote_confidence interval = mote_statistics_share_interval(sum, (double)starts);
        covered += interval.low <= mean && mean <= interval.high ? 1 : 0;
    }
    return (double)covered / sets;
}

/* The least of these over several means; with few starts, most data sets have none missed. */
static double least_cover_of_share(gsl_rng *random, int sets)
{
    static const double means[] = {0.003, 0.01, 0.025, 0.05, 0.2};
    double least = 1;
    for (size_t i = 0; i < sizeof means / sizeof means[0]; ++i) {
        for (int k = 0; k < 4; ++k)
            least = fmin(least, cover_share(random, k < 2 ? 32 : 256, means[i], k % 2, sets));
    }
    return least;
}

#define EXPONENT 1.6

/* The share of data sets whose interval covers the true exponent, of times that deviate from
   the power with the size by 5 % and with the seed by 2 %. */
static mote_status cover_exponent(gsl_rng *random, size_t sizes, int sets, double *share)
{
    enum { SEEDS = 5, SIZES_MAX = 8 };
    double x[SIZES_MAX], y[SIZES_MAX * SEEDS];
    int covered = 0;
    mote_status status = MOTE_OK;
    for (int set = 0; set < sets && status == MOTE_OK; ++set) {
        for (size_t i = 0; i < sizes; ++i) {
            x[i] = pow(2, (double)i);
            const double mean = pow(x[i], EXPONENT) * exp(gsl_ran_gaussian(random, 0.05));
            for (size_t s = 0; s < SEEDS; ++s)
                y[i * SEEDS + s] = mean * exp(gsl_ran_gaussian(random, 0.02));
        }
        mote_estimate e;
        status = mote_estimate_exponent(x, y, sizes, SEEDS, &e);
        covered += e.interval.low <= EXPONENT && EXPONENT <= e.interval.high ? 1 : 0;
    }
    *share = (double)covered / sets;
    return status;
}

static int judge(const char *what, double share, double least, double most)
{
    int failed = share < least || share > most;
    (void)printf("%-52s %5.1f %%, required %.0f-%.0f %%: %s\n", what, 100 * share, 100 * least,
                 100 * most, failed ? "FAILED" : "ok");
    return failed;
}

int main(int argc, char **argv)
{
    uint64_t given = 1000;
    if (argc > 2 || (argc == 2 && !mote_read_unsigned(argv[1], 1, 1000000, &given))) {
        (void)fprintf(stderr, "usage: interval_coverage [SETS]\n");
        return MOTE_EXIT_USAGE;
    }
    const int sets = (int)given;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    double five, twenty, four, seven;
    if (!random)
        return 1;
    gsl_rng_set(random, 20030901);
    if (cover(random, 5, sets, &five) != MOTE_OK ||
        cover(random, 20, sets, &twenty) != MOTE_OK ||
        cover_exponent(random, 4, sets, &four) != MOTE_OK ||
        cover_exponent(random, 7, sets, &seven) != MOTE_OK) {
        (void)fprintf(stderr, "coverage: %s\n", mote_error_text());
        return 1;
    }
    int failed = judge("t intervals of 5 processes cover the median", five, 0.93, 0.97);
    failed += judge("bootstrap intervals of 20 processes cover it", twenty, 0.93, 0.97);
    failed += judge("comparisons of a method with itself that alarm", alarms_of(random, 1, 200),
                    0, 0.05);
    failed += judge("comparisons with one that takes 10 % longer that do",
                    alarms_of(random, 1.1, 200), 0.9, 1);
    failed += judge("intervals of shares of dependent events cover them",
                    least_cover_of_share(random, sets), 0.93, 1);
    failed += judge("intervals of an exponent over 4 sizes cover it", four, 0.93, 1);
    failed += judge("intervals of an exponent over 7 sizes cover it", seven, 0.92, 0.97);
    gsl_rng_free(random);
    return failed ? 1 : 0;
}
