/* make test-perf: what a comparison of runs catches. Measures the same build again and again:
   unchanged, then with a slowdown and with an extra count planted into a copy of one method. It
   takes minutes, so make test leaves it out.

   perf_planted DIR [RUNS] */
#include "harness/compare/compare.h"
#include "harness/run/measure.h"
#include "harness/base/options.h"
#include "harness/run/run.h"
#include "harness/summary/summary_json.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define VICTIM "particle-paper"
#define SLOWDOWN 0.10
#define FLOOR 0.05

static const mote_method *victim;

static mote_status slow_query(void *state, const mote_frame *frame, mote_answer *answer)
{
    uint64_t start = mote_clock_ns();
    mote_status status = victim->query(state, frame, answer);
    uint64_t end = mote_clock_ns();
    uint64_t until = end + (uint64_t)((double)(end - start) * SLOWDOWN);
    while (mote_clock_ns() < until) {
    }
    return status;
}

static mote_status counting_query(void *state, const mote_frame *frame, mote_answer *answer)
{
    mote_status status = victim->query(state, frame, answer);
    answer->counters.box_tests += frame->number == 960 ? 1 : 0;
    return status;
}

/* Measures the fixed set with a query instead of the victim's (NULL: its own). */
static mote_status measure(const char *directory,
                           mote_status (*query)(void *, const mote_frame *, mote_answer *))
{
    static const char *const scenarios[] = {"ww"};
    static char name[] = "perf_planted";
    char *argv[] = {name, NULL};
    mote_choices choices = {0};
    mote_method planted = *victim;
    mote_status status = mote_choices_add(&choices, "fcl-aabb", NULL);
    if (status == MOTE_OK)
        status = mote_choices_add(&choices, VICTIM ":start=fps,n=5", NULL);
    if (status == MOTE_OK)
        status = mote_choices_add(&choices, VICTIM ":start=fps,n=16", NULL);
    if (query)
        planted.query = query;
    for (size_t i = 0; i < choices.count; ++i) {
        if (choices.items[i].method == victim)
            choices.items[i].method = &planted;
    }
    mote_run_options options = {
        .scenarios = scenarios,
        .scenario_count = 1,
        .choices = &choices,
        .plan = {.replicates = 20,
                 .first = 950,
                 .last = 1049,
                 .stride = 1,
                 .seed = 1,
                 .fixed_seed = true},
        .directory = directory,
        .timeout = 600,
        .force = true,
        .argc = 1,
        .argv = argv,
    };
    mote_run_outcome outcome;
    mote_summary summary;
    if (status == MOTE_OK)
        status = mote_run(&options, &outcome);
    if (status == MOTE_OK)
        status = mote_summary_make(directory, &summary);
    if (status == MOTE_OK) {
        status = mote_summary_write(&summary, directory);
        mote_summary_free(&summary);
    }
    mote_choices_free(&choices);
    return status;
}

/* Measures and compares with the first run; what: the label to print. */
static mote_status try_one(const char *base, const char *directory, const char *what,
                           mote_status (*query)(void *, const mote_frame *, mote_answer *),
                           bool *worse)
{
    mote_comparison c;
    mote_status status = measure(directory, query);
    if (status == MOTE_OK)
        status = mote_compare(base, directory, FLOOR, &c);
    if (status != MOTE_OK)
        return status;
    (void)printf("%-12s", what);
    for (size_t i = 0; i < c.count; ++i) {
        if (!c.changes[i].is_reference)
            (void)printf("  %.3f [%.3f, %.3f] %s", c.changes[i].ratio,
                         c.changes[i].interval.low, c.changes[i].interval.high,
                         mote_verdict_names[c.changes[i].verdict]);
    }
    (void)printf("  floor %.1f %%  %s\n", 100 * c.floor, c.worse ? "worse" : "not worse");
    (void)fflush(stdout);
    *worse = c.worse;
    mote_comparison_free(&c);
    return MOTE_OK;
}

static mote_status run_all(const char *directory, uint64_t runs, bool *passed)
{
    char *base = mote_format("%s/base", directory), *other = mote_format("%s/new", directory);
    mote_status status =
        base && other ? measure(base, NULL) : mote_fail(MOTE_ENOMEM, "no memory for a name");
    bool worse = false;
    *passed = true;
    for (uint64_t i = 0; status == MOTE_OK && i < runs; ++i) {
        status = try_one(base, other, "unchanged", NULL, &worse);
        *passed = *passed && !worse;
    }
    if (status == MOTE_OK) {
        status = try_one(base, other, "10 % slower", slow_query, &worse);
        *passed = *passed && worse;
    }
    if (status == MOTE_OK) {
        status = try_one(base, other, "one box test", counting_query, &worse);
        *passed = *passed && worse;
    }
    free(base);
    free(other);
    return status;
}

int main(int argc, char **argv)
{
    uint64_t runs = 20;
    if (argc < 2 || argc > 3 || (argc == 3 && !mote_read_unsigned(argv[2], 0, 1000, &runs))) {
        (void)fprintf(stderr, "usage: perf_planted DIR [RUNS]\n");
        return MOTE_EXIT_USAGE;
    }
    victim = mote_method_find(VICTIM);
    bool passed = false;
    mote_status status =
        victim ? run_all(argv[1], runs, &passed) : mote_fail(MOTE_EINVAL, "no method " VICTIM);
    if (status != MOTE_OK)
        return mote_command_fail();
    (void)printf("%s\n", passed ? "both changes caught, no false alarm" : "FAILED");
    return passed ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED;
}
