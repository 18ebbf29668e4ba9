/* Questions about impacts and simulations, while each place where they ask for memory, files or
   processes fails once. */
#include "tests/faults/fault_lines.h"
#include "tests/support/test.h"

#include <stddef.h>

/* The second body flies through the first within a gap; the same, sought in steps. */
#define FLIGHT                                                                                 \
    "{\"purpose\": \"a test\", \"frames\": 3, \"ask\": \"impact\", \"step\": 1, \"bodies\": [" \
    "{\"file\": \"a.obj\"}, {\"file\": \"a.obj\", \"motion\": [{\"frame\": 1, \"position\": "  \
    "[2.1, 0.1, 0]}, {\"frame\": 3, \"position\": [-2.3, 0.1, 0]}]}]}\n"

static const fault_line of_impacts[] = {
    LINE(
        run,
        " i.json --method certified --method impact-sampled:samples=3 --replicates 1 --out out",
        0),
    LINE(check, " i.json", 0),
    LINE(instructions, " i.json --frames 1-3 --method certified --inside", 0),
};

static const fault_line of_simulations[] = {
    LINE(simulate, " s.json --method aabb-tree --steps 2 --replicates 2 --out out", 0),
    LINE(simulate,
         " s.json --method certified --steps 2 --until-ci 0.001% --budget 0 --out out/new", 0),
    LINE(merge, " out sims", 0),
};

static const fault_line of_steps[] = {
    LINE(simulate, " s.json --method certified --steps 2 --step 2", 0),
    LINE(simulate, " b.json --method certified --steps 2 --step 1", 0),
    LINE(simulate, " b.json --method aabb-tree --steps 1 --step 2 --sampled", 0),
};

static const fault_line of_methods[] = {
    LINE(run, " b.json --method stream --replicates 1 --frames 1-2 --out out", 0),
    LINE(run, " b.json --method particle:n=2 --replicates 1 --frames 1-2 --out out", 0),
    LINE(run, " s.json --method stream --method auto --replicates 1 --frames 1-2 --out out", 0),
    LINE(check, " b.json", 0),
};

TEST(impacts_when_a_call_fails_say_so)
{
    FAIL_EACH(of_impacts);
}

TEST(impacts_whose_memory_runs_out_end_with_a_line)
{
    EXHAUST_EACH(of_impacts);
}

TEST(simulations_when_a_call_fails_say_so)
{
    FAIL_EACH(of_simulations);
}

TEST(simulations_within_steps_whose_memory_runs_out_end_with_a_line)
{
    EXHAUST_EACH(of_steps);
}

TEST(methods_of_scenes_whose_memory_runs_out_end_with_a_line)
{
    EXHAUST_EACH(of_methods);
}

static int make_files(void)
{
    static const fault_line kept[] = {
        LINE(simulate, " s.json --method aabb-tree --steps 2 --replicates 2 --out sims", 0)};
    return fault_lines_open() && fault_lines_write("i.json", FLIGHT) && fault_lines_run(kept, 1)
               ? 0
               : -1;
}

TEST_GROUP(make_files, fault_lines_close);
