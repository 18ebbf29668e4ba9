/* What a race says of its rows: causes, tables and JSON, from made-up results. */
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/race/race_explain.h"
#include "harness/race/race_print.h"

#include <math.h>
#include <stdio.h>
#include <sys/stat.h>

static const mote_race_cell cell = {.scenario = "ww", .method = "certified", .first = 11};

/* A row as measured, with these counts. */
static mote_race_row make_row(mote_verdict verdict, double ratio)
{
    return (mote_race_row){.cell = &cell,
                           .name = mote_duplicate("ww/certified/hot"),
                           .pairs = 12,
                           .units = 12,
                           .frames = 40,
                           .ratio = ratio,
                           .spread = 0.01,
                           .interval = {0.99 * ratio, 1.01 * ratio},
                           .verdict = verdict,
                           .instructions = {MOTE_NONE, MOTE_NONE}};
}

static mote_race race_of(mote_race_row *rows, size_t count)
{
    return (mote_race){.rows = rows, .count = count, .pairs = 12, .seconds = 3};
}

static void free_rows(mote_race_row *rows, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        free(rows[i].name);
        free(rows[i].uncounted);
        free(rows[i].what);
    }
}

static const struct {
    mote_verdict verdict;
    double ratio, sums[2], worst, instructions[2];
    const char *reason, *what;
} causes[] = {
    {MOTE_VERDICT_SAME, 1, {5, 5}, 0, {MOTE_NONE, MOTE_NONE}, "", ""},
    {MOTE_VERDICT_SAME, 1, {5, 5}, 0, {1000, 2000}, "", ""},
    {MOTE_VERDICT_SLOWER,
     2,
     {5, 5},
     0,
     {MOTE_NONE, 1000},
     "",
     "counts are the same: time for each of them changed"},
    {MOTE_VERDICT_SLOWER,
     2,
     {100, 150},
     0,
     {1000, MOTE_NONE},
     "",
     "boxes 100 to 150 (+50 %); the time changed with the counts"},
    {MOTE_VERDICT_FASTER,
     0.5,
     {5, 5},
     0,
     {1000, 1001},
     "",
     "time for the same instructions changed: memory, the layout of code, or the clock"},
    {MOTE_VERDICT_FASTER,
     0.6,
     {0, 3},
     0,
     {1000, 500},
     "",
     "boxes 0 to 3; instructions 1000 to 500 (-50 %), time for each +20 %"},
    {MOTE_VERDICT_SAME,
     1,
     {5, 5},
     0.25,
     {MOTE_NONE, MOTE_NONE},
     "",
     "answers differ by up to 0.25 L, at frame 17"},
    {MOTE_VERDICT_SAME,
     1,
     {8, 4},
     HUGE_VAL,
     {MOTE_NONE, MOTE_NONE},
     "",
     "answers differ: contact or none, at frame 17; boxes 8 to 4 (-50 %)"},
    {MOTE_VERDICT_SAME,
     1,
     {5, 5},
     1e-12,
     {MOTE_NONE, MOTE_NONE},
     "B: why",
     "answers differ by rounding (1e-12 L); B: why"},
    {MOTE_VERDICT_UNDECIDED, 1, {5, 5}, 0, {MOTE_NONE, MOTE_NONE}, "A: why", "A: why"},
};

TEST(causes_are_told_as_far_as_counts_and_instructions_show_them)
{
    for (size_t i = 0; i < ROWS_OF(causes); ++i) {
        mote_race_row row = make_row(causes[i].verdict, causes[i].ratio);
        mote_race race = race_of(&row, 1);
        test_row("%s", causes[i].what);
        row.count_count = 1;
        row.counts[0] = (mote_race_count){"boxes", {causes[i].sums[0], causes[i].sums[1]}};
        row.counted = causes[i].sums[0] != causes[i].sums[1];
        row.worst = causes[i].worst;
        row.worst_frame = 17;
        memcpy(row.instructions, causes[i].instructions, sizeof row.instructions);
        (void)snprintf(row.reason, sizeof row.reason, "%s", causes[i].reason);
        mote_race_explain(&race);
        assert_string_equal(row.what, causes[i].what);
        free_rows(&row, 1);
    }
}

/* Times of impact have no length. */
TEST(impacts_that_differ_are_told_as_parts_of_the_question)
{
    mote_race_row row = make_row(MOTE_VERDICT_SAME, 1);
    mote_race race = race_of(&row, 1);
    (void)snprintf(row.scene.ask, sizeof row.scene.ask, "impact");
    row.worst = 0.25;
    row.worst_frame = 17;
    mote_race_explain(&race);
    assert_string_equal(row.what,
                        "answers differ by up to 0.25 of the question's time, at frame 17");
    free_rows(&row, 1);
}

static void put_program(const char *name, const char *text)
{
    file_put(name, text);
    assert_int_equal(chmod(name, 0755), 0);
}

/* What the last row of counted_by says of its counts; empty if it has them. */
static char why_not[1200];

/* Instructions per frame of a row whose program, called as `mote instructions ... --out
   FOLDER`, is this script; step: of a scenario that asks for impacts, else 0. */
static double counted_within(const char *script, uint32_t frames, uint32_t step,
                             mote_verdict verdict)
{
    static char path[] = "./counts";
    mote_race_row row = make_row(verdict, 2);
    row.scene.step = step;
    mote_race race = race_of(&row, 1);
    const mote_race_builds builds = {.path = {path}, .count = 1};
    const mote_race_options options = {.builds = {&builds, &builds}};
    row.frames = frames;
    put_program("counts", script);
    mote_race_count_instructions(&options, &race);
    const double counted = row.instructions[MOTE_RACE_B];
    assert_true(row.instructions[MOTE_RACE_A] == counted ||
                (isnan(row.instructions[MOTE_RACE_A]) && isnan(counted)));
    (void)snprintf(why_not, sizeof why_not, "%s", row.uncounted ? row.uncounted : "");
    mote_race_explain(&race);
    assert_true(!row.uncounted || strstr(row.what, "; instructions are not known: "));
    assert_true(!row.uncounted || strstr(row.what, row.uncounted));
    free_rows(&row, 1);
    return counted;
}

static double counted_by(const char *script, uint32_t frames, mote_verdict verdict)
{
    return counted_within(script, frames, 0, verdict);
}

#define WRITES(json) "#!/bin/sh\necho '" json "' > \"$8/instructions.json\"\n"
#define GOOD WRITES("{\"rows\": [{\"per_frame\": 1234}]}")

TEST(instructions_are_counted_by_each_program)
{
    static const struct {
        const char *script;
        double counted;
        const char *why;
    } rows[] = {
        {GOOD, 1234, ""},
        {"#!/bin/sh\n[ \"$1 $2 $4 $6\" = 'instructions ww 11-30 certified' ] || exit 1\n" GOOD,
         1234, ""},
        {GOOD "echo no valgrind >&2; exit 3\n", NAN,
         "A: ./counts: ended with status 3: no valgrind"},
        {"#!/bin/sh\n", NAN, "instructions.json: No such file"},
        {WRITES("{"), NAN, "instructions.json"},
        {WRITES("{\"rows\": []}"), NAN, "instructions.json: has no count"},
        {WRITES("{\"rows\": [{\"per_frame\": \"many\"}]}"), NAN, "has no count"},
    };
    assert_int_equal(mkdir("temporary", 0755), 0);
    assert_int_equal(setenv("TMPDIR", "temporary", 1), 0);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].script);
        const double counted = counted_by(rows[i].script, 40, MOTE_VERDICT_SLOWER);
        assert_true(counted == rows[i].counted || (isnan(counted) && isnan(rows[i].counted)));
        if (!strstr(why_not, rows[i].why) || (!rows[i].why[0] && why_not[0]))
            fail_msg("not \"%s\" but \"%s\"", rows[i].why, why_not);
        assert_int_equal(folder_count("temporary", ""), 0);
    }
    /* Of a short row every frame; of a row that did not change nothing. */
    assert_true(counted_by("#!/bin/sh\n[ \"$4\" = 11-13 ] || exit 1\n" GOOD, 3,
                           MOTE_VERDICT_FASTER) == 1234);
    assert_true(isnan(counted_by(GOOD, 40, MOTE_VERDICT_SAME)));
    assert_string_equal(why_not, "");
    /* The last question ends a step after the frame in which it begins. */
    assert_true(counted_within("#!/bin/sh\n[ \"$4\" = 11-60 ] || exit 1\n" GOOD, 40, 30,
                               MOTE_VERDICT_SLOWER) == 1234);
    assert_true(counted_within("#!/bin/sh\n[ \"$4\" = 11-43 ] || exit 1\n" GOOD, 3, 30,
                               MOTE_VERDICT_SLOWER) == 1234);
    /* Where there is no room for a temporary folder, nothing is known. */
    assert_int_equal(setenv("TMPDIR", "nowhere", 1), 0);
    assert_true(isnan(counted_by(GOOD, 40, MOTE_VERDICT_SLOWER)));
    assert_string_equal(why_not,
                        "no folder in nowhere: No such file or directory; TMPDIR may name "
                        "another");
    static const char *const usual[] = {"", NULL};
    for (size_t i = 0; i < ROWS_OF(usual); ++i) {
        (void)(usual[i] ? setenv("TMPDIR", usual[i], 1) : unsetenv("TMPDIR"));
        assert_true(
            counted_by("#!/bin/sh\ncase $8 in /tmp/mote-race-*) ;; *) exit 1; esac\n" GOOD, 40,
                       MOTE_VERDICT_SLOWER) == 1234);
    }
}

static char *builds_path[] = {"./one", "./two"};

/* The race printed as a table, or as JSON with labels; the caller frees it. */
static char *printed(const mote_race *race, bool allow)
{
    const mote_race_builds builds[2] = {{.path = {builds_path[0]}, .count = 1},
                                        {.path = {builds_path[1]}, .count = 1}};
    const mote_race_options options = {.builds = {&builds[0], &builds[1]},
                                       .until = 0.01,
                                       .real = 0.01,
                                       .allow_changes = allow};
    FILE *out = fopen("table", "w");
    assert_non_null(out);
    mote_race_print(&options, race, out);
    assert_int_equal(fclose(out), 0);
    return file_text("table");
}

TEST(a_table_says_what_is_worse)
{
    static const struct {
        mote_race_state state;
        mote_verdict verdict;
        double low, worst;
        bool lost, allow;
        const char *says;
    } rows[] = {
        {MOTE_RACE_MEASURED, MOTE_VERDICT_SLOWER, 1.1, 0, false, false,
         " 1.250 [1.100, 1.262] slower    12 pairs  1.00 %  WORSE: why\n"},
        {MOTE_RACE_MEASURED, MOTE_VERDICT_SAME, 1.1, 0, false, false,
         "same      12 pairs  1.00 %  : why\n"},
        {MOTE_RACE_MEASURED, MOTE_VERDICT_SAME, 1.1, 0.1, false, false, " WORSE: why\n"},
        {MOTE_RACE_MEASURED, MOTE_VERDICT_SAME, 1.1, 0.1, false, true, "  : why\n"},
        {MOTE_RACE_MEASURED, MOTE_VERDICT_UNDECIDED, NAN, 0, false, false,
         " 1.250 no interval undecided    12 pairs"},
        {MOTE_RACE_FAILED, MOTE_VERDICT_UNDECIDED, NAN, 0, true, false, " WORSE: why\n"},
        {MOTE_RACE_FAILED, MOTE_VERDICT_UNDECIDED, NAN, 0, false, false, "failed "},
        {MOTE_RACE_LEFT_OUT, MOTE_VERDICT_UNDECIDED, NAN, 0, true, false, "left out "},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_race_row row = make_row(rows[i].verdict, 1.25);
        const mote_race race = race_of(&row, 1);
        test_row("%zu", i);
        row.state = rows[i].state;
        row.interval.low = rows[i].low;
        row.worst = rows[i].worst;
        row.missing[MOTE_RACE_B] = rows[i].lost;
        row.missing[MOTE_RACE_A] = !rows[i].lost;
        row.what = mote_duplicate("why");
        char *text = printed(&race, rows[i].allow);
        if (!strstr(text, rows[i].says))
            fail_msg("not \"%s\" but:\n%s", rows[i].says, text);
        assert_true(!strstr(text, "WORSE") == !strstr(rows[i].says, "WORSE"));
        free(text);
        free_rows(&row, 1);
    }
}

TEST(the_last_line_and_the_json_give_one_verdict)
{
    static const struct {
        bool worse, undecided;
        mote_race_state state;
        mote_verdict of_row;
        uint32_t looks;
        const char *line, *verdict;
    } rows[] = {
        {true, true, MOTE_RACE_MEASURED, MOTE_VERDICT_UNDECIDED, 2, "worse after 12 pairs",
         "worse"},
        {true, false, MOTE_RACE_MEASURED, MOTE_VERDICT_SLOWER, 2, "worse after 12 pairs",
         "worse"},
        {false, true, MOTE_RACE_MEASURED, MOTE_VERDICT_UNDECIDED, 2,
         "undecided: more time (--budget) may decide after 12", "undecided"},
        /* No race looks more often than this. */
        {false, true, MOTE_RACE_MEASURED, MOTE_VERDICT_UNDECIDED, MOTE_RACE_LOOKS,
         "undecided: a quieter machine, or more builds of both sides, may decide after 12",
         "undecided"},
        /* Another row, or a row that B lost, is not decided by time. */
        {false, true, MOTE_RACE_MEASURED, MOTE_VERDICT_SAME, 2, "undecided after 12",
         "undecided"},
        {false, true, MOTE_RACE_LEFT_OUT, MOTE_VERDICT_UNDECIDED, 0, "undecided after 12",
         "undecided"},
        {false, false, MOTE_RACE_MEASURED, MOTE_VERDICT_SAME, 2,
         "same or better after 12 pairs", "same-or-better"},
    };
    static const char *const labels[] = {"old", NULL};
    const mote_race_builds builds[2] = {{.path = {builds_path[0]}, .count = 1},
                                        {.path = {builds_path[1]}, .count = 2}};
    const mote_race_options options = {.builds = {&builds[0], &builds[1]}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_race_row row = make_row(rows[i].of_row, 1);
        mote_race race = race_of(&row, 1);
        test_row("%zu", i);
        row.state = rows[i].state;
        row.looks = rows[i].looks;
        race.worse = rows[i].worse;
        race.undecided = rows[i].undecided;
        row.count_count = 1;
        row.counts[0] = (mote_race_count){"boxes", {5, 6}};
        char *text = printed(&race, false);
        assert_non_null(strstr(text, rows[i].line));
        free(text);
        json_t *json = mote_race_json(&options, &race, labels);
        const json_t *first = json_array_get(json_object_get(json, "rows"), 0);
        assert_string_equal(json_string_value(json_object_get(json, "verdict")),
                            rows[i].verdict);
        assert_string_equal(json_string_value(json_object_get(json, "a")), "old");
        assert_string_equal(json_string_value(json_object_get(json, "b")), "./two");
        assert_string_equal(json_string_value(json_object_get(first, "what")), "");
        const json_t *boxes = json_object_get(json_object_get(first, "counts"), "boxes");
        assert_true(json_number_value(json_array_get(boxes, 1)) == 6);
        json_decref(json);
        free_rows(&row, 1);
    }
}

TEST(a_race_of_names_that_are_not_utf8_has_no_json)
{
    static const char *const labels[] = {"\xff", NULL};
    mote_race_row row = make_row(MOTE_VERDICT_SAME, 1);
    const mote_race race = race_of(&row, 1);
    const mote_race_builds builds = {.path = {builds_path[0]}, .count = 1};
    const mote_race_options options = {.builds = {&builds, &builds}};
    assert_null(mote_race_json(&options, &race, labels));
    free_rows(&row, 1);
}
