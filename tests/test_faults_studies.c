/* Every place where a study, or a scenario of an unusual form, asks for memory, files or
   processes, failing once. */
#include "harness/extreme.h"
#include "tests/fault_lines.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <string.h>
#include <unistd.h>

/* A body that has all that bodies can have, and one that moves along keys. */
#define RICH                                                                                   \
    "{\"purpose\": \"a test\", \"frames\": 4, \"ask\": \"distance\", \"tolerance\": 0.001, "   \
    "\"start\": 1.5, \"pace\": 0.5, \"warmup\": [1, 1], \"bodies\": [{\"file\": \"a.obj\", "   \
    "\"scale\": [1, 2, 1], \"velocity\": [0, 0.01, 0], \"spin\": [1, 0, 0], \"field\": "       \
    "{\"centres\": [[0, 0, 0], [0.2, 0.1, 0]], \"support\": 0.7, \"displacement\": "           \
    "{\"sines\": [{\"control\": 1, \"amplitude\": [0.1, 0, 0], \"period\": 30, \"phase\": "    \
    "0.25}, {\"control\": 2, \"amplitude\": [0, 0.1, 0], \"period\": 20}]}}}, {\"file\": "     \
    "\"a.obj\", \"field\": {\"kind\": \"csrbf\", \"count\": 2, \"support\": 0.7, "             \
    "\"displacement\": {\"keyframes\": [{\"frame\": 1, \"vectors\": [[0, 0, 0], [0, 0, 0]]}, " \
    "{\"frame\": 4, \"vectors\": [[0.1, 0, 0], [0, 0.1, 0]]}]}}, \"motion\": [{\"frame\": 1, " \
    "\"position\": [2.1, 0.1, 0], \"quaternion\": [1, 0, 0, 0]}, {\"frame\": 4, "              \
    "\"position\": [1.9, 0.1, 0], \"axis\": [1, 0, 0], \"degrees\": 30}]}]}\n"
#define STRETCH                                                                                \
    "{\"purpose\": \"a test\", \"like\": \"s.json\", \"bodies\": [{\"field\": {\"count\": "    \
    "null, \"support\": null, \"kind\": \"stretch\"}}, {}]}\n"
#define KEYED                                                                                  \
    "{\"purpose\": \"a test\", \"frames\": 3, \"ask\": \"contact\", \"tolerance\": 0.01, "     \
    "\"bodies\": {\"count\": 3, \"box\": 4, \"places\": [[-1.5, 0, 0], [0, 0, 0], [1.5, 0, "   \
    "0]], \"shapes\": [{\"file\": \"a.obj\", \"field\": {\"count\": 2, \"support\": 0.7, "     \
    "\"displacement\": {\"keyframes\": [{\"frame\": 1, \"vectors\": [[0, 0, 0], [0, 0, 0]]}, " \
    "{\"frame\": 3, \"vectors\": [[0.1, 0, 0], [0, 0.1, 0]]}]}}}]}}\n"

/* An icosahedron. */
#define ROUND                                                                                  \
    "v 0 1 1.6\nv 0 -1 1.6\nv 0 1 -1.6\nv 0 -1 -1.6\nv 1 1.6 0\nv -1 1.6 0\nv 1 -1.6 0\n"      \
    "v -1 -1.6 0\nv 1.6 0 1\nv -1.6 0 1\nv 1.6 0 -1\nv -1.6 0 -1\n"                            \
    "f 1 2 9\nf 1 10 2\nf 3 11 4\nf 3 4 12\nf 1 9 5\nf 1 6 10\nf 1 5 6\nf 3 6 5\nf 3 5 11\n"   \
    "f 3 12 6\nf 2 7 9\nf 2 10 8\nf 2 8 7\nf 4 11 7\nf 4 7 8\nf 4 8 12\nf 5 9 11\nf 7 11 9\n"  \
    "f 6 12 10\nf 8 10 12\n"

#define STUDY " --quick --scene tt --approaches 1 --jobs 2 --out study"

static void scenarios_of_every_form_when_a_call_fails_say_so(void **state)
{
    (void)state;
    static const fault_line list[] = {
        LINE(check, " rich.json", 0),
        LINE(export, " rich.json --frame 3 --out out --method embree-contact", 0),
        LINE(export, " stretch.json --frame 2 --out out", 0),
        LINE(export, " pair:c.obj:c.obj --frame 2 --out out", 0),
        LINE(check, " nothing", 4),
    };
    FAIL_EACH(list);
}

static void several_bodies_when_a_call_fails_say_so(void **state)
{
    (void)state;
    static const fault_line list[] = {
        LINE(run,
             " keyed.json --method certified:threads=2,ahead=2 --method fcl-aabb:refit=every "
             "--replicates 1 --out out",
             0),
        LINE(run, " b.json --method aabb-tree --method particle:n=2 --replicates 1 --out out",
             0),
        LINE(simulate, " b.json --method aabb-tree --json --steps 3 --gravity 0,0.001,0", 0),
    };
    FAIL_EACH(list);
}

static void study_of_the_closed_loop_when_a_call_fails_says_so(void **state)
{
    (void)state;
    static const fault_line list[] = {LINE(dynamics, STUDY, 0)};
    FAIL_EACH(list);
}

/* All rows but one are there. */
static int measure_a_row(int argc, char **argv)
{
    (void)unlink("study/rows/tt-certified.json");
    return mote_command_dynamics(argc, argv);
}

static void row_of_the_closed_loop_when_a_call_fails_says_so(void **state)
{
    (void)state;
    static const fault_line list[] = {{"dynamics" STUDY, measure_a_row, 0}};
    static const fault_line again[] = {LINE(dynamics, STUDY, 0)};
    FAIL_EACH(list);
    assert_true(fault_lines_run(again, 1));
}

/* Two triangles, whose fields have control points. */
static mote_extreme_recipe recipe;

static int answer_extreme(int argc, char **argv)
{
    (void)argc, (void)argv;
    static mote_extreme_recipe moved;
    mote_extreme e = {.family = "test", .label = "test"};
    mote_extreme_cell cell;
    moved = recipe;
    mote_status status = mote_extreme_set_gap(&moved, 1, 0.1);
    if (status == MOTE_OK)
        status = mote_extreme_make(&moved, &e);
    if (status == MOTE_OK)
        status = mote_extreme_measure(&e);
    if (status == MOTE_OK)
        status = mote_extreme_run(&e, "certified", &cell);
    mote_extreme_free(&e);
    if (status != MOTE_OK)
        return mote_command_fail();
    /* A method that a failing call keeps from its answer has refused or died, with a reason. */
    const bool said = cell.verdict == MOTE_EXTREME_RIGHT || cell.reason[0];
    return said ? MOTE_EXIT_DONE : MOTE_EXIT_USAGE;
}

static int make_plain(int argc, char **argv)
{
    (void)argc, (void)argv;
    static mote_extreme_recipe plain;
    return mote_extreme_plain(&plain) == MOTE_OK ? MOTE_EXIT_DONE : mote_command_fail();
}

static void extremes_when_a_call_fails_say_so(void **state)
{
    (void)state;
    static const fault_line list[] = {{"extreme", answer_extreme, 0}, {"plain", make_plain, 0}};
    FAIL_EACH(list);
}

static mote_status make_recipe(void)
{
    static mote_extreme_recipe plain;
    mote_status status = mote_extreme_plain(&plain);
    for (size_t i = 0; i < mote_extreme_family_count && status == MOTE_OK; ++i) {
        const mote_extreme_family *family = &mote_extreme_families[i];
        if (strcmp(family->name, "triangles") == 0)
            status = family->change(&plain, 2, &recipe);
    }
    return status;
}

static int make_files(void **state)
{
    (void)state;
    static const fault_line study[] = {LINE(dynamics, STUDY, 0)};
    const bool whole = fault_lines_open() && fault_lines_write("c.obj", ROUND) &&
                       fault_lines_write("rich.json", RICH) &&
                       fault_lines_write("stretch.json", STRETCH) &&
                       fault_lines_write("keyed.json", KEYED);
    return whole && make_recipe() == MOTE_OK && recipe.controls > 0 && fault_lines_run(study, 1)
               ? 0
               : -1;
}

static int remove_files(void **state)
{
    (void)state;
    fault_lines_close();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenarios_of_every_form_when_a_call_fails_say_so),
        cmocka_unit_test(several_bodies_when_a_call_fails_say_so),
        cmocka_unit_test(study_of_the_closed_loop_when_a_call_fails_says_so),
        cmocka_unit_test(row_of_the_closed_loop_when_a_call_fails_says_so),
        cmocka_unit_test(extremes_when_a_call_fails_say_so),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
