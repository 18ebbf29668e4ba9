/* The history of accepted references: what is added, drawn and refused. */
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <sys/stat.h>

/* A gnuplot that draws nothing: the test reads the data. */
#define GNUPLOT "#!/bin/sh\nfor f in $8; do echo drawn > \"$5.$f\"; done\n"

static int make_gnuplot(void)
{
    char path[256];
    file_put("gnuplot", GNUPLOT);
    (void)snprintf(path, sizeof path, "%s:/usr/bin:/bin", folder_path());
    return chmod("gnuplot", 0755) || setenv("PATH", path, 1);
}

TEST_GROUP(make_gnuplot, NULL);

#define HEADER                                                                                 \
    "date,commit,why,row,total_ns,ratio,positions,box_tests,triangle_tests,heap_live_bytes,"   \
    "error_p99\n"

TEST(history_of_what_is_none_is_refused_by_line)
{
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"", "h.csv:1: not the header of a history"},
        {"date,commit\n", "h.csv:1: not the header of a history"},
        {HEADER, "h.csv: nothing to draw; accept a reference first"},
        {HEADER "d,c,w,r,,,,,,,\n", "h.csv: nothing to draw"},
        {HEADER "d,c,w,r,0,-1,,,,,\n", "h.csv: nothing to draw"},
        {HEADER "d,c,w,r,100,2,,,,\n", "h.csv:2: not a line of a history; expected 11"},
        {HEADER "d,c,w,r,100,2,,,,,\nd,c\n", "h.csv:3: not a line of a history"},
        {HEADER "d,c,w,r,100,2,,,,,,\n", "h.csv:2: not a line of a history"},
        {HEADER "\n", "h.csv:2: not a line of a history"},
        {HEADER "d,c,w,r,100,2x,,,,,\n", "h.csv:2: 2x: not a number"},
        {HEADER "d,c,w,r,1,2,,,,,\nd,c,w,r,e,2,,,,,\n", "h.csv:3: e: not a number"},
        {HEADER "d,c,w,r,100,nan,,,,,\n", "h.csv:2: nan: not a number"},
        {HEADER "d,c,w,r,100,2,,,,,1,\n", "h.csv:2: not a line of a history"},
        {HEADER "d,c,w,r,100,2,,,,,?\n", "h.csv:2: ?: not a number"}};
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        file_put("h.csv", cases[i].text);
        mote_expect(4, cases[i].says, "history h.csv");
    }
    mote_expect(4, "/no/such/history.csv: No such file", "history /no/such/history.csv");
}

/* A file's contents, valid until the next call. */
static const char *read_data(const char *name)
{
    static char *text;
    free(text);
    return text = file_text(name);
}

/* A block a row: reference, time over the first one's, whether it changed, commit. */
TEST(history_marks_what_moves_more_than_usual)
{
    static const char lines[] = HEADER "1,0123456789abc,w,r,100,,,,,,\n"
                                       "1,0123456789abc,w,s,7,0.5,,,,,\n"
                                       "2,,w,r,101,,,,,,\n"
                                       "2,,w,s,9,0.25,,,,,\n"
                                       "3,c,w,r,100,,,,,,\n"
                                       "4,d,w,r,101,,,,,,\n"
                                       "5,e,w,r,202,,,,,,"; /* a last line without its end */
    static const char data[] = "\"r\"\n1 1 0 0123456789\n2 1.01 0 -\n3 1 0 c\n4 1.01 0 d\n"
                               "5 2.02 1 e\n\n\n\"s\"\n1 1 0 0123456789\n2 2 1 -\n";
    file_put("h.csv", lines);
    mote_expect(0, "h.svg", "history h.csv");
    assert_string_equal(read_data("h.dat"), data);
    /* A name shorter than ".csv" and without it, and no date. */
    static const char undated[] = HEADER ",c,w,r,100,,,,,,\n";
    file_put("h", undated);
    mote_expect(0, "h.svg", "history %s/h", folder_path());
    assert_string_equal(read_data("h.dat"), "\"r\"\n1 1 0 c\n");
    mote_expect(0, "h.svg", "history h");
    assert_string_equal(read_data("h.dat"), "\"r\"\n1 1 0 c\n");
}

/* Times against fcl-aabb and times in ns have no common scale, so neither is a change of the
   other. */
TEST(history_of_a_row_with_and_without_ratios_is_two_series)
{
    static const char lines[] = HEADER "1,a,w,a \"b\",100,0.5,,,,,\n"
                                       "2,b,w,a \"b\",100,,,,,,\n"
                                       "3,c,w,a \"b\",101,0.25,,,,,\n"
                                       "4,d,w,a \"b\",101,,,,,,\n";
    file_put("h.csv", lines);
    mote_expect(0, "h.svg", "history h.csv");
    assert_string_equal(read_data("h.dat"), "\"a \u201db\u201d\"\n1 1 0 a\n3 2 1 c\n\n\n"
                                            "\"a \u201db\u201d\"\n2 1 0 b\n4 1.01 0 d\n");
}

#define ASKED_HEADER                                                                           \
    "date,commit,why,row,total_ns,ratio,positions,box_tests,triangle_tests,heap_live_bytes,"   \
    "error_p99,asked\n"

/* Rows of other frames or other questions are never one series. Lines of older versions, which
   do not say these, are taken for the next of their row. */
TEST(history_of_a_row_that_was_asked_something_else_is_two_series)
{
    static const char lines[] = ASKED_HEADER "1,a,w,r,100,,,,,,,\n"
                                             "1,a,w,s,7,,,,,,,\n"
                                             "2,b,w,r,200,,,,,,,1-9 distance\n"
                                             "3,c,w,r,50,,,,,,,1-9 contact\n"
                                             "3,c,w,r,400,,,,,,,1-9 distance\n"
                                             "4,d,w,r,25,,,,,,,1-8 contact\n";
    file_put("h.csv", lines);
    mote_expect(0, "h.svg", "history h.csv");
    assert_string_equal(read_data("h.dat"),
                        "\"r, frames 1-9 distance\"\n1 1 0 a\n2 2 1 b\n3 4 1 c\n\n\n"
                        "\"s\"\n1 1 0 a\n\n\n"
                        "\"r, frames 1-9 contact\"\n3 1 0 c\n\n\n"
                        "\"r, frames 1-8 contact\"\n4 1 0 d\n");
    /* A later version may have more columns. */
    file_put("h.csv", "date,commit,why,row,total_ns,ratio,positions,box_tests,triangle_tests,"
                      "heap_live_bytes,error_p99,asked,mood\n1,a,w,r,100,,,,,,,1-9 "
                      "distance,good\n");
    mote_expect(0, "h.svg", "history h.csv");
    assert_string_equal(read_data("h.dat"), "\"r\"\n1 1 0 a\n");
    file_put("h.csv", "date,commit,why,row,total_ns,ratio,positions,box_tests,triangle_tests,"
                      "heap_live_bytes,error_p99,mood\n");
    mote_expect(4, "h.csv:1: not the header of a history", "history h.csv");
}

/* What a row was asked is added last; files of older versions get the column. */
TEST(history_add_says_what_was_asked)
{
    static const char impact[] = ", \"ask\": \"impact\", \"step\": 3, \"tolerance\": 0.01";
    static const char *const files[] = {"none.csv", "old.csv", "new.csv", "later.csv"};
    static const char *const headers[] = {NULL, HEADER, ASKED_HEADER,
                                          "date,commit,why,row,total_ns,ratio,positions,"
                                          "box_tests,triangle_tests,heap_live_bytes,error_p99,"
                                          "asked,mood\n"};
    static const char *const lines[] = {"", "1,a,w,r,100,,,,,,",
                                        "1,a,w,r,100,,,,,,,1-9 distance",
                                        "1,a,w,r,100,,,,,,,1-9 distance,good"};
    static const char *const ends[] = {"", "", "", ","};
    stored_cell_put("asked", (stored_cell){.rows = "1,0,0,5,0.5,0,0,0,7\n",
                                           .more = ", \"ask\": \"distance\""});
    stored_cell_put(
        "asked",
        (stored_cell){.rows = "1,0,0,5,,,0,0,7\n", .method = "certified", .more = impact});
    file_put("asked/manifest.json", "{}\n");
    for (size_t i = 0; i < ROWS_OF(files); ++i) {
        char expected[3][128];
        test_row("%s", files[i]);
        if (headers[i]) {
            char *text = mote_format("%s%s", headers[i], lines[i]);
            file_put(files[i], text);
            free(text);
        }
        mote_expect(0, "", "history %s --add asked --why w", files[i]);
        char *text = file_text(files[i]);
        (void)snprintf(expected[0], sizeof expected[0], ",1-4 distance%s\n", ends[i]);
        (void)snprintf(expected[1], sizeof expected[1], ",1-4 impact step 3 tolerance 0.01%s\n",
                       ends[i]);
        (void)snprintf(expected[2], sizeof expected[2], "\n%s%s\n", lines[i],
                       i == 1 ? "," : "");
        for (size_t k = 0; k < (i == 0 ? 2 : 3); ++k) {
            if (!strstr(text, expected[k]))
                fail_msg("no \"%s\" in:\n%s", expected[k], text);
        }
        const char *header = headers[i] && i > 1 ? headers[i] : ASKED_HEADER;
        assert_int_equal(strncmp(text, header, strlen(header)), 0);
        free(text);
        mote_expect(0, ".svg", "history %s", files[i]);
    }
}

/* Accepted names must not end a field; a row that failed is left out. */
TEST(history_add_of_odd_names_can_be_drawn)
{
    const stored_cell cells[] = {
        {.rows = "1,0,0,5,0.5,0,0,0,7\n", .scenario = "a,b", .more = ", \"x\": 1"},
        {.method = "certified", .rows = "1,,,,,,,,\n", .parameters = "{\"slack\": \"1,2\"}"},
        {.method = "aabb-tree", .status = "crashed"}};
    for (size_t i = 0; i < ROWS_OF(cells); ++i)
        stored_cell_put("run", cells[i]);
    static const char add[] = "history n.csv --add run --why 'a\"b,c'";
    mote_expect(4, "run/manifest.json: No such file", "%s", add);
    file_put("run/manifest.json", "{}\n");
    mote_expect(0, "", "%s", add);
    file_put("run/manifest.json",
             "{\"commit\": \"9,9\", \"sessions\": [{\"started\": \"today\"}]}\n");
    mote_expect(0, "", "%s", add);
    char *text = file_text("n.csv");
    assert_non_null(strstr(text, "\n,,a;b;c,a;b/fcl-aabb/hot,5,1,"));
    assert_non_null(strstr(text, "\ntoday,9;9,a;b;c,s/certified:slack=1;2/hot,0,,"));
    assert_null(strstr(text, "aabb-tree"));
    /* Appended after a last line without its newline. */
    text[strlen(text) - 1] = '\0';
    file_put("n.csv", text);
    free(text);
    mote_expect(0, "", "%s", add);
    mote_expect(0, "n.svg", "history n.csv");
    assert_non_null(
        strstr(read_data("n.dat"), "\"a;b/fcl-aabb/hot\"\n1 1 0 -\n2 1 0 9;9\n2 1 0 9;9\n"));
}

/* Rows are added to histories only. */
TEST(history_add_to_another_file_leaves_it_alone)
{
    file_put("h.csv", "my thesis\n");
    mote_expect(4, "h.csv:1: not the header of a history", "history h.csv --add run --why w");
    assert_string_equal(read_data("h.csv"), "my thesis\n");
}
