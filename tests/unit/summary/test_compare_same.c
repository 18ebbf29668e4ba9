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
