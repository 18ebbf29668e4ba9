/* make test-kill: kills a sweep (kill -9) at random times and restarts it each time until it is
   done; then does the same with another sweep, until there were enough kills. After each kill
   every finished cell must be there, whole and unchanged. Each sweep must end with the planned
   cells and with the summary of an uninterrupted one, times aside. make test has a few kills.

   kills DIR [KILLS [SEED [plant]]]: plant removes a row from a finished cell, which must be
   found. */
#include "harness/base/options.h"
#include "harness/base/record.h"
#include "tests/support/program.h"
#include "tests/support/run_files.h"

#include <math.h>
#include <signal.h>
#include <time.h>

#define FRAMES 20
#define CELLS 90
#define SWEEP                                                                                  \
    "run tt --frames 1-20 --stride 1 --replicates 30 --seed 3 --method particle-paper:n=2 "    \
    "--method fcl-aabb --method aabb-tree"
typedef struct study {
    const char *base;
    char directory[256], said[256], line[640];
    uint64_t random;
    uint64_t longest_us; /* the latest time after the start for a kill */
    unsigned kills, sweeps;
    bool plant;
    size_t survived; /* cells that were finished before a kill */
    run_files finished;
} study;

static bool fail(const study *s, const char *what)
{
    (void)printf("FAILED after %u kills: %s: %s\n", s->kills, s->directory, what);
    return false;
}

/* Uniform below limit (splitmix64). */
static uint64_t draw(study *s, uint64_t limit)
{
    uint64_t z = s->random += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (z ^ (z >> 31)) % limit;
}

/* Whether a key holds a time or is derived from times, as all ratios are. */
static bool is_time(const char *key)
{
    static const char *const names[] = {"quiet",          "noise_floor", "smallest_change",
                                        "rss_peak_bytes", "fronts",      "overhead"};
    size_t length = strlen(key);
    bool time =
        (length > 3 && strcmp(key + length - 3, "_ns") == 0) || strncmp(key, "ratio", 5) == 0;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i)
        time = time || strcmp(key, names[i]) == 0;
    return time;
}

/* The share by which heap bytes may differ: the allocator's sizes depend by some bytes on what
   its process has allocated before. */
#define HEAP_SHARE 2e-3

static bool same_values(const char *key, const json_t *a, const json_t *b)
{
    if (is_time(key))
        return true;
    if (json_is_number(a) && json_is_number(b)) {
        double x = json_number_value(a), y = json_number_value(b);
        double slack = strncmp(key, "heap_", 5) == 0 ? HEAP_SHARE * x : 0;
        return fabs(x - y) <= slack;
    }
    if (json_is_array(a) && json_is_array(b)) {
        bool same = json_array_size(a) == json_array_size(b);
        for (size_t i = 0; same && i < json_array_size(a); ++i)
            same = same_values(key, json_array_get(a, i), json_array_get(b, i));
        return same;
    }
    if (!json_is_object(a) || !json_is_object(b))
        return json_equal(a, b);
    bool same = json_object_size(a) == json_object_size(b);
    /* jansson's iterators take a mutable object. */
    union {
        const json_t *given;
        json_t *wanted;
    } object = {.given = a};
    const char *name;
    json_t *member;
    json_object_foreach(object.wanted, name, member)
    {
        const json_t *other = json_object_get(b, name);
        same = same && other && same_values(name, member, other);
    }
    return same;
}

static bool same_summaries(const char *a, const char *b)
{
    json_t *first = NULL, *second = NULL;
    bool same = mote_record_read_json(a, "summary.json", &first) == MOTE_OK &&
                mote_record_read_json(b, "summary.json", &second) == MOTE_OK &&
                same_values("", first, second);
    json_decref(first);
    json_decref(second);
    return same;
}

/* Removes the last row of the first finished cell, once. */
static bool plant_lost_row(study *s)
{
    if (!s->plant || s->finished.count == 0)
        return true;
    const run_file *cell = &s->finished.items[0];
    char path[640];
    (void)snprintf(path, sizeof path, "%s/cells/%.*s.csv", s->directory,
                   (int)(strlen(cell->name) - strlen(".json")), cell->name);
    size_t size = strlen(cell->csv) - 1;
    while (size > 0 && cell->csv[size - 1] != '\n')
        --size;
    s->plant = false;
    return mote_file_write(path, cell->csv, size) == MOTE_OK || fail(s, "no row to take away");
}

/* Starts the sweep and kills it at a random time. *done: it ended by itself before that. */
static bool kill_once(study *s, bool *done)
{
    const uint64_t us = draw(s, s->longest_us);
    const struct timespec pause = {(time_t)(us / 1000000), (long)(us % 1000000) * 1000};
    pid_t pid = program_start(s->line, s->said);
    int status = 0;
    if (pid < 0) /* kill(-1) would mean every process */
        return fail(s, "no process");
    (void)nanosleep(&pause, NULL);
    (void)kill(pid, SIGKILL);
    if (waitpid(pid, &status, 0) != pid)
        return fail(s, "no process");
    *done = WIFEXITED(status);
    if (*done && WEXITSTATUS(status) != 0)
        return fail(s, "a sweep that went on ended badly");
    s->kills += *done ? 0 : 1;
    if (!plant_lost_row(s))
        return false;
    const char *wrong = run_files_check(s->directory, FRAMES, &s->finished);
    return wrong ? fail(s, wrong) : true;
}

/* Runs the rest of the sweep to its end and checks the whole. */
static bool finish(study *s, const char *whole)
{
    if (program_wait(program_start(s->line, s->said)) != 0)
        return fail(s, "the last start ended badly");
    const char *wrong = run_files_check(s->directory, FRAMES, &s->finished);
    if (wrong)
        return fail(s, wrong);
    if (s->finished.count != CELLS || run_files_count(s->directory, ".csv") != CELLS)
        return fail(s, "not the cells that were planned");
    if (run_files_count(s->directory, ".part") != 0)
        return fail(s, "something else is left among the cells");
    return same_summaries(s->directory, whole) ? true : fail(s, "another summary");
}

static void name_directory(study *s, const char *name)
{
    (void)snprintf(s->directory, sizeof s->directory, "%s/%s", s->base, name);
    (void)snprintf(s->said, sizeof s->said, "%s/%s-said", s->base, name);
    (void)snprintf(s->line, sizeof s->line, SWEEP " --out %s", s->directory);
}

static bool one_sweep(study *s, unsigned kills, const char *whole)
{
    char name[32];
    bool done = false, good = true;
    (void)snprintf(name, sizeof name, "sweep-%u", ++s->sweeps);
    name_directory(s, name);
    while (good && !done && s->kills < kills)
        good = kill_once(s, &done);
    const size_t before = s->finished.count;
    s->survived += before;
    good = good && finish(s, whole);
    if (good)
        (void)printf("sweep %u: %zu cells, whole, none twice, %zu of them finished between "
                     "kills; %u kills so far\n",
                     s->sweeps, s->finished.count, before, s->kills);
    (void)fflush(stdout);
    run_files_free(&s->finished);
    return good;
}

/* The uninterrupted run. Kills come up to twice as late as its first cell: some before anything
   is measured, more while cells are measured and written. */
static bool run_whole(study *s)
{
    struct timespec from, to;
    const struct timespec pause = {0, 1000000};
    name_directory(s, "whole");
    if (run_files_count(s->directory, ".json") != 0)
        return fail(s, "an older run is there");
    (void)clock_gettime(CLOCK_MONOTONIC, &from);
    pid_t pid = program_start(s->line, s->said);
    while (run_files_count(s->directory, ".json") == 0 && waitpid(pid, NULL, WNOHANG) == 0)
        (void)nanosleep(&pause, NULL);
    (void)clock_gettime(CLOCK_MONOTONIC, &to);
    s->longest_us = 2 * ((uint64_t)(to.tv_sec - from.tv_sec) * 1000000 +
                         (uint64_t)(to.tv_nsec / 1000) - (uint64_t)(from.tv_nsec / 1000));
    (void)waitpid(pid, NULL, 0);
    bool good = finish(s, s->directory);
    run_files_free(&s->finished);
    return good;
}

int main(int argc, char **argv)
{
    uint64_t kills = 200, seed = 1;
    if (argc < 2 || argc > 5 || (argc > 2 && !mote_read_unsigned(argv[2], 1, 100000, &kills)) ||
        (argc > 3 && !mote_read_unsigned(argv[3], 0, UINT32_MAX, &seed)) ||
        (argc > 4 && strcmp(argv[4], "plant") != 0)) {
        (void)fprintf(stderr, "usage: kills DIR [KILLS [SEED [plant]]]\n");
        return MOTE_EXIT_USAGE;
    }
    char whole[256];
    study s = {.base = argv[1], .random = seed, .plant = argc > 4};
    if (mote_directory_make(argv[1]) != MOTE_OK)
        return mote_command_fail();
    bool good = run_whole(&s);
    memcpy(whole, s.directory, sizeof whole);
    while (good && s.kills < kills)
        good = one_sweep(&s, (unsigned)kills, whole);
    if (good && s.survived == 0)
        good = fail(&s, "no cell was finished between kills: nothing was tried");
    (void)printf(
        "%s: %u kills within %.2f s of the start, %u sweeps, %zu cells finished between "
        "kills\n",
        good ? "nothing lost" : "FAILED", s.kills, (double)s.longest_us * 1e-6, s.sweeps,
        s.survived);
    return good ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED;
}
