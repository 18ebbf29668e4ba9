/* The report of a run, and what it is written with. */
#include "harness/base/escape.h"
#include "harness/report/markdown_html.h"
#include "harness/base/number_text.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <sys/stat.h>

/* A name that ends a JavaScript string, a shell word, an attribute and an element. */
#define EVIL "'; system(\"x\")<script>"
#define EVIL_HTML "&#39;; system(&quot;x&quot;)&lt;script&gt;"

static char base[] = "/tmp/mote-test-report-XXXXXX";
static char run_directory[96], page[1 << 23], said[1 << 14];

/* Runs the program with these arguments, which may hold blanks; its exit status. */
static int program(const char *const arguments[])
{
    char output[96];
    (void)snprintf(output, sizeof output, "%s/said", base);
    pid_t pid = fork();
    if (pid == 0) {
        const char *argv[16] = {MOTE_PROGRAM};
        for (int i = 0; arguments[i] && i < 14; ++i)
            argv[i + 1] = arguments[i];
        int out = open(output, O_WRONLY | O_CREAT | O_TRUNC, 0644);
        if (out >= 0 && dup2(out, STDOUT_FILENO) >= 0 && dup2(out, STDERR_FILENO) >= 0)
            (void)execv(argv[0], (char *const *)(uintptr_t)argv);
        _exit(127);
    }
    int status = program_wait(pid);
    program_read(output, said, sizeof said);
    return status;
}

static int report(const char *directory)
{
    const char *const arguments[] = {"report", directory, NULL};
    return program(arguments);
}

/* Reads a file of the run into page. */
static void read_page(const char *name)
{
    char path[160];
    (void)snprintf(path, sizeof path, "%s/%s", run_directory, name);
    program_read(path, page, sizeof page);
}

static void write_file(const char *directory, const char *name, const char *content)
{
    char path[512];
    (void)snprintf(path, sizeof path, "%s/%s", directory, name);
    assert_int_equal(mote_file_write(path, content, strlen(content)), MOTE_OK);
}

/* A run of five frames of a scenario with that name, a figure, claims. */
static int make_run(void)
{
    static const char scenario[] =
        "{\"purpose\": \"p\", \"like\": \"mv\", \"frames\": 5, \"pace\": 149.75,\n"
        " \"warmup\": null, \"active\": null}\n";
    char path[160];
    if (!mkdtemp(base))
        return -1;
    (void)snprintf(run_directory, sizeof run_directory, "%s/run", base);
    (void)snprintf(path, sizeof path, "%s/" EVIL ".json", base);
    write_file(base, EVIL ".json", scenario);
    const char *const run[] = {"run",      path,        "--method", "particle-paper:n=2",
                               "--method", "certified", "--out",    run_directory,
                               "--frames", "1-5",       NULL};
    const char *const figures[] = {"figures", run_directory, NULL};
    if (program(run) != 0 || program(figures) != 0) {
        (void)fprintf(stderr, "%s", said);
        return -1;
    }
    write_file(run_directory, "claims.json",
               "[{\"id\": \"<a>\", \"section\": \"5\", \"claim\": \""
               "x < y | z"
               "\", \"measured\": \"how\", \"verdict\": \"holds\", \"value\": 0.25,\n"
               "  \"interval\": [0.2, 0.3], \"unit\": \"L\", \"threshold\": null,\n"
               "  \"values\": [{\"name\": \"v\", \"value\": 0.25, \"interval\": null,"
               " \"unit\": \"L\", \"threshold\": null}]}]\n");
    return report(run_directory);
}

static int remove_base(void)
{
    return program_remove(base);
}

TEST_GROUP(make_run, remove_base);

TEST(report_prints_its_paths)
{
    char expected[256];
    assert_int_equal(report(run_directory), 0);
    (void)snprintf(expected, sizeof expected, "%s/report.md\n%s/report.html\n", run_directory,
                   run_directory);
    assert_string_equal(said, expected);
}

TEST(report_html_of_hostile_name_is_escaped)
{
    read_page("report.html");
    assert_non_null(strstr(page, EVIL_HTML));
    assert_null(strstr(page, EVIL));
    assert_null(strstr(page, ")<script>"));
}

TEST(report_markdown_of_hostile_name_is_escaped)
{
    read_page("report.md");
    assert_non_null(strstr(page, "'; system(\"x\")&lt;script&gt;"));
    assert_null(strstr(page, "<script"));
    assert_non_null(strstr(page, "x &lt; y \\| z"));
}

/* Every link of the page to a file of the run names a file that is there. */
TEST(report_html_links_lead_somewhere)
{
    int files = 0, anchors = 0;
    read_page("report.html");
    for (const char *at = page; (at = strstr(at, "href=\"")) != NULL;) {
        char target[256], path[512], *percent;
        at += 6;
        size_t length = strcspn(at, "\"");
        assert_true(length < sizeof target);
        (void)snprintf(target, sizeof target, "%.*s", (int)length, at);
        if (strncmp(target, "data:", 5) == 0)
            continue;
        if (target[0] == '#') {
            (void)snprintf(path, sizeof path, "id=\"%s\"", target + 1);
            assert_non_null(strstr(page, path));
            ++anchors;
            continue;
        }
        while ((percent = strchr(target, '%')) != NULL) {
            char digits[3] = {percent[1], percent[2], '\0'};
            *percent = (char)strtol(digits, NULL, 16);
            memmove(percent + 1, percent + 3, strlen(percent + 3) + 1);
        }
        (void)snprintf(path, sizeof path, "%s/%s", run_directory, target);
        struct stat info;
        if (stat(path, &info) != 0)
            fail_msg("%s is linked and not there", path);
        ++files;
    }
    assert_true(anchors > 20);
    assert_true(files >= 4);
}

/* The median of the page is the one that the CSV of the summary gives. */
TEST(report_html_shows_the_numbers_of_the_summary)
{
    const char *const summarize[] = {"summarize", run_directory, "--format", "csv", NULL};
    assert_int_equal(program(summarize), 0);
    const char *row = strstr(said, "\"particle-paper:n=2\"");
    assert_non_null(row);
    for (int comma = 0; comma < 6; ++comma)
        row = strchr(row, ',') + 1;
    char shown[MOTE_NUMBER_TEXT], expected[64];
    const char *number = mote_show_time(strtod(row, NULL), shown);
    const char *blank = strchr(number, ' ');
    assert_non_null(blank);
    (void)snprintf(expected, sizeof expected, ">%.*s\u202f%s</a>", (int)(blank - number),
                   number, strcmp(blank, " us") == 0 ? "µs" : blank + 1);
    read_page("report.html");
    assert_non_null(strstr(page, expected));
}

TEST(report_html_loads_nothing)
{
    read_page("report.html");
    assert_null(strstr(page, "src=\"http"));
    assert_null(strstr(page, "@import"));
    assert_non_null(strstr(page, "default-src 'none'"));
    assert_non_null(strstr(page, "src=\"data:image/svg+xml;charset=utf-8,%3C?xml"));
    assert_non_null(strstr(page, "<h3>1. FCL: the sum of two rectangle swept spheres"));
}

TEST(report_of_what_is_missing_names_it)
{
    char partial[96], saved[96];
    (void)snprintf(saved, sizeof saved, "%s", run_directory);
    (void)snprintf(partial, sizeof partial, "%s/partial", base);
    assert_int_equal(mkdir(partial, 0777), 0);
    write_file(partial, "claims.json", "[]\n");
    assert_int_equal(report(partial), 0);
    (void)snprintf(run_directory, sizeof run_directory, "%s", partial);
    read_page("report.html");
    (void)snprintf(run_directory, sizeof run_directory, "%s", saved);
    static const char *const missing[] = {
        "manifest.json: not there", "cells: ", "summary.json: not there",
        "requirements.json: not there", "figures: no list of them"};
    for (size_t i = 0; i < sizeof missing / sizeof missing[0]; ++i)
        assert_non_null(strstr(page, missing[i]));
}

/* Reports a folder of base with one file more, and reads the page of that name. */
static void report_with(const char *folder, const char *name, const char *content,
                        const char *page_name)
{
    char path[256];
    (void)snprintf(path, sizeof path, "%s/%s", base, folder);
    (void)mkdir(path, 0777);
    write_file(path, "claims.json", "[]\n");
    write_file(path, name, content);
    assert_int_equal(report(path), 0);
    (void)snprintf(path, sizeof path, "%s/%s/%s", base, folder, page_name);
    program_read(path, page, sizeof page);
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

/* An end that was not finite is null in the file, and not 0 on the page. */
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
        report_with("interval", "claims.json", claims, "report.html");
        assert_true((strstr(page, "7 <small>") != NULL) == (i == 4));
    }
}

TEST(report_of_a_broken_cell_names_it)
{
    char broken[96], cells[128], path[256];
    (void)snprintf(broken, sizeof broken, "%s/broken", base);
    (void)snprintf(cells, sizeof cells, "%s/cells", broken);
    assert_int_equal(mkdir(broken, 0777), 0);
    assert_int_equal(mkdir(cells, 0777), 0);
    write_file(cells, "a.json", "{\"id\": \n");
    write_file(cells, "b\n\nc.json", "{\"id\": \n");
    write_file(broken, "claims.json", "[]\n");
    assert_int_equal(report(broken), 0);
    (void)snprintf(path, sizeof path, "%s/report.md", broken);
    program_read(path, page, sizeof page);
    assert_non_null(strstr(page, "cells/a.json:"));
    assert_non_null(strstr(page, "broken/cells/b\n- a cell: c.json:"));
}

TEST(report_of_a_run_with_a_broken_cell_shows_the_others)
{
    char cells[128], path[256];
    (void)snprintf(cells, sizeof cells, "%s/cells", run_directory);
    (void)snprintf(path, sizeof path, "%s/zz.json", cells);
    write_file(cells, "zz.json", "{\"id\": \n");
    int status = report(run_directory);
    read_page("report.html");
    (void)unlink(path);
    assert_int_equal(status, 0);
    assert_non_null(strstr(page, "zz.json:"));
    assert_non_null(strstr(page, "particle-paper:n=2</a>"));
}

TEST(report_of_nothing_fails_with_4)
{
    char empty[96], file[96];
    (void)snprintf(empty, sizeof empty, "%s/empty", base);
    (void)snprintf(file, sizeof file, "%s/said", base);
    assert_int_equal(mkdir(empty, 0777), 0);
    assert_int_equal(report(empty), 4);
    assert_non_null(strstr(said, "nothing to report"));
    assert_int_equal(report("/nowhere/at/all"), 4);
    assert_int_equal(report(file), 4);
    const char *const bare[] = {"report", NULL};
    assert_int_equal(program(bare), 2);
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

TEST(escape_drawing_stays_within_its_attribute)
{
    mote_text text = {0};
    mote_escape_drawing(&text, "<a b=\"#1\">\n5 % &lt; \xc2\xb7 'x'</a>");
    assert_string_equal(text.data, "%3Ca b=%22%231%22%3E 5 %25 &amp;lt; \xc2\xb7 'x'%3C/a%3E");
    free(text.data);
}

TEST(escape_script_cannot_end_the_element)
{
    mote_text text = {0};
    mote_escape_script(&text, "{\"a\": \"</script><!--\"}");
    assert_string_equal(text.data, "{\"a\": \"\\u003c/script>\\u003c!--\"}");
    free(text.data);
}

/* The vectors of RFC 4648, and a text longer than a line of the writer. */
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

TEST(markdown_html_folds_code_and_escapes)
{
    mote_text text = {0};
    mote_markdown_html(&text,
                       "# title\n\n## 1. `a<b>` & c\n\ntwo\nlines\n\n    x < y;\n\n    z\n"
                       "\nafter\n");
    assert_string_equal(text.data,
                        "<h3>1. <code>a&lt;b&gt;</code> &amp; c</h3>\n<p>two\nlines</p>\n"
                        "<details><summary>Reproduction</summary><pre><code>x &lt; y;\n\nz\n"
                        "</code></pre></details>\n<p>after</p>\n");
    free(text.data);
}

TEST(markdown_html_of_a_text_without_ends_closes_what_is_open)
{
    static const char *const pairs[][2] = {
        {"###### deep `code", "<h6>deep <code>code</code></h6>\n"},
        {"    code", "<details><summary>Reproduction</summary><pre><code>code\n"
                     "</code></pre></details>\n"},
        {"a\n\n\nb", "<p>a</p>\n<p>b</p>\n"},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i) {
        mote_text text = {0};
        mote_markdown_html(&text, pairs[i][0]);
        assert_string_equal(text.data, pairs[i][1]);
        free(text.data);
    }
    mote_text text = {0};
    mote_markdown_nested(&text, "# title\n## one\nlast");
    assert_string_equal(text.data, "### one\nlast\n");
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
