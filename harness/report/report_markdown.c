/* The report as text that reads well in a terminal, and as Markdown on a forge: numbers are in
   tables, with links to the cells they were computed from at the end of each row. */
#include "harness/base/escape.h"
#include "harness/base/record.h"
#include "harness/report/report_facts.h"
#include "harness/report/report_rows.h"
#include "harness/summary/column.h"
#include "harness/summary/dominance.h"
#include "harness/summary/table.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char *pair_text(const json_t *pair, size_t index)
{
    return json_string_value(json_array_get(pair, index));
}

/* "- key: value" for each pair. */
static void add_pairs(json_t *pairs, mote_text *text)
{
    size_t i;
    const json_t *pair;
    MOTE_EACH(i, pair, pairs)
    {
        mote_text_add(text, "- ");
        mote_escape_markdown(text, pair_text(pair, 0));
        mote_text_add(text, ": ");
        mote_escape_markdown(text, pair_text(pair, 1));
        mote_text_add(text, "\n");
    }
    json_decref(pairs);
}

static void add_commands(const mote_report *report, mote_text *text)
{
    size_t i;
    const json_t *pair;
    json_t *commands = mote_report_commands(report);
    if (json_array_size(commands) > 0)
        mote_text_add(text, "\nMeasured by\n");
    MOTE_EACH(i, pair, commands)
    {
        mote_text_add(text, "\n1. ");
        mote_escape_markdown(text, pair_text(pair, 1));
        mote_text_add(text, " (");
        mote_escape_markdown(text, pair_text(pair, 0));
        mote_text_add(text, ")");
    }
    mote_text_add(text, "%s", json_array_size(commands) > 0 ? "\n" : "");
    json_decref(commands);
}

/* Unreadable files come first, since the tables lack them. */
static void add_damaged(const mote_report *report, mote_text *text)
{
    size_t i;
    const json_t *what;
    if (json_array_size(report->damaged) == 0)
        return;
    mote_text_add(text, "\n## Not readable, and so not in this report\n\n");
    MOTE_EACH(i, what, report->damaged)
    {
        mote_text_add(text, "- ");
        mote_escape_markdown(text, json_string_value(what));
        mote_text_add(text, "\n");
    }
}

/* Missing files take one line, after everything else. */
static void add_missing(const mote_report *report, mote_text *text)
{
    size_t i;
    const json_t *what;
    if (json_array_size(report->missing) == 0)
        return;
    mote_text_add(text, "\nNot in this report: ");
    MOTE_EACH(i, what, report->missing)
    {
        mote_text_add(text, "%s", i > 0 ? "; " : "");
        mote_escape_markdown(text, json_string_value(what));
    }
    mote_text_add(text, ".\n");
}

/* Adds the known defects under a heading of level 2: every heading one level lower, without the
   title. */
static void add_defects(const char *markdown, mote_text *text)
{
    bool first = true;
    while (*markdown) {
        size_t length = strcspn(markdown, "\n");
        bool title = markdown[0] == '#' && markdown[1] != '#';
        if (!title && (length > 0 || !first)) {
            mote_text_add(text, "%s%.*s\n", markdown[0] == '#' ? "#" : "", (int)length,
                          markdown);
            first = false;
        }
        markdown += length + (markdown[length] ? 1 : 0);
    }
}

/* Adds a cell of a table, padded on its left to the width, or on its right if width is
   negative. */
static void add_field(mote_text *text, const char *value, int width)
{
    mote_text_add(text, " %*s |", width, value);
}

#define FIELD_WIDTH 9

/* The width of the first column of a block, in bytes. */
static int label_width(const mote_report *report, size_t first, size_t end)
{
    size_t width = strlen("method");
    for (size_t i = first; i < end; ++i) {
        size_t length = strlen(mote_report_row(report, i)->label);
        width = length > width ? length : width;
    }
    return (int)width;
}

/* Adds the line below the heads: as wide as the fields, with a colon on the side of
   alignment. */
static void add_rule(mote_text *text, int width, bool right)
{
    mote_text_add(text, right ? "-" : ":");
    for (int k = 0; k < width; ++k)
        mote_text_add(text, "-");
    mote_text_add(text, right ? ":|" : "-|");
}

/* The columns of the plain text: those with a brief head. */
static size_t brief_columns(const mote_column *columns[MOTE_VIEW_MAX])
{
    size_t count = 0;
    const size_t all = mote_column_view(MOTE_VIEW_REPORT, columns);
    for (size_t k = 0; k < all; ++k) {
        if (columns[k]->brief)
            columns[count++] = columns[k];
    }
    return count;
}

static void add_head(int width, mote_text *text)
{
    const mote_column *columns[MOTE_VIEW_MAX];
    const size_t count = brief_columns(columns);
    mote_text_add(text, "|");
    add_field(text, "method", -width);
    for (size_t k = 0; k < count; ++k)
        add_field(text, columns[k]->brief, FIELD_WIDTH);
    mote_text_add(text, " cells |\n|");
    add_rule(text, width, false);
    for (size_t k = 0; k < count; ++k)
        add_rule(text, FIELD_WIDTH, true);
    mote_text_add(text, ":------|\n");
}

/* "[1][c3-1] [2][c3-2]": the cells of row i. */
static void add_cell_links(const mote_summary_row *row, size_t i, mote_text *text)
{
    if (!row->cells) {
        mote_text_add(text, " [summary](summary.json)");
        return;
    }
    for (size_t r = 0; r < row->replicates; ++r)
        mote_text_add(text, " [%u][c%zu-%u]", row->cells[r].replicate, i + 1,
                      row->cells[r].replicate);
}

/* Adds the notes of a row, after its cells. */
static void add_notes(const mote_summary_row *row, mote_text *text)
{
    char note[MOTE_ROW_NOTE];
    for (int i = 0; i < MOTE_ROW_NOTES; ++i) {
        if (mote_table_note(row, i, note))
            mote_text_add(text, "; %s", note);
    }
    mote_text_add(text, " |");
}

/* Adds why a row has no values, in place of the first of them. */
static void add_ending(const mote_summary_row *row, size_t columns, mote_text *text)
{
    mote_text_add(text, " ");
    mote_escape_markdown(text, row->ending);
    mote_text_add(text, ": ");
    mote_escape_markdown(text, row->reason);
    for (size_t k = 0; k < columns; ++k)
        mote_text_add(text, " |");
}

static void add_row(const mote_report *report, size_t i, int width, mote_text *text)
{
    const mote_column *columns[MOTE_VIEW_MAX];
    const size_t count = brief_columns(columns);
    const mote_summary_row *row = mote_report_row(report, i);
    const char *label = row->label;
    const bool ok = row->status == MOTE_CELL_OK;
    char value[MOTE_NUMBER_TEXT];
    mote_text_add(text, "| ");
    mote_escape_markdown(text, label);
    mote_text_add(text, "%*s |", width - (int)strlen(label), "");
    for (size_t k = 0; ok && k < count; ++k)
        add_field(text, columns[k]->show(mote_column_number(columns[k], row), value),
                  FIELD_WIDTH);
    if (!ok)
        add_ending(row, count, text);
    add_cell_links(row, i, text);
    add_notes(row, text);
    mote_text_add(text, "\n");
}

/* Adds a table of the block's rows of one accounting: those that stand for their method, or
   all; nothing if there are none. */
static void add_table(const mote_report *report, size_t first, size_t end, bool all, bool given,
                      mote_text *text)
{
    const int width = label_width(report, first, end);
    bool begun = false;
    for (size_t i = first; i < end; ++i) {
        const mote_summary_row *row = mote_report_row(report, i);
        if (row->given != given || (!all && !row->stands_for_method))
            continue;
        if (!begun && given)
            mote_text_add(text, "\nWith positions given, where no method is charged for "
                                "deformation, FCL neither:\n\n");
        if (!begun)
            add_head(width, text);
        begun = true;
        add_row(report, i, width, text);
    }
}

/* Adds the rows charged for deformation, then those with given positions. */
static void add_tables(const mote_report *report, size_t first, size_t end, bool all,
                       mote_text *text)
{
    add_table(report, first, end, all, false, text);
    add_table(report, first, end, all, true, text);
}

static bool all_stand(const mote_report *report, size_t first, size_t end)
{
    size_t i = first;
    while (i < end && mote_report_row(report, i)->stands_for_method)
        ++i;
    return i == end;
}

static void add_block(const mote_report *report, size_t first, size_t end, mote_text *text)
{
    const mote_summary_row *row = mote_report_row(report, first);
    char *heading = mote_table_heading(&report->summary, first);
    mote_text_add(text, "\n### ");
    mote_escape_markdown(text, row->scene);
    mote_text_add(text, ": ");
    mote_escape_markdown(text, heading);
    mote_text_add(text, "\n\n");
    free(heading);
    add_tables(report, first, end, false, text);
    if (all_stand(report, first, end))
        return;
    mote_text_add(text, "\nAll configurations:\n\n");
    add_tables(report, first, end, true, text);
}

static void add_results(const mote_report *report, mote_text *text)
{
    const size_t count = report->summary.count;
    if (count == 0)
        return;
    mote_text_add(
        text,
        "\n## Results\n\nThe first table of a scenario has one row a method: its fastest "
        "configuration without a wrong\ncontact and with a p99 error of at most %g L, or else "
        "its most accurate one. Times are medians over\nframes and replicates of deformation, "
        "refit and query together; rows are sorted by them. `FCL/this`,\n`best FCL/this` and "
        "`best engine/this`: how many times slower FCL's AABB tree, FCL's "
        "fastest\nconfiguration "
        "and the fastest engine of others without a wrong answer are. Errors are "
        "absolute,\nover "
        "L. The numbers in the last column link to the cells that a row was computed from. "
        "Intervals,\nmeans, worst frames and more are in [report.html](report.html) and "
        "[summary.json](summary.json).\n",
        MOTE_CLOSE_ERROR);
    for (size_t first = 0; first < count;) {
        size_t end = mote_report_block_end(report, first);
        add_block(report, first, end, text);
        first = end;
    }
}

/* A row a method; the figures of simulations.json that say whether bodies passed through each
   other. */
static void add_simulations(const mote_report *report, mote_text *text)
{
    if (report->simulations.count == 0)
        return;
    mote_text_add(
        text,
        "\n## Simulations\n\nBodies that move freely and collide where the method "
        "reports a contact. All figures are in\n[simulations.json](simulations.json)."
        "\n\n| scenario | method | replicates | us a step | approaches | passes through "
        "| missed steps | penetration / L |\n|:---|:---|---:|---:|---:|---:|---:|---:|\n");
    for (size_t i = 0; i < report->simulations.count; ++i) {
        const mote_simulations_row *row = &report->simulations.rows[i];
        mote_text_add(text, "| ");
        mote_escape_markdown(text, row->scenario);
        mote_text_add(text, " | ");
        mote_escape_markdown(text, row->method);
        if (row->done > 0)
            mote_text_add(text,
                          " | %u | %.3g | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " | %.2g |\n",
                          row->done, row->query_ns / 1e3, row->sum.approaches, row->sum.passes,
                          row->sum.missed_steps, row->sum.depth_max);
        else
            mote_text_add(text, " | 0 | %s | | | | |\n",
                          row->unsupported ? "unsupported" : "failed");
    }
}

static void add_figures(const mote_report *report, mote_text *text)
{
    if (report->figure_count == 0)
        return;
    mote_text_add(text, "\n## Figures\n");
    for (size_t i = 0; i < report->figure_count; ++i) {
        const mote_report_figure *figure = &report->figures[i];
        mote_text_add(text, "\n![");
        mote_escape_markdown(text, figure->title);
        mote_text_add(text, "](");
        mote_escape_path(text, figure->file);
        mote_text_add(text, ")\n\n");
        mote_escape_markdown(text, figure->title);
        mote_text_add(text, ". ");
        mote_escape_markdown(text, figure->caption);
        mote_text_add(text, "\n");
    }
}

static void add_claim(const mote_report *report, const json_t *claim, const char *file,
                      mote_text *text)
{
    const double value = mote_number_at(claim, "value");
    double interval[2];
    mote_text_add(text, "- **");
    mote_escape_markdown(text, mote_text_at(claim, "id"));
    mote_text_add(text, "**, ");
    mote_escape_markdown(text, mote_text_at(claim, "verdict"));
    mote_text_add(text, ": ");
    mote_escape_markdown(text, mote_text_at(claim, "claim"));
    if (value == value) {
        mote_text_add(text, ". Measured: [%.4g", value);
        mote_escape_markdown(text, mote_text_at(claim, "unit")[0] ? " " : "");
        mote_escape_markdown(text, mote_text_at(claim, "unit"));
        mote_text_add(text, "](%s%s)", report->claims_folder, file);
    }
    if (mote_report_interval(claim, interval))
        mote_text_add(text, " (%.4g to %.4g)", interval[0], interval[1]);
    mote_text_add(text, "\n");
}

static void add_claims(const mote_report *report, const json_t *claims, const char *title,
                       const char *file, mote_text *text)
{
    size_t i;
    const json_t *claim;
    if (json_array_size(claims) == 0)
        return;
    mote_text_add(text, "\n## %s\n\n", title);
    MOTE_EACH(i, claim, claims)
    {
        add_claim(report, claim, file, text);
    }
}

/* The targets of the links in the tables. */
static void add_cells(const mote_report *report, mote_text *text)
{
    if (!report->has_cells)
        return;
    mote_text_add(text, "\n");
    for (size_t i = 0; i < report->summary.count; ++i) {
        const mote_summary_row *row = mote_report_row(report, i);
        for (size_t r = 0; r < row->replicates; ++r) {
            const mote_stored_cell *cell = &row->cells[r];
            mote_text_add(text, "[c%zu-%u]: cells/", i + 1, cell->replicate);
            mote_escape_path(text, cell->id);
            mote_text_add(text, cell->status == MOTE_CELL_OK ? ".csv\n" : ".json\n");
        }
    }
}

void mote_report_markdown(const mote_report *report, mote_text *text)
{
    char *subtitle = mote_report_subtitle(report);
    mote_text_add(text, "# ");
    mote_escape_markdown(text, report->name);
    mote_text_add(text, "\n\n");
    mote_escape_markdown(text, subtitle);
    mote_text_add(text,
                  "\n\n## What was asked\n\nHow much accuracy does a collision query by a few "
                  "particles give up, and how much time and\nmemory does it save, against "
                  "bounding volume hierarchies, on deforming triangle meshes? Every\nmethod "
                  "gets the same frames; its answers are compared with the exact "
                  "distance.\n\n");
    free(subtitle);
    add_pairs(mote_report_scenarios(report), text);
    add_commands(report, text);
    add_damaged(report, text);
    add_results(report, text);
    add_figures(report, text);
    add_simulations(report, text);
    add_claims(report, report->claims, "Claims of the paper", "claims.json", text);
    add_claims(report, report->requirements, "Requirements", "requirements.json", text);
    if (report->manifest) {
        mote_text_add(text, "\n## The machine and the program\n\n");
        add_pairs(mote_report_machine(report), text);
        mote_text_add(text, "\nFrom [manifest.json](manifest.json).\n");
    }
    if (report->defects) {
        mote_text_add(text, "\n## Known defects of the baselines\n\n");
        add_defects(report->defects, text);
    }
    add_missing(report, text);
    add_cells(report, text);
}
