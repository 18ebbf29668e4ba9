/* mote tune, against the medians of the summary that it reads. */
#include "tests/support/folder.h"
#include "tests/support/program.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <jansson.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stddef.h>

static char base[] = "/tmp/mote-test-tune-XXXXXX";
static char said[64], text[1 << 16];

static int make_base(void)
{
    (void)snprintf(said, sizeof said, "%s.said", base);
    return mkdtemp(base) ? 0 : -1;
}

static int remove_base(void)
{
    (void)remove(said);
    return program_remove(base);
}

TEST_GROUP(make_base, remove_base);

/* mote ARGUMENTS DIRECTORY MORE, in the test's directory. */
static int mote(const char *arguments, const char *more)
{
    char line[512];
    (void)snprintf(line, sizeof line, "%s%s%s", arguments, *more ? base : "", more);
    int status = program_wait(program_start(line, said));
    program_read(said, text, sizeof text);
    return status;
}

static json_t *load_rows(const char *file)
{
    char path[128];
    (void)snprintf(path, sizeof path, "%s/%s", base, file);
    json_t *object = json_load_file(path, 0, NULL);
    assert_non_null(object);
    json_t *rows = json_incref(json_object_get(object, "rows"));
    json_decref(object);
    assert_true(json_array_size(rows) > 0);
    return rows;
}

static const char *string_of(const json_t *row, const char *key)
{
    return json_string_value(json_object_get(row, key));
}

/* Least and largest median of a method in the summary, of the rows that are right or not. */
static size_t extremes(const json_t *rows, const char *method, bool right, double range[2])
{
    size_t count = 0, k;
    json_t *row;
    range[0] = HUGE_VAL;
    range[1] = 0;
    json_array_foreach((json_t *)(uintptr_t)rows, k, row)
    {
        bool good = json_number_value(json_object_get(row, "missed")) == 0 &&
                    json_number_value(json_object_get(row, "false_contacts")) == 0;
        if (strcmp(string_of(row, "method"), method) != 0 || good != right)
            continue;
        double median =
            json_number_value(json_object_get(json_object_get(row, "total_ns"), "median"));
        range[0] = fmin(range[0], median);
        range[1] = fmax(range[1], median);
        ++count;
    }
    return count;
}

TEST(tune_names_the_fastest_right_configuration)
{
    int status =
        mote("run tt --frames 201-220 --replicates 1"
             " --method fcl-aabb:queue=2|64,seed=none|previous"
             " --method fcl-obb:update=refit-top-down|none|rebuild"
             " --method fcl-rss --method fcl-kdop18:call=api --method ccd-convex --out ",
             "/");
    assert_int_equal(status, 0);
    assert_int_equal(mote("tune ", "/"), 0);
    json_t *tuned = load_rows("tune.json"), *summary = load_rows("summary.json"), *row;
    assert_int_equal(json_array_size(tuned), 5);
    size_t k;
    json_array_foreach(tuned, k, row)
    {
        bool right = json_is_true(json_object_get(row, "right"));
        double range[2], other[2];
        size_t compared = extremes(summary, string_of(row, "method"), right, range);
        assert_true(compared > 0);
        assert_true(json_number_value(json_object_get(row, "total_ns")) == range[0]);
        assert_true(json_number_value(json_object_get(json_object_get(row, "worst"),
                                                      "total_ns")) == range[1]);
        size_t others = extremes(summary, string_of(row, "method"), !right, other);
        assert_true(right || others == 0);
        assert_int_equal(json_integer_value(json_object_get(row, "configurations")),
                         compared + others);
        assert_non_null(strstr(text, string_of(row, "configuration")));
    }
    /* The fastest right row of FCL, whichever method. */
    const char *best = "";
    double least = HUGE_VAL;
    json_array_foreach(tuned, k, row)
    {
        double total = json_number_value(json_object_get(row, "total_ns"));
        if (strncmp(string_of(row, "method"), "fcl-", 4) == 0 && total < least &&
            json_is_true(json_object_get(row, "right"))) {
            least = total;
            best = string_of(row, "configuration");
        }
    }
    assert_int_equal(mote("tune --best-fcl tt ", "/"), 0);
    assert_int_equal(strcspn(text, "\n"), strlen(best));
    assert_memory_equal(text, best, strlen(best));
    assert_int_equal(mote("tune --best-fcl ww ", "/"), 0);
    assert_string_equal(text, "");
    json_decref(tuned);
    json_decref(summary);
}

/* tune.json may be edited: a time below 0 is not the least of them. */
TEST(tune_best_fcl_of_a_damaged_file_is_of_what_has_a_time)
{
    static const struct {
        const char *text, *says;
        int status;
    } cases[] = {
        {"{\"rows\": [%s, \"neg\", \"total_ns\": -5}, %s, \"good\", \"total_ns\": 5}]}\n",
         "good\n", 0},
        {"{\"rows\": [%s, \"none\", \"total_ns\": null}, %s, \"nil\", \"total_ns\": 0}]}\n", "",
         0},
        {"{\"rows\": 5}\n", "no rows", 4},
        {"{}\n", "no rows", 4},
        {"[]\n", "no rows", 4}};
    static const char row[] =
        "{\"scenario\": \"ww\", \"cache\": \"hot\", \"method\": \"fcl-aabb\","
        " \"right\": true, \"configuration\":";
    char path[128], folder[96];
    (void)snprintf(folder, sizeof folder, "%s/edited", base);
    assert_int_equal(mote_directory_make(folder), MOTE_OK);
    (void)snprintf(path, sizeof path, "%s/tune.json", folder);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        mote_text file = {0};
        const char *rest = cases[i].text;
        for (const char *hole; (hole = strstr(rest, "%s,")) != NULL; rest = hole + 3)
            mote_text_add(&file, "%.*s%s", (int)(hole - rest), rest, row);
        mote_text_add(&file, "%s", rest);
        file_put(path, file.data);
        free(file.data);
        assert_int_equal(mote("tune --best-fcl ww ", "/edited"), cases[i].status);
        if (cases[i].status == 0)
            assert_string_equal(text, cases[i].says);
        else
            assert_non_null(strstr(text, cases[i].says));
    }
}

/* A cell without frames has no time: it is neither the best nor the worst. */
TEST(tune_of_a_cell_without_frames_leaves_it_out)
{
    char folder[96];
    const stored_cell cells[] = {
        {.rows = "", .parameters = "{\"queue\": 2}"},
        {.id = "b", .rows = "1,0,0,5,1,0,0,0,7\n", .parameters = "{\"queue\": 64}"}};
    (void)snprintf(folder, sizeof folder, "%s/bare", base);
    for (size_t i = 0; i < 2; ++i)
        assert_true(stored_cell_write(folder, &cells[i]));
    assert_int_equal(mote("tune ", "/bare"), 0);
    json_t *rows = load_rows("bare/tune.json");
    assert_int_equal(json_array_size(rows), 1);
    const json_t *row = json_array_get(rows, 0);
    assert_true(json_number_value(json_object_get(row, "total_ns")) == 5);
    assert_int_equal(json_integer_value(json_object_get(row, "configurations")), 1);
    json_decref(rows);
}

TEST(tune_without_a_run_is_bad_input)
{
    assert_int_equal(mote("tune ", "/nothing"), 4);
    assert_int_equal(mote("tune --best-fcl tt ", "/nothing"), 4);
    assert_int_equal(mote("tune", ""), 2);
    assert_int_equal(mote("tune ", "/ two"), 2);
}
