/* Which rows of two runs have the same configuration. */
#include "tests/support/folder.h"
#include "tests/support/test.h"
#include "tests/support/two_runs.h"

TEST(rows_are_compared_if_everything_they_ask_is_the_same)
{
    static const struct {
        const char *members; /* of the new run's row */
        bool same;
    } rows[] = {
        {"{}", true},
        {"{'scenario': 'mv'}", false},
        {"{'fingerprint': 'f'}", false},
        {"{'method': 'particle'}", false},
        {"{'cache': 'evict'}", false},
        {"{'stride': 2}", false},
        {"{'seed': 7}", false},
        {"{'frames': 99}", false},
        {"{'parameters': {'n': 6}}", false},
        /* A parameter that the older run did not know has its default there. */
        {"{'parameters': {'start': 'random'}}", true},
        {"{'parameters': {'start': 'fps'}}", false},
        {"{'parameters': {'start': 0}}", false},
        {"{'parameters': {'unheard_of': 'random'}}", false},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].members);
        write_run("old", &usual, 1);
        write_run("new", &usual, -1);
        change_row("new", "summary.json", rows[i].members);
        if (rows[i].same)
            expect("", 0, "same or better");
        else
            expect("", 4, "no configuration in common");
    }
}

#define ASKED                                                                                  \
    "'frame_range': [1, 100], 'ask': 'impact', 'step': 3, 'tolerance': 0.5, 'faces': 'f', "    \
    "'seeds': 'own'"

/* What both runs say must be the same; an older run does not say all of it. */
TEST(rows_are_compared_if_frames_and_questions_are_the_same)
{
    static const struct {
        const char *old_members, *new_members;
        bool same;
    } rows[] = {
        {"{" ASKED "}", "{" ASKED "}", true},
        {"{" ASKED "}", "{" ASKED ", 'frame_range': [2, 101]}", false},
        {"{" ASKED "}", "{" ASKED ", 'frame_range': [1, 101]}", false},
        {"{" ASKED "}", "{" ASKED ", 'frame_range': [0, 0]}", true},
        {"{" ASKED "}", "{" ASKED ", 'step': 4}", false},
        {"{" ASKED ", 'step': null}", "{" ASKED "}", false},
        {"{" ASKED "}", "{" ASKED ", 'ask': 'contact'}", false},
        {"{" ASKED "}", "{" ASKED ", 'ask': null}", true},
        {"{" ASKED "}", "{" ASKED ", 'tolerance': 0.25}", false},
        {"{" ASKED "}", "{" ASKED ", 'tolerance': null}", true},
        {"{" ASKED "}", "{" ASKED ", 'faces': 'g'}", false},
        {"{" ASKED "}", "{" ASKED ", 'faces': null}", true},
        {"{" ASKED "}", "{" ASKED ", 'seeds': 'fixed'}", false},
        {"{" ASKED "}", "{" ASKED ", 'seeds': null}", true},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s, %s", rows[i].old_members, rows[i].new_members);
        write_run("old", &usual, 1);
        write_run("new", &usual, -1);
        change_row("old", "summary.json", rows[i].old_members);
        change_row("new", "summary.json", rows[i].new_members);
        const char *text = rows[i].same ? "same or better" : "no configuration in common";
        expect("", rows[i].same ? 0 : 4, text);
        mote_expect(rows[i].same ? 0 : 4, text, "compare new old");
    }
}

/* Rows of one method over other frames are compared each with its own, and named by them. */
TEST(rows_of_other_frames_are_compared_each_with_its_own)
{
    for (int k = 0; k < 2; ++k) {
        write_run(k ? "new" : "old", &usual, k ? -1 : 1);
        add_row(k ? "new" : "old", k ? "{'frame_range': [101, 200], 'missed': 3}"
                                     : "{'frame_range': [1, 100], 'missed': 7}");
        change_row_at(k ? "new" : "old", "summary.json", 1,
                      k ? "{'frame_range': [1, 100], 'missed': 7}"
                        : "{'frame_range': [101, 200], 'missed': 3}");
    }
    expect("", 0, "ww@1-100/particle-paper:n=5/hot");
    assert_non_null(strstr(said, "ww@101-200/particle-paper:n=5/hot"));
    assert_null(strstr(said, "missed"));
}

/* A run may have been measured with --jobs and without: times are compared with times. */
TEST(rows_whose_times_are_comparable_are_compared_with_such_rows)
{
    figures slow = usual;
    slow.ratio /= 2;
    write_run("old", &usual, 1);
    write_run("new", &slow, -1);
    add_row("new", "{'times_comparable': false, 'jobs': 2}");
    expect("", 1, "slower");
    add_row("old", "{'times_comparable': false, 'jobs': 2}");
    expect("", 1, "slower");
    assert_int_equal(test_count(said, "times not comparable: measured with --jobs"), 1);
}

/* Of a method that this build does not know no default is known. */
TEST(parameters_of_unknown_methods_have_no_default)
{
    static const char unknown[] = "{'method': 'unheard-of'}";
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    change_row("old", "summary.json", unknown);
    change_row("new", "summary.json", unknown);
    expect("", 0, "same or better");
    change_row("new", "summary.json", "{'parameters': {'start': 'random'}}");
    expect("", 4, "no configuration in common");
}
