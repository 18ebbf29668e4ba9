/* Every place where a command asks for memory, files or processes, failing once. */
#include "tests/faults/fault_lines.h"
#include "tests/support/test.h"

#include <stddef.h>

TEST(commands_of_one_file_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(list, " methods --json", 0),
        LINE(list, " scenarios", 0),
        LINE(mesh, " a.obj --json", 0),
        LINE(distance, " a.obj a.obj --json --method certified", 0),
        LINE(letter, " T --triangles 400 -o out.obj", 0),
    };
    FAIL_EACH(list);
}

TEST(commands_of_a_scenario_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(check, " s.json --out out", 0),
        LINE(check, " s.json --out run --json", 0),
        LINE(export, " s.json --frame 2 --out out --method particle:n=2", 0),
        LINE(approach, " s.json --gaps 1:0.1,4:0.05 -o out.json", 0),
        LINE(simulate, " s.json --method certified --json --trace trace.json", 0),
        LINE(simulate, " b.json --method certified --json", 0),
    };
    FAIL_EACH(list);
}

TEST(run_when_a_call_fails_says_so)
{
    static const fault_line list[] = {
        LINE(run, " s.json --method aabb-tree --replicates 1 --stride 1 --out out", 0),
        LINE(run, " b.json --method certified --replicates 1 --out out", 0),
    };
    FAIL_EACH(list);
}

TEST(commands_of_a_stored_run_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(summarize, " run", 0),
        LINE(summarize, " run --format json", 0),
        LINE(summarize, " run --format csv", 0),
        LINE(summarize, " run --format gbench", 0),
        LINE(summarize, " run --format gha", 0),
        LINE(summarize, " run --format bencher", 0),
        LINE(compare, " run run --format json", 0),
        LINE(compare, " run run", 0),
        LINE(tune, " run", 0),
        LINE(tune, " run --best-fcl s", 0),
        LINE(merge, " out run", 0),
        LINE(instructions, " s.json --frames 1-2 --out out --method certified", 0),
        LINE(instructions, " s.json --frames 1-2 --out run --method certified", 0),
    };
    FAIL_EACH(list);
}

TEST(pages_of_a_stored_run_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(figures, " run", 0),
        LINE(report, " run", 0),
        LINE(history, " history.csv --add run --why better", 0),
        LINE(history, " history.csv", 0),
    };
    FAIL_EACH(list);
}

static int make_files(void)
{
    static const fault_line runs[] = {
        LINE(run,
             " s.json --method fcl-aabb --method particle-paper:n=2 --replicates 2 --stride 1 "
             "--out run",
             0),
        LINE(history, " history.csv --add run --why first", 0),
        LINE(instructions,
             " s.json --frames 1-2 --out run --method fcl-aabb --method certified", 0)};
    return fault_lines_open() && fault_lines_run(runs, 3) ? 0 : -1;
}

TEST_GROUP(make_files, fault_lines_close);
