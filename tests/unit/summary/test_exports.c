/* What mote summarize writes for other tools; tests/scripts/exports.py tests more. */
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <jansson.h>
#include <math.h>
#include <stdbool.h>

/* Two rows of three replicates, and one of a method without distances. */
static int make_run(void)
{
    file_put("few.json", "{\"purpose\": \"a test\", \"like\": \"mv\", \"frames\": 5,"
                         " \"warmup\": null, \"active\": null}\n");
    return mote("run few.json --replicates 3 --stride 1 --method fcl-aabb --method certified"
                " --method fcl-kdop18 --out run");
}

TEST_GROUP(make_run, NULL);

static json_t *export(const char *format)
{
    mote_expect(0, "", "summarize run --format %s", format);
    json_t *value = json_loads(said, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(value);
    assert_null(strstr(said, "null"));
    return value;
}

static bool is_nanoseconds(const json_t *value)
{
    return json_is_number(value) && json_number_value(value) > 0 &&
           json_number_value(value) < 1e9;
}

TEST(gbench_has_an_entry_a_replicate_and_none_without_figures)
{
    json_t *all = export("gbench");
    const json_t *context = json_object_get(all, "context");
    assert_int_equal(json_integer_value(json_object_get(context, "json_schema_version")), 1);
    assert_true(json_string_length(json_object_get(context, "host_name")) > 0);
    assert_true(json_string_length(json_object_get(context, "date")) > 0);
    const json_t *entries = json_object_get(all, "benchmarks");
    assert_int_equal(json_array_size(entries), 6);
    for (size_t i = 0; i < 6; ++i) {
        const json_t *entry = json_array_get(entries, i);
        const char *name = json_string_value(json_object_get(entry, "name"));
        assert_string_equal(name, i < 3 ? "few/certified/hot/real_time"
                                        : "few/fcl-aabb/hot/real_time");
        assert_int_equal(json_integer_value(json_object_get(entry, "repetitions")), 3);
        assert_int_equal(json_integer_value(json_object_get(entry, "repetition_index")), i % 3);
        assert_int_equal(json_integer_value(json_object_get(entry, "iterations")), 5);
        assert_true(is_nanoseconds(json_object_get(entry, "real_time")));
        assert_true(json_is_number(json_object_get(entry, "triangle_tests")));
    }
    json_decref(all);
}

TEST(trackers_get_the_median_of_each_row_with_figures)
{
    json_t *actions = export("gha"), *bencher = export("bencher");
    assert_int_equal(json_array_size(actions), 2);
    assert_int_equal(json_object_size(bencher), 2);
    for (size_t i = 0; i < 2; ++i) {
        const json_t *entry = json_array_get(actions, i);
        assert_string_equal(json_string_value(json_object_get(entry, "unit")), "ns");
        const json_t *value = json_object_get(entry, "value");
        const json_t *latency = json_object_get(
            json_object_get(bencher, json_string_value(json_object_get(entry, "name"))),
            "latency");
        assert_true(is_nanoseconds(value));
        assert_true(json_equal(value, json_object_get(latency, "value")));
        assert_true(json_number_value(json_object_get(latency, "lower_value")) <=
                    json_number_value(json_object_get(latency, "upper_value")));
    }
    json_decref(actions);
    json_decref(bencher);
}

/* Counts the fields of a line; commas in quotes do not separate. */
static int count_fields(const char *line, size_t length)
{
    int fields = 1;
    bool quoted = false;
    for (size_t i = 0; i < length; ++i) {
        quoted = quoted != (line[i] == '"');
        fields += line[i] == ',' && !quoted;
    }
    return fields;
}

TEST(csv_leaves_empty_what_there_is_not)
{
    mote_expect(0, "", "summarize run --format csv");
    assert_null(strstr(said, "nan"));
    assert_null(strstr(said, "inf"));
    int lines = 0, fields = 0;
    for (const char *line = said; *line; ++lines) {
        size_t length = strcspn(line, "\n");
        int here = count_fields(line, length);
        fields = lines == 0 ? here : fields;
        assert_int_equal(here, fields);
        if (strstr(line, "fcl-kdop18") && strstr(line, "fcl-kdop18") < line + length)
            assert_non_null(strstr(line, ",0,unsupported,,,,"));
        line += length + (line[length] == '\n');
    }
    assert_int_equal(lines, 4);
}

/* Must be the last test: it adds a run of fewer frames. */
TEST(names_tell_rows_of_other_frames_apart)
{
    mote_expect(0, "", "run few.json --replicates 3 --frames 1-3 --method certified --out run");
    json_t *bencher = export("bencher");
    assert_int_equal(json_object_size(bencher), 3);
    assert_non_null(json_object_get(bencher, "few/certified/hot/frames:1-3/stride:1/seed:0"));
    assert_non_null(json_object_get(bencher, "few/certified/hot/frames:1-5/stride:1/seed:0"));
    assert_non_null(json_object_get(bencher, "few/fcl-aabb/hot"));
    json_decref(bencher);
}

TEST(summarize_with_an_unknown_format_lists_those_that_there_are)
{
    mote_expect(2, "gbench", "summarize run --format xml");
}
