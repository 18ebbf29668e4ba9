/* mote race A B SCENARIO...: two builds take turns measuring the same cells; which one is
   faster? */
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/command/command.h"
#include "harness/process/child.h"
#include "harness/race/protocol.h"
#include "harness/race/race_explain.h"
#include "harness/race/race_print.h"
#include "harness/base/clock.h"
#include "harness/run/plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define DEFAULT_UNTIL 0.01
#define DEFAULT_REAL 0.01
#define DEFAULT_BUDGET 300.0
#define DEFAULT_TIMEOUT 120.0
#define SECONDS_MOST 1e6

const mote_option mote_options_race[] = {
    {"method", "NAME[:key=value,...]",
     "a method that both measure; may be repeated, and key=a|b means both values; no default"},
    {"particles", "LIST",
     "numbers of particles for methods with a key n, such as 1,2,4-8 (default: the key's own)"},
    {"frames", "A-B", "measure these frames only, counted from 1 (default: all)"},
    {"cache", "hot|evict",
     "evict: walk over 32 MB between frames, so that caches are cold (default: hot)"},
    {"until", "PERCENT",
     "stop when each ratio is known to within this, such as 1% or 0.5% (default: 1%)"},
    {"budget", "SECONDS", "or after this time; 0: no limit (default: 300)"},
    {"real", "PERCENT", "smaller changes are not called faster or slower (default: 1%)"},
    {"timeout", "SECONDS", "how long a program may take to answer (default: 120)"},
    {"seed", "S", "the seed of orders and memory layouts (default: another one each time)"},
    {"allow-changes", NULL,
     "answers that differ are reported and not judged (default: the race fails)"},
    {"instructions", NULL,
     "count the instructions of rows that changed, by valgrind (default: not)"},
    {"labels", "A,B", "what A and B are, for the JSON (default: their paths)"},
    {"out", "FILE", "write the race as JSON as well (default: not)"},
    {"format", "table|json", "how to print it (default: table)"},
    {NULL, NULL, NULL}};

enum {
    OPTION_METHOD,
    OPTION_PARTICLES,
    OPTION_FRAMES,
    OPTION_CACHE,
    OPTION_UNTIL,
    OPTION_BUDGET,
    OPTION_REAL,
    OPTION_TIMEOUT,
    OPTION_SEED,
    OPTION_ALLOW_CHANGES,
    OPTION_INSTRUCTIONS,
    OPTION_LABELS,
    OPTION_OUT,
    OPTION_FORMAT,
    OPTION_COUNT
};

typedef struct request {
    const char *values[OPTION_COUNT]; /* last value given for each; NULL: not given */
    const char *plain[2 + MOTE_RACE_CELLS];
    size_t plain_count;
    mote_choices choices;
    uint32_t first, last;         /* of --frames; 1 and 0: not given */
    char *names[MOTE_RACE_CELLS]; /* of scenarios, without their frames */
    char *labels[2];
    mote_race_cell cells[MOTE_RACE_CELLS];
    mote_race_builds builds[MOTE_RACE_SIDES];
    mote_race_options race;
} request;

static int read_arguments(int argc, char **argv, request *q)
{
    mote_option_reader reader = mote_option_begin(mote_options_race, argc, argv);
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option >= 0)
            q->values[option] = value ? value : "";
        else if (q->plain_count < sizeof q->plain / sizeof q->plain[0])
            q->plain[q->plain_count++] = value;
        else
            return mote_command_usage(argv[0], "%s: more than %d scenarios", value,
                                      MOTE_RACE_CELLS);
    }
    if (q->plain_count < 3 || !q->values[OPTION_METHOD])
        return mote_command_usage(
            argv[0], "two programs, a scenario and --method are needed; write `mote race A B "
                     "SCENARIO --method NAME`");
    return MOTE_EXIT_DONE;
}

/* "1%" or "0.01" as a share. */
static bool read_share(const char *text, double *share)
{
    char number[32];
    const size_t length = strlen(text);
    const bool percent = length > 0 && text[length - 1] == '%';
    if (length >= sizeof number)
        return false;
    memcpy(number, text, length + 1);
    number[length - percent] = '\0';
    if (!mote_read_real(number, 0, percent ? 100 : 1, share))
        return false;
    *share /= percent ? 100 : 1;
    return *share > 0;
}

static int read_numbers(const char *command, request *q, mote_race_options *race)
{
    const char *const *v = q->values;
    if (v[OPTION_UNTIL] && !read_share(v[OPTION_UNTIL], &race->until))
        return mote_command_usage(
            command, "--until %s: expected a share above 0, at most 100%%, such as 1%%",
            v[OPTION_UNTIL]);
    if (v[OPTION_REAL] && !read_share(v[OPTION_REAL], &race->real))
        return mote_command_usage(
            command, "--real %s: expected a share above 0, at most 100%%, such as 1%%",
            v[OPTION_REAL]);
    if (v[OPTION_BUDGET] && !mote_read_real(v[OPTION_BUDGET], 0, SECONDS_MOST, &race->budget))
        return mote_command_usage(command, "--budget %s: expected seconds, from 0 to %g",
                                  v[OPTION_BUDGET], SECONDS_MOST);
    if (v[OPTION_TIMEOUT] &&
        !mote_read_real(v[OPTION_TIMEOUT], 0.001, SECONDS_MOST, &race->timeout))
        return mote_command_usage(command, "--timeout %s: expected seconds, from 0.001 to %g",
                                  v[OPTION_TIMEOUT], SECONDS_MOST);
    if (v[OPTION_SEED] && !mote_read_unsigned(v[OPTION_SEED], 0, UINT64_MAX, &race->seed))
        return mote_command_usage(command, "--seed %s: expected a whole number below 2^64",
                                  v[OPTION_SEED]);
    if (mote_particles_check(v[OPTION_PARTICLES]) != MOTE_OK)
        return mote_command_usage(command, "--particles %s", mote_error_text());
    q->first = 1;
    return v[OPTION_FRAMES]
               ? mote_frames_argument(command, "frames", v[OPTION_FRAMES], &q->first, &q->last)
               : MOTE_EXIT_DONE;
}

static int read_words(const char *command, request *q)
{
    const char *cache = q->values[OPTION_CACHE], *format = q->values[OPTION_FORMAT];
    const char *labels = q->values[OPTION_LABELS];
    const char *comma = labels ? strchr(labels, ',') : NULL;
    if (cache && strcmp(cache, "hot") != 0 && strcmp(cache, "evict") != 0)
        return mote_command_usage(command, "--cache %s: choose hot or evict", cache);
    if (format && strcmp(format, "table") != 0 && strcmp(format, "json") != 0)
        return mote_command_usage(command, "--format %s: choose table or json", format);
    if (labels && !comma)
        return mote_command_usage(command, "--labels %s: expected two, with a comma between",
                                  labels);
    if (labels) {
        q->labels[0] = mote_format("%.*s", (int)(comma - labels), labels);
        q->labels[1] = mote_duplicate(comma + 1);
    }
    return MOTE_EXIT_DONE;
}

static mote_status read_methods(int argc, char **argv, request *q)
{
    mote_option_reader reader = mote_option_begin(mote_options_race, argc, argv);
    const char *value;
    mote_status status = MOTE_OK;
    for (int option; status == MOTE_OK &&
                     (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == OPTION_METHOD)
            status = mote_choices_add(&q->choices, value, q->values[OPTION_PARTICLES]);
    }
    return status;
}

/* Reads the frames of a scenario: "ww@950-1149" has its own. */
static void read_frames(const request *q, const char *text, char **name, mote_race_cell *cell)
{
    uint64_t first = q->first, last = q->last;
    const char *at = strrchr(text, '@');
    *name = at && mote_read_range(at + 1, UINT32_MAX, &first, &last) == MOTE_OK
                ? mote_format("%.*s", (int)(at - text), text)
                : mote_duplicate(text);
    cell->first = (uint32_t)first;
    cell->last = (uint32_t)last;
}

/* Makes a cell for each scenario and method. */
static mote_status make_cells(request *q)
{
    const char *cache = q->values[OPTION_CACHE];
    for (size_t s = 2; s < q->plain_count; ++s) {
        mote_race_cell cell = {.cache = cache && strcmp(cache, "evict") == 0 ? MOTE_CACHE_EVICT
                                                                             : MOTE_CACHE_HOT,
                               .seed = 1};
        read_frames(q, q->plain[s], &q->names[s - 2], &cell);
        for (size_t m = 0; m < q->choices.count; ++m) {
            if (q->race.cell_count == MOTE_RACE_CELLS)
                return mote_fail(MOTE_EINVAL, "more than %d cells; race fewer",
                                 MOTE_RACE_CELLS);
            cell.scenario = q->names[s - 2];
            cell.method = q->choices.items[m].text;
            q->cells[q->race.cell_count++] = cell;
        }
    }
    return MOTE_OK;
}

/* A value that differs between processes and over time. */
static uint64_t any_seed(void)
{
    return mote_clock_ns() ^ (uint64_t)getpid() << 40;
}

static json_t *make_json(const request *q, const mote_race *race)
{
    const char *const labels[2] = {q->labels[0], q->labels[1]};
    return mote_race_json(&q->race, race, labels);
}

static mote_status write_json(const request *q, const mote_race *race, const char *path)
{
    json_t *object = make_json(q, race);
    if (!object)
        return mote_fail(MOTE_EINVAL, "%s: a name that is not UTF-8 cannot be written", path);
    char *text = json_dumps(object, MOTE_JSON_FLAGS);
    char *lines = mote_format("%s\n", text);
    json_decref(object);
    const mote_status status = mote_file_write(path, lines, strlen(lines));
    free(lines);
    free(text);
    return status;
}

static mote_status run(const request *q, mote_race *race)
{
    mote_child_heed_signals();
    mote_status status = mote_race_run(&q->race, race);
    if (status != MOTE_OK)
        return status;
    if (q->values[OPTION_INSTRUCTIONS])
        mote_race_count_instructions(&q->race, race);
    mote_race_explain(race);
    if (q->values[OPTION_OUT])
        status = write_json(q, race, q->values[OPTION_OUT]);
    if (status != MOTE_OK)
        mote_race_free(race);
    return status;
}

/* Prints the race; the exit status is the same as for `mote compare`. */
static int finish(const request *q, const mote_race *race)
{
    int code = race->worse       ? MOTE_EXIT_CHECK_FAILED
               : race->undecided ? MOTE_EXIT_UNDECIDED
                                 : MOTE_EXIT_DONE;
    const char *format = q->values[OPTION_FORMAT];
    if (!format || strcmp(format, "json") != 0)
        mote_race_print(&q->race, race, stdout);
    else if (mote_json_put(make_json(q, race), MOTE_JSON_FLAGS, stdout) != MOTE_OK)
        code = mote_command_fail();
    return code;
}

static void free_request(request *q)
{
    mote_choices_free(&q->choices);
    for (size_t i = 0; i < MOTE_RACE_CELLS; ++i)
        free(q->names[i]);
    for (int side = 0; side < MOTE_RACE_SIDES; ++side) {
        free(q->labels[side]);
        mote_race_builds_free(&q->builds[side]);
    }
    free(q);
}

static int race(int argc, char **argv, request *q)
{
    int code = read_arguments(argc, argv, q);
    q->race = (mote_race_options){.builds = {&q->builds[0], &q->builds[1]},
                                  .cells = q->cells,
                                  .until = DEFAULT_UNTIL,
                                  .real = DEFAULT_REAL,
                                  .budget = DEFAULT_BUDGET,
                                  .timeout = DEFAULT_TIMEOUT,
                                  .seed = any_seed(),
                                  .allow_changes = q->values[OPTION_ALLOW_CHANGES] != NULL};
    if (code == MOTE_EXIT_DONE)
        code = read_numbers(argv[0], q, &q->race);
    if (code == MOTE_EXIT_DONE)
        code = read_words(argv[0], q);
    if (code != MOTE_EXIT_DONE)
        return code;
    mote_race outcome;
    mote_status status = read_methods(argc, argv, q);
    for (int side = 0; status == MOTE_OK && side < MOTE_RACE_SIDES; ++side)
        status = mote_race_builds_find(q->plain[side], &q->builds[side]);
    if (status == MOTE_OK)
        status = make_cells(q);
    if (status == MOTE_OK)
        status = run(q, &outcome);
    if (status != MOTE_OK)
        return mote_command_fail();
    code = finish(q, &outcome);
    mote_race_free(&outcome);
    return mote_command_finish(code);
}

int mote_command_race(int argc, char **argv)
{
    request *q = mote_allocate(1, sizeof *q);
    const int code = race(argc, argv, q);
    free_request(q);
    return code;
}
