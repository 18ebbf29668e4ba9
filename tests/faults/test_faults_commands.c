/* Each command runs while every place where it asks for files, processes or memory fails
   once. */
#include "tests/faults/fault_lines.h"
#include "tests/support/test.h"

#include <stddef.h>

/* It asks for memory only. */
static const fault_line of_nothing[] = {LINE(list, " methods --json", 0)};

static const fault_line of_a_file[] = {
    LINE(list, " scenarios", 0),
    LINE(mesh, " a.obj --json", 0),
    LINE(distance, " a.obj a.obj --json --method certified", 0),
    LINE(letter, " T --triangles 400 -o out.obj", 0),
};

static const fault_line of_a_scenario[] = {
    LINE(check, " s.json --out out", 0),
    LINE(check, " s.json --out run --json", 0),
    LINE(export, " s.json --frame 2 --out out --method particle:n=2", 0),
    LINE(approach, " s.json --gaps 1:0.1,4:0.05 -o out.json", 0),
    LINE(simulate, " s.json --method certified --json --trace trace.json", 0),
    LINE(simulate, " b.json --method certified --json", 0),
};

/* Never name a device here: where stat fails, it may be replaced. */
static const fault_line of_further_forms[] = {
    LINE(letter, " T --triangles 400 --order leaf -o out.obj", 0),
    LINE(letter, " T --triangles 400 --order random -o /dev/stdout", 0),
    LINE(simulate, " s.json --method certified --steps 2 --replicates 2 --out out", 0),
};

static const fault_line of_measuring[] = {
    LINE(run, " s.json --method aabb-tree --replicates 1 --stride 1 --out out", 0),
    LINE(run, " b.json --method certified --replicates 1 --out out", 0),
};

static const fault_line of_a_run[] = {
    LINE(summarize, " run", 0),
    LINE(summarize, " run --format json", 0),
    LINE(summarize, " run --format csv", 0),
    LINE(summarize, " run --format gbench", 0),
    LINE(summarize, " run --format gha", 0),
    LINE(summarize, " run --format bencher", 0),
    LINE(compare, " run run --format json", 0),
    LINE(compare, " run run --format table", 0),
    LINE(tune, " run", 0),
    LINE(tune, " run --best-fcl s", 0),
    LINE(merge, " out run", 0),
    LINE(instructions, " s.json --frames 1-2 --out out --method certified", 0),
    LINE(instructions, " s.json --frames 1-2 --out run --method certified", 0),
};

static const fault_line of_pages[] = {
    LINE(figures, " run", 0),         LINE(report, " run", 0),
    LINE(site, " run -o out", 0),     LINE(history, " history.csv --add run --why better", 0),
    LINE(history, " history.csv", 0),
};

TEST(commands_of_one_file_when_a_call_fails_say_so)
{
    FAIL_EACH(of_a_file);
}

TEST(commands_of_one_file_whose_memory_runs_out_end_with_a_line)
{
    EXHAUST_EACH(of_nothing);
    EXHAUST_EACH(of_a_file);
}

TEST(commands_of_a_scenario_when_a_call_fails_say_so)
{
    FAIL_EACH(of_a_scenario);
}

TEST(commands_of_a_scenario_whose_memory_runs_out_end_with_a_line)
{
    EXHAUST_EACH(of_a_scenario);
}

TEST(commands_of_further_forms_when_a_call_fails_say_so)
{
    FAIL_EACH(of_further_forms);
}

TEST(run_when_a_call_fails_says_so)
{
    FAIL_EACH(of_measuring);
}

TEST(run_whose_memory_runs_out_ends_with_a_line)
{
    EXHAUST_EACH(of_measuring);
}

TEST(commands_of_a_stored_run_when_a_call_fails_say_so)
{
    FAIL_EACH(of_a_run);
}

TEST(pages_of_a_stored_run_when_a_call_fails_say_so)
{
    FAIL_EACH(of_pages);
}

TEST(pages_of_a_stored_run_whose_memory_runs_out_end_with_a_line)
{
    EXHAUST_EACH(of_pages);
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
