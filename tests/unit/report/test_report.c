/* The report of a run, and its building blocks. */
#include "harness/base/escape.h"
#include "harness/base/number_text.h"
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/page_data.h"
#include "tests/support/mote.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <math.h>
#include <stddef.h>

#include <sys/stat.h>

/* A name that ends a JavaScript string, a shell word, an attribute and an element. */
#define EVIL "'; system(\"x\")<script>"

/* The same for claims.json: text that would end the element in which it is embedded, begin a
   comment, and contain line ends of JavaScript that JSON does not have. */
#define EVIL_CLAIM "</script><!--<script>\xe2\x80\xa8\xc3\xbc \xf0\x9f\x99\x82 'x\""
#define EVIL_CLAIM_JSON "</script><!--<script>\xe2\x80\xa8\xc3\xbc \xf0\x9f\x99\x82 'x\\\""

static char page[1 << 23];

/* Reads a file into page. */
static void read_page(const char *path)
{
    program_read(path, page, sizeof page);
}

/* A run of five frames of a scenario named EVIL, with a figure and claims. */
static int make_run(void)
{
    static const char scenario[] =
        "{\"purpose\": \"p\", \"like\": \"mv\", \"frames\": 5, \"pace\": 149.75,\n"
        " \"warmup\": null, \"active\": null}\n";
    file_put(EVIL ".json", scenario);
    /* The shell must pass the name unchanged. */
    if (mote("run \"'; system(\\\"x\\\")<script>.json\" --method particle-paper:n=2 --method "
             "certified --out run --frames 1-5") != 0 ||
        mote("figures run") != 0) {
        (void)fprintf(stderr, "%s", said);
        return -1;
    }
    file_put("run/claims.json",
             "[{\"id\": \"<a>\", \"section\": \"5\", \"claim\": \""
             "x < y | z"
             "\", \"measured\": \"" EVIL_CLAIM_JSON
             "\", \"verdict\": \"holds\", \"value\": 0.25,\n"
             "  \"interval\": [0.2, 0.3], \"unit\": \"L\", \"threshold\": null,\n"
             "  \"values\": [{\"name\": \"v\", \"value\": 0.25, \"interval\": null,"
             " \"unit\": \"L\", \"threshold\": null}]}]\n");
    return mote("report run");
}

TEST_GROUP(make_run, NULL);

TEST(report_prints_its_paths)
{
    mote_expect(0, "", "report run");
    assert_string_equal(said, "run/report.md\nrun/report.html\n");
}

/* The data of the run's page; the caller decrefs them. */
static json_t *read_data(void)
{
    read_page("run/report.html");
    json_t *data = page_data(page, "report-data");
    assert_non_null(data);
    return data;
}

static const char *text_of(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

/* The names arrive unchanged and end no element: the only scripts are the page's own. */
TEST(report_html_of_hostile_texts_holds_them_as_data)
{
    json_t *data = read_data();
    const json_t *row = json_array_get(json_object_get(data, "rows"), 0);
    const json_t *claim = json_array_get(json_object_get(data, "claims"), 0);
    assert_string_equal(text_of(row, "scenario"), EVIL);
    assert_string_equal(text_of(claim, "measured"), EVIL_CLAIM);
    assert_int_equal(test_count(page, "<script type="),
                     test_count(page, "<script type=\"application/json\""));
    assert_int_equal(test_count(page, "<script"), test_count(page, "</script>"));
    assert_null(strstr(page, "<!--"));
    assert_null(strstr(page, ")<script>"));
    json_decref(data);
}

TEST(report_html_of_a_hostile_folder_is_escaped)
{
    file_put("<script>&\"'/claims.json", "[]\n");
    mote_expect(0, "", "report \"<script>&\\\"'\"");
    read_page("<script>&\"'/report.html");
    assert_int_equal(test_count(page, "&lt;script&gt;&amp;&quot;&#39;"), 2); /* title and h1 */
}

TEST(report_markdown_of_hostile_name_is_escaped)
{
    read_page("run/report.md");
    assert_non_null(strstr(page, "'; system(\"x\")&lt;script&gt;"));
    assert_null(strstr(page, "<script"));
    assert_non_null(strstr(page, "x &lt; y \\| z"));
}

/* Every cell and figure to which the page links exists. */
TEST(report_html_names_files_that_are_there)
{
    size_t i, k;
    const json_t *row, *cell, *figure;
    json_t *data = read_data();
    char path[512];
    size_t files = 0;
    struct stat info;
    MOTE_EACH(i, row, json_object_get(data, "rows"))
    {
        MOTE_EACH(k, cell, json_object_get(row, "cells"))
        {
            (void)snprintf(path, sizeof path, "run/cells/%s.csv",
                           json_string_value(json_array_get(cell, 1)));
            assert_int_equal(stat(path, &info), 0);
            ++files;
        }
    }
    MOTE_EACH(i, figure, json_object_get(data, "figures"))
    {
        (void)snprintf(path, sizeof path, "run/%s", text_of(figure, "file"));
        assert_int_equal(stat(path, &info), 0);
        ++files;
    }
    assert_true(files >= 4);
    json_decref(data);
}

/* The page has the median of the summary's CSV. */
TEST(report_html_has_the_numbers_of_the_summary)
{
    mote_expect(0, "", "summarize run --format csv");
    const char *csv = strstr(said, "\"particle-paper:n=2\"");
    assert_non_null(csv);
    for (int comma = 0; comma < 6; ++comma)
        csv = strchr(csv, ',') + 1;
    size_t i, found = 0;
    const json_t *row;
    json_t *data = read_data();
    MOTE_EACH(i, row, json_object_get(data, "rows"))
    {
        if (strcmp(text_of(row, "label"), "particle-paper:n=2") != 0)
            continue;
        const double median =
            json_number_value(json_object_get(json_object_get(row, "total_ns"), "median"));
        assert_true(fabs(median / strtod(csv, NULL) - 1) < 1e-6);
        ++found;
    }
    assert_int_equal(found, 1);
    json_decref(data);
}

/* The drawing in the page is that of the file. */
TEST(report_html_has_the_drawings_of_the_figures)
{
    json_t *data = read_data();
    const json_t *figure = json_array_get(json_object_get(data, "figures"), 0);
    char *drawing = page_unpack(figure, "drawing");
    char path[256];
    (void)snprintf(path, sizeof path, "run/%s", text_of(figure, "file"));
    read_page(path);
    assert_true(strlen(drawing) > 1000);
    assert_string_equal(drawing, page);
    free(drawing);
    json_decref(data);
}

/* Rows of a table are sorted by time, whatever the summary's order. */
TEST(report_rows_are_sorted_by_time)
{
    size_t i;
    const json_t *block, *columns;
    json_t *data = read_data();
    columns = json_object_get(data, "columns");
    assert_string_equal(text_of(json_array_get(columns, 0), "group"), "total");
    MOTE_EACH(i, block, json_object_get(data, "blocks"))
    {
        double before = 0;
        for (json_int_t k = json_integer_value(json_object_get(block, "first"));
             k < json_integer_value(json_object_get(block, "end")); ++k) {
            const json_t *row = json_array_get(json_object_get(data, "rows"), (size_t)k);
            const double time =
                json_number_value(json_object_get(json_object_get(row, "total_ns"), "median"));
            assert_true(time >= before);
            before = time;
        }
    }
    assert_true(i > 0);
    json_decref(data);
}

/* Figures of other commands are one text, not a list. */
TEST(report_names_other_commands_in_one_line)
{
    json_t *data = read_data();
    const json_t *missing = json_object_get(data, "missing");
    size_t i, named = 0;
    const json_t *text;
    MOTE_EACH(i, text, missing)
    {
        const char *line = json_string_value(text);
        if (strstr(line, "figures that other commands measure: ") &&
            strstr(line, "`make sweep`"))
            ++named;
        assert_null(strstr(line, "is not drawn"));
    }
    assert_int_equal(named, 1);
    json_decref(data);
    read_page("run/report.md");
    assert_true(strstr(page, "\nNot in this report: ") > strstr(page, "\n## Known defects"));
    assert_int_equal(test_count(page, "make sweep"), 1);
}

TEST(report_html_loads_nothing)
{
    read_page("run/report.html");
    assert_null(strstr(page, "src=\"http"));
    assert_null(strstr(page, "@import"));
    assert_non_null(strstr(page, "default-src 'none'"));
    assert_non_null(strstr(page, "<noscript>"));
}

TEST(report_of_what_is_missing_names_it)
{
    file_put("partial/claims.json", "[]\n");
    mote_expect(0, "", "report partial");
    read_page("partial/report.html");
    static const char *const missing[] = {
        "manifest.json: not there", "cells: ", "summary.json: not there",
        "requirements.json: not there", "figures: no list of them"};
    for (size_t i = 0; i < sizeof missing / sizeof missing[0]; ++i)
        assert_non_null(strstr(page, missing[i]));
}

/* Reports a folder with an additional file and reads the page of that name. */
static void report_with(const char *folder, const char *name, const char *content,
                        const char *page_name)
{
    char path[256];
    (void)snprintf(path, sizeof path, "%s/claims.json", folder);
    file_put(path, "[]\n");
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    file_put(path, content);
    mote_expect(0, "", "report %s", folder);
    (void)snprintf(path, sizeof path, "%s/%s", folder, page_name);
    read_page(path);
}

TEST(report_markdown_has_the_known_defects_one_level_lower)
{
    read_page("run/report.md");
    assert_non_null(strstr(page, "\n### 1. FCL: the sum of two rectangle swept spheres"));
    assert_null(strstr(page, "\n# Known"));
}

TEST(report_markdown_of_a_hostile_manifest_is_escaped)
{
    report_with(
        "manifest", "manifest.json",
        "{\"sessions\": [{\"started\": \"<script>\\n# x](y)\", \"command\": [\"<b>\"]}],"
        " \"processor\": \"<i>\", \"commit\": \"<u>\"}\n",
        "report.md");
    assert_non_null(strstr(page, "1. mote '&lt;b&gt;' (&lt;script&gt; \\# x\\](y))\n"));
}

/* A bound that was not finite is null in the file, and not 0 on the page. */
TEST(report_of_an_interval_without_its_ends_shows_none)
{
    static const char *const intervals[] = {"[null, null]", "[1, null]", "[\"1\", 2]", "[1]"};
    for (size_t i = 0; i < 5; ++i) {
        char claims[256];
        (void)snprintf(claims, sizeof claims,
                       "[{\"id\": \"a\", \"value\": 7, \"interval\": %s, \"values\": []}]\n",
                       i < 4 ? intervals[i] : "[1, 9]");
        report_with("interval", "claims.json", claims, "report.md");
        assert_non_null(strstr(page, "Measured: [7]"));
        assert_true((strstr(page, "(1 to 9)") != NULL) == (i == 4));
        assert_true((strstr(page, "claims.json) (") != NULL) == (i == 4));
    }
}

TEST(report_of_a_broken_cell_names_it)
{
    file_put("broken/cells/a.json", "{\"id\": \n");
    file_put("broken/cells/b\n\nc.json", "{\"id\": \n");
    file_put("broken/claims.json", "[]\n");
    mote_expect(0, "", "report broken");
    read_page("broken/report.md");
    assert_non_null(strstr(page, "cells/a.json:"));
    assert_non_null(strstr(page, "broken/cells/b\n- a cell: c.json:"));
}

TEST(report_of_a_run_with_a_broken_cell_shows_the_others)
{
    file_put("run/cells/zz.json", "{\"id\": \n");
    mote_expect(0, "", "report run");
    read_page("run/report.html");
    assert_int_equal(unlink("run/cells/zz.json"), 0);
    assert_non_null(strstr(page, "zz.json:"));
    assert_non_null(strstr(page, "\"label\":\"particle-paper:n=2\""));
}

TEST(report_of_nothing_fails_with_4)
{
    assert_int_equal(mkdir("empty", 0777), 0);
    mote_expect(4, "nothing to report", "report empty");
    mote_expect(4, "", "report /nowhere/at/all");
    mote_expect(4, "", "report run/claims.json");
    mote_expect(2, "", "report");
}

TEST(escape_path_leaves_no_scheme_and_no_quote)
{
    mote_text text = {0};
    mote_escape_path(&text, "javascript:a'\"<\xc3\xa9 b/c-d_e.csv");
    assert_string_equal(text.data, "javascript%3Aa%27%22%3C%C3%A9%20b/c-d_e.csv");
    free(text.data);
}

TEST(escape_html_keeps_lines_and_drops_controls)
{
    mote_text text = {0};
    mote_escape_html(&text, "a\n\t\x01<b> & 'c' \"d\"\x7f");
    assert_string_equal(text.data, "a\n\t &lt;b&gt; &amp; &#39;c&#39; &quot;d&quot; ");
    free(text.data);
}

TEST(escape_script_cannot_end_the_element)
{
    mote_text text = {0};
    mote_escape_script(&text, "{\"a\": \"</script><!--\"}");
    assert_string_equal(text.data, "{\"a\": \"\\u003c/script>\\u003c!--\"}");
    free(text.data);
}

/* The test vectors of RFC 4648, and a text longer than a line of the writer. */
TEST(base64_of_the_standards_vectors_is_theirs)
{
    static const char *const pairs[][2] = {{"f", "Zg=="},         {"fo", "Zm8="},
                                           {"foo", "Zm9v"},       {"foob", "Zm9vYg=="},
                                           {"fooba", "Zm9vYmE="}, {"foobar", "Zm9vYmFy"}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i) {
        mote_text text = {0};
        mote_base64(&text, pairs[i][0], strlen(pairs[i][0]));
        assert_string_equal(text.data, pairs[i][1]);
        free(text.data);
    }
    unsigned char zeros[3000] = {0};
    mote_text text = {0};
    mote_base64(&text, zeros, sizeof zeros);
    assert_int_equal(text.size, 4000);
    assert_int_equal(strspn(text.data, "A"), 4000);
    free(text.data);
}

TEST(show_whole_separates_thousands)
{
    char shown[MOTE_NUMBER_TEXT];
    assert_string_equal(mote_show_whole(0, shown), "0");
    assert_string_equal(mote_show_whole(999, shown), "999");
    assert_string_equal(mote_show_whole(11920, shown), "11,920");
    assert_string_equal(mote_show_whole(1e7, shown), "10,000,000");
    assert_string_equal(mote_show_whole(1e300, shown), "1e+300");
}
