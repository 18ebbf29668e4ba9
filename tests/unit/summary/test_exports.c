/* What mote summarize writes for other tools; more of it in tests/scripts/exports.py. */
#include "tests/support/plain_file.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <jansson.h>
#include <math.h>
#include <stdbool.h>

static char base[] = "/tmp/mote-test-exports-XXXXXX";
static char said[64], text[1 << 16];

static int summarize(const char *format)
{
    char line[160];
    (void)snprintf(line, sizeof line, "summarize %s/run --format %s", base, format);
    int status = program_wait(program_start(line, said));
    program_read(said, text, sizeof text);
    return status;
}

/* Two rows of three replicates, and one of a method that knows no distance. */
static int make_base(void)
{
    char line[512], name[64];
    if (!mkdtemp(base))
        return -1;
    (void)snprintf(said, sizeof said, "%s/said", base);
    (void)snprintf(name, sizeof name, "%s/few.json", base);
    if (!plain_file_put(name, "{\"purpose\": \"a test\", \"like\": \"mv\", \"frames\": 5,"
                              " \"warmup\": null, \"active\": null}\n"))
        return -1;
    (void)snprintf(line, sizeof line,
                   "run %s --replicates 3 --stride 1 --method fcl-aabb --method certified"
                   " --method fcl-kdop18 --out %s/run",
                   name, base);
    return program_wait(program_start(line, said));
}

static int remove_base(void)
{
    return program_remove(base);
}

TEST_GROUP(make_base, remove_base);

static json_t *export(const char *format)
{
    assert_int_equal(summarize(format), 0);
    json_t *value = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(value);
    assert_null(strstr(text, "null"));
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

/* Fields of a line, commas in quotes apart. */
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
    assert_int_equal(summarize("csv"), 0);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf"));
    int lines = 0, fields = 0;
    for (const char *line = text; *line; ++lines) {
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

/* The last of the tests: it adds a run of fewer frames. */
TEST(names_tell_rows_of_other_frames_apart)
{
    char line[512];
    (void)snprintf(line, sizeof line,
                   "run %s/few.json --replicates 3 --frames 1-3 --method certified"
                   " --out %s/run",
                   base, base);
    assert_int_equal(program_wait(program_start(line, said)), 0);
    json_t *bencher = export("bencher");
    assert_int_equal(json_object_size(bencher), 3);
    assert_non_null(json_object_get(bencher, "few/certified/hot/frames:1-3/stride:1/seed:0"));
    assert_non_null(json_object_get(bencher, "few/certified/hot/frames:1-5/stride:1/seed:0"));
    assert_non_null(json_object_get(bencher, "few/fcl-aabb/hot"));
    json_decref(bencher);
}

TEST(summarize_with_an_unknown_format_lists_those_that_there_are)
{
    assert_int_equal(summarize("xml"), 2);
    assert_non_null(strstr(text, "gbench"));
}
