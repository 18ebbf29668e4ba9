/* Which cells form one row, and which rows are compared with each other. */
#include "harness/figure/figure.h"
#include "harness/summary/front.h"
#include "harness/summary/summary.h"
#include "harness/summary/table.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdint.h>

#include <math.h>

static mote_summary summary;

static int free_summary(void)
{
    mote_summary_free(&summary);
    return 0;
}

TEST_EACH(folder_next, free_summary);

/* Writes frames that all take `ns` and are off by `error` L. */
static void write_frames(stored_cell cell, int first, int last, double ns, double error)
{
    char rows[512];
    size_t used = 0;
    for (int k = first; k <= last; ++k)
        used += (size_t)snprintf(rows + used, sizeof rows - used, "%d,0,0,%g,0.5,%g,0,0,7\n", k,
                                 ns, error);
    cell.rows = rows;
    stored_cell_put(".", cell);
}

static void write_cell(stored_cell cell, double ns, double error)
{
    write_frames(cell, 1, 4, ns, error);
}

static void make_summary(void)
{
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
}

static void free_figure(mote_figure *figure)
{
    free(figure->data.data);
    free(figure->caption.data);
    free(figure->missing.data);
}

/* A scenario's file may change between two runs into one directory. */
TEST(summary_of_other_questions_keeps_their_cells_apart)
{
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
        assert_non_null(row->ratio.to);
        assert_int_equal(row->first->id[1], row->ratio.to->first->id[1]);
    }
}

/* A row of another machine, or of other frames under the same name, may be faster for that
   reason alone. */
TEST(fronts_of_several_machines_and_scenes_are_kept_apart)
{
    static const stored_cell scenes[] = {{.more = ", \"machine\": \"slow\""},
                                         {.more = ", \"machine\": \"fast\""},
                                         {.fingerprint = "g"}};
    static const double scale[] = {100, 1, 1e4};
    for (int i = 0; i < 3; ++i) {
        char id[16];
        stored_cell cell = scenes[i];
        for (cell.replicate = 1; cell.replicate <= 2; ++cell.replicate) {
            cell.id = id;
            (void)snprintf(id, sizeof id, "a%d-%d", i, cell.replicate);
            cell.method = "certified";
            write_cell(cell, 10 * scale[i], 0);
            (void)snprintf(id, sizeof id, "b%d-%d", i, cell.replicate);
            cell.method = "fcl-aabb";
            write_cell(cell, 20 * scale[i], 0);
        }
    }
    make_summary();
    mote_fronts fronts = mote_fronts_make(&summary);
    assert_int_equal(fronts.count, 6);
    for (size_t i = 0; i < fronts.count; ++i) {
        const bool ours = strcmp(fronts.items[i].title, "certified") == 0;
        assert_true(fabs(fronts.items[i].speed[0].to[MOTE_RIVAL_FCL].faster - (ours ? 2 : 1)) <
                    1e-9);
    }
    for (size_t i = 0; i < summary.count; ++i) {
        const char *id = summary.rows[i].first->id;
        const mote_summary_row *by = summary.rows[i].dominated_by;
        assert_true(!by == (id[0] == 'a'));
        assert_true(!by || by->first->id[1] == id[1]);
    }
    mote_fronts_free(&fronts);
}

/* Without an interval nothing is certain. */
TEST(fronts_of_one_replicate_have_no_dominator)
{
    write_cell((stored_cell){.method = "certified"}, 10, 0);
    write_cell((stored_cell){.replicate = 1}, 11, 0);
    make_summary();
    for (size_t i = 0; i < 2; ++i)
        assert_null(summary.rows[i].dominated_by);
}

static const mote_summary_row *row_of(const char *id)
{
    for (size_t i = 0; i < summary.count; ++i) {
        if (strcmp(summary.rows[i].first->id, id) == 0)
            return &summary.rows[i];
    }
    fail_msg("no row of %s", id);
    return NULL;
}

static void refers_to(const char *id, const mote_ratio *ratio, const char *to, double value)
{
    const char *is = ratio->to ? ratio->to->first->id : "";
    if (strcmp(is, to) != 0 || !(fabs(ratio->value - value) <= 1e-9 * value))
        fail_msg("%s: %g times to %s, not %g to %s", id, ratio->value, is, value, to);
}

/* The fastest engine of others is not always FCL; one that misses a contact does not count. */
TEST(summary_best_engine_is_the_fastest_that_is_right)
{
    write_frames((stored_cell){.id = "a", .method = "certified"}, 1, 4, 10, 0);
    write_frames((stored_cell){.id = "b"}, 1, 4, 100, 0);
    write_frames((stored_cell){.id = "c", .method = "ode"}, 1, 4, 40, 0);
    write_frames((stored_cell){.id = "d", .method = "coal-aabb"}, 1, 4, 20, 1e-3);
    write_frames((stored_cell){.id = "e", .method = "aabb-tree"}, 1, 4, 15, 0);
    make_summary();
    refers_to("a", &row_of("a")->ratio_best, "b", 10);
    refers_to("a", &row_of("a")->ratio_engine, "c", 4);
    refers_to("c", &row_of("c")->ratio_engine, "c", 1);
}

/* FCL is fast near a touch (frames 3-4), and a second part of the run measured all methods
   there again. */
TEST(summary_ratios_are_of_rows_on_the_same_frames)
{
    static const char touch[] = "[3, 4]", obb[] = "fcl-obb";
    write_frames((stored_cell){.id = "a", .method = "certified", .frames = touch}, 3, 4, 10, 0);
    write_frames((stored_cell){.id = "b", .frames = touch}, 3, 4, 200, 0);
    write_frames((stored_cell){.id = "c", .frames = touch, .method = obb}, 3, 4, 20, 0);
    write_frames((stored_cell){.id = "d", .method = "certified"}, 1, 4, 10, 0);
    write_frames((stored_cell){.id = "e"}, 1, 4, 100, 0);
    write_frames((stored_cell){.id = "f", .frames = "[1, 2]"}, 1, 2, 1, 0);
    write_frames((stored_cell){.id = "g", .frames = "[1, 1]", .method = obb}, 1, 1, 500, 0);
    write_frames((stored_cell){.id = "h", .frames = "[9, 9]", .method = "certified"}, 9, 9, 5,
                 0);
    make_summary();
    refers_to("a", &row_of("a")->ratio, "b", 20);
    refers_to("a", &row_of("a")->ratio_best, "c", 2);
    refers_to("d", &row_of("d")->ratio, "e", 10);
    refers_to("d", &row_of("d")->ratio_best, "e", 10);
    refers_to("f", &row_of("f")->ratio_best, "f", 1);
    refers_to("g", &row_of("g")->ratio, "e", 0.2);
    refers_to("g", &row_of("g")->ratio_best, "f", 1.0 / 500);
    assert_true(isnan(row_of("h")->ratio.value)); /* no other row has its frame */
    assert_null(row_of("h")->ratio_best.to);
    FILE *out = fopen("/dev/null", "w");
    assert_non_null(out);
    mote_table_print(&summary, out);
    (void)fclose(out);
    mote_fronts fronts = mote_fronts_make(&summary);
    assert_int_equal(fronts.count, 8);
    for (size_t i = 0; i < fronts.count; ++i) {
        const char *id = summary.rows[fronts.items[i].first].first->id;
        if (id[0] == 'd')
            assert_true(fabs(fronts.items[i].speed[0].to[MOTE_RIVAL_FCL].faster - 10) < 1e-9);
    }
    mote_fronts_free(&fronts);
}

/* Two processes in five err: the 99th percentile over all frames is then large, though that of
   most processes is not. */
TEST(fronts_are_of_the_figures_of_the_rows)
{
    static const char *const numbers[] = {"{\"n\": 8}", "{\"n\": 16}"};
    for (int r = 1; r <= 5; ++r) {
        char id[16];
        write_cell((stored_cell){.replicate = r}, 100, 0);
        for (int k = 0; k < 2; ++k) {
            (void)snprintf(id, sizeof id, "%d-%d", k, r);
            write_cell(
                (stored_cell){
                    .id = id, .method = "ours", .parameters = numbers[k], .replicate = r},
                k ? 50 : 10, r > 3 && !k ? 0.09 : 0);
        }
    }
    make_summary();
    mote_fronts fronts = mote_fronts_make(&summary);
    assert_int_equal(fronts.count, 2);
    const mote_front *ours = &fronts.items[1];
    assert_true(fabs(summary.rows[ours->first].error.p99 - 0.09) < 1e-9);
    for (size_t k = 0; k < MOTE_FRONT_LEVELS; ++k) {
        const mote_front_speed *speed = &ours->speed[k];
        const double times = k + 1 < MOTE_FRONT_LEVELS ? 2 : 10;
        const mote_front_ratio *ratio = &speed->to[MOTE_RIVAL_FCL];
        assert_true(fabs(ratio->faster - times) < 1e-9);
        assert_true(fabs(speed->time_ns - 100 / times) < 1e-9);
        assert_true(ratio->interval.low <= times && ratio->interval.high >= times);
    }
    mote_fronts_free(&fronts);
}

/* If the reference has crashed there is no ratio; the time must not replace it. */
TEST(summary_noise_of_a_row_with_a_ratio_missing_is_of_the_others)
{
    for (int r = 1; r <= 4; ++r) {
        write_cell((stored_cell){.method = "certified", .replicate = r}, 1000 + r % 2, 0);
        if (r != 2)
            write_cell((stored_cell){.replicate = r}, 10000, 0);
    }
    const stored_cell crash = {.replicate = 2, .status = "crashed"};
    stored_cell_put(".", crash);
    make_summary();
    assert_int_equal(summary.count, 2);
    assert_true(summary.rows[0].smallest_change < 0.01);
    assert_true(summary.noise_floor < 0.01);
}

/* --until-ci gives the reference more replicates than others: they must not make it faster. */
TEST(summary_quiet_ratio_is_of_replicates_of_one_number)
{
    for (int r = 1; r <= 40; ++r) {
        if (r <= 10)
            write_cell((stored_cell){.method = "certified", .replicate = r}, 1000 - r, 0);
        write_cell((stored_cell){.replicate = r}, 10000 - 10 * r, 0);
    }
    make_summary();
    for (int k = 0; k < MOTE_QUIET_GROUPS; ++k)
        assert_true(fabs(summary.rows[0].quiet.ratio[k] - 10) < 1e-9);
}

TEST(summary_status_is_the_worst_where_no_replicate_ended_well)
{
    static const char *const ends[] = {"unsupported", "crashed", "timeout"};
    for (int r = 1; r <= 3; ++r) {
        const stored_cell cell = {.replicate = r, .status = ends[r - 1]};
        stored_cell_put(".", cell);
    }
    make_summary();
    assert_int_equal(summary.rows[0].status, MOTE_CELL_CRASHED);
    assert_int_equal(summary.rows[0].first->replicate, 2); /* the reason is reported for it */
}

/* Ratios are taken process by process, though the reference lacks the first process, and the
   first was cut short. */
TEST(figure_ratios_are_of_replicates_of_one_number)
{
    write_frames((stored_cell){.method = "certified", .replicate = 1}, 1, 1, 10, 0);
    for (int r = 2; r <= 4; ++r) {
        write_cell((stored_cell){.method = "certified", .replicate = r}, 10 * r, 0);
        write_cell((stored_cell){.replicate = r}, 100 * r, 0);
    }
    make_summary();
    const mote_figure_run run = {.summary = &summary};
    mote_figure figure = {0};
    assert_int_equal(mote_figure_ratios(&run, "s", &figure), MOTE_OK);
    assert_int_equal(figure.missing.size, 0);
    const char *line = strchr(figure.data.data, '\n');
    assert_non_null(line);
    double frame, ratio, low, high;
    assert_int_equal(sscanf(line, "%lf %lf %lf %lf", &frame, &ratio, &low, &high), 4);
    assert_true(fabs(ratio - 10) < 1e-9 && fabs(low - 10) < 1e-9 && fabs(high - 10) < 1e-9);
    free_figure(&figure);
}

/* Of 1,000 bodies at two densities, the control named in the caption answered only one. */
TEST(figure_bodies_caption_is_of_what_is_drawn)
{
    static const struct {
        const char *label;
        int density, mean;
    } of[] = {{"certified", 1, 5000},
              {"fcl-aabb:refit=every", 1, 200000},
              {"certified", 4, 5000},
              {"aabb-tree", 4, 150000}};
    mote_text text = {0};
    mote_text_add(&text, "{\"rows\": [");
    for (size_t k = 0; k < ROWS_OF(of); ++k)
        mote_text_add(&text,
                      "%s{\"label\": \"%s\", \"status\": \"ok\", \"bodies\": 1000, "
                      "\"near_pairs_wanted\": %d, \"active_total_ns\": {\"mean\": %d, "
                      "\"median\": 4000}, \"rss_peak_bytes\": 1}",
                      k ? ", " : "", of[k].label, of[k].density, of[k].mean);
    mote_text_add(&text, "]}\n");
    file_put("summary.json", text.data);
    free(text.data);
    const mote_figure_run run = {.directory = ".", .summary = &summary};
    mote_figure figure = {0};
    assert_int_equal(mote_figure_bodies(&run, "", &figure), MOTE_OK);
    assert_non_null(strstr(figure.data.data, "1000 5 "));
    assert_non_null(strstr(figure.caption.data, "Points: means"));
    assert_non_null(strstr(figure.caption.data, "takes 1/40 of"));
    assert_null(strstr(figure.caption.data, "takes 1/30 of"));
    free_figure(&figure);
}

/* A run of some frames has no figure of the others. */
TEST(figure_queries_tells_of_which_frames_it_is)
{
    static const char paper[] = "particle-paper", five[] = "{\"n\": 5}";
    write_frames(
        (stored_cell){
            .scenario = "ww", .method = paper, .parameters = five, .frames = "[950, 953]"},
        950, 953, 2e6, 0);
    make_summary();
    const mote_figure_run run = {.summary = &summary};
    mote_figure figure = {0};
    assert_int_equal(mote_figure_queries(&run, "ww", &figure), MOTE_OK);
    assert_non_null(strstr(figure.caption.data,
                           " particle-paper:n=5: active interval (950-953 only) "
                           "2 ms on average, 2 ms at most."));
    assert_null(strstr(figure.caption.data, "nan"));
    free_figure(&figure);
}

/* The interval of two processes extends farther above than below. */
TEST(run_until_ci_tells_the_wider_side_of_the_interval)
{
    char expected[64];
    mote_expect(0, "",
                "run tt --frames 200-205 --replicates 2 --method certified "
                "--until-ci 0.001%% --budget 0 --out .");
    make_summary();
    const mote_time *time = &summary.rows[0].total;
    const double width = fmax(time->high - time->median, time->median - time->low);
    (void)snprintf(expected, sizeof expected,
                   "after 2 replicates the widest interval is +-%.2g %%",
                   100 * width / time->median);
    if (!strstr(said, expected))
        fail_msg("no \"%s\" in\n%s", expected, said);
}

/* Runs mote COMMAND and returns the contents of a file or, if that is NULL, the output. */
static const char *after(const char *command, const char *file)
{
    mote_expect(0, "", "%s", command);
    if (!file)
        return said;
    static char text[1 << 20];
    char *read = file_text(file);
    (void)snprintf(text, sizeof text, "%s", read);
    free(read);
    return text;
}

/* Two scenarios of one name, or one that changed between two runs into one directory. */
TEST(scenes_of_one_name_are_told_apart_wherever_rows_are_shown)
{
    static const char *const prints[] = {"0123456789abcdef", "fedcba9876543210"};
    static const char *const names[] = {"s (scene 01234567)", "s (scene fedcba98)"};
    for (int i = 0; i < 2; ++i) {
        for (int r = 1; r <= 2; ++r) {
            char id[2][16];
            (void)snprintf(id[0], sizeof id[0], "a%d-%d", i, r);
            (void)snprintf(id[1], sizeof id[1], "b%d-%d", i, r);
            write_cell((stored_cell){.id = id[0], .fingerprint = prints[i], .replicate = r},
                       100, 0);
            write_cell((stored_cell){.id = id[1],
                                     .method = "certified",
                                     .fingerprint = prints[i],
                                     .replicate = r},
                       10, 0);
        }
    }
    make_summary();
    assert_string_equal(summary.rows[0].scene, names[0]);
    static const struct {
        const char *command, *file;
    } outputs[] = {{"summarize .", NULL},
                   {"summarize . --format csv", NULL},
                   {"summarize . --format json", NULL},
                   {"summarize . --format gbench", NULL},
                   {"tune .", NULL},
                   {"report .", "report.html"},
                   {"report .", "report.md"}};
    for (size_t i = 0; i < ROWS_OF(outputs); ++i) {
        const char *text = after(outputs[i].command, outputs[i].file);
        for (int k = 0; k < 2; ++k) {
            if (!strstr(text, names[k]) &&
                !strstr(text, k ? "\\(scene fedcba98" : "\\(scene 01"))
                fail_msg("%s does not tell %s", outputs[i].command, names[k]);
        }
    }
    /* The table of speed at equal error has the name above it, too. */
    const char *front = strstr(after("summarize .", NULL), "how many times faster");
    assert_non_null(front);
    const mote_figure_run run = {.summary = &summary};
    mote_figure figure = {0};
    assert_int_equal(mote_figure_front(&run, "s", &figure), MOTE_OK);
    size_t lines = 0;
    for (const char *c = figure.data.data; *c; ++c)
        lines += *c == '\n' ? 1 : 0;
    assert_true(lines < 12); /* the points of one scene: two families of one row each */
    free_figure(&figure);
}

/* Rows with given positions do not compete for the fastest that includes deformation. */
TEST(report_begins_with_rows_that_pay_for_deformation)
{
    static const char given[] = "{\"positions\": \"given\"}";
    write_cell((stored_cell){.method = "certified"}, 50, 0);
    write_cell((stored_cell){.method = "particle", .parameters = given}, 20, 0);
    write_cell((stored_cell){0}, 100, 0);
    make_summary();
    /* Row 0 is the one with given positions, row 1 certified. */
    assert_non_null(strstr(after("report .", "report.html"),
                           "\"first\":0,\"end\":3,\"right\":1,\"fastest\":null}]"));
    /* In report.md it is also in a table of its own, below. */
    const char *apart = strstr(after("report .", "report.md"), "With positions given");
    assert_non_null(apart);
    assert_null(strstr(apart, "| certified"));
    assert_non_null(strstr(apart, "| particle:positions"));
}

/* The second accounting: who is told the positions pays for a pass over them, who is told the
   field pays nothing, and a cell without a measured pass has no such total. */
TEST(total_with_reading_charges_who_is_told_the_positions)
{
    write_cell(
        (stored_cell){.method = "certified", .more = ", \"told\": \"field\", \"read_ns\": 0.0"},
        10, 0);
    write_cell((stored_cell){.method = "stream",
                             .more = ", \"told\": \"positions\", \"read_ns\": 4.5"},
               20, 0);
    write_cell((stored_cell){.more = ", \"told\": \"positions\""}, 100, 0);
    make_summary();
    const mote_summary_row *field = row_of("certified-1"), *stream = row_of("stream-1");
    assert_true(fabs(field->read_total.median - 10) <= 0);
    assert_true(fabs(stream->read_total.median - 24.5) <= 0);
    assert_true(fabs(stream->given_total.median - 20) <= 0);
    assert_true(isnan(row_of("fcl-aabb-1")->read_total.median));
    assert_non_null(strstr(after("summarize .", NULL), "reading"));
}

/* Times of cells that ran at once, and rows that lack replicates, must be recognisable. */
TEST(pages_and_tables_tell_which_times_and_rows_are_not_whole)
{
    static const char beside[] = "times not comparable: 2 cells at once",
                      badly[] = "1 of 3 replicates failed";
    write_cell((stored_cell){.method = "certified", .more = ", \"jobs\": 2"}, 10, 0);
    write_cell((stored_cell){.replicate = 1}, 100, 0);
    write_cell((stored_cell){.replicate = 3}, 100, 0);
    const stored_cell crash = {.replicate = 2, .status = "crashed"};
    stored_cell_put(".", crash);
    make_summary();
    static const struct {
        const char *command, *file;
    } outputs[] = {
        {"summarize .", NULL}, {"report .", "report.html"}, {"report .", "report.md"}};
    for (size_t i = 0; i < 3; ++i) {
        const char *text = after(outputs[i].command, outputs[i].file);
        if (!strstr(text, beside) || !strstr(text, badly))
            fail_msg("%s: %s does not say both", outputs[i].command, outputs[i].file);
    }
    /* Row 0 has no comparable time: it comes last, and is not the fastest. */
    assert_non_null(strstr(after("report .", "report.html"),
                           "\"first\":0,\"end\":2,\"right\":0,\"fastest\":null}]"));
    const char *csv = after("summarize . --format csv", NULL);
    assert_non_null(strstr(csv, ",replicates_failed,jobs,"));
    assert_non_null(strstr(csv, ",0,2,"));
    assert_non_null(strstr(csv, ",1,1,"));
}
