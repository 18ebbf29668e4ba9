/* Bouts and races of racers that are shell scripts: whatever a program may answer, do or leave
   undone. */
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include "harness/race/race.h"

#include <jansson.h>
#include <math.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

/* What a racer does, as commands of the shell; NULL: as a racer that measures two frames.
   `say` prints a line; $n counts the requests. */
typedef struct script {
    const char *greet, *cell, *run, *answers;
} script;

#define TIMES "3000000,3000000"

static const char *or_else(const char *own, const char *usual)
{
    return own ? own : usual;
}

static void put_racer(const char *name, script s)
{
    char text[2048];
    (void)snprintf(text, sizeof text,
                   "#!/bin/sh\nsay() { printf \"$1\\n\"; }\nn=0\n%s\n"
                   "while IFS= read -r line; do\nn=$((n + 1))\ncase $line in\n"
                   "cell*) %s ;;\nrun*) %s ;;\n*) %s ;;\nesac\ndone\n",
                   or_else(s.greet, "say 'mote-race\\t1'"),
                   or_else(s.cell, "say 'ok\\t0\\t1\\t2'"),
                   or_else(s.run, "say 'ok\\t1\\t-\\t" TIMES "'"),
                   or_else(s.answers, "say 'ok\\t0.5:0,0.5:0'"));
    file_put(name, text);
    assert_int_equal(chmod(name, 0755), 0);
}

static int put_good(void)
{
    if (folder_next() != 0)
        return -1;
    (void)signal(SIGPIPE, SIG_IGN); /* as the program does */
    put_racer("good", (script){NULL});
    return 0;
}

TEST_EACH(put_good, NULL);

static uint64_t fight_seed = 5;

/* Runs a bout of two programs in this folder, over a cell of each scenario [count]. */
static mote_status fight_over(const char *a, const char *b, const char *const *scenarios,
                              size_t count, mote_bout_result *results)
{
    mote_random random = {fight_seed};
    mote_bout bout;
    const mote_bout_options options = {
        .program = {a, b}, .core = -1, .timeout = 20, .check_scene = true, .random = &random};
    mote_status status = mote_bout_start(&options, &bout);
    for (size_t i = 0; i < count && status == MOTE_OK; ++i) {
        const mote_race_cell cell = {
            .scenario = scenarios[i], .method = "m", .first = 1, .seed = 1};
        status = mote_bout_run(&bout, &cell, &results[i]);
    }
    mote_bout_stop(&bout);
    return status;
}

/* The same of one cell. */
static mote_status fight(const char *a, const char *b, mote_bout_result *result)
{
    static const char *const scenario[] = {"s"};
    return fight_over(a, b, scenario, 1, result);
}

/* The same with other random orders. */
static mote_status fight_from(uint64_t seed, const char *a, const char *b,
                              mote_bout_result *result)
{
    fight_seed = seed;
    const mote_status status = fight(a, b, result);
    fight_seed = 5;
    return status;
}

/* What a racer says, by where it says it, and what the bout says then. */
static const char unread[] = "an answer that cannot be read";
#define MANY(k) "c" #k "1=1,c" #k "2=1,c" #k "3=1,c" #k "4=1,c" #k "5=1,"
static const struct {
    script does;
    const char *says;
    bool refused;
} wrong_answers[] = {
    {{.cell = "say 'no\\tnot here'"}, "not here", true},
    {{.cell = "say 'yes\\t0\\t1\\t2'"}, unread, false},
    {{.cell = "say 'ok\\t0'"}, unread, false},
    {{.cell = "say 'ok\\t0\\t1'"}, unread, false},
    {{.cell = "say 'ok\\t0\\tlong\\t2'"}, unread, false},
    {{.cell = "say 'ok\\t0\\t1\\t2 frames'"}, unread, false},
    {{.cell = "say 'ok\\tnone\\t1\\t2'"}, unread, false},
    {{.cell = "say 'ok\\t0\\t1\\t2\\nmore'"}, unread, false},
    {{.cell = "exit 3"}, "ended with status 3", false},
    {{.cell = "kill -SEGV $$"}, "ended by signal 11", false},
    {{.greet = "exec 0<&-; say 'mote-race\\t1'; exit 4"}, "ended with status 4", false},
    {{.cell = "printf '%1048600d' 1; exec sleep 9"}, unread, false},
    {{.run = "say 'no\\tnot now'"}, "not now", false},
    {{.run = "[ $n -gt 9 ] && exit 6; say 'ok\\t1\\t-\\t" TIMES "'"}, "status 6", false},
    {{.run = "say 'ok\\t1'"}, unread, false},
    {{.run = "say 'ok\\t1\\t-'"}, unread, false},
    {{.run = "say 'ok\\t1\\t-\\t5'"}, unread, false},
    {{.run = "say 'ok\\t1\\t-\\t5,5,5'"}, unread, false},
    {{.run = "say 'ok\\t1\\t-\\t5,soon'"}, unread, false},
    {{.run = "say 'ok\\tnone\\t-\\t5,5'"}, unread, false},
    {{.run = "say 'ok\\t1\\tboxes\\t5,5'"}, unread, false},
    {{.run = "say 'ok\\t1\\tboxes=many\\t5,5'"}, unread, false},
    {{.run = "say 'ok\\t1\\tboxes=-1\\t5,5'"}, unread, false},
    {{.run = "say 'ok\\t1\\ta_count_of_thirty_two_characters=1\\t5,5'"}, unread, false},
    {{.run = "say 'ok\\t1\\t" MANY(1) MANY(2) MANY(3) MANY(4) MANY(5) "z=1\\t5,5'"},
     unread,
     false},
    {{.run = "say 'ok\\t2\\t-\\t5,5'", .answers = "say 'no\\tforgotten'"}, "forgotten", false},
    {{.run = "say 'ok\\t2\\t-\\t5,5'", .answers = "say 'ok\\t0.5:0'"}, unread, false},
    {{.run = "say 'ok\\t2\\t-\\t5,5'", .answers = "say 'ok\\tnear:0,0.5:0'"}, unread, false},
    {{.run = "say 'ok\\t2\\t-\\t5,5'", .answers = "say 'ok\\t0.5,0.5:0'"}, unread, false},
    {{.run = "say 'ok\\t2\\t-\\t5,5'", .answers = "say 'ok\\tnan:1:0:1,nan:0'"}, unread, false},
    {{.run = "say 'ok\\t2\\t-\\t5,5'", .answers = "say 'ok\\tnan:1:x:1:2,nan:0'"},
     unread,
     false},
    {{.run = "say 'ok\\t2\\t-\\t5,5'", .answers = "say 'ok\\tnan:1:0::2,nan:0'"},
     unread,
     false},
    {{.run = "say 'ok\\t2\\t-\\t5,5'", .answers = "say 'ok\\tnan:1:0:1:2:3,nan:0'"},
     unread,
     false},
    {{.cell = "say 'ok\\t0\\t1\\t2\\t5'"}, unread, false},
    {{.cell = "say 'ok\\t0\\t1\\t2\\tx\\tdistance\\t0\\t0'"}, unread, false},
    {{.cell = "say 'ok\\t0\\t1\\t2\\t5\\tdistance\\t-1\\t0'"}, unread, false},
    {{.cell = "say 'ok\\t0\\t1\\t2\\t5\\tdistance\\t0\\tnone'"}, unread, false},
    {{.cell = "say 'ok\\t0\\t1\\t2\\t5\\ta_question_that_is_long\\t0\\t0'"}, unread, false},
    {{.run = "say 'ok\\t2\\t-\\t5,5'", .answers = "exit 7"}, "status 7", false},
};

TEST(an_answer_that_is_wrong_ends_the_bout_and_names_its_side)
{
    for (size_t i = 0; i < ROWS_OF(wrong_answers); ++i) {
        put_racer("bad", wrong_answers[i].does);
        for (int side = MOTE_RACE_A; side <= MOTE_RACE_B; ++side) {
            mote_bout_result result;
            test_row("%zu, %s, side %d", i, wrong_answers[i].says, side);
            assert_int_equal(side == MOTE_RACE_A ? fight("./bad", "./good", &result)
                                                 : fight("./good", "./bad", &result),
                             MOTE_OK);
            const mote_race_side *bad = &result.side[side], *good = &result.side[1 - side];
            assert_non_null(strstr(bad->reason, wrong_answers[i].says));
            assert_true(bad->refused == wrong_answers[i].refused &&
                        bad->failed == !wrong_answers[i].refused);
            assert_false(good->refused || good->failed);
        }
    }
}

/* Whoever begins: what both cannot answer, neither of them lost. */
TEST(a_frame_at_which_both_sides_fail_is_a_failure_of_both)
{
    put_racer("bad", (script){.run = "say 'no\\tframe 1: the method failed'"});
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        mote_bout_result result;
        test_row("seed %d", (int)seed);
        assert_int_equal(fight_from(seed, "./bad", "./bad", &result), MOTE_OK);
        for (int side = MOTE_RACE_A; side <= MOTE_RACE_B; ++side) {
            assert_true(result.side[side].failed && !result.side[side].refused);
            assert_string_equal(result.side[side].reason, "frame 1: the method failed");
        }
    }
}

TEST(racers_of_other_scenes_are_not_compared)
{
    mote_bout_result result;
    put_racer("other", (script){.cell = "say 'ok\\t5\\t1\\t2'"});
    assert_int_equal(fight("./good", "./other", &result), MOTE_OK);
    assert_false(result.same_scene);
    assert_int_equal(result.passes, 0);
#define SCENE(faces, asked)                                                                    \
    {                                                                                          \
        .cell = "say 'ok\\t7\\t1\\t2\\t" faces "\\t" asked "'"                                 \
    }
    /* An older program does not say its faces and its question: these may be any. */
    static const struct {
        script a, b;
        bool same;
    } rows[] = {
        {SCENE("5", "impact\\t3\\t0.5"), SCENE("5", "impact\\t3\\t0.5"), true},
        {SCENE("5", "impact\\t3\\t0.5"), SCENE("6", "impact\\t3\\t0.5"), false},
        {SCENE("5", "impact\\t3\\t0.5"), SCENE("5", "contact\\t3\\t0.5"), false},
        {SCENE("5", "impact\\t3\\t0.5"), SCENE("5", "impact\\t4\\t0.5"), false},
        {SCENE("5", "impact\\t3\\t0.5"), SCENE("5", "impact\\t3\\t0.25"), false},
        {SCENE("5", "impact\\t3\\t0.5"), {.cell = "say 'ok\\t7\\t1\\t2'"}, true},
        {{.cell = "say 'ok\\t7\\t1\\t2'"}, SCENE("5", "impact\\t3\\t0.5"), true},
        {{.cell = "say 'ok\\t8\\t1\\t2'"}, SCENE("5", "impact\\t3\\t0.5"), false},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%zu", i);
        put_racer("a", rows[i].a);
        put_racer("b", rows[i].b);
        assert_int_equal(fight("./a", "./b", &result), MOTE_OK);
        assert_true(result.same_scene == rows[i].same);
        assert_true((result.passes > 0) == rows[i].same);
        if (rows[i].same) {
            assert_string_equal(result.scene.ask, "impact");
            assert_true(result.scene.step == 3 && result.scene.tolerance == 0.5);
        }
    }
    put_racer("longer", (script){.cell = "say 'ok\\t0\\t1\\t3'"});
    assert_int_equal(fight("./good", "./longer", &result), MOTE_OK);
    assert_true(result.side[MOTE_RACE_B].refused);
    assert_string_equal(result.side[MOTE_RACE_B].reason,
                        "the scenario has another number of frames");
}

/* Racers number the cells that they opened, those that are then left out as well. */
TEST(a_cell_of_other_frames_does_not_shift_those_after_it)
{
    static const char *const scenarios[] = {"longer", "s", "longer", "s"};
    static const script numbered = {
        .cell =
            "case $line in *longer*) say 'ok\\t0\\t1\\t3' ;; *) say 'ok\\t0\\t1\\t2' ;; esac",
        .run = "set -- $line; [ $(($2 % 2)) = 1 ] && say 'ok\\t1\\t-\\t" TIMES
               "' || say 'no\\tcell of another scenario'"};
    put_racer("numbered", numbered);
    for (int side = MOTE_RACE_A; side <= MOTE_RACE_B; ++side) {
        mote_bout_result results[ROWS_OF(scenarios)];
        const char *const programs[] = {side == MOTE_RACE_A ? "./numbered" : "./good",
                                        side == MOTE_RACE_A ? "./good" : "./numbered"};
        test_row("side %d", side);
        assert_int_equal(
            fight_over(programs[0], programs[1], scenarios, ROWS_OF(scenarios), results),
            MOTE_OK);
        for (size_t i = 0; i < ROWS_OF(scenarios); ++i) {
            const mote_race_side *sides = results[i].side;
            assert_true(sides[MOTE_RACE_B].refused == (i % 2 == 0));
            assert_false(sides[MOTE_RACE_A].refused);
            assert_int_equal(results[i].frames, i % 2 == 0 ? 0 : 2);
        }
    }
}

TEST(a_bout_adds_counts_and_compares_answers)
{
    static const struct {
        const char *answers; /* of B, where A says 0.5:0 twice; L is 2 */
        double worst;
        uint32_t frame;
    } rows[] = {
        {"0.5:0,0.5:0", 0, 0},        {"0.25:0,0.5:0", 0.125, 1},
        {"0.25:0,1.5:0", 0.5, 2},     {"0.5:0,0.5:1", HUGE_VAL, 2},
        {"nan:0,0.5:0", HUGE_VAL, 1}, {"0.5:-,0.5:0", HUGE_VAL, 1},
    };
    static const mote_race_count counts[] = {
        {"boxes", {3, 5}}, {"leaves", {2, 0}}, {"pairs", {0, 1}}};
    script does = {.cell = "say 'ok\\t7\\t2\\t2'",
                   .run = "say 'ok\\t1\\tboxes=3,leaves=2\\t1000000,1000000'"};
    put_racer("a", does);
    does.run = "say 'ok\\t2\\tboxes=5,pairs=1\\t2000000,2000000'";
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_bout_result result;
        char answers[64];
        (void)snprintf(answers, sizeof answers, "say 'ok\\t%s'", rows[i].answers);
        does.answers = answers;
        put_racer("b", does);
        test_row("%s", rows[i].answers);
        assert_int_equal(fight("./a", "./b", &result), MOTE_OK);
        assert_true(fabs(result.log_ratio - log(2)) < 1e-12);
        assert_true(fabs(result.total_ns[0] - 1e6) < 1 && fabs(result.total_ns[1] - 2e6) < 1);
        assert_true(result.worst == rows[i].worst);
        assert_int_equal(result.worst_frame, rows[i].frame);
        assert_int_equal(result.count_count, ROWS_OF(counts));
        for (size_t k = 0; k < ROWS_OF(counts); ++k) {
            size_t at = 0;
            while (at < result.count_count &&
                   strcmp(result.counts[at].name, counts[k].name) != 0)
                ++at;
            assert_true(at < result.count_count);
            assert_true(result.counts[at].sum[0] == counts[k].sum[0] &&
                        result.counts[at].sum[1] == counts[k].sum[1]);
        }
    }
}

/* Impacts, and the pairs of more than two bodies: equal distances and contacts are not all. An
   older program does not tell the rest, which is then not compared. */
TEST(a_bout_compares_more_than_distances_and_contacts)
{
#define SET "00000000000000ff"
    static const struct {
        const char *a, *b; /* of the second frame; L is 2 */
        double worst;
    } rows[] = {
        {"nan:1:0:0.25:0.5", "nan:1:0:0.25:0.5", 0},
        {"nan:1:0:0.25:0.5", "nan:1:0:0.25:0.75", 0.25},
        {"nan:1:0:0.25:0.5", "nan:1:0:0.125:0.5", 0.125},
        {"nan:0:0:nan:nan", "nan:0:0:nan:nan", 0},
        {"nan:1:0:0.25:0.5", "nan:1:0:nan:nan", HUGE_VAL},
        {"nan:1:0:0.25:0.5", "nan:1", 0},
        {"0.5:1:" SET ":4:nan", "0.5:1:" SET ":4:nan", 0},
        {"0.5:1:" SET ":4:nan", "0.5:1:" SET ":4.5:nan", 0.5},
        {"0.5:1:" SET ":4:nan", "1:1:" SET ":4.125:nan", 0.25},
        {"0.5:1:" SET ":4:nan", "0.5:1:fe:4:nan", HUGE_VAL},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_bout_result result;
        const char *const sides[] = {rows[i].a, rows[i].b};
        for (int side = 0; side < 2; ++side) {
            char answers[128], run[64];
            (void)snprintf(answers, sizeof answers, "say 'ok\\tnan:0,%s'", sides[side]);
            (void)snprintf(run, sizeof run, "say 'ok\\t%d\\t-\\t" TIMES "'", side);
            put_racer(side ? "b" : "a",
                      (script){.cell = "say 'ok\\t7\\t2\\t2'", .run = run, .answers = answers});
        }
        test_row("%s, %s", rows[i].a, rows[i].b);
        assert_int_equal(fight("./a", "./b", &result), MOTE_OK);
        assert_true(result.worst == rows[i].worst);
        assert_int_equal(result.worst_frame, rows[i].worst > 0 ? 2 : 0);
    }
}

TEST(two_sides_without_a_distance_agree)
{
    mote_bout_result result;
    put_racer("a", (script){.answers = "say 'ok\\tnan:1,nan:-'"});
    put_racer("b", (script){.run = "say 'ok\\t2\\t-\\t" TIMES "'",
                            .answers = "say 'ok\\tnan:1,nan:-'"});
    assert_int_equal(fight("./a", "./b", &result), MOTE_OK);
    assert_true(result.worst == 0);
}

/* Passes continue for 0.1 s on both sides together, but there are 3 to 61. */
TEST(short_cells_are_measured_more_often)
{
    static const struct {
        const char *times;
        uint32_t passes;
    } rows[] = {{"0,0", 61}, {"500000,500000", 50}, {"750000,500000", 40}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_bout_result result;
        char run[64];
        (void)snprintf(run, sizeof run, "say 'ok\\t1\\t-\\t%s'", rows[i].times);
        put_racer("a", (script){.run = run});
        test_row("%s", rows[i].times);
        assert_int_equal(fight("./a", "./a", &result), MOTE_OK);
        assert_int_equal(result.passes, rows[i].passes);
        assert_true(result.log_ratio == 0);
    }
    mote_bout_result result;
    put_racer("slow",
              (script){.cell = "say 'ok\\t0\\t1\\t1'", .run = "say 'ok\\t1\\t-\\t200000000'"});
    assert_int_equal(fight("./slow", "./slow", &result), MOTE_OK);
    assert_int_equal(result.passes, 3);
}

static mote_status start_racer(const char *program, mote_racer *racer)
{
    mote_random random = {3};
    const mote_status status = mote_racer_start(program, -1, 20, &random, racer);
    return status == MOTE_OK ? mote_racer_greet(racer) : status;
}

TEST(a_racer_that_cannot_start_is_refused)
{
    static const struct {
        const char *program, *greet, *says;
        mote_status status;
    } rows[] = {
        {"./missing", NULL, "./missing: cannot be run: No such file", MOTE_EIO},
        {"./bad", "exit 0", "ended with status 0 before its greeting", MOTE_EIO},
        {"./bad", "say 'mote-race\\tnew'", "does not speak as a racer does", MOTE_EINVAL},
        {"./bad", "say 'mote-race'", "does not speak as a racer does", MOTE_EINVAL},
        {"./bad", "say 'mote-race\\t9'", "speaks format 9 of races", MOTE_EINVAL},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_racer racer;
        test_row("%s", rows[i].says);
        if (rows[i].greet)
            put_racer("bad", (script){.greet = rows[i].greet});
        assert_int_equal(start_racer(rows[i].program, &racer), rows[i].status);
        assert_non_null(strstr(mote_error_text(), rows[i].says));
        assert_int_equal(racer.pid, 0);
        mote_racer_stop(&racer);
    }
}

/* A program that ignores its children passes that on to those that it starts. */
TEST(how_a_racer_ended_is_known_under_a_parent_that_ignores_its_children)
{
    put_racer("dies", (script){.greet = "exit 3"});
    const int ended = system("trap '' CHLD; exec " MOTE_PROGRAM
                             " race ./good ./dies s --method certified > heard 2>&1");
    char *heard = file_text("heard");
    assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 4);
    assert_non_null(strstr(heard, "./dies: ended with status 3 before its greeting"));
    free(heard);
}

TEST(a_request_that_is_too_long_is_not_sent)
{
    static char name[8200];
    mote_racer racer;
    char *answer = NULL;
    memset(name, 'x', sizeof name - 1);
    assert_int_equal(start_racer("./good", &racer), MOTE_OK);
    assert_int_equal(mote_racer_ask(&racer, &answer, "cell\t%s", name), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "./good: names that are too long");
    assert_int_equal(mote_racer_ask(&racer, &answer, "cell"), MOTE_OK);
    assert_string_equal(answer, "0\t1\t2");
    mote_racer_stop(&racer);
}

/* A racer asks the race to stop, as a user does who presses Ctrl-C at that moment. */
TEST(a_race_stops_at_any_request)
{
#define STOP "kill -TERM $PPID; "
    static const script rows[] = {
        {.greet = STOP "exec sleep 9"},
        {.greet = STOP "say 'mote-race\\t1'"},
        {.cell = STOP "exec sleep 9"},
        {.run = STOP "exec sleep 9"},
        {.run = STOP "say 'ok\\t1\\t-\\t" TIMES "'"},
        {.run = "[ $n -gt 9 ] && " STOP "say 'ok\\t1\\t-\\t" TIMES "'"},
        {.run = "say 'ok\\t2\\t-\\t" TIMES "'", .answers = STOP "exec sleep 9"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        put_racer("stops", rows[i]);
        for (int side = 0; side < 2; ++side) {
            test_row("%zu, side %d", i, side);
            mote_expect(143, "stopped by a signal", "race %s s --method certified",
                        side == 0 ? "./stops ./good" : "./good ./stops");
        }
    }
}

/* A racer of one frame whose time depends on the layout of its memory: the sizes of its
   environment differ from process to process. */
static void put_varying(const char *name, int each)
{
    char run[128];
    (void)snprintf(run, sizeof run,
                   "say \"ok\\t1\\t-\\t$((100000000 + %d * ${#MOTE_RACE_PADDING}))\"", each);
    put_racer(name, (script){.cell = "say 'ok\\t0\\t1\\t1'", .run = run});
}

#define RACE "race a b s --method certified --seed 1 --format json "

TEST(a_race_looks_six_times_at_most)
{
    put_varying("a", 30000);
    put_varying("b", 30000);
    mote_expect(3, "\"looks\": 6", RACE "--until 0.001%% --real 0.001%% --budget 0");
    assert_non_null(strstr(said, "\"pairs\": 81,"));
    assert_non_null(strstr(said, "\"units\": 81,"));
    assert_non_null(strstr(said, "\"verdict\": \"undecided\""));
}

TEST(a_race_ends_when_its_ratio_is_known)
{
    put_varying("a", 0);
    put_varying("b", 100);
    mote_expect(0, "\"looks\": 1", RACE "--until 1%% --real 1%%");
    assert_non_null(strstr(said, "\"verdict\": \"same\""));
    put_varying("b", 30000);
    mote_expect(1, "\"verdict\": \"slower\"", RACE "--until 50%% --real 1%%");
    mote_expect(0, "\"verdict\": \"same\"", RACE "--until 90%% --real 90%%");
}

TEST(a_race_ends_with_its_budget)
{
    put_varying("a", 0);
    put_varying("b", 0);
    mote_expect(3, "\"pairs\": 1,", RACE "--budget 0.0001");
    assert_non_null(strstr(said, "\"spread\": null"));
    assert_non_null(strstr(said, "\"ci_low\": null"));
    mote_expect(3, "no interval undecided", "race a b s --method certified --budget 0.0001");
    assert_non_null(strstr(said, "undecided: more time (--budget) may decide after 1 pairs"));
}

/* Planted: pairs of builds that differ by these logarithms in every process. */
#define BUILDS 12
static const double apart[BUILDS] = {-0.007, -0.004, -0.002, 0.001, 0.003,  0.005,
                                     0.006,  0.008,  0.009,  0.011, 0.0135, 0.017};

/* Makes racers of one frame in the folders a and b. layout: how far the order of linking
   changes the times of both sides, as a logarithm. */
static void put_builds(size_t a, size_t b, double layout)
{
    const size_t counts[] = {a, b};
    for (size_t side = 0; side < 2; ++side) {
        assert_int_equal(mkdir(side ? "b" : "a", 0755), 0);
        for (size_t k = 0; k < counts[side]; ++k) {
            char name[32], run[64];
            const double change = layout * cos((double)k) + (side ? apart[k] : 0);
            (void)snprintf(name, sizeof name, "%s/mote-%02zu", side ? "b" : "a", k + 1);
            (void)snprintf(run, sizeof run, "say 'ok\\t1\\t-\\t%.0f'", 1e8 * exp(change));
            put_racer(name, (script){.cell = "say 'ok\\t0\\t1\\t1'", .run = run});
        }
    }
}

static double number_of(const json_t *row, const char *key)
{
    return json_number_value(json_object_get(row, key));
}

/* However many processes are raced, twelve orders of linking are a sample of twelve. */
TEST(an_interval_is_over_the_pairs_of_builds_and_covers_how_they_differ)
{
    static const double layouts[] = {0, 0.1};
    const mote_confidence expected =
        mote_paired_interval(apart, BUILDS, MOTE_RACE_ALPHA / MOTE_RACE_LOOKS);
    assert_true(expected.low < 0 && expected.high > 0);
    for (size_t i = 0; i < ROWS_OF(layouts); ++i) {
        test_row("layout %g", layouts[i]);
        assert_int_equal(folder_next(), 0);
        put_builds(BUILDS, BUILDS, layouts[i]);
        mote_expect(3, "12 builds  0.72 %",
                    "race a b s --method certified --seed 1 "
                    "--until 0.001%% --real 0.1%% --budget 0 --out race");
        assert_non_null(strstr(said, "time B / A over 12 pairs of builds; "));
        assert_non_null(strstr(said, "undecided: a quieter machine, or more builds"));
        json_t *race = json_load_file("race", 0, NULL);
        const json_t *row = json_array_get(json_object_get(race, "rows"), 0);
        assert_true(fabs(log(number_of(row, "ci_low")) - expected.low) < 1e-7);
        assert_true(fabs(log(number_of(row, "ci_high")) - expected.high) < 1e-7);
        assert_true(fabs(log(number_of(row, "ratio")) - mote_paired_centre(apart, BUILDS)) <
                    1e-7);
        assert_true(number_of(row, "units") == BUILDS && number_of(row, "pairs") == 81);
        json_decref(race);
    }
}

TEST(too_few_builds_for_any_interval_are_refused)
{
    static const struct {
        size_t a, b;
        const char *methods, *says;
    } rows[] = {
        {10, 12, "--method certified",
         "10 builds of A and 12 of B: 10 pairs of builds give no interval, 11 are needed (rows "
         "raced: 1); link more by relink.sh BUILD 11 OUT (make perf-ab: ORDERS=11)"},
        {12, 2, "--method certified", "12 builds of A and 2 of B: 2 pairs of builds"},
        {12, 11, "--method certified --method stream",
         "11 pairs of builds give no interval, 12"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%zu and %zu", rows[i].a, rows[i].b);
        assert_int_equal(folder_next(), 0);
        put_builds(rows[i].a, rows[i].b, 0);
        mote_expect(4, rows[i].says, "race a b s %s", rows[i].methods);
    }
    assert_int_equal(folder_next(), 0);
    put_builds(1, 3, 0); /* of a program, each pair of processes is a value */
    mote_expect(0, "11 pairs  ", "race a b s --method certified --seed 1 --until 5%%");
    assert_non_null(
        strstr(said, "time B / A of these programs, with the layouts that they have"));
}

/* A method that begins to fail is worse; more time would decide nothing. */
TEST(a_side_that_fails_in_a_frame_is_worse_and_one_without_the_method_is_left_out)
{
    static const script fails = {.cell = "say 'ok\\t0\\t1\\t1'",
                                 .run = "say 'no\\tframe 7: the method failed'"},
                        works = {.cell = "say 'ok\\t0\\t1\\t1'",
                                 .run = "say 'ok\\t1\\t-\\t100000000'"},
                        lacks = {.cell = "case $line in *certified*) say 'ok\\t0\\t1\\t1' ;; "
                                         "*) say 'no\\tlost' ;; esac",
                                 .run = "say 'ok\\t1\\t-\\t100000000'"};
    static const struct {
        const script *a, *b;
        int status;
        const char *row, *last;
    } rows[] = {
        {&works, &fails, 1, " WORSE: B: frame 7: the method failed\n", "worse after "},
        {&fails, &works, 0, " : A: frame 7: the method failed\n", "same or better after "},
        {&fails, &fails, 0, " : A: frame 7: the method failed; B: frame 7: the method failed\n",
         "same or better after "},
        {&works, &lacks, 3, " : B: lost\n", "undecided after "},
        {&lacks, &works, 0, " : A: lost\n", "same or better after "},
        {&lacks, &lacks, 0, " : A: lost; B: lost\n", "same or better after "},
        {&lacks, &fails, 1, " : A: lost\n", "worse after "}, /* the other row fails in B */
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%zu", i);
        put_racer("a", *rows[i].a);
        put_racer("b", *rows[i].b);
        mote_expect(rows[i].status, rows[i].row,
                    "race ./a ./b s --method certified --method stream --seed 1");
        assert_non_null(strstr(said, rows[i].last));
    }
}

/* Rows are judged one by one: the worst one decides, wherever it stands. */
TEST(a_race_is_as_good_as_its_worst_row)
{
    static const char slow[] = "case $line in *certified*) say 'ok\\t0\\t1\\t1' ;; "
                               "*) say 'no\\tlost' ;; esac",
                      dies[] =
                          "case $line in *certified*) exit 3 ;; *) say 'no\\tlost' ;; esac";
    static const struct {
        const char *cell, *methods;
        int status;
    } rows[] = {
        {slow, "--method certified --method stream", 1},
        {slow, "--method stream --method certified", 1},
        {dies, "--method certified --method stream", 1},
        {dies, "--method stream --method certified", 1},
        {dies, "--method stream --method aabb-tree", 4},
    };
    put_varying("a", 0);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].methods);
        put_racer("b", (script){.cell = rows[i].cell, .run = "say 'ok\\t1\\t-\\t200000000'"});
        mote_expect(rows[i].status, "lost", "race a b s %s --seed 1", rows[i].methods);
    }
}
