/* Tables, figures and pages of runs with odd cells: cells of several machines, caches, seeds
   and frames; cells that failed; cells without answers or names; too many of each. Tests what a
   user sees of them, also while each place that asks for memory, files or processes fails
   once. */
#include "tests/faults/fault_lines.h"

#include "harness/figure/figures.h"
#include "harness/base/file.h"
#include "harness/base/options.h"
#include "harness/base/record.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define LONG_NAME                                                                              \
    "A z/Z09-_`{@[: a name that is longer than the file of a figure's data may be, by some"

/* The frames of a cell: the first, how many, and the stride. error is NAN for a method that
   reports contact only. */
typedef struct frames {
    int first, count, stride;
    double ns, error;
} frames;

/* A cell: its name, and the keys in which it differs from the usual one. */
typedef struct odd_cell {
    const char *id, *other;
    frames rows;
} odd_cell;

static const char usual[] =
    "{\"schema\": 1, \"status\": \"ok\", \"scenario\": \"s\", \"fingerprint\": "
    "\"0123456789abcdef\", \"method\": \"certified\", \"parameters\": {}, \"replicate\": 1, "
    "\"frames\": [1, 6], \"stride\": 1, \"seed\": 0, \"cache\": \"hot\", \"triangles\": [10, "
    "12], \"vertices\": [7, 8], \"active\": [1, 6], \"program\": \"p1\", \"machine\": \"m1, "
    "two cores\", \"length\": 1, \"clock_mhz\": [2400, 2400]}";

static void write_cell(const char *directory, const odd_cell *odd)
{
    char name[96];
    json_t *cell = json_loads(usual, 0, NULL), *other = json_loads(odd->other, 0, NULL);
    assert_non_null(cell);
    if (!other)
        fail_msg("%s: not JSON", odd->other);
    assert_int_equal(json_object_update(cell, other), 0);
    json_decref(other);
    assert_int_equal(json_object_set_new(cell, "id", json_string(odd->id)), 0);
    mote_text text = {0};
    mote_text_add(&text,
                  "frame,deform_ns,update_ns,query_ns,truth,error,contact,contact_truth\n");
    for (int k = 0; k < odd->rows.count; ++k) {
        mote_text_add(&text, "%d,0,0,%.0f,%d,", odd->rows.first + k * odd->rows.stride,
                      odd->rows.ns, k % 2);
        if (!isnan(odd->rows.error))
            mote_text_add(&text, "%.17g", odd->rows.error);
        mote_text_add(&text, ",%d,%d\n", k % 3 == 0, k % 2 == 0);
    }
    (void)snprintf(name, sizeof name, "cells/%s.csv", odd->id);
    assert_int_equal(mote_record_text(directory, name, &text), MOTE_OK);
    (void)snprintf(name, sizeof name, "cells/%s.json", odd->id);
    assert_int_equal(mote_record_json(directory, name, cell), MOTE_OK);
}

#define SIX                                                                                    \
    {                                                                                          \
        1, 6, 1, 1e6, 0                                                                        \
    }
#define PAPER(n)                                                                               \
    "{\"method\": \"particle-paper\", \"parameters\": {\"n\": " #n ", \"refine\": \"no\"}"

static const odd_cell odd[] = {
    {"a1", "{}", SIX},
    {"a2", "{\"replicate\": 2, \"status\": \"timeout\"}", SIX},
    {"evict", "{\"cache\": \"evict\"}", SIX},
    {"other", "{\"machine\": \"m2, four cores\"}", SIX},
    {"nowhere", "{\"scenario\": \"nowhere\", \"machine\": \"\", \"seed\": 5}", SIX},
    {"seed", "{\"seed\": 7}", SIX},
    {"given", "{\"parameters\": {\"positions\": \"given\"}}", SIX},
    {"jobs", "{\"method\": \"particle\", \"parameters\": {\"n\": 8}, \"jobs\": 2}", SIX},
    {"short",
     "{\"method\": \"particle\", \"parameters\": {\"n\": 8}, \"frames\": [1, 3]}",
     {1, 3, 1, 1e4, 0}},
    {"crash", "{\"method\": \"fcl-obb\", \"status\": \"crashed\", \"reason\": \"it | fell\"}",
     SIX},
    {"silent", "{\"method\": \"fcl-rss\", \"status\": \"unsupported\"}", SIX},
    {"empty", "{\"method\": \"aabb-tree\"}", {1, 0, 1, 0, 0}},
    {"contact", "{\"method\": \"embree-contact\"}", {1, 6, 1, 1e5, (double)NAN}},
    {"zero", "{\"method\": \"brute-force\"}", {1, 6, 1, 0, 0.5}},
    {"aabb1", "{\"method\": \"fcl-aabb\"}", {2, 3, 2, 2e6, 0}},
    {"aabb2", "{\"method\": \"fcl-aabb\", \"replicate\": 2}", {2, 3, 2, 2e6, 0}},
    {"p3a", PAPER(3) "}", {1, 6, 1, 1e4, 1e-3}},
    {"p3b", PAPER(3) ", \"replicate\": 2}", {1, 3, 1, 1e4, 1e-3}},
    {"p3c", PAPER(3) ", \"replicate\": 3}", {1, 8, 1, 1e4, (double)NAN}},
    {"p5", PAPER(5) "}", {1, 6, 1, 2e4, 1e-4}},
    {"p9", PAPER(9) "}", {2, 5, 1, 3e4, 0.9}},
    {"stride", PAPER(30) ", \"stride\": 2}", {1, 3, 2, 3e7, 1e-6}},
    {"p100", PAPER(100) "}", {1, 6, 1, 0, 1e-6}},
    {"long", "{\"scenario\": \"" LONG_NAME "\", \"triangles\": null}", SIX},
    {"large", "{\"scenario\": \"large\", \"vertices\": [70000, 7]}", SIX},
    {"larger", "{\"scenario\": \"larger\", \"vertices\": [7, 70000]}", SIX},
    {"tt", "{\"scenario\": \"tt\"}", SIX},
    {"ttp", PAPER(3) ", \"scenario\": \"tt\"}", SIX},
    {"build", "{\"program\": \"p2\"}", SIX},
};

#define TETRAHEDRON "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
#define TWO                                                                                    \
    "{\"purpose\": \"a test\", \"frames\": 2, \"ask\": \"distance\", \"bodies\": [{\"file\": " \
    "\"four.obj\"}, {\"file\": \"four.obj\", \"velocity\": [2, 0, 0]}]}\n"

#define MANIFEST                                                                               \
    "{\"program\": \"p1\", \"build_type\": \"Debug\", \"cores\": null, \"dirty\": true, "      \
    "\"commit\": \"0123456789\", \"sessions\": [{\"started\": "                                \
    "\"2026-11-21T10:20:30.123456789012345678901234567890Z\", \"command\": [\"run\", 7, "      \
    "\"it's\", \"\"]}]}\n"

/* Claims with every field of a wrong kind or missing. */
#define ODD_CLAIMS                                                                             \
    "[{\"id\": \"a\", \"claim\": \"no unit\", \"verdict\": \"holds\", \"value\": 2, "          \
    "\"interval\": [1], \"values\": [{\"name\": \"both\", \"value\": 7, \"threshold\": "       \
    "{\"bound\": \"at most\", \"holds\": 8, \"limits\": 9}}, {\"name\": \"one\", \"value\": "  \
    "7, "                                                                                      \
    "\"unit\": \"us\", \"threshold\": {\"bound\": \"at least\", \"limits\": 6}}, {\"name\": "  \
    "\"none\", \"value\": \"x\", \"threshold\": {\"bound\": \"some\", \"holds\": \"x\"}}]}, "  \
    "{\"id\": 5, \"claim\": \"a unit\", \"value\": 0.5, \"unit\": \"L\"}]\n"

/* A list of figures in which most entries are wrong. */
#define ODD_FIGURES                                                                            \
    "{\"figures\": [{\"number\": 4, \"title\": \"Drawn\", \"scenario\": \"s\", \"files\": "    \
    "[5, "                                                                                     \
    "\".svg\", \"../up.svg\", \"gone.svg\", \"a.png\", \"a.svg\"], \"caption\": \"here\"}, "   \
    "{\"number\": 5, \"title\": \"Whole\", \"files\": [\"b.gif\"]}, {}, 7], \"missing\": "     \
    "[7], "                                                                                    \
    "\"not_drawn\": [7, {}, {\"number\": 9, \"command\": \"make x\"}, {\"number\": 12, "       \
    "\"command\": \"make y\"}, {\"number\": 9, \"command\": \"make x\"}, {\"number\": 10, "    \
    "\"command\": \"make x\"}]}\n"

static char said[1 << 18];

/* Runs the line and stores its output in said[]. */
static void hear(const fault_line *line)
{
    assert_true(fault_lines_run(line, 1));
    FILE *in = fopen("said", "r");
    assert_non_null(in);
    said[fread(said, 1, sizeof said - 1, in)] = '\0';
    (void)fclose(in);
}

static void read_page(const char *name)
{
    char *text = NULL;
    size_t size = 0;
    assert_int_equal(mote_file_read(name, sizeof said - 1, &text, &size), MOTE_OK);
    memcpy(said, text, size + 1);
    free(text);
}

static void has(const char *const *wanted, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (!strstr(said, wanted[i]))
            fail_msg("\"%s\" is not in:\n%.2000s", wanted[i], said);
    }
}
#define HAS(list) has(list, sizeof(list) / sizeof(list)[0])

TEST(tables_of_odd_cells_say_what_is_odd)
{
    static const fault_line table = LINE(summarize, " odd", 0);
    static const char *const wanted[] = {
        "crashed: it | fell",
        "unsupported: \n",
        "1 of 2 replicates failed",
        "times not comparable: 2 cells at once",
        "every 2nd frame",
        ", on m2, four cores",
        "1 cells were measured by another build and are left out",
    };
    hear(&table);
    HAS(wanted);
}

TEST(formats_of_odd_cells_tell_rows_apart)
{
    static const fault_line gbench = LINE(summarize, " odd --format gbench", 0),
                            gha = LINE(summarize, " odd --format gha", 0),
                            bencher = LINE(summarize, " odd --format bencher", 0),
                            csv = LINE(summarize, " odd --format csv", 0);
    static const char *const bench[] = {
        "\"library_build_type\": \"debug\"",
        "\"host_name\": \"m1\"",
        "s/certified/hot/frames:1-6/stride:1/seed:0/m1, two cores",
        "s/certified/hot/frames:1-6/stride:1/seed:7/m1, two cores",
        "s/certified/evict/m1, two cores",
        "s/certified/hot/m2, four cores",
    };
    hear(&gbench);
    HAS(bench);
    assert_null(strstr(said, "num_cpus"));
    assert_null(strstr(said, "particle:n=8/hot/frames:1-6")); /* two at once: no time */
    hear(&gha);
    assert_non_null(strstr(said, "s/fcl-aabb/hot/m1, two cores"));
    assert_null(strstr(said, "fcl-obb"));
    hear(&bencher);
    assert_null(strstr(said, "fcl-obb"));
    assert_non_null(strstr(said, "lower_value"));
    hear(&csv);
    assert_non_null(strstr(said, "\"m2, four cores\",0,1,"));
    assert_non_null(strstr(said, "crashed"));
}

/* The figures of each scenario have a file name that any program accepts. */
TEST(figures_of_odd_cells_are_those_that_can_be)
{
    static const fault_line figures[] = {LINE(figures, " odd", 0)};
    static const char *const wanted[] = {
        "\"name\": \"front-A_z_Z09-_______a_name_that_is_longer_than_the_file_of_a_figure_",
        "\"run\": \"20261121T102030.123456789012345-p1, commit 0123456+\"",
        "tt: other frames or faces than those measured",
        "\"scenario\": \"s\"",
    };
    assert_true(fault_lines_run(figures, 1));
    read_page("odd/figures/figures.json");
    HAS(wanted);
    read_page("odd/figures/front-s.dat");
    assert_non_null(strstr(said, "\"particle-paper:refine=no\"\n3 "));
    assert_null(strstr(said, "brute-force")); /* took no time */
    read_page("odd/figures/error-time-s.dat");
    assert_non_null(strstr(said, " 1\n")); /* a missed contact */
    FAIL_EACH(figures);
}

TEST(reports_of_odd_cells_say_what_is_odd)
{
    static const fault_line report[] = {LINE(report, " odd", 0)};
    static const char *const html[] = {
        ", on m2, four cores\"",
        "\"machine\":\"m2, four cores\"",
        "\"reason\":\"it | fell\"",
        "\"notes\":[\"every 2nd frame\"]",
        "id=\"replay-data\"",
        "larger: its meshes have more than 65535 vertices",
        "s: no scenario with the fingerprint of its cells was found",
        "mote run '' 'it'\\\\''s' ''",
        "0123456789, and changes that are in no commit",
        "[2,\"a2\",\"timeout\"]",
    };
    static const char *const markdown[] = {
        ": 10 and 12 triangles, ", ", on m2, four cores\n", " crashed: it \\| fell |",
        "[c1-1]: cells/long.csv",  "cells/crash.json\n",
    };
    assert_true(fault_lines_run(report, 1));
    read_page("odd/report.html");
    HAS(html);
    read_page("odd/report.md");
    HAS(markdown);
    FAIL_EACH(report);
}

TEST(reports_of_odd_claims_show_what_there_is)
{
    static const fault_line report[] = {LINE(report, " claims//", 0), LINE(report, " list", 0),
                                        LINE(report, " broken", 0), LINE(report, " wanted", 0)};
    static const char *const claims[] = {
        "<h1>claims</h1>",
        "\"bound\":\"at most\",\"holds\":8,\"limits\":9",
        "\"title\":\"b\"", /* from the folder, for want of a list */
        "\"file\":\"figures/c.gif\"",
        "\"animation\":true",
    };
    assert_true(fault_lines_run(report, 4));
    read_page("claims/report.html");
    HAS(claims);
    assert_null(strstr(said, "figures/.hidden"));
    assert_null(strstr(said, "a.png"));
    read_page("claims/report.md");
    static const char *const markdown[] = {": no unit. Measured: [2](claims.json)\n",
                                           "a unit. Measured: [0.5 L](claims.json)"};
    HAS(markdown);
    read_page("list/report.html");
    static const char *const list[] = {
        "\"title\":\"Figure 4. Drawn: s\",\"caption\":\"here\"",
        "\"title\":\"Figure 5. Whole\"",
        "figures that other commands measure: 9, 10 (`make x`), 12 (`make y`)"};
    HAS(list);
    assert_null(strstr(said, "up.svg"));
    assert_null(strstr(said, "gone.svg"));
    read_page("broken/report.html");
    static const char *const broken[] = {
        "\"claims.json: ", "\"requirements.json: ", "Figure 1. Alone"};
    HAS(broken);
    assert_null(strstr(said, "\"claims\":"));
    read_page("wanted/report.html");
    assert_non_null(strstr(said, "\"requirements\":"));
    FAIL_EACH(report);
}

/* The curve of a claim or a study, drawn by its own script. */
static int plot(int argc, char **argv)
{
    (void)argc;
    return mote_figures_plot(argv[1], argv[2], argv[2]) == MOTE_OK ? 0 : mote_command_fail();
}

TEST(figures_plot_when_a_call_fails_says_so)
{
    static const fault_line curve[] = {{"plot odd front-s", plot, 0}};
    assert_true(fault_lines_run(curve, 1));
    FAIL_EACH(curve);
}

/* Puts a folder where a file is expected: reading it fails. */
static bool write_pages(void)
{
    static const struct {
        const char *name, *text;
    } files[] = {
        {"claims/claims.json", ODD_CLAIMS},
        {"claims/figures/b.svg", "<svg/>"},
        {"claims/figures/.hidden.svg", "<svg/>"},
        {"claims/figures/a.png", "png"},
        {"claims/figures/c.gif", "gif"},
        {"list/figures/figures.json", ODD_FIGURES},
        {"list/figures/a.svg", "<svg/>"},
        {"list/figures/b.gif", "gif"},
        {"broken/figures/figures.json",
         "{\"figures\": [{\"number\": 1, \"title\": \"Alone\", \"files\": [\"a.svg\"]}]}\n"},
        {"broken/figures/a.svg", "<svg/>"},
        {"wanted/requirements.json", ODD_CLAIMS},
        {"wanted/manifest.json", "{}\n"},
    };
    static const char *const folders[] = {"claims/figures",           "list/figures",
                                          "broken/figures",           "broken/claims.json",
                                          "broken/requirements.json", "wanted/claims.json"};
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; ++i) {
        if (mote_directory_make(folders[i]) != MOTE_OK)
            return false;
    }
    for (size_t i = 0; i < sizeof files / sizeof files[0]; ++i) {
        if (!fault_lines_write(files[i].name, files[i].text))
            return false;
    }
    return true;
}

/* More sizes, methods, families and replicates than a figure takes: it shows the first ones. */
static bool write_many(void)
{
    static const char *const sizes[] = {"ww", "ww-x", "ww-5x", "ww-5kk", "ww-5m", "wwx"};
    char id[32], other[256];
    odd_cell cell = {id, other, SIX};
    if (mote_directory_make("many/cells") != MOTE_OK)
        return false;
    for (int k = 0; k < 17; ++k) {
        (void)snprintf(id, sizeof id, "size%d", k);
        (void)snprintf(other, sizeof other,
                       "{\"scenario\": \"ww-%dk\", \"triangles\": [%d, 7], "
                       "\"heap_live_bytes\": %d}",
                       k + 1, 1000 * (18 - k), k % 2 * 1000);
        write_cell("many", &cell);
        (void)snprintf(id, sizeof id, "family%d", k);
        (void)snprintf(other, sizeof other,
                       "{\"scenario\": \"families\", \"method\": \"m%02d\"}", k);
        write_cell("many", &cell);
    }
    for (int k = 0; k < 27; ++k) {
        (void)snprintf(id, sizeof id, "method%d", k);
        (void)snprintf(
            other, sizeof other,
            "{\"scenario\": \"ww-%dk\", \"method\": \"n%d\", \"triangles\": [%d, 7]}",
            k % 3 + 1, k / 3, k < 3 ? 5 : 1000 * (k % 3));
        write_cell("many", &cell);
    }
    for (int k = 0; k < 66; ++k) {
        (void)snprintf(id, sizeof id, "again%d", k);
        (void)snprintf(other, sizeof other,
                       "{\"scenario\": \"again\", \"method\": \"%s\", \"replicate\": %d}",
                       k == 0 ? "fcl-aabb" : "certified", k == 0 ? 1 : k);
        write_cell("many", &cell);
        (void)snprintf(id, sizeof id, "other%d", k);
        (void)snprintf(other, sizeof other,
                       "{\"scenario\": \"again\", \"method\": \"fcl-aabb\", \"replicate\": %d}",
                       k + 1);
        if (k > 0)
            write_cell("many", &cell);
    }
    static const char *const more[] = {
        "\"frames\": [1, 3]",  "\"cache\": \"evict\"",    "\"jobs\": 3",
        "\"machine\": \"m2\"", "\"status\": \"crashed\"", "\"seed\": 9",
    };
    for (size_t k = 0; k < 6; ++k) {
        (void)snprintf(id, sizeof id, "name%zu", k);
        (void)snprintf(other, sizeof other, "{\"scenario\": \"%s\"}", sizes[k]);
        write_cell("many", &cell);
        (void)snprintf(id, sizeof id, "more%zu", k);
        (void)snprintf(other, sizeof other, "{\"scenario\": \"ww-2k\", %s}", more[k]);
        cell.rows.count = k == 0 ? 3 : 6;
        write_cell("many", &cell);
    }
    return true;
}

TEST(figures_of_too_many_cells_take_the_first)
{
    static const fault_line figures[] = {LINE(figures, " many", 0)};
    assert_true(write_many());
    assert_true(fault_lines_run(figures, 1));
    read_page("many/figures/size-time.dat");
    assert_int_equal(test_count(said, " 1000 1000 1000\n"), 16 + 7 * 3); /* sizes; methods */
    assert_null(strstr(said, "\"n7\""));
    assert_non_null(strstr(said, "\"n0\"\n")); /* only one size: no exponent */
    read_page("many/figures/size-bytes.dat");
    assert_int_equal(test_count(said, " 1000 66.66"), 6); /* cells that reported their bytes */
    read_page("many/figures/shares-families.dat");
    assert_int_equal(test_count(said, "\n"), 16);
    read_page("many/figures/ratios-again.dat");
    assert_int_equal(test_count(said, " 1 1 1\n"), 6);
}

static int make_files(void)
{
    if (!fault_lines_open() || !fault_lines_install() ||
        mote_directory_make("odd/cells") != MOTE_OK ||
        !fault_lines_write("odd/manifest.json", MANIFEST) ||
        !fault_lines_write("share/mote/datasets/scenarios/four.obj", TETRAHEDRON) ||
        !fault_lines_write("share/mote/datasets/scenarios/tt.json", TWO) ||
        !fault_lines_write("share/mote/page/replay.js", "play();\n"))
        return -1;
    for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i)
        write_cell("odd", &odd[i]);
    return write_pages() ? 0 : -1;
}

TEST_GROUP(make_files, fault_lines_close);

/* gnuplot fails: each failure is reported, and the other figures are still tried. */
TEST(figures_that_gnuplot_does_not_draw_are_told)
{
    static const fault_line figures[] = {LINE(figures, " odd", 4)};
    static const char *const wanted[] = {
        "mote: odd: figure 4 (front) is not drawn; missing: gnuplot: ended with status 3\n",
        "figures could not be drawn\n"};
    assert_true(fault_lines_write("bin/gnuplot", "#!/bin/sh\nexit 3\n"));
    assert_int_equal(chmod("bin/gnuplot", 0755), 0);
    assert_false(fault_lines_run(figures, 1));
    read_page("error");
    HAS(wanted);
    FAIL_EACH(figures);
}
