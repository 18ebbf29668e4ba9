#include "harness/summary/table.h"

#include "harness/base/escape.h"
#include "harness/summary/column.h"

#include <stdlib.h>
#include <string.h>

/* A smallest change above this is not printed. */
#define CHANGE_MAX 10.0

static size_t label_width(const mote_summary *summary)
{
    size_t width = strlen("method");
    for (size_t i = 0; i < summary->count; ++i) {
        size_t length = strlen(summary->rows[i].label);
        width = length > width ? length : width;
    }
    return width;
}

/* Characters that a column's numbers need. */
static int column_width(const mote_column *column)
{
    if (column->show == mote_show_count)
        return 6;
    if (column->show == mote_show_percent)
        return 7;
    return column->show == mote_show_ratio ? 8 : 9;
}

void mote_table_heads(mote_view view, int width, FILE *out)
{
    const mote_column *columns[MOTE_VIEW_MAX];
    const size_t count = mote_column_view(view, columns);
    (void)fprintf(out, "%-*s", width, "");
    for (size_t k = 0; k < count;) {
        const char *group = columns[k]->group ? columns[k]->group : "";
        int span = -1;
        for (; k < count && strcmp(columns[k]->group ? columns[k]->group : "", group) == 0; ++k)
            span += column_width(columns[k]) + 1;
        (void)fprintf(out, " %*s", span, group);
    }
    (void)fprintf(out, "\n%-*s", width, "method");
    for (size_t k = 0; k < count; ++k)
        (void)fprintf(out, " %*s", column_width(columns[k]), columns[k]->head);
    (void)fprintf(out, "\n");
}

void mote_table_values(mote_view view, const mote_summary_row *row, FILE *out)
{
    const mote_column *columns[MOTE_VIEW_MAX];
    const size_t count = mote_column_view(view, columns);
    for (size_t k = 0; k < count; ++k) {
        char shown[MOTE_NUMBER_TEXT];
        (void)fprintf(out, " %*s", column_width(columns[k]),
                      columns[k]->show(mote_column_number(columns[k], row), shown));
    }
}

/* "11,920 and 11,920 triangles", or "100 bodies of 4 shapes, 1,380 to 11,920 triangles". */
static void describe_bodies(const mote_summary_row *row, mote_text *text)
{
    char first[MOTE_NUMBER_TEXT], second[MOTE_NUMBER_TEXT], bodies[MOTE_NUMBER_TEXT];
    (void)mote_show_whole(row->triangles[0], first);
    (void)mote_show_whole(row->triangles[1], second);
    (void)mote_show_whole(row->bodies, bodies);
    if (row->bodies == 0)
        mote_text_add(text, "%s and %s triangles", first, second);
    else if (row->shapes > 1 && strcmp(first, second) != 0)
        mote_text_add(text, "%s bodies of %u shapes, %s to %s triangles", bodies, row->shapes,
                      first, second);
    else
        mote_text_add(text, "%s bodies of %s triangles", bodies, second);
}

size_t mote_table_block_end(const mote_summary *summary, size_t start)
{
    size_t end = start;
    while (end < summary->count &&
           mote_summary_same_block(&summary->rows[start], &summary->rows[end]))
        ++end;
    return end;
}

/* Includes the largest number of frames and of replicates of its rows. */
char *mote_table_heading(const mote_summary *summary, size_t start)
{
    const mote_summary_row *row = &summary->rows[start];
    size_t frames = 0, replicates = 0;
    for (size_t i = start; i < mote_table_block_end(summary, start); ++i) {
        const mote_summary_row *other = &summary->rows[i];
        frames = other->frames > frames ? other->frames : frames;
        const size_t ran = other->finished + other->failed;
        replicates = ran > replicates ? ran : replicates;
    }
    char shown[MOTE_NUMBER_TEXT];
    mote_text text = {0};
    describe_bodies(row, &text);
    mote_text_add(&text, row->step > 0 ? ", %s question%s" : ", %s frame%s",
                  mote_show_whole((double)frames, shown), frames == 1 ? "" : "s");
    if (row->step > 0)
        mote_text_add(&text, " about impacts in steps of %s frame%s",
                      mote_show_whole(row->step, shown), row->step == 1 ? "" : "s");
    mote_text_add(&text, ", %zu replicate%s, caches %s", replicates, replicates == 1 ? "" : "s",
                  row->cache);
    if (mote_summary_machines_differ(summary))
        mote_text_add(&text, ", on %s", row->machine);
    return text.data;
}

bool mote_table_note(const mote_summary_row *row, int i, char text[MOTE_ROW_NOTE])
{
    const bool applies[MOTE_ROW_NOTES] = {row->stride > 1, row->jobs > 1,
                                          row->failed > 0 && row->finished > 0,
                                          row->told[0] && row->status == MOTE_CELL_OK};
    char ordinal[MOTE_NUMBER_TEXT];
    if (applies[i] && i == 0)
        (void)snprintf(text, MOTE_ROW_NOTE, "every %s frame",
                       mote_show_ordinal(row->stride, ordinal));
    else if (applies[i] && i == 1)
        (void)snprintf(text, MOTE_ROW_NOTE, "times not comparable: %u cells at once",
                       row->jobs);
    else if (applies[i] && i == 3)
        (void)snprintf(text, MOTE_ROW_NOTE, "told the %s", row->told);
    else if (applies[i])
        (void)snprintf(text, MOTE_ROW_NOTE, "%zu of %zu replicates failed", row->failed,
                       row->finished + row->failed);
    return applies[i];
}

static mote_view view_of(const mote_summary_row *row)
{
    return row->step > 0 ? MOTE_VIEW_IMPACTS : MOTE_VIEW_TABLE;
}

static void print_row(const mote_summary_row *row, int width, FILE *out)
{
    (void)fprintf(out, "%-*s", width, row->label);
    if (row->status != MOTE_CELL_OK) {
        (void)fprintf(out, " %s: %s\n", row->ending, row->reason);
        return;
    }
    mote_table_values(view_of(row), row, out);
    for (int i = 0; i < MOTE_ROW_NOTES; ++i) {
        char note[MOTE_ROW_NOTE];
        if (mote_table_note(row, i, note))
            (void)fprintf(out, "  %s", note);
    }
    (void)fprintf(out, "\n");
}

/* Prints below a block what ratios are relative to: for rows charged for deformation, and for
   rows with positions given. */
static void print_foot(const mote_summary *summary, size_t start, size_t end, FILE *out)
{
    for (int given = 0; given < 2; ++given) {
        const mote_summary_row *row = NULL;
        for (size_t i = start; i < end; ++i) {
            const mote_summary_row *other = &summary->rows[i];
            if (other->given == (given != 0) && other->ratio.to && other->ratio_best.to)
                row = other;
        }
        const mote_summary_row *engine = row ? row->ratio_engine.to : NULL;
        if (row)
            (void)fprintf(
                out, "%sfcl-aabb: %s; %sbest FCL: %s%s%s\n",
                given ? "of positions=given, deformation charged to nobody: " : "",
                row->ratio.to->label,
                given ? "" : "given: the same where nobody pays for deforming all vertices; ",
                row->ratio_best.to->label, engine ? "; best engine: " : "",
                engine ? engine->label : "");
    }
}

/* Prints how far the times can be trusted. */
static void print_quality(const mote_summary *summary, FILE *out)
{
    const mote_overhead *overhead = &summary->overhead;
    if (summary->noise_floor == summary->noise_floor)
        (void)fprintf(out, "noise floor %.1f %%; ", 100 * summary->noise_floor);
    if (summary->smallest_change <= CHANGE_MAX)
        (void)fprintf(out,
                      "smallest change that a comparison with a run like this detects (in nine "
                      "rows of ten): %.1f %%\n",
                      100 * summary->smallest_change);
    else
        (void)fprintf(out, "no change can be detected without more replicates\n");
    if (overhead->left_ns == overhead->left_ns)
        (void)fprintf(
            out,
            "clock and bookkeeping: %.0f ns a timed call, subtracted; %.1f ns are left, "
            "%.2f %% of the fastest median or less\n",
            overhead->clock_ns, overhead->left_ns, 100 * overhead->share);
}

void mote_table_print(const mote_summary *summary, FILE *out)
{
    const int width = (int)label_width(summary);
    for (size_t start = 0; start < summary->count;) {
        const size_t end = mote_table_block_end(summary, start);
        char *heading = mote_table_heading(summary, start);
        (void)fprintf(out, "%s%s: %s\n", start ? "\n" : "", summary->rows[start].scene,
                      heading);
        free(heading);
        mote_table_heads(view_of(&summary->rows[start]), width, out);
        for (size_t i = start; i < end; ++i)
            print_row(&summary->rows[i], width, out);
        print_foot(summary, start, end, out);
        start = end;
    }
    print_quality(summary, out);
    if (summary->stored.left_out > 0)
        (void)fprintf(out, "%zu cells were measured by another build and are left out\n",
                      summary->stored.left_out);
}

void mote_table_csv(const mote_summary *summary, mote_text *text)
{
    mote_table_csv_with(summary, NULL, NULL, text);
}

void mote_table_csv_with(const mote_summary *summary, const char *names, char *const *fields,
                         mote_text *text)
{
    const char *separator = "";
    for (size_t k = 0; k < mote_column_count; ++k) {
        if (!mote_columns[k].csv)
            continue;
        mote_text_add(text, "%s%s", separator, mote_columns[k].csv);
        separator = ",";
    }
    mote_text_add(text, "%s%s\n", names ? "," : "", names ? names : "");
    for (size_t i = 0; i < summary->count; ++i) {
        separator = "";
        for (size_t k = 0; k < mote_column_count; ++k) {
            const mote_column *column = &mote_columns[k];
            if (!column->csv)
                continue;
            const char *shown = mote_column_text(column, &summary->rows[i]);
            mote_text_add(text, "%s", separator);
            if (column->type == MOTE_COLUMN_TEXT || column->type == MOTE_COLUMN_ROW)
                mote_escape_csv(text, shown[0] ? shown : NULL, column->quoted);
            else
                mote_csv_number(text, mote_column_number(column, &summary->rows[i]));
            separator = ",";
        }
        mote_text_add(text, "%s%s\n", names ? "," : "", names ? fields[i] : "");
    }
}
