#define _DEFAULT_SOURCE /* forkpty */
/* What a person sees during a run: one moving line on a terminal, separate lines elsewhere. */
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <pty.h>
#include <stdbool.h>

/* Two configurations in two replicates: four cells. */
#define LINE                                                                                   \
    "run tt --frames 1-20 --method certified --method particle-paper:n=3 --replicates 2 "      \
    "--out ."

static void run_into_file(const char *more)
{
    assert_int_equal(folder_next(), 0);
    mote_expect(0, "", LINE " %s", more);
}

/* In the current folder. */
static void go_on_on_terminal(const char *more, unsigned short columns)
{
    char line[512], *argv[PROGRAM_ARGUMENTS];
    const struct winsize size = {.ws_row = 24, .ws_col = columns};
    int terminal;
    (void)snprintf(line, sizeof line, LINE " %s", more);
    const pid_t pid = forkpty(&terminal, NULL, NULL, &size);
    assert_true(pid >= 0);
    if (pid == 0) {
        program_split(line, argv);
        (void)execv(argv[0], argv);
        _exit(127);
    }
    size_t used = 0;
    for (ssize_t got; used + 1 < sizeof said; used += (size_t)got) {
        got = read(terminal, said + used, sizeof said - 1 - used);
        if (got <= 0) /* EIO: the program has ended */
            break;
    }
    said[used] = '\0';
    (void)close(terminal);
    assert_int_equal(program_wait(pid), 0);
}

static void run_on_terminal(unsigned short columns)
{
    assert_int_equal(folder_next(), 0);
    go_on_on_terminal("", columns);
}

TEST(progress_in_a_file_is_a_line_a_cell)
{
    run_into_file("");
    assert_int_equal(test_count(said, "plan: 4 cells, 0 of them done"), 1);
    assert_int_equal(test_count(said, ": ok, "), 4);
    assert_int_equal(test_count(said, "\r"), 0);
}

/* The interval between lines is longer than the run. */
TEST(progress_in_a_file_with_a_pause_is_a_line_after_each)
{
    run_into_file("--progress 1000");
    assert_int_equal(test_count(said, "plan: 4 cells, 0 of them done"), 1);
    assert_int_equal(test_count(said, ": ok, "), 0);
    run_into_file("--progress 1e-9");
    assert_true(test_count(said, ": ok, ") == 4 && test_count(said, "[0/4] tt ") >= 1);
}

/* Moving lines are cut to the terminal's width, because a longer one could not be erased. */
TEST(progress_on_a_terminal_is_one_line_that_moves)
{
    static const char begin[] = "\r\033[K";
    run_on_terminal(30);
    size_t moved = 0;
    for (const char *at = said; (at = strstr(at, begin)) != NULL; ++moved) {
        at += strlen(begin);
        const char *next = strstr(at, begin), *feed = strchr(at, '\n');
        if (next && (!feed || next < feed) && next - at > 29)
            fail_msg("%.60s", at);
    }
    assert_true(moved > 4);
    assert_int_equal(test_count(said, "\r\033[K4 cells measured in "), 1);
    assert_int_equal(test_count(said, " s left\r\n"), 0); /* none remains */
}

/* A third replicate is stored; the budget ends before one that is not. */
TEST(a_run_that_goes_on_counts_only_what_it_measures_itself)
{
    run_into_file("--replicates 3");
    go_on_on_terminal("--until-ci 0.001% --budget 0", 100);
    assert_int_equal(test_count(said, "plan: 4 cells, 4 of them done"), 1);
    assert_int_equal(test_count(said, " cells measured in "), 0);
}

/* The table of all columns is twice as wide as a terminal. */
TEST(a_run_on_a_terminal_ends_with_the_best_rows)
{
    run_on_terminal(100);
    assert_int_equal(test_count(said, "* certified"), 1);
    assert_int_equal(test_count(said, "mote summarize "), 1);
    for (const char *line = strstr(said, "tt: 1380"); line && *line;) {
        const size_t length = strcspn(line, "\r\n");
        assert_true(length <= 100);
        line += length + strspn(line + length, "\r\n");
    }
    run_into_file("--progress 1000");
    assert_null(strstr(said, "* certified"));
    assert_non_null(strstr(said, "p95"));
}
