/* The list of columns against everything made from it: the schema and the document in the
   repository, a run's summary.json and CSV. */
#include "harness/base/data.h"
#include "harness/summary/column_docs.h"
#include "harness/summary/summary_json.h"
#include "harness/summary/table.h"
#include "tests/support/folder.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <math.h>

#define SCHEMA MOTE_SOURCE_DIR "/results/schema/summary.json"
#define DOCUMENT MOTE_SOURCE_DIR "/results/README.md"

static mote_summary summary;

static int make_run(void)
{
    for (int r = 1; r <= 2; ++r) {
        const stored_cell cells[] = {
            {.replicate = r, .rows = "1,0,0,5,0.5,0,0,0,7\n2,0,0,6,0.5,0.1,0,1,7\n"},
            {.method = "odd, \\\"name\\\"",
             .id = r == 1 ? "o1" : "o2",
             .replicate = r,
             .status = "crashed",
             .more = ", \"reason\": \"a signal\""}};
        for (size_t i = 0; i < 2; ++i)
            stored_cell_put(".", cells[i]);
    }
    return mote_summary_make(".", &summary) == MOTE_OK ? 0 : -1;
}

static int remove_run(void)
{
    mote_summary_free(&summary);
    return 0;
}

TEST_GROUP(make_run, remove_run);

static bool is_null_object(const json_t *row, const mote_column *column)
{
    return column->object && json_is_null(json_object_get(row, column->object));
}

static const json_t *value_of(const json_t *row, const mote_column *column)
{
    return json_object_get(column->object ? json_object_get(row, column->object) : row,
                           column->key);
}

TEST(columns_have_names_that_differ_and_a_member_each)
{
    for (size_t i = 0; i < mote_column_count; ++i) {
        const mote_column *column = &mote_columns[i];
        assert_ptr_equal(mote_column_find(column->object, column->key), column);
        assert_true(column->offset > 0);
        assert_non_null(column->unit);
        assert_true(column->meaning ||
                    (i > 0 && column->object && mote_columns[i - 1].object &&
                     strcmp(column->object, mote_columns[i - 1].object) == 0));
        for (size_t k = 0; k < i; ++k)
            assert_true(!column->csv || !mote_columns[k].csv ||
                        strcmp(column->csv, mote_columns[k].csv) != 0);
        for (int view = 0; view < MOTE_VIEWS; ++view)
            assert_true(column->place[view] == 0 || (column->show && column->head));
    }
}

TEST(views_are_sorted_by_place)
{
    for (int view = 0; view < MOTE_VIEWS; ++view) {
        const mote_column *columns[MOTE_VIEW_MAX];
        const size_t count = mote_column_view((mote_view)view, columns);
        assert_true(count >= 6 && count < MOTE_VIEW_MAX);
        for (size_t k = 1; k < count; ++k)
            assert_true(columns[k - 1]->place[view] < columns[k]->place[view]);
    }
}

/* Every row of summary.json has every column, apart from optional ones, with the same number as
   the CSV. */
TEST(rows_hold_the_values_of_their_columns)
{
    assert_int_equal(summary.count, 2);
    for (size_t i = 0; i < summary.count; ++i) {
        json_t *row = mote_summary_row_json(&summary.rows[i]);
        size_t known = 0;
        for (size_t k = 0; k < mote_column_count; ++k) {
            const mote_column *column = &mote_columns[k];
            const json_t *value = value_of(row, column);
            if (!value && !column->optional && !column->of_scenes &&
                !is_null_object(row, column))
                fail_msg("no %s.%s", column->object ? column->object : "", column->key);
            if (json_is_number(value)) {
                assert_true(json_number_value(value) ==
                            mote_column_number(column, &summary.rows[i]));
                ++known;
            }
        }
        assert_true(known > 5);
        json_decref(row);
    }
    const mote_column *max = mote_column_find("error", "max");
    assert_true(mote_column_number(max, &summary.rows[0]) == 0.1);
    assert_null(mote_column_find(NULL, "max"));
}

/* summary.json holds everything of a row: written again after reading, it is the same to the
   last bit. */
TEST(rows_that_are_read_are_written_alike)
{
    mote_summary read;
    assert_int_equal(mote_summary_write(&summary, "."), MOTE_OK);
    assert_int_equal(mote_summary_read(".", "summary.json", &read), MOTE_OK);
    assert_int_equal(read.count, summary.count);
    for (size_t i = 0; i < read.count; ++i) {
        json_t *written = mote_summary_row_json(&summary.rows[i]);
        json_t *again = mote_summary_row_json(&read.rows[i]);
        assert_true(json_equal(written, again));
        assert_int_equal(read.rows[i].status, summary.rows[i].status);
        assert_int_equal(read.rows[i].given, summary.rows[i].given);
        json_decref(written);
        json_decref(again);
    }
    mote_summary_free(&read);
}

/* A missing member, or one of another type, has no value. */
TEST(rows_that_lack_a_column_have_no_value_there)
{
    static const char *const files[] = {
        "{\"rows\": [{}]}\n", "{\"rows\": [5]}\n",
        "{\"rows\": [{\"scenario\": 1, \"frames\": -1, \"jobs\": 4294967296, \"seed\": 1.5,"
        " \"total_ns\": {\"median\": \"1\"}, \"ratio\": [], \"status\": \"other\","
        " \"triangles\": 3, \"processes\": {}, \"times_comparable\": 0}]}\n"};
    for (size_t i = 0; i < ROWS_OF(files); ++i) {
        mote_summary read;
        file_put("odd.json", files[i]);
        assert_int_equal(mote_summary_read(".", "odd.json", &read), MOTE_OK);
        const mote_summary_row *row = &read.rows[0];
        assert_string_equal(row->scenario, "");
        assert_true(isnan(row->total.median) && isnan(row->quiet.ratio[0]));
        assert_int_equal(row->frames + row->jobs + row->seed + row->triangles[1], 0);
        assert_int_equal(row->status, MOTE_CELL_STATUSES);
        assert_true(row->times_comparable && !row->given && !row->ratio.to);
        assert_int_equal(row->process_count, 0);
        mote_summary_free(&read);
    }
}

/* The number of fields in a line of a CSV; quotes inside fields are doubled. */
static size_t count_fields(const char *line)
{
    size_t fields = 1;
    bool quoted = false;
    for (; *line && (*line != '\n' || quoted); ++line) {
        quoted = quoted != (*line == '"');
        fields += *line == ',' && !quoted ? 1 : 0;
    }
    return fields;
}

TEST(csv_has_a_field_a_column_whatever_names_hold)
{
    mote_text text = {0};
    mote_table_csv(&summary, &text);
    assert_int_equal(strncmp(text.data, "scenario,cache,method,label,n,", 30), 0);
    const size_t fields = count_fields(text.data);
    size_t lines = 0;
    for (const char *line = text.data; *line; line = strchr(line, '\n') + 1, ++lines)
        assert_int_equal(count_fields(line), fields);
    assert_int_equal(lines, 1 + summary.count);
    assert_non_null(strstr(text.data, "\"odd, \"\"name\"\"\""));
    free(text.data);
}

/* Prints what the file should hold: the test's folder is removed when it ends. */
static void differs(const char *file, const char *expected)
{
    (void)printf("--- %s\n%s\n---\n", file, expected);
    fail_msg("%s is not what harness/summary/column.c says, which is printed above", file);
}

TEST(schema_of_a_row_is_that_of_the_columns)
{
    json_t *schema = json_load_file(SCHEMA, 0, NULL), *expected = mote_columns_schema();
    assert_non_null(schema);
    json_t *definitions = json_object_get(schema, "$defs");
    if (!json_equal(json_object_get(definitions, "row"), expected)) {
        assert_int_equal(json_object_set(definitions, "row", expected), 0);
        char *text = json_dumps(schema, JSON_INDENT(1));
        differs(SCHEMA, text);
    }
    json_decref(expected);
    json_decref(schema);
}

TEST(document_holds_the_table_of_the_columns)
{
    mote_text expected = {0};
    mote_columns_markdown(&expected);
    char *document = file_text(DOCUMENT);
    if (!strstr(document, expected.data))
        differs(DOCUMENT, expected.data);
    free(document);
    free(expected.data);
}

/* The data that a page needs to draw a table from rows alone. */
TEST(columns_as_data_say_where_a_value_is_and_how_it_is_shown)
{
    for (size_t i = 0; i < mote_column_count; ++i) {
        json_t *entry = mote_column_json(&mote_columns[i]);
        const char *object = json_string_value(json_object_get(entry, "object"));
        const char *key = json_string_value(json_object_get(entry, "key"));
        assert_ptr_equal(mote_column_find(object, key), &mote_columns[i]);
        assert_int_equal(json_is_string(json_object_get(entry, "show")),
                         mote_columns[i].show != NULL);
        json_decref(entry);
    }
}
