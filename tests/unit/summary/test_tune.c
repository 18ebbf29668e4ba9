/* mote tune, against the medians of the summary that it reads. */
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <jansson.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stddef.h>

static json_t *load_rows(const char *file)
{
    json_t *object = json_load_file(file, 0, NULL);
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

/* The least and the largest median of a method in the summary, among rows that are right or
   wrong. */
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
    mote_expect(0, "",
                "run tt --frames 201-220 --replicates 1"
                " --method 'fcl-aabb:queue=2|64,seed=none|previous'"
                " --method 'fcl-obb:update=refit-top-down|none|rebuild'"
                " --method fcl-rss --method fcl-kdop18:call=api --method ccd-convex --out .");
    mote_expect(0, "", "tune .");
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
        assert_non_null(strstr(said, string_of(row, "configuration")));
    }
    /* The fastest right row of FCL, of any FCL method. */
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
    mote_expect(0, best, "tune --best-fcl tt .");
    assert_int_equal(strcspn(said, "\n"), strlen(best));
    assert_memory_equal(said, best, strlen(best));
    mote_expect(4, "", "tune --best-fcl ww . 2>err.txt");
    assert_string_equal(said, "");
    mote_expect(4, "./tune.json: scenario 'ww' is not in it", "tune --best-fcl ww .");
    mote_expect(4, "./tune.json: scenario 'ww' is not in it", "tune --best ww .");
    /* Of the engines of others there are only FCL's and libccd's, and libccd's parts are no
       engine for meshes. */
    mote_expect(0, best, "tune --best tt .");
    json_decref(tuned);
    json_decref(summary);
}

/* tune.json may be edited: a negative time is not the least. */
TEST(tune_best_fcl_of_a_damaged_file_is_of_what_has_a_time)
{
    static const struct {
        const char *text, *says;
        int status;
    } cases[] = {
        {"{\"rows\": [%s, \"neg\", \"total_ns\": -5}, %s, \"good\", \"total_ns\": 5}]}\n",
         "good\n", 0},
        {"{\"rows\": [%s, \"none\", \"total_ns\": null}, %s, \"nil\", \"total_ns\": 0}]}\n",
         "mote: edited/tune.json lists no FCL that is right on ww\n", 0},
        {"{\"rows\": 5}\n", "no rows", 4},
        {"{}\n", "no rows", 4},
        {"[]\n", "no rows", 4}};
    static const char row[] =
        "{\"scenario\": \"ww\", \"cache\": \"hot\", \"method\": \"fcl-aabb\","
        " \"right\": true, \"configuration\":";
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        mote_text file = {0};
        const char *rest = cases[i].text;
        for (const char *hole; (hole = strstr(rest, "%s,")) != NULL; rest = hole + 3)
            mote_text_add(&file, "%.*s%s", (int)(hole - rest), rest, row);
        mote_text_add(&file, "%s", rest);
        file_put("edited/tune.json", file.data);
        free(file.data);
        mote_expect(cases[i].status, cases[i].says, "tune --best-fcl ww edited");
        if (cases[i].status == 0)
            assert_string_equal(said, cases[i].says);
    }
}

/* A cell without frames has no time: it is neither the best nor the worst. */
TEST(tune_of_a_cell_without_frames_leaves_it_out)
{
    const stored_cell cells[] = {
        {.rows = "", .parameters = "{\"queue\": 2}"},
        {.id = "b", .rows = "1,0,0,5,1,0,0,0,7\n", .parameters = "{\"queue\": 64}"}};
    for (size_t i = 0; i < 2; ++i)
        stored_cell_put("bare", cells[i]);
    mote_expect(0, "", "tune bare");
    json_t *rows = load_rows("bare/tune.json");
    assert_int_equal(json_array_size(rows), 1);
    const json_t *row = json_array_get(rows, 0);
    assert_true(json_number_value(json_object_get(row, "total_ns")) == 5);
    assert_int_equal(json_integer_value(json_object_get(row, "configurations")), 1);
    json_decref(rows);
}

TEST(tune_without_a_run_is_bad_input)
{
    mote_expect(4, "", "tune nothing");
    mote_expect(4, "nothing/tune.json: there is none; `mote tune nothing` writes it",
                "tune --best-fcl tt nothing");
    mote_expect(2, "", "tune");
    mote_expect(2, "", "tune . two");
}

/* Of engines of others, the fastest right one; ours are not among them. */
TEST(tune_best_is_of_all_engines_of_others)
{
    static const char file[] =
        "{\"rows\": ["
        "{\"scenario\": \"s\", \"cache\": \"hot\", \"method\": \"certified\", \"right\": true,"
        " \"configuration\": \"certified\", \"total_ns\": 1},"
        "{\"scenario\": \"s\", \"cache\": \"hot\", \"method\": \"bullet-gimpact\", \"right\": "
        "false,"
        " \"configuration\": \"bullet-gimpact\", \"total_ns\": 2},"
        "{\"scenario\": \"s\", \"cache\": \"hot\", \"method\": \"ode\", \"right\": true,"
        " \"configuration\": \"ode:vertices=single\", \"total_ns\": 3},"
        "{\"scenario\": \"s\", \"cache\": \"hot\", \"method\": \"fcl-aabb\", \"right\": true,"
        " \"configuration\": \"fcl-aabb\", \"total_ns\": 4}]}\n";
    file_put("engines/tune.json", file);
    mote_expect(0, "ode:vertices=single\n", "tune --best s engines");
    mote_expect(0, "fcl-aabb\n", "tune --best-fcl s engines");
    mote_expect(4, "engines/tune.json: scenario 't' is not in it", "tune --best t engines");
    /* Measured, but nothing of FCL's is right. */
    file_put("engines/tune.json",
             "{\"rows\": [{\"scenario\": \"s\", \"cache\": \"hot\", \"method\": \"fcl-aabb\", "
             "\"right\": false, \"configuration\": \"fcl-aabb\", \"total_ns\": 4}]}\n");
    mote_expect(0, "engines/tune.json lists no FCL that is right on s",
                "tune --best-fcl s engines");
}
