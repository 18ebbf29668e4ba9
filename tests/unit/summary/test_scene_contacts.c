/* Contacts of more than two bodies against those of an exact method in the same run. */
#include "harness/summary/scene_contacts.h"

#include "harness/base/file.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Missed and false contacts (frame, a, b) count up to the last common frame. */
TEST(mote_scene_contacts_lacking_counts_by_frame_and_pair)
{
    static const struct {
        mote_scene_contact mine[3], theirs[3];
        size_t mine_count, theirs_count, missed, wrong;
    } cases[] = {
        {{{1, {0, 1}}}, {{1, {0, 1}}}, 1, 1, 0, 0},
        {{{1, {0, 1}}}, {{1, {0, 2}}}, 1, 1, 1, 1},
        {{{1, {0, 2}}}, {{1, {0, 1}}}, 1, 1, 1, 1},
        {{{1, {1, 2}}}, {{1, {0, 2}}}, 1, 1, 1, 1},
        {{{1, {0, 2}}}, {{1, {1, 2}}}, 1, 1, 1, 1},
        {{{1, {0, 1}}}, {{2, {0, 1}}}, 1, 1, 1, 1},
        {{{0, {0, 0}}}, {{1, {0, 1}}, {2, {0, 1}}}, 0, 2, 2, 0},
        {{{1, {0, 1}}, {2, {0, 1}}}, {{0, {0, 0}}}, 2, 0, 0, 2},
        {{{1, {0, 1}}, {2, {0, 1}}, {3, {0, 1}}}, {{2, {0, 1}}, {3, {0, 2}}}, 3, 2, 0, 1},
        {{{1, {0, 1}}, {2, {0, 3}}}, {{1, {0, 1}}, {1, {0, 2}}, {2, {0, 3}}}, 2, 3, 1, 0},
    };
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        mote_scene_contact a[3], b[3];
        memcpy(a, cases[k].mine, sizeof a);
        memcpy(b, cases[k].theirs, sizeof b);
        const mote_scene_contacts mine = {a, cases[k].mine_count};
        const mote_scene_contacts theirs = {b, cases[k].theirs_count};
        const size_t missed = mote_scene_contacts_lacking(&theirs, &mine, 2);
        const size_t wrong = mote_scene_contacts_lacking(&mine, &theirs, 2);
        if (missed != cases[k].missed || wrong != cases[k].wrong)
            fail_msg("case %zu: %zu missed, %zu false", k, missed, wrong);
    }
}

#define HEADER "frame,body_a,body_b,steps,distance,lower,contact,ax\n"

/* A stored cell of two frames with a total of `contacts` touching pairs. */
static mote_stored_cell cell_of(const char *method, const char *refit, const char *id,
                                double *columns)
{
    static uint32_t frames[] = {1, 2};
    mote_stored_cell cell = {.json = json_pack("{s:s}", "refit", refit),
                             .id = id,
                             .scenario = "b",
                             .fingerprint = "1",
                             .faces = "",
                             .method = method,
                             .cache = "hot",
                             .machine = "",
                             .ask = "distance",
                             .status = MOTE_CELL_OK,
                             .first = 1,
                             .last = 2,
                             .bodies = 9,
                             .frames = 2,
                             .frame = frames};
    cell.parameters = cell.json;
    for (int k = 0; k < MOTE_SCENE_COLUMN_COUNT; ++k)
        cell.scene[k] = columns;
    return cell;
}

static void write_pairs(const char *id, const char *lines)
{
    char *path = mote_format("cells/%s.pairs.csv", id);
    char *text = mote_format(HEADER "%s", lines);
    file_put(path, text);
    free(text);
    free(path);
}

static double numbers[] = {3, 4};

static mote_summary_row row_of(const mote_stored_cell *cell)
{
    return (mote_summary_row){.cells = cell,
                              .replicates = 1,
                              .finished = cell->status == MOTE_CELL_OK,
                              .first = cell,
                              .status = cell->status,
                              .scenario = cell->scenario,
                              .fingerprint = cell->fingerprint,
                              .faces = cell->faces,
                              .cache = cell->cache,
                              .machine = cell->machine,
                              .ask = cell->ask,
                              .method = cell->method,
                              .parameters = cell->parameters,
                              .frame_range = {cell->first, cell->last},
                              .bodies = cell->bodies,
                              .missed = (double)NAN,
                              .near_pairs = (double)NAN};
}

TEST(mote_scene_contacts_count_takes_the_best_exact_row)
{
    mote_stored_cell cells[] = {
        cell_of("particle", "near", "p", numbers), cell_of("certified", "near", "c", numbers),
        cell_of("fcl-aabb", "near", "f", numbers), cell_of("fcl-aabb", "every", "g", numbers)};
    mote_summary_row rows[4];
    for (int k = 0; k < 4; ++k)
        rows[k] = row_of(&cells[k]);
    write_pairs("p", "1,1,2,1,0.5,,0,1\n2,1,3,1,0,0,1,1\n2,2,3,1,0,0,1,1\n");
    write_pairs("c", "1,1,2,1,0,0,1,1\n2,1,3,1,0,0,1,1\n");
    write_pairs("f", "1,1,2,1,0,0,1,1\n2,1,3,1,0,0,1,1\n");
    write_pairs("g", "1,1,2,1,0,0,1,1\n1,4,5,1,0,0,1,1\n2,1,3,2,0,0,1,1\n");
    assert_int_equal(mote_scene_contacts_count(".", rows, 4), MOTE_OK);
    static const double missed[] = {2, 1, 1, 0}, wrong[] = {1, 0, 0, 0};
    for (int k = 0; k < 4; ++k) {
        assert_ptr_equal(rows[k].contacts_of, &rows[3]);
        assert_true(rows[k].missed == missed[k] && rows[k].false_contacts == wrong[k]);
        assert_true(rows[k].near_pairs == 3.5 && rows[k].contacts == 7);
    }
    /* If it is missing, or on other frames, the next best is used; without an exact method,
       none. */
    rows[3].finished = 0;
    cells[2].last = 3;
    for (int k = 0; k < 3; ++k)
        rows[k] = row_of(&cells[k]);
    assert_int_equal(mote_scene_contacts_count(".", rows, 4), MOTE_OK);
    assert_ptr_equal(rows[0].contacts_of, &rows[1]);
    assert_ptr_equal(rows[2].contacts_of, &rows[2]);
    rows[0] = row_of(&cells[0]);
    assert_int_equal(mote_scene_contacts_count(".", rows, 1), MOTE_OK);
    assert_null(rows[0].contacts_of);
    assert_true(isnan(rows[0].missed));
    for (int k = 0; k < 4; ++k)
        json_decref(cells[k].json);
}

/* A cell that ended before its first frame has no numbers. */
TEST(mote_scene_contacts_count_of_cells_that_failed_compares_nothing)
{
    mote_stored_cell cell = cell_of("certified", "near", "none", numbers);
    cell.status = MOTE_CELL_TIMEOUT;
    cell.frames = 0;
    mote_summary_row row = row_of(&cell);
    assert_int_equal(mote_scene_contacts_count(".", &row, 1), MOTE_OK);
    assert_null(row.contacts_of);
    assert_true(isnan(row.missed) && isnan(row.near_pairs));
    json_decref(cell.json);
}

TEST(mote_scene_contacts_count_names_the_line_that_is_no_pair)
{
    static const struct {
        const char *lines, *where;
    } cases[] = {{"1,1,2,1,0,0,1,1\n1,1,2,1,0,0,1,1\n", "c.pairs.csv:3"},
                 {"2,1,2,1,0,0,1,1\n1,1,2,1,0,0,1,1\n", "c.pairs.csv:3"},
                 {"0,1,2,1,0,0,1,1\n", "c.pairs.csv:2"},
                 {"1,x,2,1,0,0,1,1\n", "c.pairs.csv:2"},
                 {"1,1,5000000000,1,0,0,1,1\n", "c.pairs.csv:2"},
                 {"1,1,2\n", "c.pairs.csv:2"},
                 {"1,1,2,1\n1,1,3,1,0,0,1,1\n", "c.pairs.csv:2"},
                 {"1,1,2,1,0,0,1", "c.pairs.csv:2"}};
    mote_stored_cell cell = cell_of("certified", "near", "c", numbers);
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        mote_summary_row row = row_of(&cell);
        write_pairs("c", cases[k].lines);
        assert_int_equal(mote_scene_contacts_count(".", &row, 1), MOTE_EINVAL);
        if (!strstr(mote_error_text(), cases[k].where))
            fail_msg("case %zu: %s", k, mote_error_text());
    }
    json_decref(cell.json);
}
