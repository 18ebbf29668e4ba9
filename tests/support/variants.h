/* What certify and streamed find of each variant of a query, and how they tell it. */
#ifndef MOTE_TESTS_VARIANTS_H
#define MOTE_TESTS_VARIANTS_H

#include "tests/support/checks.h"

#include <math.h>

/* Of all queries of one variant. */
typedef struct variant_counts {
    const char *name;
    uint64_t queries;
    uint64_t above;      /* a lower bound above the truth */
    uint64_t wrong;      /* an answer that is not within its promise */
    uint64_t stopped;    /* ended by a budget */
    uint64_t contacts;   /* the truth is 0 */
    double least_margin; /* of truth - lower, over L, where apart; begins as HUGE_VAL */
    double most_error;   /* of |distance - truth|, over L, where exact */
} variant_counts;

/* Counts a query, but for wrong and most_error, which depend on what the variant promises. */
static inline void variant_count(variant_counts *v, double truth, double lower, bool stopped,
                                 double length)
{
    ++v->queries;
    v->stopped += stopped;
    v->contacts += truth > 0 ? 0 : 1;
    v->above += lower <= truth ? 0 : 1;
    if (truth > 0)
        v->least_margin = fmin(v->least_margin, (truth - lower) / length);
}

static inline uint64_t variants_queries(const variant_counts *const v[], int count)
{
    uint64_t sum = 0;
    for (int i = 0; i < count; ++i)
        sum += v[i]->queries;
    return sum;
}

/* False, after a line on stderr, when the file cannot be written. */
static inline bool variants_write(const char *path, const variant_counts *const v[], int count)
{
    FILE *file = fopen(path, "w");
    bool good = file && fprintf(file, "[\n") > 0;
    for (int i = 0; i < count && good; ++i)
        good =
            fprintf(file,
                    "  {\"variant\": \"%s\", \"queries\": %" PRIu64
                    ", \"lower_above_truth\": %" PRIu64 ", \"wrong\": %" PRIu64
                    ", \"stopped\": %" PRIu64 ", \"contacts\": %" PRIu64 ", \"least_margin\": ",
                    v[i]->name, v[i]->queries, v[i]->above, v[i]->wrong, v[i]->stopped,
                    v[i]->contacts) > 0 &&
            (isfinite(v[i]->least_margin) ? fprintf(file, "%.3g", v[i]->least_margin)
                                          : fprintf(file, "null")) > 0 &&
            fprintf(file, ", \"largest_error\": %.3g}%s\n", v[i]->most_error,
                    i + 1 < count ? "," : "") > 0;
    good = good && fprintf(file, "]\n") > 0;
    good = file && fclose(file) == 0 && good;
    if (!good)
        fprintf(stderr, "%s: cannot be written\n", path);
    return good;
}

/* Prints a table, writes the files that the options name, the first check with all queries and
   the second with `exact` of them; returns the exit status. */
static inline int variants_report(const variant_counts *const v[], int count,
                                  const checks_options *options, const char *above_check,
                                  const char *wrong_check, uint64_t exact)
{
    uint64_t above = 0, wrong = 0;
    printf("%-10s %10s %12s %8s %8s %9s %14s %14s\n", "variant", "queries", "above truth",
           "wrong", "stopped", "contacts", "least margin", "largest error");
    for (int i = 0; i < count; ++i) {
        printf("%-10s %10" PRIu64 " %12" PRIu64 " %8" PRIu64 " %8" PRIu64 " %9" PRIu64
               " %14.2e %14.2e\n",
               v[i]->name, v[i]->queries, v[i]->above, v[i]->wrong, v[i]->stopped,
               v[i]->contacts, v[i]->least_margin, v[i]->most_error);
        above += v[i]->above;
        wrong += v[i]->wrong;
    }
    const bool written =
        (!options->out || variants_write(options->out, v, count)) &&
        checks_add(options->checks, above_check, variants_queries(v, count), above) &&
        checks_add(options->checks, wrong_check, exact, wrong);
    return written && above == 0 && wrong == 0 ? 0 : 1;
}

#endif
