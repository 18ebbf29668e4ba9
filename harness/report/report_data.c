#include "harness/report/report_data.h"

#include "harness/base/record.h"
#include "harness/report/packed.h"
#include "harness/report/report_facts.h"
#include "harness/report/report_rows.h"
#include "harness/summary/column_docs.h"
#include "harness/summary/summary_json.h"
#include "harness/summary/table.h"

#include <stdlib.h>
#include <string.h>

#define FIGURE_LIMIT ((size_t)64 << 20)

/* A value that is not UTF-8 is NULL, and is omitted. */
static void set(json_t *object, const char *key, json_t *value)
{
    (void)json_object_set_new(object, key, value);
}

static void append(json_t *array, json_t *value)
{
    (void)json_array_append_new(array, value);
}

static json_t *index_or_null(size_t index)
{
    return index == SIZE_MAX ? json_null() : json_integer((json_int_t)index);
}

/* A column's meaning, or that of the first member of its object. */
static const char *meaning_of(const mote_column *column)
{
    while (!column->meaning)
        --column;
    return column->meaning;
}

/* A column; `extra` if neither report.md nor the screen of `make bench` has it. */
static json_t *column_data(const mote_column *column)
{
    json_t *data = mote_column_json(column);
    json_t *path = json_array();
    if (column->object)
        append(path, json_string(column->object));
    append(path, json_string(column->key));
    set(data, "path", path);
    set(data, "meaning", json_string(meaning_of(column)));
    set(data, "extra", json_boolean(!column->brief && !column->place[MOTE_VIEW_SCREEN]));
    return data;
}

static json_t *notes_data(const mote_summary_row *row)
{
    json_t *notes = json_array();
    char note[MOTE_ROW_NOTE];
    for (int i = 0; i < MOTE_ROW_NOTES; ++i) {
        if (mote_table_note(row, i, note))
            append(notes, json_string(note));
    }
    return notes;
}

static json_t *cells_data(const mote_summary_row *row)
{
    json_t *cells = json_array();
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        append(cells, json_pack("[i, s, s]", (int)cell->replicate, cell->id,
                                mote_cell_status_names[cell->status]));
    }
    return cells;
}

/* A row of the summary, without members that no table of the page shows. */
static json_t *row_data(const mote_summary_row *row)
{
    static const char *const unused[] = {"processes",   "quiet", "counters",
                                         "fingerprint", "faces", "least_ns"};
    json_t *data = mote_summary_row_json(row);
    for (size_t k = 0; k < sizeof unused / sizeof unused[0]; ++k)
        (void)json_object_del(data, unused[k]);
    set(data, "right", json_boolean(mote_summary_row_right(row)));
    set(data, "contacts_right", json_boolean(mote_summary_contacts_right(row)));
    set(data, "notes", notes_data(row));
    set(data, "cells", cells_data(row));
    return data;
}

/* Whether any scene is asked for impacts: else their columns would be empty. */
static bool asks_impacts(const mote_summary *summary)
{
    bool asks = false;
    for (size_t i = 0; i < summary->count; ++i)
        asks = asks || summary->rows[i].step > 0;
    return asks;
}

void mote_report_rows_data(const mote_report *report, json_t *data)
{
    json_t *columns = json_array(), *blocks = json_array(), *rows = json_array();
    const mote_column *shown[MOTE_VIEW_MAX];
    const size_t count = mote_column_view(MOTE_VIEW_REPORT, shown);
    const bool impacts = asks_impacts(&report->summary);
    for (size_t k = 0; k < count; ++k) {
        if (impacts || !shown[k]->object || strcmp(shown[k]->object, "impact") != 0)
            append(columns, column_data(shown[k]));
    }
    for (size_t first = 0; first < report->summary.count;) {
        const size_t end = mote_report_block_end(report, first);
        const mote_report_glance glance = mote_report_block_glance(report, first, end);
        char *heading = mote_table_heading(&report->summary, first);
        append(blocks, json_pack("{s:s, s:I, s:I, s:o, s:o}", "heading", heading, "first",
                                 (json_int_t)first, "end", (json_int_t)end, "right",
                                 index_or_null(glance.right), "fastest",
                                 index_or_null(glance.fastest)));
        free(heading);
        for (size_t i = first; i < end; ++i)
            append(rows, row_data(mote_report_row(report, i)));
        first = end;
    }
    set(data, "columns", columns);
    set(data, "time", column_data(mote_column_find("total_ns", "median")));
    set(data, "error", column_data(mote_column_find("error", "p99")));
    set(data, "best", column_data(mote_column_find("ratio_best", "value")));
    set(data, "engine", column_data(mote_column_find("ratio_engine", "value")));
    set(data, "ratio", column_data(mote_column_find("ratio", "value")));
    set(data, "memory", column_data(mote_column_find(NULL, "heap_peak_bytes")));
    set(data, "blocks", blocks);
    set(data, "rows", rows);
    const double floor = report->summary.noise_floor;
    if (floor == floor && report->has_summary)
        set(data, "noise_floor", json_real(floor));
}

/* Sets the drawing of a figure, packed; an animation is linked instead. */
static mote_status set_drawing(const mote_report *report, const mote_report_figure *figure,
                               json_t *data)
{
    char *path = mote_format("%s/%s", report->directory, figure->file);
    char *svg = NULL;
    size_t size = 0;
    mote_text packed = {0};
    const mote_status status = mote_file_read(path, FIGURE_LIMIT, &svg, &size);
    if (status == MOTE_OK) {
        mote_packed_add(&packed, svg, size);
        set(data, "drawing", json_string(packed.data));
    }
    free(packed.data);
    free(svg);
    free(path);
    return status;
}

static mote_status set_figures(const mote_report *report, json_t *data)
{
    json_t *figures = json_array();
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < report->figure_count && status == MOTE_OK; ++i) {
        const mote_report_figure *figure = &report->figures[i];
        json_t *entry =
            json_pack("{s:s, s:s, s:s, s:b}", "file", figure->file, "title", figure->title,
                      "caption", figure->caption, "animation", figure->animation);
        if (!figure->animation)
            status = set_drawing(report, figure, entry);
        append(figures, entry);
    }
    set(data, "figures", figures);
    return status;
}

mote_status mote_report_data(const mote_report *report, json_t **data)
{
    json_t *made = json_object();
    set(made, "scenarios", mote_report_scenarios(report));
    set(made, "commands", mote_report_commands(report));
    set(made, "machine", mote_report_machine(report));
    (void)json_object_set(made, "damaged", report->damaged);
    (void)json_object_set(made, "missing", report->missing);
    mote_report_rows_data(report, made);
    if (report->simulations.count > 0) {
        json_t *simulations = mote_simulations_json(&report->simulations);
        (void)json_object_set(made, "simulations", json_object_get(simulations, "rows"));
        json_decref(simulations);
    }
    if (json_is_array(report->claims))
        (void)json_object_set(made, "claims", report->claims);
    if (json_is_array(report->requirements))
        (void)json_object_set(made, "requirements", report->requirements);
    if (report->claims_folder)
        set(made, "claims_folder", json_string(report->claims_folder));
    if (report->defects)
        set(made, "defects", json_string(report->defects));
    const mote_status status = set_figures(report, made);
    if (status == MOTE_OK)
        *data = made;
    else
        json_decref(made);
    return status;
}
