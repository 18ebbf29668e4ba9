/* The history of accepted references: what is added to it, drawn of it, and refused. */
#include "tests/support/folder.h"
#include "tests/support/plain_file.h"
#include "tests/support/program.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <sys/stat.h>

static char base[] = "/tmp/mote-test-history-XXXXXX";
static char file[64], said[64], text[1 << 14];

/* A gnuplot that draws nothing: what is drawn from is looked at. */
#define GNUPLOT "#!/bin/sh\nfor f in $8; do echo drawn > \"$5.$f\"; done\n"

static int make_base(void)
{
    char path[512];
    if (!mkdtemp(base))
        return -1;
    (void)snprintf(file, sizeof file, "%s/h.csv", base);
    (void)snprintf(said, sizeof said, "%s/said", base);
    (void)snprintf(path, sizeof path, "%s/gnuplot", base);
    if (!plain_file_put(path, GNUPLOT) || chmod(path, 0755) != 0)
        return -1;
    (void)snprintf(path, sizeof path, "%s:/usr/bin:/bin", base);
    return setenv("PATH", path, 1);
}

static int remove_base(void)
{
    return program_remove(base);
}

TEST_GROUP(make_base, remove_base);

/* mote history ARGUMENTS: its exit status, and what it must say. */
static void expect(const char *arguments, int status, const char *says)
{
    char line[512];
    (void)snprintf(line, sizeof line, "history %s", arguments);
    const int ended = program_wait(program_start(line, said));
    program_read(said, text, sizeof text);
    if (ended != status || !strstr(text, says))
        fail_msg("mote %s: exit %d, not %d, or not \"%s\":\n%s", line, ended, status, says,
                 text);
}

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
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        file_put(file, cases[i].text);
        expect(file, 4, cases[i].says);
    }
    expect("/no/such/history.csv", 4, "/no/such/history.csv: No such file");
}

static void read_data(const char *name)
{
    char path[96];
    (void)snprintf(path, sizeof path, "%s/%s", base, name);
    program_read(path, text, sizeof text);
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
    file_put(file, lines);
    expect(file, 0, "h.svg");
    read_data("h.dat");
    assert_string_equal(text, data);
    /* A name without .csv, shorter than it, and no date. */
    static const char undated[] = HEADER ",c,w,r,100,,,,,,\n";
    char path[96];
    (void)snprintf(path, sizeof path, "%s/h", base);
    file_put(path, undated);
    expect(path, 0, "h.svg");
    read_data("h.dat");
    assert_string_equal(text, "\"r\"\n1 1 0 c\n");
    assert_int_equal(chdir(base), 0);
    expect("h", 0, "h.svg");
    read_data("h.dat");
    assert_string_equal(text, "\"r\"\n1 1 0 c\n");
}

/* Times against fcl-aabb and times in ns have no scale in common: neither is a change of the
   other. */
TEST(history_of_a_row_with_and_without_ratios_is_two_series)
{
    static const char lines[] = HEADER "1,a,w,a \"b\",100,0.5,,,,,\n"
                                       "2,b,w,a \"b\",100,,,,,,\n"
                                       "3,c,w,a \"b\",101,0.25,,,,,\n"
                                       "4,d,w,a \"b\",101,,,,,,\n";
    file_put(file, lines);
    expect(file, 0, "h.svg");
    read_data("h.dat");
    assert_string_equal(text, "\"a \u201db\u201d\"\n1 1 0 a\n3 2 1 c\n\n\n"
                              "\"a \u201db\u201d\"\n2 1 0 b\n4 1.01 0 d\n");
}

/* What would end a field is none, whatever was accepted; a row that did not end well is left
   out. */
TEST(history_add_of_odd_names_can_be_drawn)
{
    char arguments[256], path[96];
    const stored_cell cells[] = {
        {.rows = "1,0,0,5,0.5,0,0,0,7\n", .scenario = "a,b", .more = ", \"x\": 1"},
        {.method = "certified", .rows = "1,,,,,,,,\n", .parameters = "{\"slack\": \"1,2\"}"},
        {.method = "aabb-tree", .status = "crashed"}};
    (void)snprintf(path, sizeof path, "%s/run", base);
    for (size_t i = 0; i < sizeof cells / sizeof cells[0]; ++i)
        assert_true(stored_cell_write(path, &cells[i]));
    (void)snprintf(arguments, sizeof arguments, "%s/n.csv --add %s/run --why a\"b,c", base,
                   base);
    expect(arguments, 4, "run/manifest.json: No such file");
    (void)snprintf(path, sizeof path, "%s/run/manifest.json", base);
    file_put(path, "{}\n");
    expect(arguments, 0, "");
    file_put(path, "{\"commit\": \"9,9\", \"sessions\": [{\"started\": \"today\"}]}\n");
    expect(arguments, 0, "");
    read_data("n.csv");
    assert_non_null(strstr(text, "\n,,a;b;c,a;b/fcl-aabb/hot,5,1,"));
    assert_non_null(strstr(text, "\ntoday,9;9,a;b;c,s/certified:slack=1;2/hot,0,,"));
    assert_null(strstr(text, "aabb-tree"));
    /* Added to behind a last line that was not ended. */
    (void)snprintf(path, sizeof path, "%s/n.csv", base);
    text[strlen(text) - 1] = '\0';
    file_put(path, text);
    expect(arguments, 0, "");
    expect(path, 0, "n.svg");
    read_data("n.dat");
    assert_non_null(strstr(text, "\"a;b/fcl-aabb/hot\"\n1 1 0 -\n2 1 0 9;9\n2 1 0 9;9\n"));
}

/* Only to a history is added. */
TEST(history_add_to_another_file_leaves_it_alone)
{
    char arguments[256];
    file_put(file, "my thesis\n");
    (void)snprintf(arguments, sizeof arguments, "%s --add %s/run --why w", file, base);
    expect(arguments, 4, "h.csv:1: not the header of a history");
    read_data("h.csv");
    assert_string_equal(text, "my thesis\n");
}
