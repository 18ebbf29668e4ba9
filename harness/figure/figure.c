#include "harness/figure/figure.h"

#include "harness/base/memory.h"
#include "harness/summary/front.h"

#include <stdlib.h>
#include <string.h>

const char *mote_figure_number(double value, char text[MOTE_FIGURE_NUMBER])
{
    char digits[MOTE_FIGURE_NUMBER];
    (void)snprintf(digits, sizeof digits, "%.0f", value);
    const size_t count = strlen(digits);
    size_t used = 0;
    for (size_t i = 0; i < count && used + 2 < MOTE_FIGURE_NUMBER; ++i) {
        if (i > 0 && (count - i) % 3 == 0)
            text[used++] = ',';
        text[used++] = digits[i];
    }
    text[used] = '\0';
    return text;
}

static bool usable(const mote_summary_row *row, const char *scenario)
{
    return row->status == MOTE_CELL_OK && row->jobs == 1 &&
           strcmp(row->first->scenario, scenario) == 0 &&
           strcmp(row->first->cache, mote_cache_names[MOTE_CACHE_HOT]) == 0;
}

/* The first and last frame, 0 for what is no frame's number. */
static void frame_range(const mote_summary_row *row, json_int_t range[2])
{
    const json_t *frames = json_object_get(row->first->json, "frames");
    for (size_t i = 0; i < 2; ++i) {
        const json_int_t number = json_integer_value(json_array_get(frames, i));
        range[i] = number >= 1 && number <= UINT32_MAX ? number : 0;
    }
}

bool mote_figure_shows(const mote_summary *summary, const mote_summary_row *row,
                       const char *scenario)
{
    if (!usable(row, scenario))
        return false;
    json_int_t widest[2] = {0, -1}, range[2];
    const mote_summary_row *first = NULL;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        if (!usable(other, scenario))
            continue;
        frame_range(other, range);
        if (range[1] - range[0] > widest[1] - widest[0]) {
            memcpy(widest, range, sizeof widest);
            first = other;
        }
    }
    frame_range(row, range);
    return first && range[0] == widest[0] && range[1] == widest[1] &&
           mote_stored_by_scene(row->first, first->first) == 0;
}

const mote_summary_row *mote_figure_row(const mote_summary *summary, const char *scenario,
                                        const char *label)
{
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (strcmp(row->label, label) == 0 && mote_figure_shows(summary, row, scenario))
            return row;
    }
    return NULL;
}

const mote_summary_row *mote_figure_near(const mote_summary *summary, const char *scenario,
                                         const char *family, double n)
{
    const mote_summary_row *best = NULL;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char other[MOTE_FIGURE_FAMILY];
        mote_front_title(row, other, sizeof other);
        if (strcmp(family, other) == 0 && mote_figure_shows(summary, row, scenario) &&
            (!best || fabs(row->n - n) < fabs(best->n - n)))
            best = row;
    }
    return best;
}

bool mote_figure_first(const mote_summary *summary, const mote_summary_row *row,
                       const char *scenario)
{
    char family[MOTE_FIGURE_FAMILY], other[MOTE_FIGURE_FAMILY];
    mote_front_title(row, family, sizeof family);
    for (const mote_summary_row *before = summary->rows; before < row; ++before) {
        mote_front_title(before, other, sizeof other);
        if (strcmp(family, other) == 0 && mote_figure_shows(summary, before, scenario))
            return false;
    }
    return true;
}

static const double *times_of(const mote_stored_cell *cell, mote_figure_part part)
{
    const double *const times[] = {[MOTE_FIGURE_DEFORM] = cell->deform_ns,
                                   [MOTE_FIGURE_UPDATE] = cell->update_ns,
                                   [MOTE_FIGURE_QUERY] = cell->query_ns,
                                   [MOTE_FIGURE_TOTAL] = cell->total_ns};
    return times[part];
}

void mote_figure_frames(const mote_summary_row *row, mote_figure_part part, double *values)
{
    double *work = mote_allocate(row->replicates, sizeof *work);
    for (size_t k = 0; k < row->first->frames; ++k) {
        size_t count = 0;
        for (size_t r = 0; r < row->replicates; ++r) {
            const mote_stored_cell *cell = &row->cells[r];
            if (k < cell->frames && cell->frame[k] == row->first->frame[k])
                work[count++] = times_of(cell, part)[k];
        }
        values[k] = mote_statistics_median(work, count);
    }
    free(work);
}

void mote_figure_time(const mote_time *time, double over, mote_text *text)
{
    const bool interval = time->low == time->low;
    mote_text_add(text, "%.17g %.17g %.17g", time->median / over,
                  (interval ? time->low : time->median) / over,
                  (interval ? time->high : time->median) / over);
}

bool mote_figure_has_error(const mote_summary_row *row)
{
    return row->error.p99 == row->error.p99;
}

double mote_figure_length(const mote_summary_row *row)
{
    const double length = mote_stored_number(row->first, "length");
    return length > 0 ? length : 1;
}

double mote_figure_triangles(const mote_summary_row *row)
{
    const json_t *triangles = json_object_get(row->first->json, "triangles");
    const double a = json_number_value(json_array_get(triangles, 0));
    const double b = json_number_value(json_array_get(triangles, 1));
    return a > b ? a : b;
}
