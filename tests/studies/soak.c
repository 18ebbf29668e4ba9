/* make soak: random scenarios, each frame answered by our methods and judged by the truth. A
   case that fails is shrunk and kept as DIR/cases/SEED.json; to make it a test, put it into
   tests/cases, with mesh paths relative to there. Usage: soak [--hours H | --cases N] [--seed
   S] [--out DIR] [--checks FILE] [--plant], or soak --replay FILE...: S is the first case's
   seed; DIR/soak.json has each method's errors by decades; --plant alters two
   answers of the first case, which must then be found. Exit status 1 where something failed. */
#include "tests/support/checks.h"

#include "harness/base/options.h"
#include "tests/studies/soak_case.h"
#include "tests/studies/soak_judge.h"
#include "tests/studies/soak_shrink.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

typedef struct soak {
    double hours;
    uint64_t cases, seed;
    const char *out, *checks;
    bool plant;
    uint64_t tried, refused, failed, settled;
    uint64_t otherwise; /* failures other than of a certified answer */
    soak_tally sum[SOAK_METHODS];
} soak;

static void add(soak *s, const soak_verdict *verdict)
{
    s->settled += verdict->settled;
    for (int m = 0; m < SOAK_METHODS; ++m) {
        soak_tally *sum = &s->sum[m];
        const soak_tally *one = &verdict->tally[m];
        sum->queries += one->queries;
        sum->wrong += one->wrong;
        sum->violated += one->violated;
        sum->missed += one->missed;
        sum->false_contacts += one->false_contacts;
        sum->largest = one->largest > sum->largest ? one->largest : sum->largest;
        sum->loosest = one->loosest > sum->loosest ? one->loosest : sum->loosest;
        for (int k = 0; k < SOAK_DECADES; ++k)
            sum->decades[k] += one->decades[k];
    }
}

/* Reports what failed, shrinks the case and keeps its file. */
static mote_status keep(soak *s, uint64_t seed, json_t *scenario, const char *path,
                        mote_status failure, soak_plant plant, soak_verdict verdict)
{
    ++s->failed;
    fprintf(stderr, "soak: case %" PRIu64 " fails%s%s\n", seed, failure == MOTE_OK ? "" : ": ",
            failure == MOTE_OK ? "" : mote_error_text());
    mote_status status = soak_shrink(scenario, path, &plant, &verdict);
    for (int m = 0; m < SOAK_METHODS; ++m) {
        const soak_tally *t = &verdict.tally[m];
        if (t->wrong + t->violated > 0)
            fprintf(stderr,
                    "soak: case %" PRIu64
                    ": %s at frame %u: error %.3g L, lower bound %.3g L below%s\n",
                    seed, soak_methods[m], verdict.failed_frame, t->largest, t->loosest,
                    t->violated ? ", or above the truth" : "");
    }
    fprintf(stderr, "soak: case %" PRIu64 ": shrunk to %s\n", seed, path);
    return status;
}

/* Whether a case failed by something that the counts of certified answers do not include. */
static bool fails_otherwise(mote_status judged, const soak_verdict *verdict)
{
    bool wrong = judged == MOTE_EIO;
    for (int m = SOAK_EXACT - 1; judged == MOTE_OK && m < SOAK_METHODS; ++m)
        wrong = wrong || verdict->tally[m].wrong + verdict->tally[m].violated > 0;
    return wrong;
}

static mote_status run_case(soak *s, uint64_t seed)
{
    char path[4096];
    (void)snprintf(path, sizeof path, "%s/cases/%" PRIu64 ".json", s->out, seed);
    json_t *scenario = soak_case_make(seed, MOTE_SOURCE_DIR "/datasets/meshes");
    if (!scenario)
        return mote_fail(MOTE_ENOMEM, "no memory for case %" PRIu64, seed);
    const soak_plant plant = {s->plant && s->tried == 0 ? 17 : 0};
    soak_verdict verdict;
    mote_status status = soak_case_write(scenario, path);
    mote_status judged =
        status == MOTE_OK ? soak_judge(path, &plant, false, &verdict) : MOTE_OK;
    if (status == MOTE_OK) {
        ++s->tried;
        s->refused += judged != MOTE_OK && judged != MOTE_EIO;
        s->otherwise += fails_otherwise(judged, &verdict);
        add(s, &verdict);
        if (soak_failed(judged, &verdict))
            status = keep(s, seed, scenario, path, judged, plant, verdict);
        else if (remove(path) != 0)
            status = mote_fail(MOTE_EIO, "cannot remove %s: %s", path, strerror(errno));
    }
    json_decref(scenario);
    return status;
}

/* The sum over all certified methods, which do not include the truth. */
static soak_tally certified_sum(const soak *s)
{
    soak_tally sum = {0};
    for (int m = 0; m < SOAK_EXACT - 1; ++m) {
        sum.queries += s->sum[m].queries;
        sum.wrong += s->sum[m].wrong;
        sum.violated += s->sum[m].violated;
    }
    return sum;
}

static bool add_checks(const soak *s)
{
    const soak_tally certified = certified_sum(s), *bounded = &s->sum[SOAK_BOUNDED];
    return checks_add(s->checks, "random scenarios: certified beyond 1e-12 L of the truth",
                      certified.queries - bounded->queries, certified.wrong - bounded->wrong) &&
           checks_add(s->checks, "random scenarios: a bracket that does not hold the truth",
                      bounded->queries, bounded->wrong + bounded->violated) &&
           checks_add(s->checks, "random scenarios: a lower bound above the truth",
                      certified.queries, certified.violated) &&
           checks_add(s->checks, "random scenarios: crashes, hangs, particles below the truth",
                      s->tried, s->otherwise);
}

static mote_status write_json(const soak *s)
{
    json_t *methods = json_array();
    for (int m = 0; m < SOAK_METHODS; ++m) {
        const soak_tally *t = &s->sum[m];
        json_t *decades = json_array();
        for (int k = 0; k < SOAK_DECADES; ++k)
            json_array_append_new(decades, json_integer((json_int_t)t->decades[k]));
        json_array_append_new(
            methods, json_pack("{s:s, s:I, s:I, s:I, s:I, s:I, s:f, s:f, s:o}", "method",
                               soak_methods[m], "queries", (json_int_t)t->queries, "wrong",
                               (json_int_t)t->wrong, "violated", (json_int_t)t->violated,
                               "missed", (json_int_t)t->missed, "false_contacts",
                               (json_int_t)t->false_contacts, "largest_error", t->largest,
                               "loosest_bound", t->loosest, "decades", decades));
    }
    json_t *root =
        json_pack("{s:I, s:I, s:I, s:I, s:I, s:o}", "seed", (json_int_t)s->seed, "cases",
                  (json_int_t)s->tried, "refused", (json_int_t)s->refused, "failed",
                  (json_int_t)s->failed, "settled", (json_int_t)s->settled, "methods", methods);
    char path[4096];
    (void)snprintf(path, sizeof path, "%s/soak.json", s->out);
    const int written = root ? json_dump_file(root, path, JSON_INDENT(2)) : -1;
    json_decref(root);
    return written == 0 ? MOTE_OK : mote_fail(MOTE_EIO, "cannot write %s", path);
}

static void print(const soak *s)
{
    const soak_tally certified = certified_sum(s);
    printf("%" PRIu64 " cases (%" PRIu64 " refused), %" PRIu64 " certified queries: %" PRIu64
           " wrong, %" PRIu64 " bounds above the truth; %" PRIu64
           " frames settled by 113 bits\n",
           s->tried, s->refused, certified.queries, certified.wrong, certified.violated,
           s->settled);
    printf("%-34s %10s %6s %9s %8s %8s %9s %9s %9s\n", "method", "queries", "wrong", "violated",
           "missed", "false", "exact", "largest", "loosest");
    for (int m = 0; m < SOAK_METHODS; ++m) {
        const soak_tally *t = &s->sum[m];
        uint64_t exact = 0;
        for (int k = 0; k <= 4; ++k)
            exact += t->decades[k];
        printf("%-34s %10" PRIu64 " %6" PRIu64 " %9" PRIu64 " %8" PRIu64 " %8" PRIu64
               " %8.3f%% %9.2e %9.2e\n",
               soak_methods[m], t->queries, t->wrong, t->violated, t->missed, t->false_contacts,
               t->queries ? 100.0 * (double)exact / (double)t->queries : 0, t->largest,
               t->loosest);
    }
}

static bool read_options(int argc, char **argv, soak *s)
{
    for (int i = 1; i < argc; ++i) {
        if (strcmp(argv[i], "--plant") == 0) {
            s->plant = true;
            continue;
        }
        if (i + 1 == argc)
            return false;
        char *value = argv[i + 1];
        bool known = true;
        if (strcmp(argv[i], "--hours") == 0)
            known = mote_read_real(value, 0, 1e6, &s->hours);
        else if (strcmp(argv[i], "--cases") == 0)
            known = mote_read_unsigned(value, 1, UINT64_MAX, &s->cases);
        else if (strcmp(argv[i], "--seed") == 0)
            known = mote_read_unsigned(value, 0, UINT64_MAX, &s->seed);
        else if (strcmp(argv[i], "--out") == 0)
            s->out = value;
        else if (strcmp(argv[i], "--checks") == 0)
            s->checks = value;
        else
            known = false;
        if (!known)
            return false;
        ++i;
    }
    return s->hours > 0 || s->cases > 0;
}

/* Judges kept cases again. */
static int replay(int count, char **paths)
{
    int failed = 0;
    for (int i = 0; i < count; ++i) {
        soak_verdict verdict;
        const mote_status status = soak_judge(paths[i], NULL, false, &verdict);
        const bool bad = status != MOTE_OK || verdict.failed_frame > 0;
        printf("%s: %s\n", paths[i], bad ? "fails" : "right");
        if (status != MOTE_OK)
            fprintf(stderr, "soak: %s\n", mote_error_text());
        failed += bad;
    }
    return failed == 0 ? 0 : 1;
}

static mote_status make_folder(const char *path)
{
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return mote_fail(MOTE_EIO, "cannot make %s: %s", path, strerror(errno));
    return MOTE_OK;
}

int main(int argc, char **argv)
{
    soak s = {.seed = 1, .out = "."};
    if (argc > 2 && strcmp(argv[1], "--replay") == 0)
        return replay(argc - 2, argv + 2);
    if (!read_options(argc, argv, &s)) {
        fprintf(stderr, "usage: soak --hours H | --cases N [--seed S] [--out DIR] [--checks "
                        "FILE] [--plant]\n       soak --replay FILE...\n");
        return 2;
    }
    char cases[4096];
    (void)snprintf(cases, sizeof cases, "%s/cases", s.out);
    mote_status status = make_folder(s.out);
    if (status == MOTE_OK)
        status = make_folder(cases);
    const time_t begin = time(NULL);
    for (uint64_t k = 0; status == MOTE_OK; ++k) {
        if (s.cases > 0 ? k >= s.cases : difftime(time(NULL), begin) >= 3600 * s.hours)
            break;
        status = run_case(&s, s.seed + k);
    }
    if (status == MOTE_OK)
        status = write_json(&s);
    if (status != MOTE_OK) {
        fprintf(stderr, "soak: %s\n", mote_error_text());
        return 4;
    }
    print(&s);
    if (!add_checks(&s))
        return 4;
    if (s.sum[0].queries == 0)
        fprintf(stderr, "soak: every case was refused: nothing was tried\n");
    return s.failed == 0 && s.sum[0].queries > 0 ? 0 : 1;
}
