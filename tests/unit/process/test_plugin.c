/* Shared libraries with methods and fields, compiled against the installed headers
   (support/plugins/). A sound one works as if it were built in; any other is refused or costs a
   cell. */
#include "core/base/plugin.h"
#include "core/body/field_maker.h"
#include "core/method/method.h"
#include "harness/base/heap_count.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

static const char *const sound[] = {MOTE_PLUGINS "/libplugin_sound.so",
                                    MOTE_PLUGINS "/libplugin_sound_cpp.so"};

static json_t *rows_of(const char *directory)
{
    json_t *object = NULL;
    assert_int_equal(mote_record_read_json(directory, "summary.json", &object), MOTE_OK);
    json_t *rows = json_incref(json_object_get(object, "rows"));
    json_decref(object);
    return rows;
}

static const json_t *row_of(const json_t *rows, const char *method)
{
    const json_t *row;
    size_t i;
    json_array_foreach(rows, i, row)
    {
        if (strcmp(json_string_value(json_object_get(row, "method")), method) == 0)
            return row;
    }
    fail_msg("no row of %s", method);
    return NULL;
}

TEST(methods_of_a_library_are_measured_as_those_built_in)
{
    for (size_t k = 0; k < ROWS_OF(sound); ++k) {
        test_row("%s", sound[k]);
        char directory[] = "run-0";
        directory[4] = (char)('0' + k);
        mote_expect(0, "plugin-points",
                    "run tt --frames 1-4 --replicates 1 --plugin %s --method plugin-points "
                    "--method certified --method plugin-moody --out %s",
                    sound[k], directory);
        json_t *rows = rows_of(directory);
        const json_t *row = row_of(rows, "plugin-points");
        assert_string_equal(json_string_value(json_object_get(row, "status")), "ok");
        row = row_of(rows, "plugin-moody");
        assert_string_equal(json_string_value(json_object_get(row, "status")), "unsupported");
        json_decref(rows);
        mote_expect(0, "plugin-points", "summarize %s --plugin=%s", directory, sound[k]);
        /* Its rows can be read without it. */
        mote_expect(0, "plugin-points", "summarize %s", directory);
    }
}

/* Each method is counted in a process of its own, in which both libraries must be open. */
TEST(instructions_are_counted_with_every_library)
{
    if (!mote_heap_read().counted || !has_valgrind())
        skip(); /* callgrind cannot run what sanitizers have built */
    mote_expect(0, "plugin-points",
                "instructions tt --frames 1-2 --out counted --method plugin-points --method "
                "plugin-second --plugin %s --plugin " MOTE_PLUGINS "/libplugin_second.so",
                sound[0]);
    assert_non_null(strstr(said, "plugin-second"));
    json_t *object = NULL;
    assert_int_equal(mote_record_read_json("counted", "instructions.json", &object), MOTE_OK);
    assert_int_equal(json_array_size(json_object_get(object, "rows")), 2);
    json_decref(object);
}

/* What reads rows treats them as any others, with the library at hand or without. */
TEST(tune_compare_and_the_page_have_methods_of_a_library)
{
    assert_int_equal(mote("run tt --frames 1-4 --replicates 2 --plugin %s --method certified "
                          "--method 'plugin-points:share=0.5|1' --out kept",
                          sound[0]),
                     0);
    mote_expect(0, "of 2, none of them right", "tune kept --plugin %s", sound[0]);
    mote_expect(0, "plugin-points:does=answer,share=", "tune kept");
    mote_expect(0, "tt/plugin-points:share=0.5/hot", "compare kept kept --plugin %s", sound[0]);
    mote_expect(0, "tt/plugin-points:does=answer,share=0.5/hot", "compare kept kept");
    mote_expect(0, "report.html", "report kept --plugin %s", sound[0]);
    mote_expect(0, "index.html", "site kept -o site");
    static const char *const files[] = {"kept/report.html", "kept/report.md", "site/index.html",
                                        "site/results.csv"};
    for (size_t k = 0; k < ROWS_OF(files); ++k) {
        test_row("%s", files[k]);
        char *text = file_text(files[k]);
        assert_non_null(strstr(text, "plugin-points"));
        free(text);
    }
}

TEST(extremes_try_a_method_of_a_library)
{
    mote_expect(
        0, "| plugin-points | 3 | 4 | 0 | 0 | 0 | 0 | 0 |",
        "extremes --quick --family touch --method plugin-points --plugin %s --out tried",
        sound[0]);
    assert_null(strstr(said, "certified"));
    char *text = file_text("tried/extremes.csv");
    /* Bodies in one place: the points that the method sees are as well. */
    assert_non_null(strstr(text, "\"one place\",plugin-points,right,0,"));
    assert_non_null(strstr(text, "\"face\",plugin-points,inexact,"));
    free(text);
}

/* Runs the program of `make oracle` on tt's first frames; the rows of the methods. */
static json_t *oracle(int status, const char *methods)
{
    file_put("four.json", "{\"purpose\": \"tt's first frames\", \"like\": \"tt\", "
                          "\"frames\": 4, \"warmup\": [1, 1], \"active\": [1, 4]}\n");
    char *line =
        mote_format(MOTE_ORACLE " --scenario ./four.json --plugin %s --out oracle.json "
                                "%s > oracle.txt",
                    sound[0], methods);
    const int code = system(line);
    free(line);
    assert_true(WIFEXITED(code));
    assert_int_equal(WEXITSTATUS(code), status);
    json_t *object = NULL;
    assert_int_equal(mote_record_read_json(".", "oracle.json", &object), MOTE_OK);
    json_t *rows = json_incref(
        json_object_get(json_array_get(json_object_get(object, "frames"), 0), "methods"));
    json_decref(object);
    return rows;
}

static json_int_t count_in(const json_t *row, const char *key)
{
    return json_integer_value(json_object_get(row, key));
}

/* In tt's first frames the letters are apart, and so are the points that the method sees. */
TEST(oracle_judges_a_method_of_a_library)
{
    json_t *rows = oracle(0, "--method certified");
    const json_t *row = row_of(rows, "certified");
    assert_int_equal(count_in(row, "frames"), 4);
    assert_int_equal(count_in(row, "distances_wrong"), 0);
    json_decref(rows);
    rows = oracle(1, "--method plugin-points --method plugin-points:share=0 --method certified "
                     "--method plugin-moody");
    row = row_of(rows, "plugin-points");
    assert_int_equal(count_in(row, "distances_wrong"), 4);
    assert_int_equal(count_in(row, "contacts_missed") + count_in(row, "contacts_invented"), 0);
    row = row_of(rows, "plugin-points:share=0");
    assert_int_equal(count_in(row, "contacts_invented"), 4);
    assert_int_equal(count_in(row_of(rows, "certified"), "distances_wrong"), 0);
    const json_t *failure = json_object_get(row_of(rows, "plugin-moody"), "failure");
    assert_non_null(strstr(json_string_value(failure), "today is not a good day"));
    json_decref(rows);
}

TEST(oracle_outlives_a_method_that_crashes_hangs_or_leaves)
{
    static const char *const ends[][2] = {
        {"crash", "ended by signal"}, {"hang", "took too long"}, {"leave", "ended with"}};
    json_t *rows = oracle(1, "--timeout 2 --method plugin-points:does=crash --method "
                             "plugin-points:does=hang --method plugin-points:does=leave");
    for (size_t k = 0; k < ROWS_OF(ends); ++k) {
        test_row("%s", ends[k][0]);
        const json_t *failure = json_object_get(json_array_get(rows, k), "failure");
        assert_non_null(strstr(json_string_value(failure), ends[k][1]));
    }
    json_decref(rows);
}

TEST(a_library_is_told_of_in_lists_and_in_the_manifest)
{
    mote_expect(0, "plugin-points: the bodies are points", "list methods --plugin %s",
                sound[0]);
    mote_expect(0, "plugin-shift: moves every vertex", "list fields --plugin %s", sound[0]);
    assert_int_equal(mote("list methods"), 0);
    assert_null(strstr(said, "plugin-points"));
    assert_int_equal(mote("run tt --frames 1-2 --replicates 1 --plugin %s --method "
                          "plugin-points:share=0.5 --out listed",
                          sound[0]),
                     0);
    json_t *manifest = NULL;
    assert_int_equal(mote_record_read_json("listed", "manifest.json", &manifest), MOTE_OK);
    const json_t *library = json_array_get(json_object_get(manifest, "plugins"), 0);
    assert_int_equal(json_integer_value(json_object_get(library, "contract")), MOTE_CONTRACT);
    assert_int_equal(json_array_size(json_object_get(library, "methods")), 2);
    json_decref(manifest);
}

TEST(a_method_that_crashes_hangs_or_leaves_costs_its_cell)
{
    static const struct {
        const char *does, *status;
    } cases[] = {{"crash", "crashed"}, {"leave", "crashed"}, {"hang", "timeout"}};
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        test_row("%s", cases[k].does);
        char *directory = mote_format("ends-%s", cases[k].does);
        assert_int_equal(mote("run tt --frames 1-4 --replicates 1 --timeout 2 --plugin %s "
                              "--method plugin-points:does=%s --method certified --out %s",
                              sound[0], cases[k].does, directory),
                         5);
        json_t *rows = rows_of(directory);
        const json_t *row = row_of(rows, "plugin-points");
        assert_string_equal(json_string_value(json_object_get(row, "status")), cases[k].status);
        row = row_of(rows, "certified");
        assert_string_equal(json_string_value(json_object_get(row, "status")), "ok");
        json_decref(rows);
        free(directory);
    }
}

/* The field moves body 1 of tt by 3 in z times its weight, which is 0 in one frame and 1 in the
   other: the truth follows. */
TEST(a_field_of_a_library_deforms_a_body_of_a_scenario)
{
    file_put(
        "shift.json",
        "{\"purpose\": \"a shift\", \"frames\": 2, \"ask\": \"distance\", \"bodies\": [\n"
        "{\"letter\": \"T\", \"triangles\": 1380, \"field\": {\"kind\": \"plugin-shift\",\n"
        "\"displacement\": {\"keyframes\": [{\"frame\": 1, \"vectors\": [[0, 0, 0]]},\n"
        "{\"frame\": 2, \"vectors\": [[0, 0, 3]]}]}}},\n"
        "{\"letter\": \"T\", \"triangles\": 1380}]}\n");
    mote_expect(4, "unknown kind plugin-shift", "check shift.json");
    assert_int_equal(mote("run shift.json --replicates 1 --method certified --plugin %s --out "
                          "shifted",
                          sound[0]),
                     0);
    mote_expect(0, "error", "summarize shifted --format csv");
    FILE *cells = popen("cut -d, -f5 shifted/cells/*-certified-*.csv", "r");
    char line[64];
    double distance[2] = {-1, -1};
    assert_non_null(cells);
    assert_non_null(fgets(line, sizeof line, cells)); /* the heading */
    for (int k = 0; k < 2; ++k) {
        assert_non_null(fgets(line, sizeof line, cells));
        distance[k] = strtod(line, NULL);
    }
    (void)pclose(cells);
    /* Both letters fill -h <= z <= h: they intersect at first, and are 3 L - 2 h apart then. */
    assert_true(distance[0] == 0);
    assert_true(distance[1] > 1);
}

/* Methods compiled elsewhere share these structs with the program. When one changes, raise
   MOTE_CONTRACT in core/base/plugin.h; if no release had the old one, change only the number
   here. */
TEST(the_contract_is_raised_when_its_structs_change)
{
    assert_int_equal(MOTE_CONTRACT, 1);
    assert_int_equal(MOTE_METHOD_SIZES, 944);
    assert_int_equal(MOTE_FIELD_SIZES, 336);
}

TEST(what_is_wrong_with_a_library_is_said)
{
    static const struct {
        const char *library, *says;
    } cases[] = {
        {"1", "built for version 7 of the contract of methods; this mote has version 1"},
        {"2", "item 1: a name is a lower-case letter"},
        {"3", "certified: there is a method of that name"},
        {"4", "plugin-wrong: its summary is not one line"},
        {"5", "plugin-wrong: has no function query"},
        {"6", "the default of a parameter: n=9 is not valid"},
        {"7", "parameter n ranges from 9 to 8"},
        {"8", "ended by signal 6"},
        {"9", "asking it what it offers: took too long"},
        {"10", "has one of create and destroy"},
        {"11", "compiled against headers of another mote with version 1"},
    };
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        test_row("%s", cases[k].says);
        mote_expect(4, cases[k].says, "list methods --plugin %s/libplugin_unsound_%s.so",
                    MOTE_PLUGINS, cases[k].library);
        assert_int_equal(strncmp(said, "mote: " MOTE_PLUGINS, strlen("mote: " MOTE_PLUGINS)),
                         0);
    }
    file_put("text.so", "no library");
    mote_expect(4, "text.so: cannot be loaded", "list methods --plugin text.so");
    mote_expect(4, "nothing.so: there is no such file", "list methods --plugin nothing.so");
    mote_expect(4, "not a regular file", "list methods --plugin .");
    mote_expect(2, "--plugin: no file", "list methods --plugin");
    mote_expect(4, "there is a method of that name", "list methods --plugin %s --plugin %s",
                sound[0], sound[0]);
    mote_expect(4, "unknown method plugin-points", "run tt --method plugin-points");
}
