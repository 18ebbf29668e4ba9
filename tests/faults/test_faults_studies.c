/* Each study runs while every place where it asks for files or processes fails once. */
#include "harness/study/extreme.h"
#include "harness/base/options.h"
#include "tests/faults/fault_lines.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <string.h>
#include <unistd.h>

/* The program appears to be installed beside a small scenario tt. */
#define TT                                                                                     \
    "{\"purpose\": \"a test\", \"frames\": 4, \"ask\": \"distance\", \"bodies\": ["            \
    "{\"letter\": \"T\", \"triangles\": 400}, {\"letter\": \"T\", \"triangles\": 400}]}\n"
#define STUDY " --quick --scene tt --approaches 1 --out "

/* Measures the one row that is missing. The manifest is removed because it would grow and so
   change the numbers of the calls. */
static int measure_a_row(int argc, char **argv)
{
    (void)unlink("rows/rows/tt-certified.json");
    (void)unlink("rows/manifest.json");
    return mote_command_dynamics(argc, argv);
}

TEST(study_of_the_closed_loop_when_a_call_fails_says_so)
{
    static const fault_line list[] = {{"dynamics" STUDY "rows", measure_a_row, 0}};
    FAIL_EACH(list);
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
        mote_extreme_measure(&e);
    if (status == MOTE_OK)
        status = mote_extreme_run(&e, "certified", &cell);
    mote_extreme_free(&e);
    if (status != MOTE_OK)
        return mote_command_fail();
    /* If a failing call leaves a method without an answer, it has refused or died with a
       reason. */
    const bool said = cell.verdict == MOTE_EXTREME_RIGHT || cell.reason[0];
    return said ? MOTE_EXIT_DONE : MOTE_EXIT_USAGE;
}

static int make_plain(int argc, char **argv)
{
    (void)argc, (void)argv;
    static mote_extreme_recipe plain;
    return mote_extreme_plain(&plain) == MOTE_OK ? MOTE_EXIT_DONE : mote_command_fail();
}

TEST(extremes_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        {"extreme", answer_extreme, 0},
        LINE(extremes, " --quick --family plain --method certified --out out", 0)};
    FAIL_EACH(list);
}

TEST(extremes_whose_memory_runs_out_end_with_a_line)
{
    static const fault_line list[] = {{"plain", make_plain, 0}};
    EXHAUST_EACH(list);
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

static int make_files(void)
{
    static const fault_line rows[] = {LINE(dynamics, STUDY "rows", 0)};
    const bool whole = fault_lines_open() && fault_lines_install() &&
                       fault_lines_write("share/mote/datasets/scenarios/tt.json", TT);
    return whole && make_recipe() == MOTE_OK && recipe.controls > 0 && fault_lines_run(rows, 1)
               ? 0
               : -1;
}

TEST_GROUP(make_files, fault_lines_close);
