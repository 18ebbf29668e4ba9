/* One hash over the answers of our methods on the built-in scenarios of two bodies: distance,
   lower bound, witnesses and contact of 24 frames each, in eight leaps of three frames. A
   second hash covers their counts (core/method/method.h), that is, how they got there. Every
   compiler, optimisation, number of threads and repetition must give the same bits.

   answers [--few] [--scenario NAME] [--runs N] [--threads K] [--check FILE]
   prints a line {scenario, method, hash, hash of counts} each, and one over all. --check:
   compares with FILE; exit status 1 where a line differs. --threads: K jobs run at once, each
   a scenario and a method of its own. --few: 24 small scenarios, and their lines, in a second
   instead of half a minute. --scenario: of this one. If you change a method on
   purpose, renew tests/answers.txt from the whole output once make determinism agrees on it. */
#include "harness/scene/catalog.h"
#include "harness/base/method_choice.h"
#include "harness/base/options.h"
#include "harness/base/file.h"
#include "harness/base/hash.h"
#include "harness/engine/engine.h"
#include "harness/scene/scenario.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const methods[] = {"certified", "stream", "auto", "particle:n=8",
                                      "particle-paper:n=5"};
/* Left out: these are built in minutes, and are ww again. */
static const char *const large[] = {"ww-100k", "ww-1m", "ww-10m"};
/* Answered within a twentieth of a second each; hands and hand-shapes are characters. */
static const char *const few[] = {
    "comb",     "far",    "fast-5", "flat",     "hand-shapes", "hands",
    "islands",  "morph",  "mv",     "rigid-mv", "rigid-ww",    "shell",
    "sliver-3", "spider", "still",  "touch",    "tt",          "tt-distance",
    "tw",       "twist",  "vv",     "ww",       "ww-1k",       "ww-contact"};

enum {
    METHODS = sizeof methods / sizeof methods[0],
    LARGE = sizeof large / sizeof large[0],
    FEW = sizeof few / sizeof few[0],
    LEAPS = 8,
    STEPS = 3,
    THREADS_MAX = 64
};

typedef struct job {
    const mote_scenario *scenario;
    const char *method;
    uint64_t hash, counts;
    mote_status status; /* a refusal is part of the answer, too */
} job;

typedef struct work {
    job *jobs;
    size_t count, next;
    pthread_mutex_t lock;
} work;

static void hash_answer(uint64_t *hash, const mote_answer *a)
{
    *hash = mote_hash_word(*hash, (uint64_t)a->has_distance | (uint64_t)a->has_lower << 1 |
                                      (uint64_t)a->has_witness << 2 |
                                      (uint64_t)a->has_contact << 3 |
                                      (uint64_t)(a->has_contact && a->contact) << 4);
    if (a->has_distance)
        *hash = mote_hash_double(*hash, a->distance);
    if (a->has_lower)
        *hash = mote_hash_double(*hash, a->lower);
    for (int k = 0; a->has_witness && k < 2; ++k) {
        *hash = mote_hash_double(*hash, a->witness[k].x);
        *hash = mote_hash_double(*hash, a->witness[k].y);
        *hash = mote_hash_double(*hash, a->witness[k].z);
    }
}

static void hash_counts(uint64_t *hash, const mote_counters *c)
{
#define HASH_COUNT(name) *hash = mote_hash_word(*hash, c->name);
    MOTE_COUNTERS(HASH_COUNT)
    MOTE_COUNTERS_MORE(HASH_COUNT)
#undef HASH_COUNT
}

static mote_status answer_frames(job *j, mote_engine *probe, mote_frame_buffer *buffer)
{
    const uint32_t frames = j->scenario->frames;
    mote_status status = MOTE_OK;
    uint32_t previous = 0;
    for (uint32_t k = 0; k < LEAPS * STEPS && status == MOTE_OK; ++k) {
        uint32_t number = 1 + (uint32_t)((uint64_t)(frames - 1) * (k / STEPS) / LEAPS);
        number = number + k % STEPS <= frames ? number + k % STEPS : frames;
        const mote_frame *frame = mote_scenario_frame(j->scenario, buffer, number, previous);
        mote_answer answer;
        status = mote_engine_answer(probe, frame, &answer);
        if (status == MOTE_OK) {
            hash_answer(&j->hash, &answer);
            hash_counts(&j->counts, &answer.counters);
        }
        previous = number;
    }
    return status;
}

static void answer(job *j)
{
    j->hash = j->counts = MOTE_HASH_START;
    mote_method_choice choice;
    mote_frame_buffer *buffer = NULL;
    mote_engine *probe = NULL;
    mote_status status = mote_method_choice_read(j->method, &choice);
    if (status == MOTE_OK)
        buffer = mote_frame_buffer_create(j->scenario);
    if (status == MOTE_OK)
        status = mote_engine_open_two(&j->scenario->body[0], &j->scenario->body[1], &choice,
                                      j->scenario->ask, j->scenario->tolerance, 1, &probe);
    if (status == MOTE_OK)
        status = answer_frames(j, probe, buffer);
    j->hash = mote_hash_word(j->hash, status);
    j->status = status;
    mote_engine_destroy(probe);
    mote_frame_buffer_destroy(buffer);
}

static void *answer_jobs(void *context)
{
    work *w = context;
    for (;;) {
        (void)pthread_mutex_lock(&w->lock);
        const size_t k = w->next < w->count ? w->next++ : w->count;
        (void)pthread_mutex_unlock(&w->lock);
        if (k == w->count)
            return NULL;
        answer(&w->jobs[k]);
    }
}

static mote_status answer_all(work *w, uint64_t threads)
{
    pthread_t thread[THREADS_MAX];
    uint64_t started = 0;
    w->next = 0;
    while (started < threads && pthread_create(&thread[started], NULL, answer_jobs, w) == 0)
        ++started;
    for (uint64_t k = 0; k < started; ++k)
        (void)pthread_join(thread[k], NULL);
    return started == threads ? MOTE_OK : mote_fail(MOTE_EIO, "cannot start a thread");
}

static bool is_among(const char *const *names, int count, const char *name)
{
    bool found = false;
    for (int k = 0; k < count; ++k)
        found = found || strcmp(name, names[k]) == 0;
    return found;
}

typedef struct options {
    uint64_t runs, threads;
    const char *check;        /* NULL: nothing to compare with */
    const char *const *names; /* of scenarios; NULL: all */
    int count;
} options;

/* Loads the scenarios one by one; each makes a job for every method. */
static mote_status load(const mote_catalog *catalog, const options *o,
                        mote_scenario **scenarios, work *w)
{
    mote_status status = MOTE_OK;
    size_t loaded = 0;
    for (size_t k = 0; k < catalog->count && status == MOTE_OK; ++k) {
        const char *name = catalog->entries[k].name;
        if (catalog->entries[k].several || is_among(large, LARGE, name) ||
            (o->names && !is_among(o->names, o->count, name)))
            continue;
        status = mote_scenario_load(name, &scenarios[loaded]);
        for (int m = 0; m < METHODS && status == MOTE_OK; ++m)
            w->jobs[w->count++] = (job){.scenario = scenarios[loaded], .method = methods[m]};
        loaded += status == MOTE_OK;
    }
    if (status == MOTE_OK && o->names && loaded != (size_t)o->count)
        status = mote_fail(MOTE_EINVAL, "%zu of the %d scenarios asked for are here", loaded,
                           o->count);
    return status;
}

/* The lines to print, as one text; the caller frees it. */
static char *report(const work *w)
{
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    if (!file)
        return NULL;
    uint64_t all = MOTE_HASH_START;
    for (size_t k = 0; k < w->count; ++k) {
        (void)fprintf(file, "%s %s %016" PRIx64 " %016" PRIx64 "%s\n",
                      w->jobs[k].scenario->name, w->jobs[k].method, w->jobs[k].hash,
                      w->jobs[k].counts, w->jobs[k].status == MOTE_OK ? "" : " refused");
        all = mote_hash_word(mote_hash_word(all, w->jobs[k].hash), w->jobs[k].counts);
    }
    (void)fprintf(file, "all %zu %016" PRIx64 "\n", w->count, all);
    return fclose(file) == 0 ? text : (free(text), NULL);
}

/* Prints the lines of text that are not in expected; returns true if there are none, and, of
   all scenarios and methods, nothing else is in expected. */
static bool compare(const char *text, const char *expected, bool all)
{
    bool same = !all || strcmp(text, expected) == 0;
    const char *last = strstr(text, "\nall ") + 1;
    for (const char *line = text; line < last; line = strchr(line, '\n') + 1) {
        const int length = (int)(strchr(line, '\n') - line) + 1;
        char *copy = mote_format("%.*s", length, line);
        if (copy && !strstr(expected, copy)) {
            (void)printf("differs: %s", copy);
            same = false;
        }
        free(copy);
    }
    if (!same)
        (void)printf("answers changed; when that was wanted: build/tests/answers > "
                     "tests/answers.txt\n");
    return same;
}

static void ask(options *o, const char *const *names, int count)
{
    o->names = names;
    o->count = count;
}

static bool read_options(int argc, char **argv, options *o)
{
    const bool asks_few = argc > 1 && strcmp(argv[1], "--few") == 0;
    const int first = asks_few ? 2 : 1;
    if (asks_few)
        ask(o, few, FEW);
    bool good = (argc - first) % 2 == 0;
    for (int i = first; i + 1 < argc && good; i += 2) {
        if (strcmp(argv[i], "--check") == 0)
            o->check = argv[i + 1];
        else if (strcmp(argv[i], "--scenario") == 0)
            ask(o, (const char *const *)&argv[i + 1], 1);
        else if (strcmp(argv[i], "--runs") == 0)
            good = mote_read_unsigned(argv[i + 1], 1, 1000000, &o->runs);
        else
            good = strcmp(argv[i], "--threads") == 0 &&
                   mote_read_unsigned(argv[i + 1], 1, THREADS_MAX, &o->threads);
    }
    if (!good)
        (void)fprintf(stderr,
                      "usage: answers [--few] [--scenario NAME] [--runs N] [--threads K] "
                      "[--check FILE]\n");
    return good;
}

/* Does all runs. *same: each gave what the first gave, or what --check names. */
static mote_status run(const options *o, work *w, bool *same)
{
    char *first = NULL;
    size_t size;
    mote_status status = MOTE_OK;
    *same = true;
    if (o->check)
        status = mote_file_read(o->check, 1 << 20, &first, &size);
    for (uint64_t k = 0; k < o->runs && status == MOTE_OK; ++k) {
        status = answer_all(w, o->threads);
        char *text = status == MOTE_OK ? report(w) : NULL;
        if (status == MOTE_OK && !text)
            status = mote_fail(MOTE_ENOMEM, "no memory for a report");
        if (text && k == 0)
            (void)fputs(o->check ? strstr(text, "\nall ") + 1 : text, stdout);
        if (text && first)
            *same = compare(text, first, !o->names) && *same;
        if (!first)
            first = text;
        else
            free(text);
    }
    free(first);
    return status;
}

int main(int argc, char **argv)
{
    options o = {.runs = 1, .threads = 1};
    if (!read_options(argc, argv, &o))
        return MOTE_EXIT_USAGE;
    mote_catalog catalog = {0};
    work w = {.lock = PTHREAD_MUTEX_INITIALIZER};
    mote_status status = mote_catalog_read(&catalog);
    mote_scenario **scenarios = calloc(catalog.count + 1, sizeof *scenarios);
    w.jobs = calloc(METHODS * catalog.count + 1, sizeof *w.jobs);
    if (status == MOTE_OK && (!scenarios || !w.jobs))
        status = mote_fail(MOTE_ENOMEM, "no memory for the scenarios");
    bool same = false;
    if (status == MOTE_OK)
        status = load(&catalog, &o, scenarios, &w);
    if (status == MOTE_OK)
        status = run(&o, &w, &same);
    if (status != MOTE_OK)
        (void)fprintf(stderr, "answers: %s\n", mote_error_text());
    for (size_t k = 0; scenarios && k < catalog.count; ++k)
        mote_scenario_destroy(scenarios[k]);
    free(scenarios);
    free(w.jobs);
    mote_catalog_free(&catalog);
    return status != MOTE_OK ? MOTE_EXIT_BAD_INPUT
           : same            ? MOTE_EXIT_DONE
                             : MOTE_EXIT_CHECK_FAILED;
}
