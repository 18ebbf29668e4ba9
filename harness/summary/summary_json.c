#include "harness/summary/summary_json.h"

#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/summary/column.h"
#include "harness/summary/front.h"
#include "harness/summary/table.h"

#include <string.h>

/* The object of a row that contains a column. */
static json_t *object_of(json_t *row, const mote_column *column)
{
    if (!column->object)
        return row;
    if (!json_object_get(row, column->object))
        (void)json_object_set_new(row, column->object, json_object());
    return json_object_get(row, column->object);
}

json_t *mote_summary_row_json(const mote_summary_row *row)
{
    json_t *object = json_object();
    for (size_t i = 0; i < mote_column_count; ++i) {
        const mote_column *column = &mote_columns[i];
        if (column->of_scenes && row->bodies == 0)
            continue;
        json_t *value = mote_column_write(column, row);
        /* An object that begins with an optional member is null without it. */
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
    for (size_t i = 0; i < summary->count; ++i)
        (void)json_array_append_new(rows, mote_summary_row_json(&summary->rows[i]));
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

static const json_t *value_in(const json_t *row, const mote_column *column)
{
    return json_object_get(column->object ? json_object_get(row, column->object) : row,
                           column->key);
}

/* Derives members from others of the row. */
static void complete_row(mote_summary_row *row)
{
    row->given = strcmp(row->accounting, "given") == 0;
    row->status = 0;
    while (row->status < MOTE_CELL_STATUSES &&
           strcmp(row->ending, mote_cell_status_names[row->status]) != 0)
        ++row->status;
    if (row->scene[0] == '\0') /* older builds */
        row->scene = (char *)(uintptr_t)row->scenario;
}

/* The row with a label in the scene of another row, possibly that row itself. */
static const mote_summary_row *row_labelled(const mote_summary *summary, const char *label,
                                            const mote_summary_row *row)
{
    if (strcmp(row->label, label) == 0)
        return row;
    for (size_t i = 0; i < summary->count; ++i) {
        if (strcmp(summary->rows[i].label, label) == 0 &&
            mote_summary_by_scene(&summary->rows[i], row) == 0)
            return &summary->rows[i];
    }
    return NULL;
}

/* Resolves the rows that the columns of a row name. */
static void link_row(const mote_summary *summary, const json_t *object, mote_summary_row *row)
{
    for (size_t i = 0; i < mote_column_count; ++i) {
        const char *label = json_string_value(value_in(object, &mote_columns[i]));
        if (mote_columns[i].type != MOTE_COLUMN_ROW || !label)
            continue;
        const mote_summary_row *other = row_labelled(summary, label, row);
        memcpy((char *)row + mote_columns[i].offset, &other, sizeof(const mote_summary_row *));
    }
}

static void read_rows(const json_t *rows, mote_summary *summary)
{
    summary->rows = mote_allocate(json_array_size(rows), sizeof *summary->rows);
    for (; summary->count < json_array_size(rows); ++summary->count) {
        mote_summary_row *row = &summary->rows[summary->count];
        for (size_t i = 0; i < mote_column_count; ++i)
            mote_column_read(&mote_columns[i],
                             value_in(json_array_get(rows, summary->count), &mote_columns[i]),
                             row);
        complete_row(row);
    }
    for (size_t i = 0; i < summary->count; ++i)
        link_row(summary, json_array_get(rows, i), &summary->rows[i]);
}

mote_status mote_summary_read(const char *directory, const char *name, mote_summary *summary)
{
    mote_summary made = {0};
    const mote_status status = mote_record_read_json(directory, name, &made.document);
    if (status != MOTE_OK)
        return status;
    const json_t *rows = json_object_get(made.document, "rows");
    if (!json_is_array(rows)) {
        json_decref(made.document);
        return mote_fail(MOTE_EINVAL, "%s/%s: no rows; name a run, or its summary.json",
                         directory, name);
    }
    made.noise_floor = mote_number_at(made.document, "noise_floor");
    made.smallest_change = mote_number_at(made.document, "smallest_change");
    const json_t *overhead = json_object_get(made.document, "overhead");
    made.overhead = (mote_overhead){.clock_ns = mote_number_at(overhead, "clock_ns"),
                                    .left_ns = mote_number_at(overhead, "left_ns"),
                                    .share = mote_number_at(overhead, "share")};
    read_rows(rows, &made);
    *summary = made;
    return MOTE_OK;
}
