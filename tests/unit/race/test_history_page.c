/* The history as a page: its contents, the links of its points, and what is refused. */
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include "harness/race/history_page.h"
#include "harness/race/race_files.h"

#include <math.h>
#include <sys/stat.h>

#define HEADER                                                                                 \
    "date,commit,why,row,total_ns,ratio,positions,box_tests,triangle_tests,heap_live_bytes,"   \
    "error_p99\n"
static const char history[] =
    HEADER "1,0123456789abc,first,ww/a:n=5;b=c/hot,,2,,,,,\n"
           "2,def,<script>alert(1)</script>,ww/a:n=5;b=c/hot,,1,,,,,\n";

static const char *race(const char *date, const char *verdict, double ratio)
{
    static char text[2048];
    (void)snprintf(
        text, sizeof text,
        "{\"schema\": 1, \"date\": \"%s\", \"a\": \"one\", \"b\": \"<two>\", \"verdict\": "
        "\"worse\", \"rows\": [{\"name\": \"ww/a:b=c,n=5/hot\", \"ratio\": %g, \"ci_low\": "
        "1.01, "
        "\"ci_high\": 1.2, \"verdict\": \"%s\", \"worse\": true, \"what\": \"counts & more\"}, "
        "{\"name\": \"ww/new/hot\", \"ratio\": null, \"verdict\": \"undecided\"}]}\n",
        date, ratio, verdict);
    return text;
}

static int empty_folder(void)
{
    return folder_next() || mkdir("perf-ab", 0755);
}

TEST_EACH(empty_folder, NULL);

TEST(keys_of_a_row_may_stand_in_any_order)
{
    static const char *const same[] = {"ww/a:n=5;b=c/hot", "ww/a:b=c,n=5/hot",
                                       "ww/a:b=c;n=5/hot", "ww/a:n=5,b=c/hot"};
    for (size_t i = 0; i < ROWS_OF(same); ++i) {
        char *key = mote_race_row_key(same[i], "");
        assert_string_equal(key, "ww/a:b=c,n=5/hot");
        free(key);
    }
    static const char *const alone[] = {"ww/a/hot", "ww",           "",           "/",
                                        "a:b",      "ww/a:n=5/hot", "ww/hot:n=5", "a:b=c"};
    for (size_t i = 0; i < ROWS_OF(alone); ++i) {
        char *key = mote_race_row_key(alone[i], "");
        assert_string_equal(key, alone[i]);
        free(key);
    }
}

TEST(races_are_read_by_date)
{
    mote_race_files files;
    file_put("perf-ab/b.json", race("2026-01-01", "slower", 1.1));
    file_put("perf-ab/a.json", race("2026-01-02", "faster", 0.9));
    file_put("perf-ab/last.json", "no race");
    file_put("perf-ab/notes.txt", "no race");
    assert_int_equal(mote_race_files_read("perf-ab", &files), MOTE_OK);
    assert_int_equal(files.count, 2);
    assert_int_equal(files.name_count, 2);
    const mote_race_point first = mote_race_files_point(&files, 0, "ww/a:b=c,n=5/hot");
    assert_true(fabs(first.ratio - 1.1) < 1e-12 && fabs(first.interval.high - 1.2) < 1e-12);
    assert_string_equal(first.verdict, "slower");
    assert_true(isnan(mote_race_files_point(&files, 0, "ww/other/hot").ratio));
    assert_true(mote_race_files_has(&files, "ww/a:b=c,n=5/hot"));
    assert_false(mote_race_files_has(&files, "ww/new/hot"));
    char *changes = mote_race_files_changes(&files, 1);
    assert_string_equal(changes, "ww/a:b=c,n=5/hot faster (0.9)");
    free(changes);
    mote_race_files_free(&files);
    assert_int_equal(mote_race_files_read("nowhere", &files), MOTE_OK);
    assert_int_equal(files.count, 0);
    mote_race_files_free(&files);
}

TEST(points_lead_to_commits_and_reasons)
{
    file_put("h.csv", history);
    file_put("perf-ab/a.json", race("2026-01-01", "slower", 1.1));
    assert_int_equal(mote_history_page("h.csv", "perf-ab", "h.html"), MOTE_OK);
    char *page = file_text("h.html");
    /* One chart for both, whatever the order of keys; a row that only races have gets
       another. */
    assert_int_equal(test_count(page, "<figure>"), 2);
    assert_int_equal(test_count(page, "<h2>ww/"), 2);
    assert_int_equal(test_count(page, "href=\"#reference-2\""), 1);
    assert_int_equal(test_count(page, "id=\"reference-2\""), 1);
    assert_int_equal(test_count(page, "href=\"#race-1\""), 1);
    assert_int_equal(test_count(page, "id=\"race-1\""), 1);
    assert_int_equal(test_count(page, "class=\"point changed\""), 1);
    assert_int_equal(test_count(page, "class=\"point slower\""), 1);
    assert_int_equal(test_count(page, "ww/a:b=c,n=5/hot slower (1.1)"), 1);
    /* File contents appear as text, and nothing is loaded. */
    assert_int_equal(test_count(page, "<script"), 0);
    assert_int_equal(test_count(page, "<two>"), 0);
    assert_int_equal(test_count(page, "counts & more"), 0);
    assert_int_equal(test_count(page, "http"), 0);
    assert_int_equal(test_count(page, "src="), 0);
    assert_int_equal(test_count(page, "nan"), 0);
    free(page);
}

/* A race of one row, "ww/a:b=c,n=5/hot". asked: "", or its JSON with the comma. */
static void put_race(const char *file, const char *date, const char *asked)
{
    char text[1024];
    (void)snprintf(text, sizeof text,
                   "{\"schema\": 1, \"date\": \"%s\", \"rows\": [{\"name\": "
                   "\"ww/a:b=c,n=5/hot\"%s, \"ratio\": 2, \"verdict\": \"slower\"}]}\n",
                   date, asked);
    file_put(file, text);
}

/* Races and references of other frames or questions have charts of their own. Those of older
   versions do not say what they were asked, and are taken for the same as others. */
TEST(rows_that_were_asked_something_else_are_other_rows)
{
    static const char first[] = ", \"asked\": \"1-9 distance\"",
                      second[] = ", \"asked\": \"1-9 contact\"",
                      named[] = ", \"asked\": \"1-9 distance\", \"scenario\": \"ww\", "
                                "\"method\": \"a:n=5,b=c\", \"cache\": \"hot\"";
    static const struct {
        const char *line; /* of the reference, last column */
        const char *races[3];
        int titles, charts;
    } rows[] = {
        {"", {"", "", ""}, 1, 2},
        {"", {first, "", first}, 1, 2},
        {"", {"", "", second}, 1, 2},
        {"1-9 distance", {"", "", ""}, 1, 2},
        {"1-9 distance", {first, named, ""}, 1, 2},
        {"1-9 distance", {first, second, first}, 2, 3},
        {"1-8 distance", {first, second, first}, 3, 3},
        {"1-9 contact", {first, first, first}, 2, 2},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char text[512], file[32];
        test_row("%zu", i);
        (void)snprintf(text, sizeof text,
                       "date,commit,why,row,total_ns,ratio,positions,box_tests,triangle_tests,"
                       "heap_live_bytes,error_p99,asked\n1,c,w,ww/a:n=5;b=c/hot,,2,,,,,,%s\n",
                       rows[i].line);
        file_put("h.csv", text);
        for (int k = 0; k < 3; ++k) {
            (void)snprintf(file, sizeof file, "perf-ab/%d.json", k);
            put_race(file, file, rows[i].races[k]);
        }
        assert_int_equal(mote_history_page("h.csv", "perf-ab", "h.html"), MOTE_OK);
        char *page = file_text("h.html");
        assert_int_equal(test_count(page, "<h2>ww/"), rows[i].titles);
        assert_int_equal(test_count(page, "<figure>"), rows[i].charts);
        for (int k = 1; k <= 3; ++k) {
            (void)snprintf(file, sizeof file, "href=\"#race-%d\"", k);
            assert_int_equal(test_count(page, file), 1);
        }
        if (rows[i].titles > 2)
            assert_int_equal(test_count(page, ", frames 1-9 contact</h2>"), 1);
        free(page);
    }
}

/* A race without an interval has no whisker, one that lacks the row no point. */
TEST(points_of_races_show_what_is_known)
{
    file_put("h.csv", HEADER);
    file_put("perf-ab/a.json", race("2026-01-01", "slower", 1.1));
    file_put("perf-ab/b.json",
             "{\"schema\": 1, \"date\": \"2026-01-02\", \"rows\": [{\"name\": "
             "\"ww/a:n=5,b=c/hot\", \"ratio\": 2, \"ci_low\": null, \"verdict\": "
             "\"undecided\"}]}\n");
    file_put("perf-ab/c.json", "{\"schema\": 1, \"date\": \"2026-01-03\", \"rows\": "
                               "[{\"name\": \"other/hot\", \"ratio\": 0.5}]}\n");
    assert_int_equal(mote_history_page("h.csv", "perf-ab", "h.html"), MOTE_OK);
    char *page = file_text("h.html");
    assert_int_equal(test_count(page, "class=\"whisker\""), 1);
    assert_int_equal(test_count(page, "href=\"#race-1\""), 1);
    assert_int_equal(test_count(page, "href=\"#race-2\""), 1);
    assert_int_equal(test_count(page, "href=\"#race-3\""), 1);
    assert_int_equal(test_count(page, "nan"), 0);
    free(page);
}

/* Every row that is worse, and every faster one, is told, and no other. */
TEST(changes_of_a_race_are_its_worse_and_faster_rows)
{
    mote_race_files files;
    file_put("perf-ab/a.json",
             "{\"schema\": 1, \"date\": \"2026-01-01\", \"rows\": ["
             "{\"name\": \"a/hot\", \"ratio\": 2, \"verdict\": \"slower\", \"worse\": true}, "
             "{\"name\": \"b/hot\", \"ratio\": 1, \"verdict\": \"same\", \"worse\": false}, "
             "{\"name\": \"c/hot\", \"ratio\": 0.5, \"verdict\": \"faster\"}, "
             "{\"name\": \"d/hot\", \"verdict\": \"undecided\"}]}\n");
    assert_int_equal(mote_race_files_read("perf-ab", &files), MOTE_OK);
    char *changes = mote_race_files_changes(&files, 0);
    assert_string_equal(changes, "a/hot slower (2); c/hot faster (0.5)");
    free(changes);
    mote_race_files_free(&files);
}

TEST(mote_history_writes_the_page)
{
    file_put("h.csv", history);
    file_put("perf-ab/a.json", race("2026-01-01", "slower", 1.1));
    (void)mote("history h.csv"); /* gnuplot may be missing */
    char *page = file_text("h.html");
    assert_int_equal(test_count(page, "class=\"point slower\""), 1);
    free(page);
    (void)mote("history h.csv --races nowhere");
    page = file_text("h.html");
    assert_int_equal(test_count(page, "class=\"point slower\""), 0);
    free(page);
}

TEST(what_is_no_race_is_refused)
{
    static const struct {
        const char *text, *says;
    } rows[] = {
        {"[]\n", "perf-ab/bad.json: not a race"},
        {"{\"schema\": 1}\n", "perf-ab/bad.json: not a race"},
        {"{\"schema\": 2, \"date\": \"\", \"rows\": []}\n", "perf-ab/bad.json: not a race"},
        {"{\"schema\": 1, \"date\": 5, \"rows\": []}\n", "perf-ab/bad.json: not a race"},
        {"{", "perf-ab/bad.json:1"},
    };
    file_put("h.csv", history);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%zu", i);
        file_put("perf-ab/bad.json", rows[i].text);
        mote_expect(4, rows[i].says, "history h.csv");
        assert_false(file_exists("h.html"));
    }
    /* Invalid or empty rows must not cause a failure. */
    file_put("perf-ab/bad.json",
             "{\"schema\": 1, \"date\": \"\", \"rows\": [5, {}, {\"name\": \"x\"}]}\n");
    assert_int_equal(mote_history_page("h.csv", "perf-ab", "h.html"), MOTE_OK);
    file_put("h.csv", HEADER);
    assert_int_equal(mote_history_page("h.csv", "nowhere", "h.html"), MOTE_EINVAL);
}
