/* Which rows dominate others, which are on the front, and what is compared with what, in runs
   that the test writes itself. */
#include "harness/summary/dominance.h"
#include "harness/summary/front.h"
#include "harness/summary/table.h"
#include "tests/support/folder.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <math.h>

static mote_summary summary;

static int free_summary(void)
{
    mote_summary_free(&summary);
    return 0;
}

TEST_EACH(folder_next, free_summary);

#define FRAMES 200

/* A method's answers over FRAMES frames, of which the first 100 are contacts. */
typedef struct answers {
    double deform_ns, query_ns;
    double error;      /* of the frames that are not exact */
    int inexact;       /* the number of these */
    int missed, wrong; /* contacts missed, and false ones */
} answers;

static void write_answers(stored_cell cell, answers a)
{
    static char rows[FRAMES * 64];
    size_t used = 0;
    for (int k = 1; k <= FRAMES; ++k) {
        const bool truth = k <= 100;
        const bool contact = truth ? k > a.missed : k - 100 <= a.wrong;
        used += (size_t)snprintf(rows + used, sizeof rows - used, "%d,%g,0,%g,0.5,%g,%d,%d,7\n",
                                 k, a.deform_ns, a.query_ns, k <= a.inexact ? a.error : 0,
                                 contact, truth);
    }
    cell.rows = rows;
    cell.frames = "[1, 200]";
    stored_cell_put(".", cell);
}

/* Writes three replicates that differ by 1 % in time. */
static void write_row(stored_cell cell, answers a)
{
    const double query_ns = a.query_ns;
    char id[64];
    for (cell.replicate = 1; cell.replicate <= 3; ++cell.replicate) {
        (void)snprintf(id, sizeof id, "%s-%s-%d", cell.method,
                       cell.parameters && strstr(cell.parameters, "given") ? "given" : "",
                       cell.replicate);
        cell.id = id;
        a.query_ns = query_ns * (1 + 0.01 * cell.replicate);
        write_answers(cell, a);
    }
}

static void make_summary(void)
{
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
}

static const mote_summary_row *row_of(const char *method, bool given)
{
    for (size_t i = 0; i < summary.count; ++i) {
        if (strcmp(summary.rows[i].method, method) == 0 && summary.rows[i].given == given)
            return &summary.rows[i];
    }
    fail_msg("no row of %s", method);
    return NULL;
}

/* A row that is faster and worse in one figure only. */
TEST(a_row_that_is_worse_in_one_figure_dominates_nothing)
{
    static const struct {
        const char *figure;
        answers slow, fast;
        bool dominated;
    } cases[] = {
        {"nothing", {0, 1000, 0, 0, 0, 0}, {0, 10, 0, 0, 0, 0}, true},
        {"nothing, though neither is exact",
         {0, 1000, 0.1, 50, 3, 3},
         {0, 10, 0.1, 50, 3, 3},
         true},
        {"time", {0, 10, 0, 0, 0, 0}, {0, 10.05, 0, 0, 0, 0}, false},
        {"the 99th percentile", {0, 1000, 0.1, 50, 0, 0}, {0, 10, 0.2, 50, 0, 0}, false},
        /* One frame in 200: the 99th percentile does not see it. */
        {"the largest error", {0, 1000, 0, 0, 0, 0}, {0, 10, 8.7e-3, 1, 0, 0}, false},
        {"the exact share", {0, 1000, 0.1, 50, 0, 0}, {0, 10, 0.1, 51, 0, 0}, false},
        {"missed contacts", {0, 1000, 0, 0, 3, 3}, {0, 10, 0, 0, 4, 3}, false},
        {"false contacts", {0, 1000, 0, 0, 3, 3}, {0, 10, 0, 0, 3, 4}, false},
    };
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        assert_int_equal(folder_next(), 0);
        write_row((stored_cell){.method = "slow"}, cases[i].slow);
        write_row((stored_cell){.method = "fast"}, cases[i].fast);
        make_summary();
        const mote_summary_row *slow = row_of("slow", false), *fast = row_of("fast", false);
        if ((slow->dominated_by != NULL) != cases[i].dominated ||
            slow->on_front == cases[i].dominated || !fast->on_front)
            fail_msg("worse in %s: dominated %d, on the front %d and %d", cases[i].figure,
                     slow->dominated_by != NULL, slow->on_front, fast->on_front);
        mote_summary_free(&summary);
    }
}

/* The budget ends a slow cell of many bodies early: its times are of other frames. */
TEST(rows_of_many_bodies_that_ended_early_are_of_other_frames)
{
    const mote_summary_row whole = {.bodies = 100, .frames = 60, .frame_range = {1, 60}};
    mote_summary_row cut = whole;
    cut.frames = 12;
    assert_true(mote_summary_by_frames(&whole, &cut) < 0);
    assert_true(mote_summary_by_frames(&cut, &whole) > 0);
    cut.frames = 60;
    assert_int_equal(mote_summary_by_frames(&whole, &cut), 0);
}

/* A row of every 16th frame is of the same frames as one of all. */
TEST(rows_of_two_bodies_with_other_strides_are_of_the_same_frames)
{
    const mote_summary_row all = {.frames = 160, .frame_range = {1, 160}, .stride = 1};
    const mote_summary_row some = {.frames = 10, .frame_range = {1, 160}, .stride = 16};
    assert_int_equal(mote_summary_by_frames(&all, &some), 0);
}

/* 2 missed contacts in 12 frames are more than 3 in 200, and 1 in 100 less than 3. */
TEST(rows_with_other_strides_are_compared_by_shares_of_wrong_contacts)
{
    static const struct {
        size_t frames;
        double missed, false_contacts;
        bool better;
    } cases[] = {{12, 2, 0, false}, {12, 0, 2, false}, {100, 1, 1, true}, {12, 0, 0, true}};
    write_row((stored_cell){.method = "ours"},
              (answers){.query_ns = 1000, .missed = 3, .wrong = 3});
    make_summary();
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        mote_summary_row rows[] = {*row_of("ours", false), *row_of("ours", false)};
        test_row("%zu frames, %g and %g wrong", cases[i].frames, cases[i].missed,
                 cases[i].false_contacts);
        rows[1].frames = cases[i].frames;
        rows[1].stride = (uint32_t)(FRAMES / cases[i].frames);
        rows[1].missed = cases[i].missed;
        rows[1].false_contacts = cases[i].false_contacts;
        rows[1].total.median = rows[1].total.low = rows[1].total.high = 10;
        mote_find_dominated(rows, ROWS_OF(rows));
        assert_int_equal(rows[0].dominated_by == &rows[1], cases[i].better);
        mote_find_method_rows(rows, ROWS_OF(rows));
        assert_int_equal(rows[1].stands_for_method, cases[i].better);
        assert_int_equal(rows[0].stands_for_method, !cases[i].better);
    }
}

/* A scene that asks for contacts only: some methods also give a distance, others none. */
TEST(distances_do_not_count_where_contacts_are_asked_for)
{
    static const char contact[] = ", \"ask\": \"contact\", \"tolerance\": 0.0";
    write_row((stored_cell){.method = "fast", .more = contact}, (answers){.query_ns = 10});
    write_row((stored_cell){.method = "wrong", .more = contact},
              (answers){.query_ns = 5, .missed = 1});
    write_row((stored_cell){.method = "slow", .more = contact},
              (answers){.query_ns = 1000, .error = 0.5, .inexact = 9});
    make_summary();
    assert_true(row_of("fast", false)->on_front);
    assert_true(row_of("wrong", false)->on_front);
    assert_false(row_of("slow", false)->on_front);
    mote_summary_row silent = *row_of("fast", false);
    silent.error.p99 = silent.error.max = silent.error.exact_rate = MOTE_NONE;
    assert_true(mote_dominates(&silent, row_of("slow", false)));
}

/* 998 of 1,000 frames exact is not "exact", though the 99th percentile is. */
TEST(speed_at_exact_is_of_rows_exact_in_every_frame)
{
    write_row((stored_cell){.method = "fcl-aabb"}, (answers){.query_ns = 1000});
    write_row((stored_cell){.method = "almost"},
              (answers){.query_ns = 10, .error = 8.7e-3, .inexact = 1});
    write_row((stored_cell){.method = "certified"}, (answers){.query_ns = 20});
    make_summary();
    mote_fronts fronts = mote_fronts_make(&summary);
    assert_int_equal(fronts.count, 3);
    for (size_t i = 0; i < fronts.count; ++i) {
        const mote_front *front = &fronts.items[i];
        const double exact = front->speed[0].to[MOTE_RIVAL_FCL].faster,
                     next = front->speed[1].to[MOTE_RIVAL_FCL].faster;
        if (strcmp(front->title, "almost") == 0)
            assert_true(isnan(exact) && fabs(next - 100) < 1e-9);
        else if (strcmp(front->title, "certified") == 0)
            assert_true(fabs(exact - 50) < 1e-9 && fabs(next - 50) < 1e-9);
    }
    mote_fronts_free(&fronts);
}

/* FCL needs 200 ns and, for deformation, 800 ns; with positions given it needs 250. */
TEST(rows_with_positions_given_are_compared_without_deformation)
{
    static const char given[] = "{\"positions\": \"given\"}";
    write_row((stored_cell){.method = "fcl-aabb"},
              (answers){.deform_ns = 800, .query_ns = 200});
    write_row((stored_cell){.method = "ours"}, (answers){.deform_ns = 100, .query_ns = 20});
    write_row((stored_cell){.method = "ours", .parameters = given}, (answers){.query_ns = 20});
    make_summary();
    const mote_summary_row *charged = row_of("ours", false), *ours = row_of("ours", true);
    assert_true(fabs(ours->ratio.value - 10) < 1e-9 &&
                fabs(ours->ratio_best.value - 10) < 1e-9);
    assert_true(fabs(charged->ratio.value - 1002.0 / 120.2) < 0.1);
    assert_true(fabs(charged->ratio_given.value - 10) < 1e-9);
    /* Fastest of all and exact, yet it dominates only rows of its kind. */
    assert_true(charged->on_front && ours->on_front);
    mote_fronts fronts = mote_fronts_make(&summary);
    for (size_t i = 0; i < fronts.count; ++i) {
        if (&summary.rows[fronts.items[i].first] == ours)
            assert_true(fabs(fronts.items[i].speed[0].to[MOTE_RIVAL_FCL].faster - 10) < 1e-9);
    }
    mote_fronts_free(&fronts);
    mote_summary_free(&summary);
    write_row((stored_cell){.method = "fcl-aabb", .parameters = given},
              (answers){.query_ns = 250});
    make_summary();
    ours = row_of("ours", true);
    /* The lines below the table name the reference of the ratios for either accounting. */
    char *table = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&table, &size);
    assert_non_null(out);
    mote_table_print(&summary, out);
    (void)fclose(out);
    assert_non_null(strstr(table, "\nfcl-aabb: fcl-aabb; given"));
    assert_non_null(strstr(table, "\nof positions=given, deformation charged to nobody: "
                                  "fcl-aabb: fcl-aabb:positions"));
    free(table);
    assert_true(ours->ratio.to == row_of("fcl-aabb", true));
    assert_true(fabs(ours->ratio.value - 12.5) < 1e-9);
    assert_true(ours->ratio_best.to == row_of("fcl-aabb", false));
    assert_true(row_of("ours", false)->ratio.to == row_of("fcl-aabb", false));
}

/* In three of five processes the smaller number of particles happens to be exact, in all five
   it is not: the interval is that of exact configurations, and contains the estimate. */
TEST(interval_of_a_speed_lies_on_both_sides_of_it)
{
    static const double noise[] = {1, 1.03, 0.98, 1.01, 0.99, 1.02, 1.005, 0.97, 1.015, 0.995};
    static const int processes[] = {5, 10}; /* Student's t, and resampling */
    for (size_t i = 0; i < 2; ++i) {
        assert_int_equal(folder_next(), 0);
        for (int r = 0; r < processes[i]; ++r) {
            char id[3][16];
            for (int k = 0; k < 3; ++k)
                (void)snprintf(id[k], sizeof id[k], "%c-%d", "abc"[k], r + 1);
            write_answers((stored_cell){.id = id[0], .replicate = r + 1},
                          (answers){.query_ns = 1000 * noise[r]});
            write_answers(
                (stored_cell){.id = id[1],
                              .method = "ours",
                              .parameters = "{\"n\": 8}",
                              .replicate = r + 1},
                (answers){.query_ns = 10, .error = 0.09, .inexact = r % 5 > 2 ? 9 : 0});
            write_answers((stored_cell){.id = id[2],
                                        .method = "ours",
                                        .parameters = "{\"n\": 16}",
                                        .replicate = r + 1},
                          (answers){.query_ns = 50});
        }
        make_summary();
        mote_fronts fronts = mote_fronts_make(&summary);
        const mote_front_ratio *speed = &fronts.items[1].speed[0].to[MOTE_RIVAL_FCL];
        if (!(speed->interval.low < speed->faster && speed->interval.high > speed->faster &&
              speed->interval.low > 19 && speed->interval.high < 21))
            fail_msg("%d processes: %g [%g, %g]", processes[i], speed->faster,
                     speed->interval.low, speed->interval.high);
        mote_fronts_free(&fronts);
        mote_summary_free(&summary);
    }
}

/* A ratio to itself is always 1 and has no interval; every other figure lies inside its own. */
TEST(intervals_lie_around_their_figures_and_a_ratio_to_itself_has_none)
{
    write_row((stored_cell){.method = "fcl-aabb"}, (answers){.query_ns = 1000});
    static const char *const ids[] = {"o-1", "o-2", "o-3"};
    for (int r = 0; r < 3; ++r)
        write_answers((stored_cell){.id = ids[r], .method = "fcl-obb", .replicate = r + 1},
                      (answers){.query_ns = 3000 + 100 * (r == 1)});
    make_summary();
    const mote_summary_row *best = row_of("fcl-aabb", false), *other = row_of("fcl-obb", false);
    const mote_ratio *own[] = {&best->ratio, &best->ratio_best};
    for (size_t i = 0; i < 2; ++i)
        assert_true(own[i]->value == 1 && isnan(own[i]->low) && isnan(own[i]->high));
    assert_true(other->ratio.low < other->ratio.value &&
                other->ratio.value < other->ratio.high);
    assert_true(best->total.low < best->total.median && best->total.median < best->total.high);
    mote_fronts fronts = mote_fronts_make(&summary);
    for (size_t i = 0; i < fronts.count; ++i) {
        const mote_front_ratio *speed = &fronts.items[i].speed[0].to[MOTE_RIVAL_FCL];
        if (&summary.rows[fronts.items[i].first] == best)
            assert_true(speed->faster == 1 && isnan(speed->interval.low));
        else
            assert_true(speed->interval.low < speed->faster &&
                        speed->faster < speed->interval.high);
    }
    mote_fronts_free(&fronts);
}

/* One row a method and accounting: the fastest one that is good enough, or else the one with
   the fewest wrong contacts, then the smallest error. */
TEST(the_row_that_stands_for_a_method_is_its_fastest_good_one)
{
    static const struct {
        const char *id, *method, *parameters;
        answers a;
        bool stands;
    } rows[] = {
        {"a1", "ours", "{\"n\": 1}", {0, 10, 0.5, 50, 3, 0}, false},
        {"a2", "ours", "{\"n\": 2}", {0, 20, 0.009, 50, 0, 0}, true},
        {"a3", "ours", "{\"n\": 3}", {0, 30, 0, 0, 0, 0}, false},
        {"b1", "poor", "{\"n\": 1}", {0, 10, 0.4, 50, 0, 3}, false},
        {"b2", "poor", "{\"n\": 2}", {0, 20, 0.5, 50, 0, 2}, false},
        {"b3", "poor", "{\"n\": 3}", {0, 30, 0.4, 50, 1, 1}, true},
        {"c1", "ours", "{\"positions\": \"given\"}", {0, 99, 0, 0, 0, 0}, true},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i)
        write_answers((stored_cell){.id = rows[i].id,
                                    .method = rows[i].method,
                                    .parameters = rows[i].parameters},
                      rows[i].a);
    make_summary();
    assert_int_equal(summary.count, sizeof rows / sizeof rows[0]);
    for (size_t i = 0; i < summary.count; ++i) {
        for (size_t k = 0; k < summary.count; ++k) {
            if (strcmp(summary.rows[i].first->id, rows[k].id) == 0 &&
                summary.rows[i].stands_for_method != rows[k].stands)
                fail_msg("%s", rows[k].id);
        }
    }
}
