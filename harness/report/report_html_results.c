/* The page's tables: results, each number linked to its cells, and the cells themselves. */
#include "harness/base/escape.h"
#include "harness/report/report_html.h"
#include "harness/report/report_rows.h"

#include <stdio.h>
#include <string.h>

/* The link of a row's numbers: its line in the table of cells, or the file of the summary. */
static void add_row_link(const mote_report *report, size_t i, mote_text *text)
{
    if (report->has_cells)
        mote_text_add(text, "#cells-%zu", i + 1);
    else
        mote_text_add(text, "summary.json");
}

/* "us" as the sign for micro; a narrow blank before the unit. */
static void add_number(mote_text *text, const char *shown)
{
    const char *blank = strchr(shown, ' ');
    if (!blank) {
        mote_text_add(text, "%s", strcmp(shown, "-") == 0 ? "–" : shown);
        return;
    }
    mote_text_add(text, "%.*s\u202f%s", (int)(blank - shown), shown,
                  strcmp(blank + 1, "us") == 0 ? "µs" : blank + 1);
}

/* "11.5 – 11.6 µs": the unit once where both have the same. */
static void add_interval(const json_t *row, const mote_report_column *column, mote_text *text)
{
    char low_text[MOTE_NUMBER_TEXT], high_text[MOTE_NUMBER_TEXT];
    const double low = mote_report_number(row, column->object, "ci_low");
    const double high = mote_report_number(row, column->object, "ci_high");
    const double value = mote_report_number(row, column->object, column->key);
    if (low != low || high != high || value == 0)
        return;
    const char *from = column->show(low, low_text);
    const char *to = column->show(high, high_text);
    const char *unit = strchr(from, ' '), *other = strchr(to, ' ');
    mote_text_add(text, "<small>");
    if (unit && other && strcmp(unit, other) == 0)
        mote_text_add(text, "%.*s", (int)(unit - from), from);
    else
        add_number(text, from);
    mote_text_add(text, " – ");
    add_number(text, to);
    mote_text_add(text, "</small>");
}

static void add_value(const mote_report *report, size_t i, const mote_report_column *column,
                      mote_text *text)
{
    char shown[MOTE_NUMBER_TEXT];
    const json_t *row = mote_report_row(report, i);
    const double value = mote_report_number(row, column->object, column->key);
    if (value != value) {
        mote_text_add(text, "<td>–</td>");
        return;
    }
    bool wrong = value > 0 && !column->object && strcmp(column->group, "contacts") == 0;
    mote_text_add(text, "<td%s><a tabindex=\"-1\" href=\"", wrong ? " class=\"wrong\"" : "");
    add_row_link(report, i, text);
    mote_text_add(text, "\">");
    add_number(text, column->show(value, shown));
    mote_text_add(text, "</a>");
    if (column->interval)
        add_interval(row, column, text);
    mote_text_add(text, "</td>");
}

static void add_notes(const json_t *row, mote_text *text)
{
    char note[MOTE_REPORT_NOTE];
    for (size_t i = 0; i < MOTE_REPORT_NOTES; ++i) {
        if (mote_report_note(row, i, note))
            mote_text_add(text, "<small>%s</small>", note);
    }
}

static void add_row(const mote_report *report, size_t i, mote_text *text)
{
    const json_t *row = mote_report_row(report, i);
    const char *status = mote_report_text(row, "status");
    mote_text_add(text, "<tr><th scope=\"row\"><a href=\"");
    add_row_link(report, i, text);
    mote_text_add(text, "\">");
    mote_escape_html(text, mote_report_text(row, "label"));
    mote_text_add(text, "</a>");
    add_notes(row, text);
    mote_text_add(text, "</th>");
    if (strcmp(status, "ok") == 0) {
        for (size_t k = 0; k < mote_report_column_count; ++k)
            add_value(report, i, &mote_report_columns[k], text);
    } else {
        mote_text_add(text, "<td class=\"ended\" colspan=\"%zu\">", mote_report_column_count);
        mote_escape_html(text, status);
        mote_text_add(text, ": ");
        mote_escape_html(text, mote_report_text(row, "reason"));
        mote_text_add(text, "</td>");
    }
    mote_text_add(text, "</tr>\n");
}

/* Two lines: what belongs together, and the columns. */
static void add_head(mote_text *text)
{
    mote_text_add(text, "<thead><tr><th rowspan=\"2\" scope=\"col\">method</th>");
    for (size_t k = 0; k < mote_report_column_count;) {
        size_t next = k;
        while (next < mote_report_column_count &&
               strcmp(mote_report_columns[next].group, mote_report_columns[k].group) == 0)
            ++next;
        mote_text_add(text, "<th colspan=\"%zu\" scope=\"colgroup\">%s</th>", next - k,
                      mote_report_columns[k].group);
        k = next;
    }
    mote_text_add(text, "</tr>\n<tr>");
    for (size_t k = 0; k < mote_report_column_count; ++k)
        mote_text_add(text, "<th scope=\"col\" title=\"%s\">%s</th>",
                      mote_report_columns[k].meaning, mote_report_columns[k].head);
    mote_text_add(text, "</tr></thead>\n");
}

/* A number of a row within a sentence, linked. */
static void add_linked(const mote_report *report, size_t i, const char *object, const char *key,
                       mote_number_show show, mote_text *text)
{
    char shown[MOTE_NUMBER_TEXT];
    mote_text_add(text, "<a href=\"");
    add_row_link(report, i, text);
    mote_text_add(text, "\">");
    add_number(text, show(mote_report_number(mote_report_row(report, i), object, key), shown));
    mote_text_add(text, "</a>");
}

static void add_label(const json_t *row, mote_text *text)
{
    mote_text_add(text, "<code>");
    mote_escape_html(text, mote_report_text(row, "label"));
    mote_text_add(text, "</code>");
}

static void add_right(const mote_report *report, size_t i, mote_text *text)
{
    const json_t *row = mote_report_row(report, i);
    const char *best = mote_report_text(json_object_get(row, "ratio_best"), "to");
    mote_text_add(text, "Fastest without a wrong answer in any frame: ");
    add_label(row, text);
    mote_text_add(text, ", ");
    add_linked(report, i, "total_ns", "median", mote_show_time, text);
    mote_text_add(text, " a query");
    if (best[0] && strcmp(best, mote_report_text(row, "label")) != 0) {
        mote_text_add(text, "; the best FCL, <code>");
        mote_escape_html(text, best);
        mote_text_add(text, "</code>, takes ");
        add_linked(report, i, "ratio_best", "value", mote_show_ratio, text);
        mote_text_add(text, " times as long");
    }
    mote_text_add(text, ". ");
}

static void add_fastest(const mote_report *report, size_t i, mote_text *text)
{
    const json_t *row = mote_report_row(report, i);
    mote_text_add(text, "Fastest of all: ");
    add_label(row, text);
    mote_text_add(text, ", ");
    add_linked(report, i, "total_ns", "median", mote_show_time, text);
    if (mote_report_number(row, "error", "p99") >= 0) {
        mote_text_add(text, ", with an error of ");
        add_linked(report, i, "error", "p99", mote_show_count, text);
        mote_text_add(text, "\u202fL at the 99th percentile");
    }
    mote_text_add(text, "; ");
    add_linked(report, i, NULL, "missed", mote_show_count, text);
    mote_text_add(text, " contacts missed, ");
    add_linked(report, i, NULL, "false_contacts", mote_show_count, text);
    mote_text_add(text, " false.");
}

static void add_caption(const mote_report *report, size_t first, size_t end, mote_text *text)
{
    const json_t *row = mote_report_row(report, first);
    const json_t *triangles = json_object_get(row, "triangles");
    char shown[3][MOTE_NUMBER_TEXT];
    double frames = 0, replicates = 0;
    for (size_t i = first; i < end; ++i) {
        const json_t *other = mote_report_row(report, i);
        const double f = mote_report_number(other, NULL, "frames");
        const double r = mote_report_number(other, NULL, "replicates");
        frames = f > frames ? f : frames;
        replicates = r > replicates ? r : replicates;
    }
    mote_text_add(text, "<h3>");
    mote_escape_html(text, mote_report_text(row, "scenario"));
    mote_text_add(text,
                  " <span class=\"aside\">%s and %s triangles, %s frames, %.0f "
                  "replicate%s, caches ",
                  mote_show_whole(json_number_value(json_array_get(triangles, 0)), shown[0]),
                  mote_show_whole(json_number_value(json_array_get(triangles, 1)), shown[1]),
                  mote_show_whole(frames, shown[2]), replicates, replicates == 1 ? "" : "s");
    mote_escape_html(text, mote_report_text(row, "cache"));
    if (report->has_cells && mote_summary_machines_differ(&report->cells)) {
        mote_text_add(text, ", on ");
        mote_escape_html(text, mote_report_text(row, "machine"));
    }
    mote_text_add(text, "</span></h3>\n");
}

static void add_block(const mote_report *report, size_t first, size_t end, mote_text *text)
{
    const mote_report_glance glance = mote_report_block_glance(report, first, end);
    add_caption(report, first, end, text);
    mote_text_add(text, "<p>");
    if (glance.right != SIZE_MAX)
        add_right(report, glance.right, text);
    if (glance.fastest != SIZE_MAX)
        add_fastest(report, glance.fastest, text);
    mote_text_add(text, "</p>\n<div class=\"wide\" tabindex=\"0\" role=\"region\" "
                        "aria-label=\"Results, ");
    mote_escape_html(text, mote_report_text(mote_report_row(report, first), "scenario"));
    mote_text_add(text, "\"><table>\n");
    add_head(text);
    mote_text_add(text, "<tbody>\n");
    for (size_t i = first; i < end; ++i)
        add_row(report, i, text);
    mote_text_add(text, "</tbody></table></div>\n");
}

void mote_report_html_results(const mote_report *report, mote_text *text)
{
    const size_t count = mote_report_row_count(report);
    if (count == 0)
        return;
    mote_report_html_section(text, "results", "Results");
    mote_text_add(text,
                  "<p>A row a configuration; times are medians over frames and replicates, "
                  "with 95\u202f%% intervals below. Every number links to the cells it was "
                  "computed from.");
    const double floor = mote_report_number(report->summary, NULL, "noise_floor");
    if (floor == floor)
        mote_text_add(text,
                      " Rows differ from themselves by up to <a "
                      "href=\"summary.json\">%.1f\u202f%%</a> (the noise floor of this run).",
                      100 * floor);
    mote_text_add(text, "</p>\n");
    for (size_t first = 0; first < count;) {
        size_t end = mote_report_block_end(report, first);
        add_block(report, first, end, text);
        first = end;
    }
    mote_text_add(text, "</section>\n");
}

static void add_cell(const mote_stored_cell *cell, mote_text *text)
{
    mote_text_add(text, "<li>%u: <a href=\"cells/", cell->replicate);
    mote_escape_path(text, cell->id);
    mote_text_add(text, ".json\">json</a>");
    if (cell->status == MOTE_CELL_OK) {
        mote_text_add(text, " <a href=\"cells/");
        mote_escape_path(text, cell->id);
        mote_text_add(text, ".csv\">csv</a>");
    } else {
        mote_text_add(text, " %s", mote_cell_status_names[cell->status]);
    }
    mote_text_add(text, "</li>");
}

void mote_report_html_cells(const mote_report *report, mote_text *text)
{
    if (!report->has_cells)
        return;
    mote_report_html_section(text, "cells", "Raw cells");
    mote_text_add(text, "<p>A cell is one process: <em>json</em> says what was measured, "
                        "<em>csv</em> has a row a frame. The numbers stand for the "
                        "replicates.</p>\n<div class=\"wide\" tabindex=\"0\" role=\"region\" "
                        "aria-label=\"Raw cells\"><table class=\"cells\"><thead><tr>"
                        "<th scope=\"col\">method</th><th scope=\"col\">scenario</th>"
                        "<th scope=\"col\">caches</th><th scope=\"col\">cells</th></tr>"
                        "</thead><tbody>\n");
    for (size_t i = 0; i < report->cells.count; ++i) {
        const mote_summary_row *row = &report->cells.rows[i];
        mote_text_add(text, "<tr id=\"cells-%zu\"><th scope=\"row\">", i + 1);
        mote_escape_html(text, row->label);
        mote_text_add(text, "</th><td>");
        mote_escape_html(text, row->first->scenario);
        mote_text_add(text, "</td><td>");
        mote_escape_html(text, row->first->cache);
        mote_text_add(text, "</td><td><ul>");
        for (size_t r = 0; r < row->replicates; ++r)
            add_cell(&row->cells[r], text);
        mote_text_add(text, "</ul></td></tr>\n");
    }
    mote_text_add(text, "</tbody></table></div></section>\n");
}
