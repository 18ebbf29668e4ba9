/* The data of figures of runs that the test writes itself, with frames without an answer,
   methods that fail, and rows that lack something; gnuplot is a stand-in. */
#include "harness/base/memory.h"
#include "harness/figure/figure.h"
#include "harness/summary/summary_json.h"
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define GNUPLOT "#!/bin/sh\nfor f in $8; do echo drawn > \"$5.$f\"; done\n"

static int put_gnuplot(void)
{
    char path[256], here[200];
    if (folder_next() != 0 || !getcwd(here, sizeof here))
        return -1;
    file_put("bin/gnuplot", GNUPLOT);
    (void)snprintf(path, sizeof path, "%s/bin:/usr/bin:/bin", here);
    return chmod("bin/gnuplot", 0755) || setenv("PATH", path, 1);
}

TEST_EACH(put_gnuplot, NULL);

/* Four frames that each take NS: exact, inexact and without an answer in one frame, in contact
   all the time, without any answer. */
#define EXACT                                                                                  \
    "1,1,2,%d,0.5,0,0,0,7\n2,1,2,%d,0.25,0,0,0,7\n3,1,2,%d,0,0,1,1,7\n4,1,2,%d,0,0,1,1,7\n"
#define WRONG                                                                                  \
    "1,1,2,%d,0.5,0.1,0,0,7\n2,1,2,%d,0.25,,,0,7\n3,1,2,%d,0,0.1,0,1,7\n4,1,2,%d,0,0,1,1,7\n"
#define TOUCH                                                                                  \
    "1,1,2,%d,0,0,1,1,7\n2,1,2,%d,0,0.2,0,1,7\n3,1,2,%d,0,0,1,1,7\n4,1,2,%d,0,0,1,1,7\n"
#define APART                                                                                  \
    "1,1,2,%d,0.5,0,0,0,7\n2,1,2,%d,0.4,0,0,0,7\n3,1,2,%d,0.3,0,0,0,7\n4,1,2,%d,0.2,0,0,0,7\n"
#define SILENT "1,1,2,%d,0.5,,,0,7\n2,1,2,%d,0.25,,,0,7\n3,1,2,%d,0,,,1,7\n4,1,2,%d,0,,,1,7\n"

/* Writes two replicates; each frame takes ns in the first, and a little longer then. */
static void put(const char *scenario, const char *method, const char *parameters, int ns,
                const char *form)
{
    static int number;
    for (int replicate = 1; replicate <= 2; ++replicate) {
        char id[24], rows[256];
        const int t = ns + replicate;
        (void)snprintf(id, sizeof id, "c%d", ++number);
        /* The form has four numbers. */
        char *at = rows;
        for (const char *c = form; *c; ++c) {
            if (c[0] == '%' && c[1] == 'd') {
                at += sprintf(at, "%d", t);
                ++c;
            } else {
                *at++ = *c;
            }
        }
        *at = '\0';
        stored_cell_put("run", (stored_cell){.id = id,
                                             .method = method,
                                             .scenario = scenario,
                                             .parameters = parameters,
                                             .replicate = replicate,
                                             .rows = rows});
    }
}

static const char *const ingredients[] = {
    "{\"n\": 8}", "{\"n\": 8, \"refine\": 1}", "{\"n\": 8, \"launch\": 8}",
    "{\"n\": 0}", "{\"n\": 8, \"track\": 16}", "{\"n\": 8, \"start\": \"random\"}",
    "{\"n\": 2}", "{\"n\": 8, \"track\": 0}",
};

static void put_ingredients(const char *scenario, const char *form)
{
    for (int k = 0; k < (int)ROWS_OF(ingredients); ++k)
        put(scenario, "particle", ingredients[k], 100 * (k + 1), form);
}

/* The caption of a figure; the caller frees it. */
static char *caption_of(const char *figure)
{
    json_t *list = NULL;
    char *caption = NULL;
    assert_int_equal(mote_record_read_json("run/figures", "figures.json", &list), MOTE_OK);
    const json_t *one;
    size_t i;
    MOTE_EACH(i, one, json_object_get(list, "figures"))
    {
        if (strcmp(mote_text_at(one, "name"), figure) == 0)
            caption = mote_duplicate(mote_text_at(one, "caption"));
    }
    json_decref(list);
    if (!caption)
        fail_msg("no figure %s", figure);
    return caption;
}

static void expect_in(const char *text, const char *const *parts, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (!strstr(text, parts[i]))
            fail_msg("no \"%s\" in:\n%.3000s", parts[i], text);
    }
}

TEST(ingredients_that_fail_are_named_in_the_caption)
{
    static const char *const lines[] = {"\"jump\"\n0 100 50 1 ", "\"ww-1m\"\n0 25 25 1 ",
                                        "\"comb\"\n0 0 0 1 ", "\"ww\"\n0 0 NaN 1 "};
    static const char *const failures[] = {
        " It fails on jump (100 % not exact, 1 of 2 contacts missed), ww-1m (25 % not exact, 1 "
        "of 4 contacts missed): the search is local"};
    put_ingredients("jump", WRONG);
    put_ingredients("comb", EXACT);
    put_ingredients("ww", APART);
    put_ingredients("ww-1m", TOUCH);
    put("comb", "particle", "{\"n\": 8, \"leap\": \"off\"}", 50, SILENT);
    mote_expect(0, "figures/ingredients.svg", "figures run");
    char *data = file_text("run/figures/ingredients.dat"), *caption = caption_of("ingredients");
    expect_in(data, lines, ROWS_OF(lines));
    expect_in(caption, failures, ROWS_OF(failures));
    /* What has no error has no line. */
    const char *comb = strstr(data, "\"comb\"\n");
    assert_null(strstr(comb, "\n1 "));
    free(data);
    free(caption);
}

TEST(ingredients_that_succeed_have_no_failures)
{
    put_ingredients("comb", EXACT);
    mote_expect(0, "figures/tracked-comb.svg", "figures run");
    char *caption = caption_of("ingredients");
    assert_null(strstr(caption, "It fails on"));
    free(caption);
    char *data = file_text("run/figures/tracked-comb.dat");
    static const char *const series[] = {"\"n\"\n", "\"launch\"\n", "\"track\"\n"};
    expect_in(data, series, ROWS_OF(series));
    free(data);
}

/* Errors over n: a frame without an answer has no part, and a share of missed contacts is one
   of the frames in contact. */
TEST(errors_over_n_leave_out_what_was_not_answered)
{
    put("s", "particle-paper", "{\"n\": 1}", 100, WRONG);
    put("s", "particle-paper", "{\"n\": 2}", 200, APART);
    put("s", "particle-paper", "{\"n\": 3}", 300, TOUCH);
    put("s", "particle-paper", "{\"n\": 4}", 300, SILENT);
    put("s", "fcl-aabb", "{}", 1000, EXACT);
    mote_expect(0, "figures/errors-s.svg", "figures run");
    char *data = file_text("run/figures/errors-s.dat");
    static const char *const lines[] = {
        "\n1 0.1", " 0.5 0.5 0.5\n2 0 0 0 0 0 0 0 0 0 nan nan nan\n3 0 0 0 ",
        " 0.25 0.25 0.25\n"};
    expect_in(data, lines, ROWS_OF(lines));
    assert_null(strstr(data, "\n4 "));
    free(data);
}

/* Its place would be at minus infinity. */
TEST(errors_over_n_leave_out_no_particles_and_say_so)
{
    put("s", "particle", "{\"n\": 0}", 100, EXACT);
    put("s", "particle", "{\"n\": 64}", 200, EXACT);
    put("s", "particle", "{\"n\": 128}", 300, EXACT);
    mote_expect(0, "figures/errors-s.svg", "figures run");
    char *data = file_text("run/figures/errors-s.dat"), *caption = caption_of("errors-s");
    static const char *const lines[] = {"\"particle\"\n64 0 ", "\n128 0 "};
    static const char *const note[] = {" Rows with n = 0 are left out"};
    expect_in(data, lines, ROWS_OF(lines));
    expect_in(caption, note, ROWS_OF(note));
    free(data);
    free(caption);
}

/* By name, all engines that are faster than ours are before them. */
TEST(shares_keep_the_fastest_and_ours_and_say_how_many_are_not_there)
{
    static const char *const shown[] = {"\n16 ",
                                        "\"certified\"",
                                        "\"particle:n=8\"",
                                        "\"particle-paper:n=5\"",
                                        "\"fcl-aabb:queue=3\"",
                                        "\"coal-aabb:queue=11\""};
    static const char *const note[] = {
        " Of these 24, the fastest are shown, and always certified, particle, particle-paper "
        "and the fastest of FCL; the other 8 are not."};
    char parameters[40];
    for (int k = 1; k <= 18; ++k) {
        (void)snprintf(parameters, sizeof parameters, "{\"queue\": %d}", k);
        put("s", "coal-aabb", parameters, 100 * k, EXACT);
    }
    put("s", "fcl-aabb", "{\"queue\": 3}", 6000, EXACT);
    put("s", "fcl-aabb", "{\"queue\": 5}", 7000, EXACT);
    put("s", "aabb-tree", "{}", 50, EXACT);
    put("s", "certified", "{}", 8000, EXACT);
    put("s", "particle", "{\"n\": 8}", 9000, EXACT);
    put("s", "particle-paper", "{\"n\": 5}", 9500, EXACT);
    mote_expect(0, "figures/shares-s.svg", "figures run");
    char *data = file_text("run/figures/shares-s.dat"), *caption = caption_of("shares-s");
    expect_in(data, shown, ROWS_OF(shown));
    assert_null(strstr(data, "\n17 "));
    assert_null(strstr(data, "fcl-aabb:queue=5"));
    expect_in(caption, note, ROWS_OF(note));
    free(data);
    free(caption);
}

/* A row of a summary without cells. */
static void add_row(const char *label, const char *scenario, int triangles, int stride,
                    const char *interval, mote_text *rows)
{
    const bool other = strcmp(scenario, "ww-10m") == 0;
    mote_text_add(rows,
                  "%s{\"label\": \"%s\", \"scenario\": \"%s\", \"status\": \"ok\", \"cache\": "
                  "\"hot\", \"machine\": \"m\", \"times_comparable\": true, \"stride\": %d, "
                  "\"frame_range\": [%d, %d], \"triangles\": [%d, %d], \"vertices\": [9, 9], "
                  "\"heap_live_bytes\": 5, \"total_ns\": {\"median\": %d%s}}",
                  rows->size ? ", " : "", label, scenario, stride, other ? 1 : 5,
                  other ? 30 : 204, triangles, triangles, triangles, interval);
}

/* The captions of figures 6 and 7 of a summary of these rows, which are freed; the caller frees
   both. */
static void size_captions(mote_text *rows, char **time, char **bytes)
{
    mote_summary summary;
    mote_figure figure = {0}, other = {0};
    char *json = mote_format("{\"rows\": [%s]}", rows->data);
    file_put("sizes/summary.json", json);
    free(json);
    free(rows->data);
    assert_int_equal(mote_summary_read("sizes", "summary.json", &summary), MOTE_OK);
    const mote_figure_run run = {"sizes", &summary, NULL};
    assert_int_equal(mote_figure_size_time(&run, NULL, &figure), MOTE_OK);
    assert_int_equal(mote_figure_size_bytes(&run, NULL, &other), MOTE_OK);
    free(figure.data.data);
    free(other.data.data);
    *time = figure.caption.data;
    *bytes = other.caption.data;
    mote_summary_free(&summary);
}

#define INTERVAL ", \"ci_low\": 1, \"ci_high\": 2"

TEST(times_over_sizes_say_which_frames_and_intervals_they_have)
{
    static const char *const note[] = {
        "included, with its 95 % interval where two or more processes ran. Frames, which each "
        "scenario numbers from its own start: 5-204 of ww-1k, ww, ww-1m; 1-30 of ww-10m. "
        "Every 16th of these only: fcl-aabb on ww-1m, ww-10m; aabb-tree on ww-10m. Exponents"};
    mote_text rows = {0};
    char *time, *bytes;
    const char *const labels[] = {"certified", "fcl-aabb", "aabb-tree"};
    for (int m = 0; m < 3; ++m) {
        add_row(labels[m], "ww-1k", 1000, 1, INTERVAL, &rows);
        add_row(labels[m], "ww", 11920, 1, INTERVAL, &rows);
        add_row(labels[m], "ww-1m", 1000000, m == 1 ? 16 : 1, INTERVAL, &rows);
        add_row(labels[m], "ww-10m", 10000000, m > 0 ? 16 : 1, "", &rows);
    }
    size_captions(&rows, &time, &bytes);
    expect_in(time, note, 1);
    free(time);
    free(bytes);
}

TEST(times_of_one_process_over_sizes_have_no_interval)
{
    static const char *const note[] = {"refitting included. Frames"};
    static const char *const sizes[] = {"ww-1k", "ww-2k", "ww-3k"};
    mote_text rows = {0};
    char *time, *bytes;
    for (int i = 0; i < 3; ++i)
        add_row("certified", sizes[i], 1000 * (i + 1), 1, "", &rows);
    size_captions(&rows, &time, &bytes);
    expect_in(time, note, 1);
    assert_null(strstr(time, "interval"));
    assert_null(strstr(time, "Every"));
    assert_null(strstr(time, "not shown"));
    free(time);
    free(bytes);
}

TEST(methods_over_sizes_beyond_the_eighth_are_counted)
{
    static const char *const notes[] = {" 1 more method of this run is not shown.",
                                        " 2 more methods of this run are not shown."};
    static const char *const sizes[] = {"ww-1k", "ww-2k", "ww-3k"};
    for (int more = 1; more <= 2; ++more) {
        mote_text rows = {0};
        char *time, *bytes;
        for (int m = 0; m < 8 + more; ++m) {
            char label[24];
            (void)snprintf(label, sizeof label, "certified:leaf=%d", m);
            for (int i = 0; i < 3; ++i)
                add_row(label, sizes[i], 1000 * (i + 1), 1, INTERVAL, &rows);
        }
        size_captions(&rows, &time, &bytes);
        expect_in(time, &notes[more - 1], 1);
        expect_in(bytes, &notes[more - 1], 1);
        free(time);
        free(bytes);
    }
}

/* The caption of figure 15 says of the bodies only what the rows do. */
TEST(several_bodies_are_named_by_their_rows)
{
    static const struct {
        const char *first, *second, *said;
    } rows[] = {
        {"\"triangles\": [1380, 11920], \"shapes\": 4",
         "\"triangles\": [11920, 11920], \"shapes\": 1",
         "4 near pairs a body: 1,380 to 11,920 triangles each, of 1 to 4 shapes. Points"},
        {"\"triangles\": [500, 500], \"shapes\": 1", "\"triangles\": [500, 500], \"shapes\": 1",
         "4 near pairs a body: 500 triangles each, of 1 shape. Points"},
        {"\"shapes\": 0", "\"shapes\": 0", "4 near pairs a body. Points"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        const mote_summary none = {0};
        mote_figure figure = {0};
        test_row("%s", rows[i].said);
        char *json =
            mote_format("{\"rows\": [{\"label\": \"certified\", \"status\": \"ok\", "
                        "\"near_pairs_wanted\": 1, "
                        "\"bodies\": 100, %s}, {\"label\": \"aabb-tree\", \"status\": \"ok\", "
                        "\"near_pairs_wanted\": 4, \"bodies\": 10, %s}, {\"label\": \"ode\", "
                        "\"status\": \"ok\", "
                        "\"near_pairs_wanted\": 4, \"bodies\": 10, \"triangles\": [2, 90000], "
                        "\"shapes\": 9}]}",
                        rows[i].first, rows[i].second);
        file_put("several/summary.json", json);
        const mote_figure_run run = {"several", &none, NULL};
        assert_int_equal(mote_figure_bodies(&run, NULL, &figure), MOTE_OK);
        expect_in(figure.caption.data, &rows[i].said, 1);
        free(json);
        free(figure.data.data);
        free(figure.caption.data);
    }
}

#define FILM                                                                                   \
    "{\"purpose\": \"letters that meet\", \"frames\": 11, \"ask\": \"distance\", "             \
    "\"tolerance\": 0.01, \"bodies\": {\"count\": 4, \"seed\": 3, \"box\": 4, \"near\": 0.2, " \
    "\"shapes\": [{\"letter\": \"T\", \"triangles\": 400}, {\"letter\": \"L\", "               \
    "\"triangles\": 400}]}}\n"

/* The pictures of the film in several/film, after its pairs have been replaced by these lines:
   a number and a hash for each; the caller frees them. */
static char *pictures_of(const char *lines)
{
    static const char rename[] = "cd several/film/cells && head -1 *.pairs.csv > kept && "
                                 "cat kept lines > $(ls *.pairs.csv) && rm kept lines";
    file_put("several/film/cells/lines", lines);
    assert_int_equal(system(rename), 0);
    mote_expect(0, "figures/letters.gif", "figures several");
    return file_text("several/figures/letters.dat");
}

/* Which of two texts' lines differ, as "01011". */
static void compare_lines(const char *a, const char *b, char *differ)
{
    for (; *a && *b; ++differ) {
        const size_t first = strcspn(a, "\n"), second = strcspn(b, "\n");
        *differ = first == second && strncmp(a, b, first) == 0 ? '0' : '1';
        a += first + (a[first] == '\n');
        b += second + (b[second] == '\n');
    }
    *differ = '\0';
}

/* A film shows every fifth frame, and bodies in contact in another colour. */
TEST(film_of_letters_marks_contacts)
{
    static const struct {
        const char *lines, *differ; /* from the film without contacts */
    } rows[] = {
        {"1,1,2,1,0,0,1,0,0,0,0,0,0,0,0,0,0\n", "100"},
        {"2,1,2,1,0,0,1,0,0,0,0,0,0,0,0,0,0\n6,1,4,1,0,0,1,0,0,0,0,0,0,0,0,0,0\n", "010"},
        {"6,1,4,1,0,0,0,0,0,0,0,0,0,0,0,0,0\n", "000"},  /* near, but no contact */
        {"11,3,9,1,0,0,1,0,0,0,0,0,0,0,0,0,0\n", "001"}, /* there is no body 9 */
        {"11,8,9,1,0,0,1,0,0,0,0,0,0,0,0,0,0\n", "000"},
    };
    file_put("several/film/letters.json", FILM);
    mote_expect(
        0, "letters",
        "run several/film/letters.json --method certified --replicates 1 --pairs contacts "
        "--out several/film");
    put("s", "fcl-aabb", "{}", 1000, EXACT);
    assert_int_equal(system("mv run/cells several/cells"), 0);
    char *none = pictures_of("");
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char differ[64];
        test_row("%s", rows[i].lines);
        char *pictures = pictures_of(rows[i].lines);
        compare_lines(none, pictures, differ);
        assert_string_equal(differ, rows[i].differ);
        free(pictures);
    }
    free(none);
    file_put("several/film/letters.json",
             "{\"purpose\": \"others\", \"like\": \"letters\", \"frames\": 11}\n");
    mote_expect(0, "other frames or faces than those measured", "figures several");
    file_put("several/film/letters.json", FILM);
    /* A second method: which film is it? */
    mote_expect(
        0, "letters",
        "run several/film/letters.json --method stream --replicates 1 --out several/film");
    mote_expect(0, "several/film: not the run of one film", "figures several");
}
