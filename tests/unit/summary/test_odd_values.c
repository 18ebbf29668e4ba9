/* Summaries of cells whose JSON has values of another kind or size than mote writes. */
#include "harness/base/record.h"
#include "harness/summary/summary_row.h"
#include "tests/support/stored_run.h"

static json_t *rows_of_summary(void)
{
    json_t *object = NULL;
    mote_expect(0, "", "summarize --format json . > summary");
    char *text = file_text("summary");
    object = json_loads(text, 0, NULL);
    free(text);
    assert_non_null(object);
    json_t *rows = json_incref(json_object_get(object, "rows"));
    json_decref(object);
    return rows;
}

/* A label has the parameters that are not the method's defaults, as on the command line. */
TEST(labels_show_parameters_of_any_kind)
{
    static const struct {
        const char *method, *parameters, *label;
    } rows[] = {
        {"particle", "{\"n\": \"auto\"}", "particle"},
        {"particle", "{\"n\": 8}", "particle:n=8"},
        {"particle", "{\"n\": \"many\"}", "particle:n=many"},
        {"particle", "{\"start\": \"fps\"}", "particle"},
        {"particle", "{\"start\": \"random\"}", "particle:start=random"},
        {"particle", "{\"start\": 3}", "particle:start=3"},
        {"particle", "{\"other\": 1.5}", "particle:other=1.5"},
        {"particle", "{\"other\": \"x\"}", "particle:other=x"},
        {"particle", "{\"other\": true}", "particle:other=true"},
        {"unheard-of", "{\"x\": 0.1}", "unheard-of:x=0.1"},
        {"unheard-of", "{\"x\": 7}", "unheard-of:x=7"},
        {"unheard-of", "{\"x\": \"auto\"}", "unheard-of:x=auto"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s %s", rows[i].method, rows[i].parameters);
        write_cell((stored_cell){.id = "c",
                                 .method = rows[i].method,
                                 .parameters = rows[i].parameters,
                                 .rows = ROWS});
        json_t *made = rows_of_summary();
        assert_int_equal(json_array_size(made), 1);
        assert_string_equal(mote_text_at(json_array_get(made, 0), "label"), rows[i].label);
        json_decref(made);
    }
}

TEST(numbers_out_of_range_count_as_unknown)
{
    static const struct {
        const char *more;
        int bodies, shapes;
    } rows[] = {
        {", \"bodies\": 3, \"shapes\": 2", 3, 2},
        {", \"bodies\": -3, \"shapes\": 0", 0, 0},
        {", \"bodies\": 5000000000, \"shapes\": 5000000000", 0, 0},
        {", \"bodies\": \"3\", \"shapes\": \"2\"", 0, 0},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_stored stored;
        test_row("%s", rows[i].more);
        write_cell((stored_cell){.id = "c", .rows = ROWS, .more = rows[i].more});
        assert_int_equal(mote_stored_read(".", NULL, &stored), MOTE_OK);
        assert_int_equal(stored.cells[0].bodies, rows[i].bodies);
        const mote_summary_row row = mote_summary_row_make(stored.cells, 1);
        assert_int_equal(row.shapes, rows[i].shapes);
        mote_summary_row_free((mote_summary_row[]){row});
        mote_stored_free(&stored);
    }
}
