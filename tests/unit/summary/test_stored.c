#define _DEFAULT_SOURCE /* truncate */
/* Runs whose files the test wrote: damaged ones are refused by file and line, and summaries and
   merges follow from the rest. */
#include "harness/figure/figure.h"
#include "harness/summary/merge.h"
#include "harness/base/record.h"
#include "harness/summary/scene_contacts.h"
#include "harness/summary/summary.h"
#include "tests/support/stored_run.h"
#include "tests/support/test.h"

#include <math.h>
#include <unistd.h>

TEST(stored_read_of_a_cell_with_a_wrong_field_names_the_file)
{
    static const char json[] = "cells/fcl-aabb-1.json: a field of a cell is missing or wrong";
    static const struct {
        const char *key, *value; /* NULL: without the key */
    } changes[] = {{"id", NULL},
                   {"id", "7"},
                   {"status", NULL},
                   {"status", "\"great\""},
                   {"status", "3"},
                   {"replicate", "0"},
                   {"replicate", NULL},
                   {"stride", "0"},
                   {"stride", "\"1\""},
                   {"jobs", "0"},
                   {"jobs", "\"2\""},
                   {"active", "[1]"},
                   {"active", "\"1-4\""},
                   {"method", "[]"},
                   {"scenario", NULL},
                   {"parameters", NULL},
                   {"fingerprint", "1"},
                   {"frames", NULL},
                   {"seed", NULL},
                   {"triangles", NULL},
                   {"vertices", NULL},
                   {"cache", NULL},
                   {"replicate", "1001"},
                   {"seed", "1.5"},
                   {"seed", "-1"},
                   {"seed", "4611686018427387904"},
                   {"fixed_seed", "1"},
                   {"heap_live_bytes", "1.5"},
                   {"heap_peak_bytes", "-1"},
                   {"rss_peak_bytes", "5.4e128"},
                   {"deform_bytes", "4611686018427387904"}};
    for (size_t i = 0; i < ROWS_OF(changes); ++i) {
        json_t *cell = NULL;
        write_cell((stored_cell){.rows = ROWS});
        assert_int_equal(mote_record_read_json(".", "cells/fcl-aabb-1.json", &cell), MOTE_OK);
        if (changes[i].value)
            (void)json_object_set_new(cell, changes[i].key,
                                      json_loads(changes[i].value, JSON_DECODE_ANY, NULL));
        else
            (void)json_object_del(cell, changes[i].key);
        char *dump = json_dumps(cell, 0);
        assert_non_null(dump);
        file_put("cells/fcl-aabb-1.json", dump);
        free(dump);
        json_decref(cell);
        refused(changes[i].key, json);
    }
    write_cell((stored_cell){.rows = ROWS});
    file_put("cells/.hidden.json", "no cell");
    file_put("cells/.json", "no cell");
    file_put("cells/notes.txt", "no cell");
    mote_expect(0, "", "summarize .");
    assert_int_equal(system("cp cells/fcl-aabb-1.json cells/fcl.json"), 0);
    refused("name", "cells/fcl.json: its id is fcl-aabb-1; a cell is named by its id");
    assert_int_equal(rename("cells/fcl.json", "cells/fcl-aabb-12.json"), 0);
    refused("name", "cells/fcl-aabb-12.json: its id is fcl-aabb-1; a cell is named by its id");
}

/* Up to 2^62 - 1, where doubles are 512 apart: neither draws nor groups are mixed up with
   another run's. */
TEST(stored_read_keeps_every_bit_of_a_seed)
{
    static const struct {
        int replicate;
        uint64_t seed, draws;
        const char *more;
    } cells[] = {{1, 0, 0, ""},
                 {2, 0, 1, ""},
                 {3, 5, 5, ", \"fixed_seed\": true"},
                 {4, MOTE_SEED_MAX, MOTE_SEED_MAX + 3, ""},
                 {5, MOTE_SEED_MAX - 1, MOTE_SEED_MAX + 3, ""}};
    enum { CELLS = sizeof cells / sizeof cells[0] };
    for (int i = 0; i < CELLS; ++i)
        write_cell((stored_cell){.replicate = cells[i].replicate,
                                 .seed = cells[i].seed,
                                 .more = cells[i].more,
                                 .rows = ROWS});
    mote_stored stored;
    assert_int_equal(mote_stored_read(".", NULL, &stored), MOTE_OK);
    assert_int_equal(stored.count, CELLS);
    for (int i = 0; i < CELLS; ++i) {
        const mote_stored_cell *cell = &stored.cells[i];
        const int k = (int)cell->replicate - 1;
        assert_true(cell->seed == cells[k].seed);
        assert_true(cell->replicate_seed == cells[k].draws);
        for (int j = 0; j < i; ++j)
            assert_int_equal(strcmp(stored.cells[j].group, cell->group) == 0,
                             stored.cells[j].seed == cell->seed);
    }
    mote_stored_free(&stored);
}

#define TEN_COLUMNS "a,b,c,d,e,f,g,h,i,j,"

TEST(stored_read_of_a_damaged_csv_names_the_line)
{
    static const struct {
        const char *csv, *says;
    } changes[] = {
        {"", "fcl-aabb-1.csv:1: not the header"},
        {"frame", "fcl-aabb-1.csv:1: not the header"},
        {"frame,truth\n1,2\n", "fcl-aabb-1.csv:1: not the header"},
        {TEN_COLUMNS TEN_COLUMNS TEN_COLUMNS TEN_COLUMNS TEN_COLUMNS TEN_COLUMNS TEN_COLUMNS
             STORED_COLUMNS,
         "fcl-aabb-1.csv:1: not the header"},
        {STORED_COLUMNS "1,1,2,3,0,0,0,0\n",
         "fcl-aabb-1.csv:2: not a frame's row; expected 9 fields"},
        {STORED_COLUMNS "1,1,2,3,0,0,0,0,7,8\n", "fcl-aabb-1.csv:2: not a frame's row"},
        {STORED_COLUMNS ROWS "5,1,2,3,0,0,0,0,\n\n", "fcl-aabb-1.csv:7: not a frame's row"},
        {STORED_COLUMNS "1,one,2,3,0,0,0,0,7\n", "fcl-aabb-1.csv:2: not a frame's row"},
        {STORED_COLUMNS "1,nan,2,3,0,0,0,0,7\n", "fcl-aabb-1.csv:2: not a frame's row"},
        {STORED_COLUMNS "1,1,1e999,3,0,0,0,0,7\n", "fcl-aabb-1.csv:2: not a frame's row"},
        {STORED_COLUMNS "1,1 2,3,4,0,0,0,0,7\n", "fcl-aabb-1.csv:2: not a frame's row"},
        {STORED_COLUMNS "0,1,2,3,0,0,0,0,7\n", "fcl-aabb-1.csv:2: not a frame's row"},
        {STORED_COLUMNS "-1,1,2,3,0,0,0,0,7\n", "fcl-aabb-1.csv:2: not a frame's row"},
        {STORED_COLUMNS "5e9,1,2,3,0,0,0,0,7\n", "fcl-aabb-1.csv:2: not a frame's row"},
        {STORED_COLUMNS ",1,2,3,0,0,0,0,7\n", "fcl-aabb-1.csv:2: not a frame's row"},
        {STORED_COLUMNS "2,1,2,3,0,0,0,0,7\n2,1,2,3,0,0,0,0,7\n",
         "fcl-aabb-1.csv:3: not a frame's row"}};
    write_cell((stored_cell){.rows = ROWS});
    for (size_t i = 0; i < ROWS_OF(changes); ++i) {
        file_put("cells/fcl-aabb-1.csv", changes[i].csv);
        refused(changes[i].csv, changes[i].says);
    }
    static const char rows[] = ROWS;
    static const struct {
        const char *more;
        int bytes;                                       /* of the remaining rows */
    } cuts[] = {{", \"rows\": 4", (int)sizeof rows - 2}, /* without its last line feed */
                {", \"rows\": 4", 0},
                {", \"rows\": 5", (int)sizeof rows - 1},
                {", \"rows\": \"4\"", (int)sizeof rows - 1}};
    for (size_t i = 0; i < ROWS_OF(cuts); ++i) {
        char left[sizeof rows];
        (void)snprintf(left, sizeof left, "%.*s", cuts[i].bytes, rows);
        write_cell((stored_cell){.rows = left, .more = cuts[i].more});
        refused(left, "cells/fcl-aabb-1.csv: ");
        assert_non_null(strstr(mote_error_text(), " whole rows, not the "));
    }
    write_cell((stored_cell){.rows = rows, .more = ", \"rows\": 4"});
    mote_expect(0, "", "summarize .");
    write_cell((stored_cell){.rows = ROWS});
    file_put("cells/fcl-aabb-1.csv", changes[sizeof changes / sizeof changes[0] - 1].csv);
    assert_int_equal(mote("summarize ."), 4);
    assert_memory_equal(said, "mote: ", 6);
    assert_non_null(strstr(said, "fcl-aabb-1.csv:3: not a frame's row"));
}

/* If a method cannot answer, the field is empty and the summary has no answer. */
TEST(summary_of_empty_fields_has_no_figures_of_them)
{
    write_cell((stored_cell){.rows = "1,,,,,,,,\n2,,,5,0.5,,,0,\n3,,,7,0,,1,1,\n"
                                     "4,,,9,0.5,,,,2\n",
                             .more = ", \"heap_live_bytes\": null, \"rss_peak_bytes\": 96, "
                                     "\"fixed_seed\": true, \"reason\": \"none\""});
    assert_int_equal(mote("summarize --format json ."), 0);
    json_t *summary = json_loads(said, 0, NULL);
    const json_t *row = json_array_get(json_object_get(summary, "rows"), 0);
    assert_true(json_is_null(json_object_get(json_object_get(row, "error"), "median")));
    assert_true(json_is_null(json_object_get(row, "heap_live_bytes")));
    assert_int_equal(json_integer_value(json_object_get(row, "rss_peak_bytes")), 96);
    assert_string_equal(json_string_value(json_object_get(row, "reason")), "none");
    const json_t *total = json_object_get(row, "total_ns");
    assert_true(json_number_value(json_object_get(total, "median")) == 6);
    assert_true(json_number_value(json_object_get(row, "contacts")) == 1);
    assert_true(json_number_value(json_object_get(row, "missed")) == 0);
    const json_t *steps = json_object_get(json_object_get(row, "counters"), "steps");
    assert_true(json_number_value(json_object_get(steps, "max")) == 2);
    json_decref(summary);
}

/* An impossible clock rate is not passed on to other tools. */
TEST(summary_clock_of_a_core_is_told_where_it_can_be_one)
{
    static const struct {
        const char *more, *says; /* says NULL: nothing about it */
    } cells[] = {{", \"clock_mhz\": [2400.5, 2400.5]", "\"mhz_per_cpu\": 2400"},
                 {", \"clock_mhz\": [1e300, 1e300]", NULL},
                 {", \"clock_mhz\": [-1, -1]", NULL},
                 {", \"clock_mhz\": \"fast\"", NULL}};
    for (size_t i = 0; i < ROWS_OF(cells); ++i) {
        write_cell((stored_cell){.rows = ROWS, .more = cells[i].more});
        assert_int_equal(mote("summarize --format gbench ."), 0);
        assert_non_null(strstr(said, cells[i].says ? cells[i].says : "\"context\""));
        assert_true(cells[i].says || !strstr(said, "mhz_per_cpu"));
    }
}

/* Cells of other programs are left out if the manifest names a program. */
TEST(stored_read_keeps_the_cells_of_the_manifests_program)
{
    static const struct {
        const char *manifest;
        size_t count, left_out;
    } cases[] = {{"{\"program\": \"one\"}", 1, 2},
                 {"{\"program\": \"three\"}", 0, 3},
                 {"{\"program\": 5}", 3, 0},
                 {"{\"program\": \"a name that is longer than any hash of a program\"}", 3, 0},
                 {"no JSON", 3, 0}};
    write_cell((stored_cell){.rows = ROWS, .more = ", \"program\": \"one\""});
    write_cell((stored_cell){.rows = ROWS, .replicate = 2, .more = ", \"program\": \"two\""});
    write_cell((stored_cell){.rows = ROWS, .replicate = 3});
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        mote_stored stored;
        file_put("manifest.json", cases[i].manifest);
        assert_int_equal(mote_stored_read(".", NULL, &stored), MOTE_OK);
        assert_int_equal(stored.count, cases[i].count);
        assert_int_equal(stored.left_out, cases[i].left_out);
        mote_stored_free(&stored);
    }
}

static const mote_summary_row *find_row(const mote_summary *summary, const char *label)
{
    for (size_t i = 0; i < summary->count; ++i) {
        if (strcmp(summary->rows[i].label, label) == 0)
            return &summary->rows[i];
    }
    fail_msg("no row %s", label);
    return NULL;
}

/* Writes replicate r of a method: frame k takes scale * k + r ns. frames lists digits; 'x'
   after one stands for no time. */
static void write_times(const char *method, int replicate, const char *frames, double scale)
{
    char rows[256] = "";
    size_t used = 0;
    for (const char *f = frames; *f; ++f) {
        const bool none = f[1] == 'x';
        used += (size_t)snprintf(rows + used, sizeof rows - used, "%c,0,0,%g,0.5,0,0,0,7\n", *f,
                                 none ? 0 : scale * (*f - '0') + replicate);
        f += none ? 1 : 0;
    }
    write_cell((stored_cell){.method = method, .replicate = replicate, .rows = rows});
}

static void write_crash(const char *method, int replicate)
{
    write_cell((stored_cell){.method = method, .replicate = replicate, .status = "crashed"});
}

/* Groups of 12 replicates: 1-3, 4-5, 6-8, 9-10, 11-12. */
TEST(summary_quiet_times_are_the_fastest_of_each_frame_in_a_group)
{
    for (int r = 1; r <= 12; ++r) {
        const char *frames = r >= 6 && r <= 8 ? "23x45" : "2345";
        if (r == 9 || r == 10)
            write_crash("certified", r);
        else
            write_times("certified", r, r == 4 ? "234" : frames, 100); /* 4: cut short */
        if (r > 10)
            write_crash("fcl-aabb", r);
        else
            write_times("fcl-aabb", r, "134", 1000);
    }
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    const mote_summary_row *row = find_row(&summary, "certified");
    assert_int_equal(row->replicates, 12);
    assert_int_equal(row->finished, 10);
    about(row->quiet.total[0], 351); /* median over 4 frames of 100 k + 1 */
    about(row->quiet.total[1], 355);
    about(row->quiet.total[2], (206.0 + 406) / 2);
    assert_true(isnan(row->quiet.total[3])); /* none of its replicates has run */
    about(row->quiet.total[4], 361);
    about(row->quiet.ratio[0], (3001.0 / 301 + 4001.0 / 401) / 2); /* frames 3 and 4 */
    about(row->quiet.ratio[1], (3004.0 / 305 + 4004.0 / 405) / 2);
    about(row->quiet.ratio[2], 4006.0 / 406); /* frame 3 took no time */
    assert_true(isnan(row->quiet.ratio[3]) && isnan(row->quiet.ratio[4]));
    /* The halves compared for the noise floor: replicates 1-6 and 7-12. */
    about(summary.noise_floor, (4001.0 / 401) / (4007.0 / 407) - 1);
    mote_summary_free(&summary);
}

/* Replicates need not be equally many in each row; one that crashed or was cut short does not
   count. */
TEST(summary_least_times_are_the_fastest_of_each_frame_in_all_replicates)
{
    write_times("certified", 1, "2345", 100);
    write_times("certified", 2, "23x4", 90); /* cut short */
    write_crash("certified", 3);
    write_times("certified", 4, "234x5", 100);
    write_times("fcl-aabb", 1, "2345", 1000);
    write_crash("brute-force", 1);
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    const mote_summary_row *row = find_row(&summary, "certified");
    about(row->least.median, (201.0 + 301) / 2); /* of 201, 301, 0 and 501 */
    about(row->least.settled_sum, 201 + 301 + 501);
    about(find_row(&summary, "fcl-aabb")->least.median, 3501);
    about(find_row(&summary, "fcl-aabb")->least.settled_sum, 14004);
    row = find_row(&summary, "brute-force");
    assert_true(isnan(row->least.median) && isnan(row->least.settled_sum));
    mote_summary_free(&summary);
}

/* Frames 1 .. count, of which frame k takes k ns, and 1,000 more for deformation. */
static void write_ramp(const char *method, int count, const char *parameters)
{
    char rows[2048];
    size_t used = 0;
    for (int k = 1; k <= count; ++k)
        used += (size_t)snprintf(rows + used, sizeof rows - used, "%d,1000,0,%d,0.5,0,0,0,7\n",
                                 k, k);
    write_cell((stored_cell){
        .method = method, .rows = rows, .frames = "[1, 60]", .parameters = parameters});
}

TEST(summary_settled_sum_begins_at_frame_50_where_there_are_60)
{
    write_ramp("stream", 60, "{\"positions\": \"given\"}");
    write_ramp("aabb-tree", 59, "{\"positions\": \"given\"}");
    write_ramp("certified", 60, "{}");
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    const mote_least given = find_row(&summary, "stream")->least;
    about(given.median, 30.5);
    about(given.settled_sum, 11 * 55); /* 50 .. 60 */
    about(find_row(&summary, "aabb-tree:positions=given")->least.settled_sum, 59 * 30);
    about(find_row(&summary, "certified")->least.median, 1030.5);
    about(find_row(&summary, "certified")->least.settled_sum, 11 * 1055);
    mote_summary_free(&summary);
}

/* Frames that only one of the two has, and times of 0, are in no ratio. */
TEST(summary_ratio_is_of_common_frames_with_a_time)
{
    write_times("certified", 1, "12x4", 10);
    write_times("certified", 2, "1", 10);
    write_times("certified", 3, "6", 10); /* no frame of the reference */
    write_times("aabb-tree", 1, "1x2x", 10);
    write_times("brute-force", 1, "6", 10);
    write_times("fcl-aabb", 1, "234", 100);
    write_crash("fcl-aabb", 2);
    write_times("fcl-aabb", 3, "345", 100);
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    about(find_row(&summary, "certified")->ratio.value, 401.0 / 41);
    assert_true(isnan(find_row(&summary, "certified")->processes[1].ratio));
    assert_true(isnan(find_row(&summary, "aabb-tree")->ratio.value));
    assert_true(isnan(find_row(&summary, "brute-force")->ratio.value));
    assert_true(isnan(find_row(&summary, "aabb-tree")->smallest_change));
    mote_summary_free(&summary);
}

/* Labels: parameters of an unknown method, unknown parameters, and numbers. */
TEST(summary_label_names_what_is_not_default)
{
    write_cell((stored_cell){.rows = ROWS,
                             .method = "particle-paper",
                             .parameters = "{\"n\": 5, \"law\": \"log\", \"new\": true}"});
    write_cell((stored_cell){
        .rows = ROWS, .method = "bygone", .parameters = "{\"n\": \"few\", \"speed\": [1]}"});
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    about(find_row(&summary, "particle-paper:n=5,new=true")->n, 5);
    assert_true(isnan(find_row(&summary, "bygone:n=few,speed=[1]")->n));
    mote_summary_free(&summary);
}

/* A parameter of another type than the method's is shown unchanged. */
TEST(summary_label_of_a_parameter_of_another_kind_is_its_json)
{
    write_cell((stored_cell){.rows = ROWS, .parameters = "{\"queue\": true, \"seed\": null}"});
    write_cell((stored_cell){.rows = ROWS, .id = "two", .parameters = "{\"queue\": 64.5}"});
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    (void)find_row(&summary, "fcl-aabb:queue=true,seed=null");
    (void)find_row(&summary, "fcl-aabb:queue=64.5"); /* a choice is stored by name */
    assert_int_equal(summary.count, 2);
    mote_summary_free(&summary);
}

/* The reference of ratios: fcl-aabb with default parameters, else the first row, on the same
   frames, caches and machine. */
TEST(summary_reference_is_of_the_same_frames_and_caches)
{
    static const stored_cell cells[] = {
        {.method = "certified", .id = "a"},
        {.method = "certified", .id = "b", .fingerprint = "g"},
        {.method = "certified", .id = "c", .cache = "evict"},
        {.method = "certified", .id = "d", .more = ", \"machine\": \"other\""},
        {.method = "certified", .id = "e", .more = ", \"jobs\": 2"},
        {.method = "certified", .id = "f", .scenario = "t"},
        {.method = "fcl-aabb", .id = "g", .parameters = "{\"queue\": \"64\"}"},
        {.method = "fcl-aabb", .id = "h", .parameters = "{\"queue\": \"128\"}"},
        {.method = "fcl-aabb", .id = "i", .parameters = "{\"queue\": \"2\"}"},
        {.method = "fcl-aabb",
         .id = "j",
         .cache = "evict",
         .parameters = "{\"queue\": \"128\"}"},
        {.method = "fcl-aabb",
         .id = "k",
         .cache = "evict",
         .parameters = "{\"queue\": \"64\"}"}};
    for (size_t i = 0; i < ROWS_OF(cells); ++i) {
        stored_cell cell = cells[i];
        cell.rows = ROWS;
        write_cell(cell);
    }
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    assert_int_equal(summary.count, 11);
    for (size_t i = 0; i < summary.count; ++i) {
        const mote_summary_row *row = &summary.rows[i];
        const char *id = row->first->id;
        const char *to = strchr("aghi", id[0]) ? "i" : strchr("cjk", id[0]) ? "j" : "";
        const char *is = row->ratio.to ? row->ratio.to->first->id : "";
        if (strcmp(is, to) != 0)
            fail_msg("the ratio of %s is to \"%s\", not \"%s\"", id, is, to);
    }
    mote_summary_free(&summary);
}

/* A successful cell without frames, and contacts of which one side is unknown. */
TEST(summary_of_a_cell_without_frames_or_vertices_has_no_figures)
{
    write_cell((stored_cell){.rows = "", .method = "certified"});
    write_cell((stored_cell){.rows = "1,0,0,5,0,0,1,,7\n2,0,0,5,0,0,,1,7\n"});
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    const mote_summary_row *none = find_row(&summary, "certified");
    assert_int_equal(none->finished, 0);
    assert_true(isnan(none->total.median) && isnan(none->contacts) && isnan(none->missed));
    const mote_summary_row *row = find_row(&summary, "fcl-aabb");
    about(row->contacts, 1);
    assert_true(isnan(row->missed) && isnan(row->false_contacts));
    mote_summary_free(&summary);
    mote_expect(0, "", "summarize .");
}

/* 69 that agree and a last one that does not: its error widens the interval. */
TEST(figure_quantile_of_many_replicates_takes_them_all)
{
    for (int k = 1; k <= 70; ++k)
        write_cell((stored_cell){.replicate = k,
                                 .rows = k < 70 ? "1,1,2,3,0.5,0.001,0,0,7\n"
                                                : "1,1,2,3,0.5,0.25,0,0,7\n"});
    mote_summary summary;
    mote_text figure = {0};
    double value, low, high;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    assert_int_equal(summary.rows[0].replicates, 70);
    mote_figure_quantile(&summary.rows[0], 0.5, 0.001, &figure);
    assert_int_equal(sscanf(figure.data, "%lf %lf %lf", &value, &low, &high), 3);
    assert_true(value == 0.001 && low <= value);
    assert_true(high > 0.01); /* a mean of 0.0046 and 2 standard errors of 0.0036 */
    free(figure.data);
    mote_summary_free(&summary);
}

static void merge(int status, const char *says)
{
    mote_expect(status, says, "merge out in");
}

static size_t sessions_of(const char *name)
{
    json_t *manifest = NULL;
    assert_int_equal(mote_record_read_json(".", name, &manifest), MOTE_OK);
    const size_t count = json_array_size(json_object_get(manifest, "sessions"));
    json_decref(manifest);
    return count;
}

#define BY_ONE "\"program\": \"one\""

TEST(merge_copies_what_is_not_there_and_adds_sessions)
{
    merge(4, "in/cells: No such file");
    stored_cell_put("in", (stored_cell){.rows = ROWS, .more = ", " BY_ONE});
    merge(4, "in/manifest.json: No such file");
    file_put("in/manifest.json", "{" BY_ONE ", \"sessions\": [1, 2]}\n");
    merge(0, "out: 1 cells copied, 0 were there");
    /* A crashed cell has no frames to copy, and a session is added once. */
    stored_cell_put("in",
                    (stored_cell){.replicate = 2, .status = "crashed", .more = ", " BY_ONE});
    file_put("in/manifest.json", "{" BY_ONE ", \"sessions\": [2, 3]}\n");
    for (int again = 0; again < 2; ++again) {
        merge(0, again ? "0 cells copied, 2 were" : "1 cells copied, 1 w");
        assert_int_equal(sessions_of("out/manifest.json"), 3);
    }
    file_put("in/manifest.json", "{\"program\": \"two\", \"sessions\": [4]}\n");
    merge(4, "in: measured by another build than ");
    file_put("in/manifest.json", "{" BY_ONE ", \"sessions\": [4]}\n");
    file_put("out/manifest.json", "{" BY_ONE "}\n");
    merge(4, "out/manifest.json: no list of sessions");
    file_put("out/manifest.json", "no JSON\n");
    merge(4, "out/manifest.json:1:");
}

static bool merged_is_ok(void)
{
    json_t *cell = NULL;
    assert_int_equal(mote_record_read_json("out", "cells/fcl-aabb-1.json", &cell), MOTE_OK);
    const bool ok = strcmp(mote_text_at(cell, "status"), "ok") == 0;
    json_decref(cell);
    return ok;
}

/* A cell that failed in one shard and not in another, merged in both orders. */
TEST(merge_prefers_a_good_cell_to_a_failed_one)
{
    static const char *const bad[] = {"crashed", "timeout", "unsupported"};
    const stored_cell good = {.rows = ROWS, .more = ", " BY_ONE};
    file_put("good/manifest.json", "{" BY_ONE ", \"sessions\": [1]}\n");
    file_put("bad/manifest.json", "{" BY_ONE ", \"sessions\": [2]}\n");
    stored_cell_put("good", good);
    for (size_t i = 0; i < ROWS_OF(bad); ++i) {
        stored_cell_put("bad", (stored_cell){.status = bad[i], .more = ", " BY_ONE});
        mote_expect(0, "1 cells copied, 0 were there", "merge out bad");
        mote_expect(0, "0 cells copied, 1 were there", "merge out bad");
        assert_false(merged_is_ok());
        mote_expect(0, "1 cells copied, 0 were there", "merge out good");
        assert_true(merged_is_ok() && file_exists("out/cells/fcl-aabb-1.csv"));
        mote_expect(0, "0 cells copied, 1 were there", "merge out bad");
        assert_true(merged_is_ok());
        assert_int_equal(folder_remove("out"), 0);
    }
}

/* Whatever reads a file of pairs has the same limit: 4 GiB. */
TEST(merge_and_summary_refuse_pairs_of_the_same_size)
{
    static const char says[] = "a.pairs.csv: 4294967297 bytes; at most 4294967296 are read";
    const mote_stored_cell cell = {.id = "a"};
    mote_scene_contacts contacts;
    file_put("in/cells/a.pairs.csv", "frame\n");
    assert_int_equal(truncate("in/cells/a.pairs.csv", ((off_t)4 << 30) + 1), 0);
    assert_int_equal(mote_record_copy("in", "out", "cells/a.pairs.csv"), MOTE_EINVAL);
    if (!strstr(mote_error_text(), says))
        fail_msg("%s", mote_error_text());
    assert_int_equal(mote_scene_contacts_read("in", &cell, &contacts), MOTE_EINVAL);
    if (!strstr(mote_error_text(), says))
        fail_msg("%s", mote_error_text());
}
