/* The output of tune for runs whose files the test wrote. */
#include "harness/summary/tune.h"

#include "harness/base/record.h"
#include "tests/support/stored_run.h"
#include "tests/support/test.h"

#define RIGHT(ns) "1,0,0," #ns ",0.5,0,0,0,7\n"
#define MISSED(ns) "1,0,0," #ns ",0,0,0,1,7\n"
#define FAR(ns) "1,0,0," #ns ",0.5,0.25,0,0,7\n"
#define WRONG(ns) "1,0,0," #ns ",0.5,0.25,1,0,7\n"

TEST(tune_of_right_and_wrong_configurations_names_the_fastest_right_one)
{
    static const stored_cell cells[] = {
        {.method = "fcl-aabb", .id = "a", .status = "crashed"},
        {.method = "fcl-obb", .id = "b", .rows = WRONG(10), .parameters = "{\"n\": 1}"},
        {.method = "fcl-obb", .id = "b2", .rows = MISSED(9), .parameters = "{\"n\": 1.25}"},
        {.method = "fcl-obb", .id = "b3", .rows = FAR(12), .parameters = "{\"n\": 1.5}"},
        {.method = "fcl-obb", .id = "c", .rows = RIGHT(50), .parameters = "{\"n\": 2}"},
        {.method = "fcl-obb", .id = "d", .rows = RIGHT(40), .parameters = "{\"n\": 3}"},
        {.method = "fcl-obb", .id = "e", .rows = WRONG(5), .parameters = "{\"n\": 4}"},
        {.method = "fcl-obb", .id = "f", .rows = RIGHT(90), .parameters = "{\"n\": 5}"},
        {.method = "fcl-obb", .id = "g", .rows = RIGHT(1), .more = ", \"jobs\": 2"},
        {.method = "fcl-rss", .id = "h", .rows = WRONG(7)},
        {.method = "fcl-rss", .id = "i", .rows = RIGHT(8), .cache = "evict"},
        {.method = "fcl-rss", .id = "j", .rows = RIGHT(9), .scenario = "t"},
        {.method = "fcl-rss", .id = "k", .status = "timeout", .scenario = "u"}};
    mote_expect(4, "/cells: No such file or directory; name the directory", "tune .");
    write_cell(cells[0]);
    mote_expect(0, "", "tune ."); /* all failed: no row */
    assert_string_equal(said, "");
    for (size_t i = 0; i < ROWS_OF(cells); ++i)
        write_cell(cells[i]);
    mote_expect(0, "", "tune .");
    static const struct {
        const char *scenario, *cache, *method;
        double best, worst;
        int configurations;
        bool right;
    } expected[] = {{"s", "hot", "fcl-obb", 40, 90, 7, true},
                    {"s", "hot", "fcl-rss", 7, 7, 1, false},
                    {"s", "evict", "fcl-rss", 8, 8, 1, true},
                    {"t", "hot", "fcl-rss", 9, 9, 1, true}};
    json_t *object = NULL;
    assert_int_equal(mote_record_read_json(".", "tune.json", &object), MOTE_OK);
    const json_t *rows = json_object_get(object, "rows");
    assert_int_equal(json_array_size(rows), 4);
    for (size_t i = 0; i < 4; ++i) {
        const json_t *row = json_array_get(rows, i);
        const char *scenario, *cache, *method;
        double best, worst;
        int configurations, right;
        assert_int_equal(json_unpack((json_t *)(uintptr_t)row,
                                     "{s:s, s:s, s:s, s:F, s:{s:F}, s:i, s:b}", "scenario",
                                     &scenario, "cache", &cache, "method", &method, "total_ns",
                                     &best, "worst", "total_ns", &worst, "configurations",
                                     &configurations, "right", &right),
                         0);
        assert_string_equal(scenario, expected[i].scenario);
        assert_string_equal(cache, expected[i].cache);
        assert_string_equal(method, expected[i].method);
        about(best, expected[i].best);
        about(worst, expected[i].worst);
        assert_int_equal(configurations, expected[i].configurations);
        assert_true((right != 0) == expected[i].right);
    }
    json_decref(object);
    assert_non_null(strstr(said, "none of them right"));
}

TEST(tune_best_fcl_reads_only_rows_that_mote_wrote)
{
#define TUNED(scenario, cache, method, name, right, total)                                     \
    "{\"scenario\": \"" scenario "\", \"cache\": \"" cache "\", \"method\": \"" method         \
    "\", \"configuration\": \"" name "\", \"right\": " right ", \"total_ns\": " total "}"
    static const char rows[] =
        "{\"rows\": [5, {\"scenario\": \"s\"}," TUNED("s", "hot", "fcl-a", "a", "true", "9") "," TUNED(
            "t", "hot", "fcl-b", "b", "true",
            "1") "," TUNED("s", "evict", "fcl-c", "c", "true",
                           "1") "," TUNED("s", "hot", "certified", "d", "true",
                                          "1") "," TUNED("s", "hot", "fcl-e", "e", "false",
                                                         "1") "," TUNED("s", "hot", "fcl-f",
                                                                        "f", "true",
                                                                        "8") "," TUNED("s",
                                                                                       "hot",
                                                                                       "fcl-g",
                                                                                       "g",
                                                                                       "true",
                                                                                       "8.5") "]}";
    file_put("tune.json", rows);
    mote_expect(0, "", "tune --best-fcl s .");
    assert_string_equal(said, "f\n");
    mote_expect(4, "tune.json: scenario 'u' is not in it", "tune --best-fcl u .");
    file_put("tune.json", "{\"rows\": [");
    mote_expect(4, "tune.json:1:", "tune --best-fcl s .");
}
