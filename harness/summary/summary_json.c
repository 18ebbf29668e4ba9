#include "harness/summary/summary_json.h"

#include "harness/base/record.h"
#include "harness/summary/column.h"
#include "harness/summary/front.h"
#include "harness/summary/table.h"

#include <string.h>

/* A new reference to the value of a column; NULL where there is none. */
static json_t *value_json(const mote_column *column, const mote_summary *summary,
                          const mote_summary_row *row)
{
    if (column->json)
        return column->json(row);
    if (column->stored)
        return json_incref(json_object_get(row->first->json, column->key));
    if (column->type == MOTE_COLUMN_TEXT) {
        const char *text = mote_column_text(column, summary, row);
        return text ? json_string(text) : NULL;
    }
    const double value = mote_column_number(column, row);
    if (value != value)
        return NULL;
    if (column->type == MOTE_COLUMN_FLAG)
        return json_boolean(value != 0);
    return column->type == MOTE_COLUMN_WHOLE ? json_integer((json_int_t)value)
                                             : mote_json_number(value);
}

/* The object of a row that a column stands in. */
static json_t *object_of(json_t *row, const mote_column *column)
{
    if (!column->object)
        return row;
    json_t *object = json_object_get(row, column->object);
    if (!object && json_object_set_new(row, column->object, json_object()) == 0)
        object = json_object_get(row, column->object);
    return object;
}

json_t *mote_summary_row_json(const mote_summary *summary, const mote_summary_row *row)
{
    json_t *object = json_object();
    for (size_t i = 0; object && i < mote_column_count; ++i) {
        const mote_column *column = &mote_columns[i];
        json_t *value = value_json(column, summary, row);
        /* An object that begins with an optional member is null without it: there is nothing
           that it would be of. */
        const bool null_object = column->object && column->optional && !value;
        const bool null_already =
            column->object && json_is_null(json_object_get(object, column->object));
        if (null_object)
            (void)json_object_set_new(object, column->object, json_null());
        else if (null_already)
            json_decref(value);
        else if (value || !column->optional)
            (void)json_object_set_new(object_of(object, column), column->key,
                                      value ? value : json_null());
    }
    return object;
}

static json_t *summary_json(const mote_summary *summary, const mote_fronts *fronts)
{
    json_t *rows = json_array();
    for (size_t i = 0; rows && i < summary->count; ++i) {
        if (json_array_append_new(rows, mote_summary_row_json(summary, &summary->rows[i])) !=
            0) {
            json_decref(rows);
            rows = NULL;
        }
    }
    if (!rows)
        return NULL;
    json_t *overhead =
        json_pack("{s:o, s:o, s:o}", "clock_ns", mote_json_number(summary->overhead.clock_ns),
                  "left_ns", mote_json_number(summary->overhead.left_ns), "share",
                  mote_json_number(summary->overhead.share));
    return json_pack("{s:i, s:i, s:o, s:o, s:o, s:o, s:o}", "schema", 1, "cells_left_out",
                     (int)summary->stored.left_out, "noise_floor",
                     mote_json_number(summary->noise_floor), "smallest_change",
                     mote_json_number(summary->smallest_change), "overhead", overhead, "rows",
                     rows, "fronts", mote_fronts_json(fronts));
}

json_t *mote_summary_json(const mote_summary *summary)
{
    mote_fronts fronts = mote_fronts_make(summary);
    json_t *object = summary_json(summary, &fronts);
    mote_fronts_free(&fronts);
    return object;
}

mote_status mote_summary_write(const mote_summary *summary, const char *directory)
{
    mote_fronts fronts = mote_fronts_make(summary);
    mote_text csv = {0};
    mote_table_csv(summary, &csv);
    mote_status status = mote_record_text(directory, "summary.csv", &csv);
    if (status == MOTE_OK)
        status = mote_fronts_write(&fronts, directory);
    if (status == MOTE_OK)
        status = mote_record_json(directory, "summary.json", summary_json(summary, &fronts));
    mote_fronts_free(&fronts);
    return status;
}
