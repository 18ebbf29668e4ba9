/* Races, and the child of a race, while each place where they ask for memory, files or
   processes fails once. */
#include "tests/faults/fault_lines.h"
#include "tests/support/test.h"

#include "harness/base/file.h"
#include "harness/race/history_page.h"
#include "harness/race/race_child.h"

#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/stat.h>

/* A racer that measures two frames; the answers of its last block vary with its name. */
#define RACER                                                                                  \
    "#!/bin/sh\nprintf 'mote-race\\t1\\n'\nwhile read -r line; do\ncase $line in\n"            \
    "cell*) printf 'ok\\t0\\t1\\t2\\n' ;;\n"                                                   \
    "run*) printf \"ok\\t${#0}\\tboxes=3\\t3000000,3000000\\n\" ;;\n"                          \
    "*) printf \"ok\\t0.${#0}:0,0.5:0\\n\" ;;\nesac\ndone\n"

/* The cells and their frames, as `mote race` asks for them. */
#define ASKED                                                                                  \
    "cell\ts.json\t1\t0\thot\t1\t1\taabb-tree\ncell\ts.json\t2\t3\tevict\t1\t1\tparticle\n"    \
    "cell\tb.json\t1\t4\thot\t1\t0\tcertified\nrun\t0\t1\t4\nrun\t1\t2\t2\nrun\t2\t1\t4\n"     \
    "answers\t0\nanswers\t1\nanswers\t2\n"

#define RACE                                                                                   \
    "{\"schema\": 1, \"date\": \"2026-01-01\", \"a\": \"one\", \"b\": \"two\", \"verdict\": "  \
    "\"worse\", \"rows\": [{\"name\": \"s/aabb-tree/hot\", \"ratio\": 1.1, \"ci_low\": "       \
    "1.01, \"ci_high\": 1.2, \"verdict\": \"slower\", \"worse\": true, \"what\": \"why\"}]}\n"

/* A race tells in its table which side failed, and not in a line of its own. */
static int race(int argc, char **argv)
{
    (void)signal(SIGPIPE, SIG_IGN); /* as the program does */
    const int code = mote_command_race(argc, argv);
    if (code != MOTE_EXIT_DONE && code != MOTE_EXIT_CHECK_FAILED)
        return code;
    (void)fprintf(stderr, "mote: the table names a side that failed\n");
    return MOTE_EXIT_CHECK_FAILED;
}

/* Serves what has been asked, as a process that `mote race` started does. */
static int serve(int argc, char **argv)
{
    return freopen("asked", "r", stdin) ? mote_race_child(argc, argv) : 1;
}

static int draw_history(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    return mote_directory_make("out") == MOTE_OK &&
                   mote_history_page("history.csv", "races", "out/h.html") == MOTE_OK
               ? 0
               : mote_command_fail();
}

static const fault_line of_a_race[] = {
    {"race bin/a bin/other s.json --method certified --until 9% --budget 0.0001 --seed 1 "
     "--allow-changes --out out.json",
     race, MOTE_EXIT_UNDECIDED},
    {"race bin/a builds s.json --method certified --budget 0.0001 --seed 1 --allow-changes "
     "--labels a,b "
     "--format json",
     race, MOTE_EXIT_UNDECIDED},
};

static const fault_line of_a_child[] = {{"race-child --core 1 --heap 99", serve, 0}};

static const fault_line of_a_page[] = {{"the history", draw_history, 0}};

TEST(races_when_a_call_fails_say_so)
{
    FAIL_EACH(of_a_race);
}

TEST(races_whose_memory_runs_out_end_with_a_line)
{
    EXHAUST_EACH(of_a_race);
}

TEST(a_child_of_a_race_when_a_call_fails_says_so)
{
    FAIL_EACH(of_a_child);
}

TEST(a_child_of_a_race_whose_memory_runs_out_ends_with_a_line)
{
    EXHAUST_EACH(of_a_child);
}

TEST(a_page_of_races_when_a_call_fails_says_so)
{
    FAIL_EACH(of_a_page);
}

static int make_files(void)
{
    static const char *const racers[] = {"bin/a", "bin/other", "builds/one", "builds/two"};
    static const fault_line history[] = {
        LINE(run, " s.json --method aabb-tree --replicates 1 --out run", 0),
        LINE(history, " history.csv --add run --why first", 0)};
    if (!fault_lines_open() || mkdir("builds", 0700) != 0 || mkdir("races", 0700) != 0 ||
        !fault_lines_write("asked", ASKED) || !fault_lines_write("races/a.json", RACE) ||
        !fault_lines_run(history, 2))
        return -1;
    for (size_t i = 0; i < ROWS_OF(racers); ++i) {
        if (!fault_lines_write(racers[i], RACER) || chmod(racers[i], 0755) != 0)
            return -1;
    }
    return 0;
}

TEST_GROUP(make_files, fault_lines_close);
