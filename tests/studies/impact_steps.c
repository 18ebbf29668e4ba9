/* make impacts: the time of impact between the frames of scenarios, K frames at a time, against
   1,000 samples of each path with the first crossing bisected; beside it, what as many samples
   as the query's time allows would have missed. Usage: impact_steps [--intervals N] [--out
   FILE] SCENARIO ... . Times are processor times. Exit status 1 where an impact is missed or
   false. */
#include "core/certificate/certificate.h"
#include "core/impact/impact.h"
#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/base/statistics.h"
#include "harness/scene/scenario_path.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define TOLERANCE 1e-3 /* of L */

enum { SAMPLES = 1000, INTERVALS_MOST = 10000 };

static const uint32_t steps[] = {1, 3, 10, 30, 100};

/* A scenario and what asks about it. */
typedef struct session {
    mote_scenario *scenario;
    const mote_body *bodies[2];
    mote_scenario_path *path;
    mote_impact_search *search;
    mote_certificate *certificate; /* of samples: not the search's */
    double *weights[2];
    mote_frame frame;
} session;

typedef struct counts {
    size_t intervals; /* that did not begin in contact */
    size_t started;   /* in contact */
    size_t impacts, missed, wrong, undecided, samples_missed;
    double widest; /* bracket */
    double iterations[INTERVALS_MOST], us[INTERVALS_MOST];
} counts;

static double processor_us(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e6 + (double)t.tv_nsec * 1e-3;
}

static double distance_at(session *s, double time)
{
    mote_certificate_answer a;
    for (int i = 0; i < 2; ++i)
        mote_path_state(mote_scenario_path_of(s->path, i), s->bodies[i], time, s->weights[i],
                        &s->frame.body[i]);
    ++s->frame.number;
    mote_certificate_query(s->certificate, &s->frame, NULL, -1, &a);
    return a.distance;
}

/* Whether any of count samples after the start is in contact; *first: the first that is,
   bisected. */
static bool sampled_contact(session *s, int count, double tolerance, double *first)
{
    for (int i = 1; i <= count; ++i) {
        double high = (double)i / count, low = (i - 1.0) / count;
        if (distance_at(s, high) > tolerance)
            continue;
        for (int k = 0; k < 40; ++k) {
            const double middle = 0.5 * (low + high);
            *(distance_at(s, middle) <= tolerance ? &high : &low) = middle;
        }
        *first = high;
        return true;
    }
    *first = 2;
    return false;
}

/* How many samples take as long as a query did; at least the end alone. */
static int samples_in(session *s, double us)
{
    const double from = processor_us();
    for (int i = 0; i < 8; ++i)
        (void)distance_at(s, i / 8.0);
    const double one = (processor_us() - from) / 8;
    return us > one ? (int)(us / one) : 1;
}

static bool ask(session *s, uint32_t frame, counts *n)
{
    const double tolerance = TOLERANCE * s->scenario->length;
    mote_scenario_path_set(s->path, frame);
    const mote_impact_question question = {
        .path = {mote_scenario_path_of(s->path, 0), mote_scenario_path_of(s->path, 1)},
        .end = 1,
        .tolerance = tolerance};
    mote_impact_found found = {.iterations = 0};
    const double from = processor_us();
    if (mote_impact_query(s->search, &question, &found) != MOTE_OK)
        return false;
    const double us = processor_us() - from;
    if (distance_at(s, 0) <= tolerance) {
        ++n->started;
        n->missed += found.outcome != MOTE_IMPACT_FOUND || found.to > 0;
        return true;
    }
    double first, sampled;
    const bool impact = sampled_contact(s, SAMPLES, tolerance, &first);
    const bool hit = found.outcome == MOTE_IMPACT_FOUND;
    n->iterations[n->intervals] = found.iterations;
    n->us[n->intervals++] = us;
    n->undecided +=
        found.outcome == MOTE_IMPACT_GRAZING || found.outcome == MOTE_IMPACT_UNDECIDED;
    n->impacts += impact || hit;
    n->missed += (impact && found.outcome == MOTE_IMPACT_NONE) || first < found.from;
    n->wrong += hit && distance_at(s, found.to) > tolerance * (1 + 1e-12);
    n->widest = fmax(n->widest, hit ? found.to - found.from : 0);
    n->samples_missed +=
        (impact || hit) && !sampled_contact(s, samples_in(s, us), tolerance, &sampled);
    return true;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile(double *values, size_t count, double part)
{
    qsort(values, count, sizeof *values, ascending);
    return count > 0 ? mote_statistics_quantile(values, count, part) : 0;
}

/* A line of the table, and of the CSV file where there is one. */
static void print_row(FILE *out, const session *s, uint32_t step, counts *n)
{
    const double it[2] = {quantile(n->iterations, n->intervals, 0.5),
                          quantile(n->iterations, n->intervals, 0.95)};
    const double us[2] = {quantile(n->us, n->intervals, 0.5),
                          quantile(n->us, n->intervals, 0.95)};
    const char *name = s->scenario->name;
    printf("%-10s %4" PRIu32
           " %6zu %5zu %6zu %6zu %5zu %5zu %6zu  %8.1e %6.0f %6.0f %8.0f %8.0f\n",
           name, step, n->intervals, n->started, n->impacts, n->missed, n->wrong, n->undecided,
           n->samples_missed, n->widest, it[0], it[1], us[0], us[1]);
    if (out)
        (void)fprintf(out,
                      "%s,%" PRIu32 ",%zu,%zu,%zu,%zu,%zu,%zu,%zu,%.3g,%.4g,%.4g,%.4g,%.4g\n",
                      name, step, n->intervals, n->started, n->impacts, n->missed, n->wrong,
                      n->undecided, n->samples_missed, n->widest, it[0], it[1], us[0], us[1]);
}

static const char *const columns =
    "scenario,step,intervals,began_in_contact,impacts,missed,false,undecided,"
    "missed_by_samples,widest_bracket,iterations_median,iterations_p95,us_median,"
    "us_p95\n";

static mote_status open_step(session *s, uint32_t step)
{
    mote_impact_options options = mote_default_impact_options(s->scenario->length);
    mote_status status = mote_scenario_path_create(s->scenario, step, &s->path);
    if (status == MOTE_OK)
        status = mote_impact_create(s->bodies, &options, &s->search);
    return status;
}

static void close_step(session *s)
{
    mote_scenario_path_destroy(s->path);
    mote_impact_destroy(s->search);
    s->path = NULL;
    s->search = NULL;
}

/* Asks about at most `most` intervals, spread over the frames; false where that fails. */
static bool run_step(session *s, uint32_t step, uint32_t most, FILE *out, size_t *errors)
{
    static counts n;
    memset(&n, 0, sizeof n);
    const uint32_t frames = s->scenario->frames;
    if (frames <= step)
        return true;
    const uint32_t stride = (frames - step + most - 1) / most;
    bool good = open_step(s, step) == MOTE_OK;
    for (uint32_t frame = 1; good && frame + step <= frames; frame += stride)
        good = ask(s, frame, &n);
    close_step(s);
    if (!good)
        return false;
    print_row(out, s, step, &n);
    *errors += n.missed + n.wrong + (n.widest > 1.0001e-6);
    return true;
}

static mote_status open_scenario(const char *name, session *s)
{
    mote_status status = mote_scenario_load(name, &s->scenario);
    if (status != MOTE_OK)
        return status;
    for (int i = 0; i < 2; ++i) {
        s->bodies[i] = &s->scenario->body[i];
        s->weights[i] =
            mote_allocate(3 * (size_t)s->bodies[i]->field->padded + 1, sizeof(double));
    }
    const mote_certificate_options options =
        mote_default_certificate_options(s->scenario->length);
    return mote_certificate_create(s->bodies, &options, &s->certificate);
}

static void close_scenario(session *s)
{
    mote_certificate_destroy(s->certificate);
    free(s->weights[0]);
    free(s->weights[1]);
    mote_scenario_destroy(s->scenario);
}

static bool run_scenario(const char *name, uint32_t most, FILE *out, size_t *errors)
{
    session s = {.scenario = NULL};
    bool good = open_scenario(name, &s) == MOTE_OK;
    for (size_t i = 0; good && i < sizeof steps / sizeof steps[0]; ++i)
        good = run_step(&s, steps[i], most, out, errors);
    if (!good)
        fprintf(stderr, "impact_steps: %s\n", mote_error_text());
    close_scenario(&s);
    return good;
}

int main(int argc, char **argv)
{
    uint64_t most = 100;
    const char *path = NULL;
    int i = 1;
    for (; i + 1 < argc && strncmp(argv[i], "--", 2) == 0; i += 2) {
        if (strcmp(argv[i], "--out") == 0)
            path = argv[i + 1];
        else if (strcmp(argv[i], "--intervals") != 0 ||
                 !mote_read_unsigned(argv[i + 1], 1, INTERVALS_MOST, &most))
            break;
    }
    if (i >= argc || strncmp(argv[i], "--", 2) == 0) {
        (void)fprintf(stderr,
                      "usage: impact_steps [--intervals N] [--out FILE] SCENARIO ...\n");
        return 2;
    }
    FILE *out = path ? fopen(path, "w") : NULL;
    bool good = !path || (out && fputs(columns, out) >= 0);
    size_t errors = 0;
    printf("scenario   step  apart touch impact missed false undec sample   bracket     it    "
           "p95  "
           "     us      p95\n");
    for (; good && i < argc; ++i)
        good = run_scenario(argv[i], (uint32_t)most, out, &errors);
    if (out && fclose(out) != 0)
        good = false;
    if (!good && path)
        fprintf(stderr, "impact_steps: %s may not be complete\n", path);
    return good && errors == 0 ? 0 : 1;
}
