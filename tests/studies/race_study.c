/* make perf-study: how often the verdicts of a race are wrong, and how long races take.

   race_study run PROGRAMS OUT RACES PLANTED [ONLY]   races builds of race_planted (PROGRAMS/a
   and PROGRAMS/b: folders of them, all linked in different orders) against each other: RACES
   times unchanged, and PLANTED times with each slowdown; each on the machine as it is and
   beside a compiler on the other core. ONLY: words PLACE:PER_CENT, such as "idle:2 compiler:5",
   and no other races (0: unchanged). Each race adds a line to OUT/races.csv; a race that has
   its line is not run again.

   race_study table RACES.csv BASE   prints the shares as a table, and writes BASE.dat for
   plots/power.gp */
#include "harness/base/clock.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/process/child.h"
#include "harness/process/load.h"
#include "harness/process/spawn.h"
#include "harness/race/race.h"
#include "harness/run/cell_process.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define HEADER                                                                                 \
    "place,plant,per_cent,number,slower,faster,same,undecided,named_alone,ratio,ci_low,"       \
    "ci_high,pairs,seconds,busy_cores\n"
#define FILE_LIMIT ((size_t)1 << 26)
#define UNCHANGED_A_ROUND 5 /* unchanged races per planted race of a kind, as 200 to 40 */

static const char *const places[] = {"idle", "compiler", "busy"};
static const char *const place_titles[] = {"idle", "beside a compiler", "busy machine"};
#define PLACES_RACED 2
#define PLACES 3
/* If other processes keep more than this many cores busy before or after a race, the race is
   recorded as one of a busy machine, whatever it was meant to be, and run again later. */
#define BUSY_CORES 0.25
/* Time for the compiler to finish what it had begun. */
#define COMPILATION_SECONDS 3
static const int sizes[] = {1, 2, 3, 5, 10}; /* per cent */
#define SIZES (sizeof sizes / sizeof sizes[0])

/* What is slowed down, and the row that has to be named. */
typedef struct kind {
    const char *name, *plant;
    size_t row;
    bool slows_all; /* the other row, too */
} kind;
static const kind kinds[] = {{"certified query", "slow:certified", 0, false},
                             {"particle sweep", "slow:particle-paper", 1, false},
                             {"clock path", "clock", 0, true}};
#define KINDS (sizeof kinds / sizeof kinds[0])

static const mote_race_cell cells[] = {
    {.scenario = "ww", .method = "certified", .first = 950, .last = 1149, .seed = 1},
    {.scenario = "ww",
     .method = "particle-paper:start=fps,n=5",
     .first = 950,
     .last = 1149,
     .seed = 1}};
#define CELLS (sizeof cells / sizeof cells[0])
#define CERTIFIED 0 /* the cell whose frames the clock path's shares are of */

typedef struct study {
    const char *programs, *out;
    const char *only; /* words PLACE:PER_CENT; "": all */
    mote_text lines;  /* of races.csv */
    double frame_ns;  /* of CERTIFIED in the last race, with nothing planted; 0: no race yet */
} study;

/* Makes a folder of wrappers that run the programs of a side with something planted, and finds
   them. */
static mote_status make_racers(const study *s, const char *side, const char *plant,
                               mote_race_builds *builds)
{
    mote_race_builds programs = {.count = 0};
    char *own = mote_format("%s/%s", s->programs, side);
    char *folder = mote_format("%s/racers/%s", s->out, side);
    mote_status status = mote_race_builds_find(own, &programs);
    if (status == MOTE_OK)
        status = mote_directory_make(folder);
    for (size_t i = 0; status == MOTE_OK && i < programs.count; ++i) {
        char *path = mote_format("%s/%02zu", folder, i);
        char *text =
            mote_format("#!/bin/sh\nMOTE_PLANT=%s exec '%s' \"$@\"\n", plant, programs.path[i]);
        status = mote_file_write(path, text, strlen(text));
        if (status == MOTE_OK && chmod(path, 0755) != 0)
            status = mote_fail(MOTE_EIO, "%s: cannot be made a program", path);
        free(path);
        free(text);
    }
    if (status == MOTE_OK)
        status = mote_race_builds_find(folder, builds);
    free(folder);
    free(own);
    mote_race_builds_free(&programs);
    return status;
}

/* Compiles on the other core, again and again. */
static mote_status compile(void *context, int output)
{
    static const char *const argv[] = {"cc",
                                       "-std=c17",
                                       "-O3",
                                       "-D_POSIX_C_SOURCE=200809L",
                                       "-I" MOTE_SOURCE_DIR,
                                       "-c",
                                       "-o",
                                       "/dev/null",
                                       MOTE_SOURCE_DIR "/core/certificate/certificate_query.c",
                                       NULL};
    (void)context;
    (void)output;
    mote_status status = MOTE_OK;
    if (mote_process_core() > 0)
        mote_process_pin(mote_process_core() - 1);
    while (status == MOTE_OK)
        status = mote_spawn_quiet(argv, NULL);
    return status;
}

/* The line of a race: place, key, verdicts of both rows, the named row's ratio. */
static void add_line(study *s, const char *place, const char *key, const mote_race *race,
                     size_t named, double busy)
{
    size_t verdicts[4] = {0};
    for (size_t i = 0; i < race->count; ++i)
        ++verdicts[race->rows[i].verdict];
    const mote_race_row *row = &race->rows[named];
    const bool alone =
        row->verdict == MOTE_VERDICT_SLOWER && verdicts[MOTE_VERDICT_SLOWER] == 1;
    mote_text_add(&s->lines, "%s,%s,%zu,%zu,%zu,%zu,%d,%.5f,%.5f,%.5f,%zu,%.1f,%.2f\n", place,
                  key, verdicts[MOTE_VERDICT_SLOWER], verdicts[MOTE_VERDICT_FASTER],
                  verdicts[MOTE_VERDICT_SAME], verdicts[MOTE_VERDICT_UNDECIDED],
                  row->verdict == MOTE_VERDICT_SLOWER ? 1 + alone : 0, row->ratio,
                  row->interval.low, row->interval.high, race->pairs, race->seconds, busy);
}

/* Makes the programs of both sides, and races them; place 1: beside a compiler. */
static mote_status race_planted(study *s, size_t place, const kind *k, int size,
                                mote_race *race)
{
    char *plant = strcmp(k->plant, "clock") == 0
                      ? mote_format("clock:%.0f", 0.01 * size * s->frame_ns)
                      : mote_format("%s:%.3f", k->plant, 0.01 * size);
    char *none = mote_format("%s:0", k->plant);
    mote_race_builds builds[MOTE_RACE_SIDES] = {{.count = 0}, {.count = 0}};
    mote_child compiler = {.pid = 0};
    mote_status status = make_racers(s, "a", none, &builds[0]);
    if (status == MOTE_OK)
        status = make_racers(s, "b", plant, &builds[1]);
    if (place == 1 && status == MOTE_OK)
        status = mote_child_start(compile, NULL, (mote_child_limits){.seconds = 0}, &compiler);
    const mote_race_options options = {.builds = {&builds[0], &builds[1]},
                                       .cells = cells,
                                       .cell_count = CELLS,
                                       .until = 0.01,
                                       .real = 0.01,
                                       .budget = 300,
                                       .timeout = 120,
                                       .seed = mote_clock_ns()};
    if (status == MOTE_OK)
        status = mote_race_run(&options, race);
    if (status == MOTE_OK)
        s->frame_ns = race->rows[CERTIFIED].total_ns[0];
    if (compiler.pid > 0) {
        mote_child_stop(&compiler, 1);
        (void)sleep(COMPILATION_SECONDS);
    }
    mote_child_release(&compiler);
    for (int side = 0; side < MOTE_RACE_SIDES; ++side)
        mote_race_builds_free(&builds[side]);
    free(plant);
    free(none);
    return status;
}

/* Races unchanged programs for the time of a frame, which no other race has measured yet. */
static mote_status measure_frame(study *s, size_t place)
{
    mote_race race;
    const mote_status status = race_planted(s, place, &kinds[0], 0, &race);
    if (status == MOTE_OK)
        mote_race_free(&race);
    return status;
}

/* Races, and adds the line of the race to the file. */
static mote_status race_and_store(study *s, size_t place, const kind *k, int size,
                                  const char *key)
{
    mote_status status = s->frame_ns > 0 ? MOTE_OK : measure_frame(s, place);
    double busy = mote_busy_cores();
    mote_race race;
    if (status == MOTE_OK)
        status = race_planted(s, place, k, size, &race);
    if (status != MOTE_OK)
        return status;
    char *path = mote_format("%s/races.csv", s->out);
    busy = fmax(busy, mote_busy_cores());
    add_line(s, places[busy > BUSY_CORES ? PLACES_RACED : place], key, &race, k->row, busy);
    status = mote_file_write(path, s->lines.data, s->lines.size);
    (void)printf("%s,%s: %s %.4f, %zu pairs, %.0f s, %.1f other cores busy\n", places[place],
                 key, mote_verdict_names[race.rows[k->row].verdict], race.rows[k->row].ratio,
                 race.pairs, race.seconds, busy);
    (void)fflush(stdout);
    free(path);
    mote_race_free(&race);
    return status;
}

/* Whether a list of words has PLACE:PER_CENT. */
static bool names_race(const char *words, size_t place, int size)
{
    char *list = mote_format(" %s ", words);
    char *word = mote_format(" %s:%d ", places[place], size);
    const bool found = strstr(list, word) != NULL;
    free(list);
    free(word);
    return found;
}

static mote_status check_only(const char *words)
{
    size_t known = 0, given = 0;
    for (size_t place = 0; place < PLACES_RACED; ++place) {
        known += names_race(words, place, 0);
        for (size_t i = 0; i < SIZES; ++i)
            known += names_race(words, place, sizes[i]);
    }
    for (const char *c = words; *c; ++c)
        given += *c != ' ' && (c == words || c[-1] == ' ');
    return known == given
               ? MOTE_OK
               : mote_fail(
                     MOTE_EINVAL,
                     "ONLY=\"%s\": write different words of idle or compiler, a colon, and "
                     "0, 1, 2, 3, 5 or 10 per cent, such as \"idle:2 compiler:5\"",
                     words);
}

/* Races once, unless its line exists or it is not asked for. size 0: unchanged. */
static mote_status race_once(study *s, size_t place, const kind *k, int size, uint64_t number)
{
    if (*s->only && !names_race(s->only, place, size))
        return MOTE_OK;
    char *key = mote_format("%s,%d,%" PRIu64, size ? k->name : "none", size, number);
    char *begins = mote_format("\n%s,%s,", places[place], key);
    const bool known = strstr(s->lines.data, begins) != NULL;
    const mote_status status = known ? MOTE_OK : race_and_store(s, place, k, size, key);
    free(key);
    free(begins);
    return status;
}

/* Goes in rounds, so an interrupted study has an equal number of each race. */
static mote_status run_rounds(study *s, uint64_t races, uint64_t planted)
{
    mote_status status = MOTE_OK;
    const uint64_t enough = (races + UNCHANGED_A_ROUND - 1) / UNCHANGED_A_ROUND;
    const uint64_t rounds = planted > enough ? planted : enough;
    for (uint64_t round = 0; round < rounds; ++round) {
        for (size_t place = 0; place < PLACES_RACED; ++place) {
            for (uint64_t i = round * UNCHANGED_A_ROUND;
                 status == MOTE_OK && i < (round + 1) * UNCHANGED_A_ROUND && i < races; ++i)
                status = race_once(s, place, &kinds[0], 0, i + 1);
            for (size_t k = 0; round < planted && k < KINDS * SIZES && status == MOTE_OK; ++k)
                status = race_once(s, place, &kinds[k / SIZES], sizes[k % SIZES], round + 1);
        }
    }
    return status;
}

static mote_status read_lines(const char *path, mote_text *lines)
{
    char *data = NULL;
    size_t size = 0;
    if (access(path, F_OK) != 0) {
        mote_text_add(lines, HEADER);
        return MOTE_OK;
    }
    mote_status status = mote_file_read(path, FILE_LIMIT, &data, &size);
    if (status == MOTE_OK && strncmp(data, HEADER, strlen(HEADER)) != 0)
        status = mote_fail(MOTE_EINVAL, "%s:1: not the header of races", path);
    if (status == MOTE_OK)
        mote_text_add(lines, "%s", data);
    free(data);
    return status;
}

static mote_status run(study *s, uint64_t races, uint64_t planted)
{
    char *path = mote_format("%s/races.csv", s->out);
    mote_status status = check_only(s->only);
    if (status == MOTE_OK)
        status = mote_directory_make(s->out);
    mote_child_heed_signals();
    if (status == MOTE_OK)
        status = read_lines(path, &s->lines);
    if (status == MOTE_OK)
        status = run_rounds(s, races, planted);
    free(path);
    free(s->lines.data);
    return status;
}

/* The races of one kind in one place. */
typedef struct tally {
    size_t races, slower, alone, changed, same;
    double *seconds, *ratios;
} tally;

static tally count_races(const char *lines, const char *place, const char *plant, int size)
{
    tally t = {.races = 0};
    size_t most = 0;
    for (const char *c = lines; *c; ++c)
        most += *c == '\n';
    t.seconds = mote_allocate(most, sizeof *t.seconds);
    t.ratios = mote_allocate(most, sizeof *t.ratios);
    char *begins = mote_format("\n%s,%s,%d,", place, plant, size);
    for (const char *at = lines; (at = strstr(at, begins)); ++at) {
        size_t slower, faster, same, undecided, named, number;
        double ratio, seconds;
        if (sscanf(at + strlen(begins), "%zu,%zu,%zu,%zu,%zu,%zu,%lf,%*f,%*f,%*u,%lf", &number,
                   &slower, &faster, &same, &undecided, &named, &ratio, &seconds) != 8)
            continue;
        t.seconds[t.races] = seconds;
        t.ratios[t.races++] = ratio;
        t.slower += named > 0;
        t.alone += named > 1;
        t.changed += slower + faster > 0;
        t.same += same == CELLS;
    }
    free(begins);
    return t;
}

static void print_share(size_t successes, size_t trials)
{
    const mote_confidence c = mote_statistics_share_interval((double)successes, (double)trials);
    if (trials == 0)
        (void)printf(" - |");
    else
        (void)printf(" %zu of %zu (%.0f to %.0f %%) |", successes, trials, 100 * c.low,
                     100 * c.high);
}

static void print_seconds(const tally *t)
{
    if (t->races == 0)
        (void)printf(" - |");
    else
        (void)printf(" %.0f s |", mote_statistics_median(t->seconds, t->races));
}

static void print_unchanged(const char *lines)
{
    (void)printf("| | races | called faster or slower | both rows called same | median time |\n"
                 "| --- | ---: | --- | --- | ---: |\n");
    for (size_t place = 0; place < PLACES; ++place) {
        tally t = count_races(lines, places[place], "none", 0);
        (void)printf("| unchanged, %s | %zu |", place_titles[place], t.races);
        print_share(t.changed, t.races);
        print_share(t.same, t.races);
        print_seconds(&t);
        (void)printf("\n");
        free(t.seconds);
        free(t.ratios);
    }
}

/* A line of the table and of the figure's block: size, share, its interval, per cent. */
static void print_planted(const char *lines, size_t place, const kind *k, int size,
                          mote_text *data)
{
    tally t = count_races(lines, places[place], k->name, size);
    if (t.races == 0) {
        free(t.seconds);
        free(t.ratios);
        return;
    }
    const mote_confidence c = mote_statistics_share_interval((double)t.slower, (double)t.races);
    (void)printf("| %s, %s | %d %% |", k->name, place_titles[place], size);
    print_share(t.slower, t.races);
    if (k->slows_all)
        (void)printf(" slows both |");
    else
        print_share(t.alone, t.races);
    print_seconds(&t);
    if (t.races > 0) {
        (void)printf(" %+.1f %% |\n", 100 * (mote_statistics_median(t.ratios, t.races) - 1));
        mote_text_add(data, "%d %.2f %.2f %.2f\n", size,
                      100 * (double)t.slower / (double)t.races, 100 * c.low, 100 * c.high);
    } else {
        (void)printf(" - |\n");
    }
    free(t.seconds);
    free(t.ratios);
}

/* The figure leaves out races of a busy machine: a race or two of a size say nothing. */
static mote_status print_table(const char *path, const char *base)
{
    mote_text lines = {0}, data = {0};
    mote_status status = read_lines(path, &lines);
    if (status != MOTE_OK)
        return status;
    print_unchanged(lines.data);
    (void)printf("\n| planted | size | called slower | and nothing else was | median time | "
                 "measured |\n| --- | ---: | --- | --- | ---: | ---: |\n");
    for (size_t place = 0; place < PLACES; ++place) {
        for (size_t k = 0; k < KINDS; ++k) {
            mote_text block = {0};
            for (size_t i = 0; i < SIZES; ++i)
                print_planted(lines.data, place, &kinds[k], sizes[i], &block);
            if (block.size > 0 && place < PLACES_RACED)
                mote_text_add(&data, "%s\"%s, %s\"\n%s", data.size ? "\n\n" : "", kinds[k].name,
                              place_titles[place], block.data);
            free(block.data);
        }
    }
    char *file = mote_format("%s.dat", base);
    status = mote_file_write(file, data.data, data.size);
    free(file);
    free(lines.data);
    free(data.data);
    return status;
}

int main(int argc, char **argv)
{
    uint64_t races, planted;
    mote_status status;
    if ((argc == 6 || argc == 7) && strcmp(argv[1], "run") == 0 &&
        mote_read_unsigned(argv[4], 0, 100000, &races) &&
        mote_read_unsigned(argv[5], 0, 100000, &planted)) {
        study s = {.programs = argv[2], .out = argv[3], .only = argc == 7 ? argv[6] : ""};
        status = run(&s, races, planted);
    } else if (argc == 4 && strcmp(argv[1], "table") == 0) {
        status = print_table(argv[2], argv[3]);
    } else {
        (void)fprintf(stderr, "usage: race_study run PROGRAMS OUT RACES PLANTED [ONLY]\n"
                              "       race_study table RACES.csv BASE\n");
        return MOTE_EXIT_USAGE;
    }
    return status == MOTE_OK ? MOTE_EXIT_DONE : mote_command_fail();
}
