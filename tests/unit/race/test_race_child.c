/* mote race-child: its answers to requests that `mote race` makes, and to those that it never
   makes. */
#include "tests/support/command_lines.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CELL(first, last, print, method)                                                       \
    "cell\tletters.json\t" #first "\t" #last "\thot\t1\t" #print "\t" method "\n"

static void put_box(const char *name, double near)
{
    char text[512];
    (void)snprintf(text, sizeof text,
                   "{\"purpose\": \"letters in a box\", \"frames\": 4, \"ask\": \"distance\",\n"
                   "\"bodies\": {\"count\": 6, \"seed\": 1, \"box\": [3, 3, 3], \"near\": %g,\n"
                   "\"speed\": 0.006, \"spin\": 0.8,\n"
                   "\"shapes\": [{\"letter\": \"T\", \"triangles\": 400}]}}\n",
                   near);
    file_put(name, text);
}

/* Two small letters that pass each other without touching. */
static int put_files(void)
{
    file_put("letters.json",
             "{\"purpose\": \"two letters that pass\", \"frames\": 60, \"ask\": \"distance\",\n"
             "\"bodies\": [{\"letter\": \"T\", \"triangles\": 400},\n"
             "{\"letter\": \"T\", \"triangles\": 400, \"motion\": [{\"frame\": 1, "
             "\"position\": [1.5, 0, 0]}, {\"frame\": 60, \"position\": [0.9, 0.5, 0]}]}]}\n");
    file_put(
        "touch.json",
        "{\"purpose\": \"one letter within another\", \"frames\": 2, \"ask\": \"contact\",\n"
        "\"bodies\": [{\"letter\": \"T\", \"triangles\": 400},\n"
        "{\"letter\": \"T\", \"triangles\": 400}]}\n");
    file_put("meet.json",
             "{\"purpose\": \"one letter within another\", \"frames\": 2, \"ask\": "
             "\"distance\",\n\"bodies\": [{\"letter\": \"T\", \"triangles\": 400},\n"
             "{\"letter\": \"T\", \"triangles\": 400}]}\n");
    /* They meet between frames 3 and 4. */
    file_put("pass.json",
             "{\"purpose\": \"one letter flies into another\", \"frames\": 5, \"ask\": "
             "\"impact\", \"step\": 2,\n\"bodies\": [{\"letter\": \"T\", \"triangles\": "
             "400},\n{\"letter\": \"T\", \"triangles\": 400, \"motion\": [{\"frame\": 1, "
             "\"position\": [8, 0, 0]}, {\"frame\": 5, \"position\": [-0.9, 0, 0]}]}]}\n");
    file_put("many.json",
             "{\"purpose\": \"letters in a box\", \"frames\": 10, \"ask\": \"distance\",\n"
             "\"bodies\": {\"count\": 6, \"seed\": 1, \"near_pairs\": 1, \"near\": 0.2,\n"
             "\"speed\": 0.006, \"spin\": 0.8,\n"
             "\"shapes\": [{\"letter\": \"T\", \"triangles\": 400}]}}\n");
    /* The same a little later, still between frames 3 and 5. */
    file_put("later.json",
             "{\"purpose\": \"one letter flies into another\", \"frames\": 5, \"ask\": "
             "\"impact\", \"step\": 2,\n\"bodies\": [{\"letter\": \"T\", \"triangles\": "
             "400},\n{\"letter\": \"T\", \"triangles\": 400, \"motion\": [{\"frame\": 1, "
             "\"position\": [8, 0, 0]}, {\"frame\": 5, \"position\": [-0.8, 0, 0]}]}]}\n");
    /* The same bodies in one box: more pairs are near in the second. */
    put_box("box.json", 0.5);
    put_box("wide.json", 1.5);
    file_put("odd.json", "{\"two\\nlines\": 1}\n");
    return 0;
}

TEST_GROUP(put_files, NULL);

/* What a child answers to these requests; the caller frees it. */
static char *answers_to(const char *requests)
{
    file_put("asked", requests);
    assert_int_equal(mote("race-child <asked >heard"), 0);
    assert_string_equal(said, "");
    return file_text("heard");
}

TEST(requests_that_cannot_be_answered_are_refused_with_a_reason)
{
    static const struct {
        const char *requests, *says; /* its last line */
    } rows[] = {
        {"hello\n", "no\thello: no such request\n"},
        {"\n", "no\t: no such request\n"},
        {"cell\ttoo\tfew\n", "no\tcell: no such request\n"},
        {"cell\t1\t2\t3\t4\t5\t6\t7\t8\t9\n", "no\tcell: no such request\n"},
        {"run\t0\t1\t1\n", "no\t0: no such cell\n"},
        {"answers\tx\n", "no\tx: no such cell\n"},
        {CELL(1, 70, 0, "certified"),
         "no\tframes 1-70: outside letters.json; it has frames 1-60\n"},
        {CELL(7, 6, 0, "certified"),
         "no\tframes 7-6: outside letters.json; it has frames 1-60\n"},
        {CELL(0, 7, 0, "certified"), "no\tcell: frames or seed are not numbers\n"},
        {CELL(1, x, 0, "certified"), "no\tcell: frames or seed are not numbers\n"},
        {"cell\tletters.json\t1\t7\thot\tx\t0\tcertified\n",
         "no\tcell: frames or seed are not numbers\n"},
        {CELL(1, 7, 0, "nothing"), "no\tunknown method nothing"},
        {CELL(1, 7, 0, "certified:threads=2"), "leave threads and ahead out\n"},
        {CELL(1, 7, 0, "certified:ahead=2"), "leave threads and ahead out\n"},
        {"cell\tnowhere.json\t1\t7\thot\t1\t0\tcertified\n", "nowhere.json"},
        /* The name of a key ends the line of the error, but not of the answer. */
        {"cell\todd.json\t1\t7\thot\t1\t0\tcertified\n", "two lines: unknown key"},
        {CELL(1, 7, 0, "certified") "run\t0\t5\t4\n", "no\trun: frames outside the cell's\n"},
        {CELL(2, 7, 0, "certified") "run\t0\t1\t2\n", "no\trun: frames outside the cell's\n"},
        {CELL(2, 7, 0, "certified") "run\t0\t2\t0\n", "no\trun: frames outside the cell's\n"},
        {CELL(2, 7, 0, "certified") "run\t1\t2\t1\n", "no\t1: no such cell\n"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].requests);
        char *heard = answers_to(rows[i].requests);
        const size_t length = strlen(heard);
        assert_int_equal(strncmp(heard, "mote-race\t1\n", 12), 0);
        assert_int_equal(heard[length - 1], '\n');
        const char *last = heard + length - 1;
        while (last[-1] != '\n')
            --last;
        if (strncmp(last, "no\t", 3) != 0 || !strstr(last, rows[i].says))
            fail_msg("not \"%s\" but:\n%s", rows[i].says, heard);
        free(heard);
    }
}

/* Names of the counts that a method sends; "-": none. */
TEST(counts_that_are_not_0_are_sent)
{
    static const struct {
        const char *cell, *counts[6];
    } rows[] = {
        {CELL(1, 0, 0, "brute-force"), {"triangle_tests="}},
        {"cell\ttouch.json\t1\t2\thot\t1\t0\tode\n", {"\t-\t"}},
        {"cell\tmany.json\t1\t4\thot\t1\t0\tcertified\n",
         {"box_tests=", "triangle_tests=", "blocks=", "rows=", "leaf_pairs="}},
        {CELL(1, 4, 0, "particle:n=5"), {"positions=", "launches=", "refined="}},
        {CELL(1, 4, 0, "particle-paper:n=5"), {"steps=", "moves=", "ended_nmin="}},
        {CELL(1, 4, 0, "particle-paper:n=5,nmax=1,nmin=1"), {"steps=", "ended_nmax="}},
    };
    assert_int_equal(mote("list methods"), 0);
    const bool has_ode = strstr(said, "\node: ") != NULL;
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char requests[256];
        (void)snprintf(requests, sizeof requests, "%srun\t0\t1\t2\n", rows[i].cell);
        test_row("%s", rows[i].cell);
        if (strstr(rows[i].cell, "\tode\n") && !has_ode)
            continue;
        char *heard = answers_to(requests);
        for (size_t k = 0; k < ROWS_OF(rows[i].counts) && rows[i].counts[k]; ++k) {
            if (!strstr(heard, rows[i].counts[k]))
                fail_msg("no %s in:\n%s", rows[i].counts[k], heard);
        }
        free(heard);
    }
}

/* The same answers from two cells of one scene, whatever the order of their frames. */
TEST(cells_of_one_scene_are_served_side_by_side)
{
    char *heard = answers_to(CELL(1, 0, 1, "certified") CELL(3, 8, 1, "aabb-tree") CELL(
        1, 8, 0, "embree") "run\t0\t3\t2\nanswers\t0\nrun\t1\t3\t2\nanswers\t1\n");
    char print[2][40], told[2][80];
    unsigned last[2];
    static const char format[] =
        "mote-race\t1\nok\t%39s\t%*s\t%u%*[^\n]\nok\t%39s\t%*s\t%u%*[^\n]\n%*[^\n]\n"
        "ok\t%*[^\n]\nok\t%79s\n"
        "ok\t%*[^\n]\nok\t%79s\n";
    assert_int_equal(
        sscanf(heard, format, print[0], &last[0], print[1], &last[1], told[0], told[1]), 6);
    assert_string_equal(print[0], print[1]);
    assert_string_not_equal(print[0], "0000000000000000");
    assert_int_equal(last[0], 60);
    assert_int_equal(last[1], 8);
    double distance[2][2];
    for (int k = 0; k < 2; ++k)
        assert_int_equal(sscanf(told[k], "%lf:0,%lf:0", &distance[k][0], &distance[k][1]), 2);
    for (int k = 0; k < 2; ++k)
        assert_true(distance[0][k] > 0 &&
                    distance[1][k] - distance[0][k] < 1e-9 * distance[0][k] &&
                    distance[0][k] - distance[1][k] < 1e-9 * distance[0][k]);
    free(heard);
}

TEST(contacts_are_told_with_and_without_a_distance)
{
    char *heard = answers_to("cell\tmeet.json\t1\t2\tevict\t1\t0\tcertified\n"
                             "cell\ttouch.json\t1\t2\thot\t1\t0\tfcl-obb\n"
                             "run\t0\t1\t2\nanswers\t0\nrun\t1\t1\t2\nanswers\t1\n");
    assert_non_null(strstr(heard, "\nok\t0:1,0:1\n"));
    assert_non_null(strstr(heard, "\nok\tnan:1,nan:1\n"));
    free(heard);
}

/* Scenarios that ask for impacts: a question spans the scenario's step. */
TEST(impacts_are_raced)
{
    char *heard = answers_to("cell\tpass.json\t1\t0\thot\t1\t0\tcertified\nrun\t0\t1\t3\n"
                             "answers\t0\ncell\tpass.json\t1\t4\thot\t1\t0\tcertified\n"
                             "cell\tpass.json\t1\t0\thot\t1\t0\tstream\n");
    /* The last of five frames that asks, and the question. */
    assert_non_null(strstr(heard, "\t3\t0000000000000000\timpact\t2\t0\nok\t"));
    const char *told = strstr(heard, "\nok\tnan:0:0000000000000000:nan:nan,nan:1:");
    assert_non_null(told);
    /* They meet in the same frame, asked about from two: half a question earlier. */
    double from[2], to[2];
    assert_int_equal(sscanf(told, "\nok\tnan:0:%*x:nan:nan,nan:1:%*x:%lf:%lf,nan:1:%*x:%lf:%lf",
                            &from[0], &to[0], &from[1], &to[1]),
                     4);
    assert_true(from[0] <= to[0] && to[0] < 1 && fabs(to[0] - to[1] - 0.5) < 1e-6);
    assert_non_null(strstr(
        heard, "no\tframes 1-4: outside pass.json; it has frames 1-3 from which it asks\n"));
    assert_non_null(strstr(heard, "no\tstream does not answer impacts"));
    free(heard);
    mote_expect(0, "pass.json/certified/hot",
                "race %s %s pass.json --method certified --budget 60 --until 20%% --real 20%%",
                MOTE_PROGRAM, MOTE_PROGRAM);
    assert_null(strstr(said, "failed"));
}

/* The hash of a block's answers and the last line, the answers. */
static void read_block(const char *cell, int frame, char hash[17], char answers[512])
{
    char requests[256];
    (void)snprintf(requests, sizeof requests, "%srun\t0\t%d\t1\nanswers\t0\n", cell, frame);
    char *heard = answers_to(requests);
    assert_int_equal(
        sscanf(heard, "%*[^\n]\n%*[^\n]\nok\t%16s\t%*[^\n]\nok\t%511s", hash, answers), 2);
    free(heard);
}

/* Two impacts at other times of one question, and near pairs beside the closest one, which is
   the same in both scenes: every answer is in the hash by which blocks are compared. */
TEST(all_answers_are_hashed_and_told)
{
    static const char *const cells[][2] = {
        {"cell\tpass.json\t3\t0\thot\t1\t0\tcertified\n",
         "cell\tlater.json\t3\t0\thot\t1\t0\tcertified\n"},
        {"cell\tbox.json\t1\t0\thot\t1\t0\tcertified\n",
         "cell\twide.json\t1\t0\thot\t1\t0\tcertified\n"},
    };
    for (size_t i = 0; i < ROWS_OF(cells); ++i) {
        char hash[2][17], answers[2][512];
        test_row("%s", cells[i][0]);
        for (int k = 0; k < 2; ++k)
            read_block(cells[i][k], i == 0 ? 3 : 1, hash[k], answers[k]);
        assert_string_not_equal(hash[0], hash[1]);
        /* Distance and contact are the same. */
        const size_t same = strcspn(strchr(answers[0], ':') + 1, ":") +
                            (size_t)(strchr(answers[0], ':') + 1 - answers[0]);
        assert_int_equal(strncmp(answers[0], answers[1], same), 0);
        assert_string_not_equal(answers[0], answers[1]);
    }
}

TEST(a_child_has_256_cells_at_most)
{
    enum { CELLS = 256 };
    static char requests[CELLS * 64 + 128];
    size_t size = 0;
    for (int i = 0; i <= CELLS; ++i)
        size += (size_t)snprintf(requests + size, sizeof requests - size,
                                 "cell\ttouch.json\t1\t2\thot\t1\t0\tbrute-force\n");
    char *heard = answers_to(requests);
    size_t lines = 0;
    const char *last = heard;
    for (const char *at = heard; *at; at = strchr(at, '\n') + 1, ++lines)
        last = at;
    assert_int_equal(lines, 1 + CELLS + 1);
    assert_string_equal(last, "no\tmore than 256 cells; race fewer\n");
    free(heard);
}

/* A child ends where its input does, and where nobody reads its answers. */
TEST(a_child_ends_with_its_parent)
{
    file_put("asked", "hello\nhello");
    mote_expect(0, "no\thello: no such request\n", "race-child <asked");
    assert_string_equal(strchr(said, '\n') + 1, "no\thello: no such request\n");
    static char lines[3][9000];
    memset(lines, 'x', sizeof lines);
    lines[2][8999] = '\0';
    file_put("asked", &lines[0][0]); /* longer than any request */
    mote_expect(0, "mote-race", "race-child <asked");
    assert_string_equal(strchr(said, '\n') + 1, "");
    file_put("asked", "hello\n");
    assert_int_equal(mote("race-child <asked >&-"), 0);
    assert_int_equal(mote("race-child <asked >/dev/full"), 0);
}

TEST(command_lines_of_a_child_that_are_wrong)
{
    static const command_line lines[] = {
        {"race-child --core x", 2, "not a number that `mote race` gives"},
        {"race-child --stack 2000000", 2, "not a number that `mote race` gives"},
        {"race-child one", 2, "not a number that `mote race` gives"},
        {"race-child --cores 1", 2, "--cores"},
    };
    command_refuses(lines, ROWS_OF(lines));
}
