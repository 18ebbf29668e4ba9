/* Which cells are put into one row, and which rows are compared with each other. */
#include "harness/front.h"
#include "harness/summary.h"
#include "tests/program.h"
#include "tests/stored_cells.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static char base[] = "/tmp/mote-test-summary-XXXXXX";
static char directory[64];
static int directories;
static mote_summary summary;

static int make_base(void **state)
{
    (void)state;
    return mkdtemp(base) ? 0 : -1;
}

static int remove_base(void **state)
{
    (void)state;
    return program_remove(base);
}

static int next_directory(void **state)
{
    (void)state;
    (void)snprintf(directory, sizeof directory, "%s/%d", base, directories++);
    return 0;
}

static int free_summary(void **state)
{
    (void)state;
    mote_summary_free(&summary);
    return 0;
}

/* Of four frames that all take `ns`, and are wrong by `error` L. */
static void write_cell(stored_cell cell, double ns, double error)
{
    char rows[512];
    size_t used = 0;
    for (int k = 1; k <= 4; ++k)
        used += (size_t)snprintf(rows + used, sizeof rows - used, "%d,0,0,%g,0.5,%g,0,0,7\n", k,
                                 ns, error);
    cell.rows = rows;
    assert_true(stored_cell_write(directory, &cell));
}

static void make_summary(void)
{
    assert_int_equal(mote_summary_make(directory, &summary), MOTE_OK);
}

/* A scenario's file may change between two runs into one directory. */
static void summary_of_other_questions_keeps_their_cells_apart(void **state)
{
    (void)state;
    static const char *const asked[] = {", \"ask\": \"contact\", \"tolerance\": 0.0",
                                        ", \"ask\": \"distance\", \"tolerance\": 0.0",
                                        ", \"ask\": \"distance\", \"tolerance\": 0.5"};
    for (int i = 0; i < 3; ++i) {
        char ours[16], fcl[16];
        (void)snprintf(ours, sizeof ours, "a%d", i);
        (void)snprintf(fcl, sizeof fcl, "b%d", i);
        write_cell((stored_cell){.id = ours, .method = "certified", .more = asked[i]}, 10, 0);
        write_cell((stored_cell){.id = fcl, .more = asked[i]}, 100 * (i + 1), 0);
    }
    make_summary();
    assert_int_equal(summary.count, 6);
    for (size_t i = 0; i < summary.count; ++i) {
        const mote_summary_row *row = &summary.rows[i];
        assert_int_equal(row->replicates, 1);
        assert_true(row->ratio.to != SIZE_MAX);
        assert_int_equal(row->first->id[1], summary.rows[row->ratio.to].first->id[1]);
    }
}

/* What was measured on another machine, or on other frames of that name, is faster by what
   these are. */
static void fronts_of_several_machines_and_scenes_are_kept_apart(void **state)
{
    (void)state;
    static const stored_cell scenes[] = {{.more = ", \"machine\": \"slow\""},
                                         {.more = ", \"machine\": \"fast\""},
                                         {.fingerprint = "g"}};
    static const double scale[] = {100, 1, 1e4};
    for (int i = 0; i < 3; ++i) {
        char ours[16], fcl[16];
        (void)snprintf(ours, sizeof ours, "a%d", i);
        (void)snprintf(fcl, sizeof fcl, "b%d", i);
        stored_cell cell = scenes[i];
        cell.id = ours;
        cell.method = "certified";
        write_cell(cell, 10 * scale[i], 0);
        cell.id = fcl;
        cell.method = "fcl-aabb";
        write_cell(cell, 20 * scale[i], 0);
    }
    make_summary();
    mote_fronts fronts;
    assert_int_equal(mote_fronts_make(&summary, &fronts), MOTE_OK);
    assert_int_equal(fronts.count, 6);
    for (size_t i = 0; i < fronts.count; ++i) {
        const bool ours = strcmp(fronts.items[i].title, "certified") == 0;
        assert_true(fabs(fronts.items[i].speed[0].faster - (ours ? 2 : 1)) < 1e-9);
    }
    for (size_t i = 0; i < summary.count; ++i) {
        const char *id = summary.rows[i].first->id;
        const size_t by = fronts.dominator[i];
        assert_true((by == SIZE_MAX) == (id[0] == 'a'));
        assert_true(by == SIZE_MAX || summary.rows[by].first->id[1] == id[1]);
    }
    mote_fronts_free(&fronts);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, next_directory, free_summary)
    const struct CMUnitTest tests[] = {
        TEST(summary_of_other_questions_keeps_their_cells_apart),
        TEST(fronts_of_several_machines_and_scenes_are_kept_apart),
    };
    return cmocka_run_group_tests(tests, make_base, remove_base);
}
