/* mote site: several runs on one page, and the runs that it refuses. */
#define _DEFAULT_SOURCE /* realpath */
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/page_data.h"
#include "tests/support/test.h"

#include <unistd.h>

/* Ends a JavaScript string, a shell word, an attribute, an element and a CSV field. */
#define EVIL "a \"b\", <script>'c'"

/* A summary of one row: what a run's needs at least. */
#define ROW(scenario, method, machine, time, ask)                                              \
    "{\"scenario\": " scenario ", \"method\": \"" method "\", \"label\": \"" method            \
    ":n=1,k=2\", \"machine\": \"" machine "\", \"fingerprint\": \"0123456789abcdef\", "        \
    "\"ask\": \"" ask "\", \"cache\": \"hot\", \"status\": \"ok\", \"times_comparable\": "     \
    "true, \"stands_for_method\": true, \"total_ns\": {\"median\": " time                      \
    "}, \"parameters\": {\"n\": 1}}"
#define SUMMARY(rows) "{\"schema\": 1, \"rows\": [" rows "]}\n"

static void make_run(const char *folder, const char *summary, const char *manifest)
{
    char path[1100];
    assert_int_equal(mote_directory_make(folder), MOTE_OK);
    (void)snprintf(path, sizeof path, "%s/summary.json", folder);
    file_put(path, summary);
    (void)snprintf(path, sizeof path, "%s/manifest.json", folder);
    if (manifest)
        file_put(path, manifest);
}

static json_t *site_data(const char *path)
{
    char *page = file_text(path);
    json_t *data = page_data(page, "site-data");
    assert_non_null(data);
    free(page);
    return data;
}

static const char *text_in(const json_t *array, size_t i, const char *key)
{
    const char *text = json_string_value(json_object_get(json_array_get(array, i), key));
    return text ? text : "";
}

TEST_EACH(folder_next, NULL);

TEST(rows_of_one_machine_and_question_are_one_block_and_others_are_not)
{
    make_run(
        "one", SUMMARY(ROW("\"ww\"", "fast", "m1", "10", "distance")),
        "{\"sessions\": [{\"started\": \"2026-01-02T03:04:05Z\"}], \"commit\": \"c0ffee\"}");
    make_run("two",
             SUMMARY(ROW("\"ww\"", "slow", "m1", "30", "distance") ", " ROW(
                 "\"ww\"", "touch", "m1", "3", "contact") ", " ROW("\"ww\"", "far", "m2", "1",
                                                                   "distance")),
             NULL);
    mote_expect(0, "site/index.html\nsite/results.csv\n", "site two one -o site");
    json_t *data = site_data("site/index.html");
    const json_t *blocks = json_object_get(data, "blocks"),
                 *rows = json_object_get(data, "rows");
    assert_int_equal(json_array_size(blocks), 3);
    assert_string_equal(text_in(blocks, 0, "ask"), "contact");
    assert_string_equal(text_in(blocks, 1, "machine"), "m1");
    assert_string_equal(text_in(blocks, 2, "machine"), "m2");
    /* The two of one block come from two runs, the faster first. */
    assert_string_equal(text_in(rows, 1, "method"), "fast");
    assert_string_equal(text_in(rows, 2, "method"), "slow");
    const json_t *runs = json_object_get(data, "runs");
    const json_t *origin = json_object_get(json_array_get(rows, 1), "run");
    assert_string_equal(text_in(runs, (size_t)json_integer_value(origin), "name"), "one");
    assert_string_equal(text_in(runs, 1, "started"), "2026-01-02T03:04:05Z");
    assert_string_equal(text_in(runs, 1, "folder"), "./../one");
    assert_string_equal(text_in(runs, 0, "started"), "");
    json_decref(data);
}

TEST(the_csv_has_each_row_with_its_run)
{
    make_run(
        "one", SUMMARY(ROW("\"ww\"", "fast", "m1", "10", "distance")),
        "{\"sessions\": [{\"started\": \"2026-01-02T03:04:05Z\"}], \"commit\": \"c0ffee\"}");
    mote_expect(0, "", "site one -o site");
    char *csv = file_text("site/results.csv");
    char *second = strchr(csv, '\n') + 1;
    assert_non_null(strstr(csv, ",run,started,commit\n"));
    assert_non_null(strstr(second, ",\"one\",2026-01-02T03:04:05Z,c0ffee\n"));
    assert_ptr_equal(strchr(second, '\n') + 1, csv + strlen(csv));
    free(csv);
}

TEST(names_with_quotes_commas_and_elements_stay_text)
{
    make_run(EVIL,
             SUMMARY(ROW("\"a \\\"b\\\", <script>'c'\"", "</script><!--", "m, \\\"1\\\"", "1",
                         "distance")),
             "{\"commit\": \"</script>\"}");
    assert_int_equal(symlink(EVIL, "plain"), 0); /* the shell is not the subject */
    mote_expect(0, "", "site plain -o site");
    char *page = file_text("site/index.html"), *csv = file_text("site/results.csv");
    json_t *data = site_data("site/index.html");
    assert_string_equal(text_in(json_object_get(data, "rows"), 0, "scenario"), EVIL);
    assert_string_equal(text_in(json_object_get(data, "runs"), 0, "name"), EVIL);
    assert_null(strstr(page, "</script><!--"));
    assert_non_null(strstr(csv, "\"a \"\"b\"\", <script>'c'\""));
    json_decref(data);
    free(page);
    free(csv);
}

TEST(a_run_named_twice_is_shown_once)
{
    make_run("one", SUMMARY(ROW("\"ww\"", "fast", "m1", "10", "distance")), NULL);
    make_run("copies/one", SUMMARY(ROW("\"ww\"", "fast", "m1", "10", "distance")), NULL);
    assert_int_equal(symlink("one", "link"), 0);
    mote_expect(0, "the same run as one; it is shown once",
                "site one ./one/ link copies/one -o site");
    json_t *data = site_data("site/index.html");
    assert_int_equal(json_array_size(json_object_get(data, "rows")), 1);
    assert_int_equal(json_array_size(json_object_get(data, "left_out")), 3);
    json_decref(data);
}

TEST(runs_with_the_same_last_name_are_told_apart)
{
    make_run("x/run", SUMMARY(ROW("\"ww\"", "fast", "m1", "10", "distance")), NULL);
    make_run("y/run", SUMMARY(ROW("\"ww\"", "fast", "m1", "11", "distance")), NULL);
    mote_expect(0, "", "site x/run y/run -o site/deep");
    json_t *data = site_data("site/deep/index.html");
    const json_t *runs = json_object_get(data, "runs");
    assert_string_equal(text_in(runs, 0, "name"), "x/run");
    assert_string_equal(text_in(runs, 1, "name"), "y/run");
    assert_string_equal(text_in(runs, 0, "folder"), "./../../x/run");
    json_decref(data);
}

/* The run that the page is in, beside, above or below, and one whose name begins like it. */
TEST(links_lead_from_the_page_to_the_run)
{
    static const struct {
        const char *run, *site, *link;
    } rows[] = {
        {"one", "site", "./../one"},        {"one", "one", "."},
        {"one", "one/site", "./.."},        {"a/b", "a", "./b"},
        {"one", "one2", "./../one"},        {"one2", "one", "./../one2"},
        {"a/b", "c/d/e", "./../../../a/b"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        char page[64];
        test_row("%s from %s", rows[i].run, rows[i].site);
        make_run(rows[i].run, SUMMARY(ROW("\"ww\"", "fast", "m1", "10", "distance")), NULL);
        mote_expect(0, "", "site %s -o %s", rows[i].run, rows[i].site);
        (void)snprintf(page, sizeof page, "%s/index.html", rows[i].site);
        json_t *data = site_data(page);
        assert_string_equal(text_in(json_object_get(data, "runs"), 0, "folder"), rows[i].link);
        json_decref(data);
    }
}

/* A path that ends with all of another one, from the root on, and two more of the same name. */
TEST(runs_are_named_by_as_many_parts_as_tell_them_apart)
{
    static const char *const others[] = {"x/run", "y/run", "z/run"};
    char here[1024];
    char *folder = realpath(".", NULL);
    (void)snprintf(here, sizeof here, "deep%s/x/run", folder);
    free(folder);
    make_run(here, SUMMARY(ROW("\"ww\"", "fast", "m1", "9", "distance")), NULL);
    for (size_t i = 0; i < 3; ++i) {
        char summary[512];
        (void)snprintf(summary, sizeof summary,
                       SUMMARY(ROW("\"ww\"", "fast", "m1", "1%zu", "distance")), i);
        make_run(others[i], summary, NULL);
    }
    mote_expect(0, "", "site x/run %s y/run z/run -o site", here);
    json_t *data = site_data("site/index.html");
    const json_t *runs = json_object_get(data, "runs");
    assert_int_equal(json_array_size(runs), 4);
    for (size_t i = 0; i < 4; ++i) {
        for (size_t k = 0; k < i; ++k)
            assert_string_not_equal(text_in(runs, i, "name"), text_in(runs, k, "name"));
    }
    json_decref(data);
}

TEST(a_run_without_rows_makes_a_page_without_rows)
{
    make_run("empty", SUMMARY(""), NULL);
    mote_expect(0, "", "site empty -o site");
    char *page = file_text("site/index.html"), *csv = file_text("site/results.csv");
    assert_non_null(strstr(page, "<p>1 run, 0 rows</p>"));
    assert_ptr_equal(strchr(csv, '\n') + 1, csv + strlen(csv));
    free(page);
    free(csv);
}

TEST(what_is_no_run_is_refused_and_nothing_is_written)
{
    static const struct {
        const char *name, *summary, *says;
    } wrong[] = {
        {"schema", "{\"schema\": 2, \"rows\": []}", "its schema is not 1"},
        {"none", "{\"rows\": []}", "its schema is not 1"},
        {"word", "{\"schema\": \"1\", \"rows\": []}", "its schema is not 1"},
        {"method", SUMMARY("{\"scenario\": \"ww\", \"label\": \"m\"}"), "row 1 has no"},
        {"rowless", "{\"schema\": 1}", "no rows"},
        {"cut", "{\"schema\": 1, \"rows\": [", "summary.json:1:"},
        {"number", "{\"schema\": 1, \"rows\": [7]}", "row 1 has no scenario"},
        {"nameless", SUMMARY("{\"scenario\": \"ww\", \"method\": \"m\"}"), "row 1 has no"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        test_row("%s", wrong[i].name);
        make_run(wrong[i].name, wrong[i].summary, NULL);
        mote_expect(4, wrong[i].says, "site %s -o site", wrong[i].name);
    }
    assert_int_equal(mote_directory_make("empty"), MOTE_OK);
    file_put("file", "x");
    mote_expect(4, "empty: no summary.json there; name the directories of runs",
                "site empty -o site");
    mote_expect(4, "gone: No such file or directory", "site gone -o site");
    mote_expect(4, "file: not a directory", "site file -o site");
    make_run("damaged", SUMMARY(ROW("\"ww\"", "fast", "m1", "10", "distance")), "{");
    mote_expect(4, "damaged/manifest.json:1:", "site damaged -o site");
    make_run("one", SUMMARY(ROW("\"ww\"", "fast", "m1", "12", "distance")), NULL);
    mote_expect(2, "something is missing", "site one");
    mote_expect(2, "something is missing", "site -o site");
    mote_expect(4, "", "site one -o file/site");
    assert_false(file_exists("site"));
}

TEST(a_hundred_runs_and_one_without_rows)
{
    char line[4096] = "site empty";
    make_run("empty", SUMMARY(""), NULL);
    for (int i = 0; i < 100; ++i) {
        char folder[32], summary[1024];
        (void)snprintf(folder, sizeof folder, "run-%d", i);
        (void)snprintf(summary, sizeof summary,
                       SUMMARY(ROW("\"s%d\"", "fast", "m%d", "%d", "distance")), i % 7, i % 3,
                       i + 1);
        make_run(folder, summary, NULL);
        (void)snprintf(line + strlen(line), sizeof line - strlen(line), " %s", folder);
    }
    mote_expect(0, "", "%s -o site", line);
    json_t *data = site_data("site/index.html");
    assert_int_equal(json_array_size(json_object_get(data, "runs")), 101);
    assert_int_equal(json_array_size(json_object_get(data, "rows")), 100);
    assert_int_equal(json_array_size(json_object_get(data, "blocks")), 21);
    json_decref(data);
}
