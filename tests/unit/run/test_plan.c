/* What `mote run` plans, and what it refuses to plan, without a measurement. */
#include "tests/support/command_lines.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#define LETTER "{\"letter\": \"T\", \"triangles\": 400}"
#define SCENARIO(asks)                                                                         \
    "{\"purpose\": \"p\", \"frames\": 5, " asks ", \"bodies\": [" LETTER                       \
    ", {\"letter\": \"T\", \"triangles\": 400, \"motion\": [{\"frame\": 1, \"position\": [8, " \
    "0, 0]}, {\"frame\": 5, \"position\": [-0.9, 0, 0]}]}]}"

static int put_files(void)
{
    file_put("plain.json", SCENARIO("\"ask\": \"distance\""));
    file_put("pass.json", SCENARIO("\"ask\": \"impact\", \"step\": 2"));
    file_put(
        "many.json",
        "{\"purpose\": \"p\", \"frames\": 4, \"ask\": \"distance\", \"bodies\": {\"count\": "
        "3, \"seed\": 1, \"box\": 20, \"shapes\": [" LETTER "]}}");
    return 0;
}

TEST_GROUP(put_files, NULL);

TEST(plans_that_cannot_be_are_refused)
{
    static const command_line lines[] = {
        {"run pass.json --step 2,9,10 --out x", 4, "a step of 9 frames"},
        {"run many.json --step 2 --out x", 4, "impacts are asked of two bodies; it has 3"},
        {"run pass.json --frames 1-2 --out x", 4, "as a step of pass is 2 frames"},
        {"run plain.json --frames 2-6 --out x", 4, "it has frames 1-5"},
        {"run plain.json --method 'one|two' --out x", 4, "unknown method one"},
        {"run plain.json --method 'certified:seed|none' --out x", 4,
         "not of the form key=value"},
        {"run plain.json --method 'certified:seed=none|no' --out x", 4, "seed=no is not valid"},
        {"run plain.json --method 'certified:slack=0,seed=none|no' --out x", 4,
         "seed=no is not valid"},
        {"run plain.json --method certified:threads=2 --out x", 4, "leave them out"},
        {"run pass.json --method certified:threads=2 --out x", 4, "leave them out"},
        {"run plain.json --method particle --particles 1-20000 --out x", 2,
         "more than 10000 particle counts"},
        {"run plain.json --method particle-paper --particles 1-6000 --method particle "
         "--particles 1-6000 --out x",
         4, "more than 10000 configurations; split the run"},
    };
    command_refuses(lines, ROWS_OF(lines));
}

/* Lines of a plan, each once. */
static void expect_plan(const char *arguments, const char *const *lines, size_t count)
{
    mote_expect(0, "plan: ", "run %s --out planned --dry-run", arguments);
    for (size_t i = 0; i < count; ++i) {
        const char *found = strstr(said, lines[i]);
        if (!found || strstr(found + 1, lines[i]))
            fail_msg("%s: not once \"%s\" but:\n%s", arguments, lines[i], said);
    }
    assert_false(file_exists("planned"));
}

TEST(questions_about_impacts_are_planned_by_their_steps)
{
    static const char *const own[] =
        {"pass certified replicate 1, frames 1-5, stride 2, step 2",
         "pass fcl-continuous replicate 1", "pass impact-sampled replicate 1"},
                             *const given[] =
                                 {
                                     "pass certified replicate 1, frames 1-5, stride 1, step 1",
                                     "pass certified replicate 1, frames 1-5, stride 2, step 2",
                                 },
                             *const strided[] = {
                                 "replicate 1, frames 1-5, stride 1, step 1",
                                 "replicate 1, frames 1-5, stride 1, step 2",
                             };
    expect_plan("pass.json", own, ROWS_OF(own));
    assert_null(strstr(said, "fcl-aabb")); /* only methods that answer impacts */
    expect_plan("pass.json --method certified --step 1,2", given, ROWS_OF(given));
    expect_plan("plain.json --method certified --step 1,2 --frames 1-5 --stride 1", strided,
                ROWS_OF(strided));
}

/* Where a stride would change what a method remembers, the plan says that there is none. */
TEST(a_stride_that_does_not_hold_is_told)
{
    static const struct {
        const char *arguments, *names; /* NULL: nothing is told */
    } cases[] = {
        {"plain.json --stride 2 --method certified:seed=none --method certified --method "
         "particle --method fcl-aabb:seed=none --replicates 2",
         "every frame: certified, particle\n"},
        {"plain.json many.json --stride 2 --method certified --method aabb-tree:seed=none",
         "every frame: certified, all methods on many\n"},
        {"many.json --stride 3 --method certified", "every frame: all methods on many\n"},
        {"plain.json --stride 2 --method certified:seed=none", NULL},
        {"plain.json many.json --stride 1 --method certified", NULL},
        {"plain.json many.json --method certified", NULL},
        {"plain.json --step 1 --stride 2 --method certified", NULL},
    };
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        test_row("%s", cases[i].arguments);
        mote_expect(0, cases[i].names ? cases[i].names : "plan: ",
                    "run %s --out planned --dry-run", cases[i].arguments);
        assert_int_equal(strstr(said, "does not hold") != NULL, cases[i].names != NULL);
    }
}

TEST(lists_of_values_are_planned_one_by_one)
{
    static const char *const both[] = {
        "plain certified:seed=none,width=4 replicate 1",
        "plain certified:seed=none,width=8 replicate 1",
        "plain certified:seed=pair,width=4 replicate 1",
        "plain certified:seed=pair,width=8 replicate 1",
    };
    expect_plan("plain.json --method 'certified:seed=none|pair,width=4|8'", both,
                ROWS_OF(both));
}

TEST(what_is_done_is_not_planned_again)
{
    static const char run[] =
        "run pass.json --method certified --method impact-sampled --replicates 1 --out r";
    mote_expect(0, "plan: 2 cells, 0 of them done", run);
    mote_expect(0, "plan: 2 cells, 2 of them done", "%s --dry-run", run);
    assert_non_null(strstr(said, "hot, done, not again "));
}
