#include "harness/figure/figure.h"

#include "harness/base/memory.h"
#include "harness/summary/front.h"

#include <stdlib.h>
#include <string.h>

static bool usable(const mote_summary_row *row, const char *scenario)
{
    return row->status == MOTE_CELL_OK && row->times_comparable &&
           strcmp(row->scenario, scenario) == 0 &&
           strcmp(row->cache, mote_cache_names[MOTE_CACHE_HOT]) == 0;
}

static int64_t frames_asked(const mote_summary_row *row)
{
    return (int64_t)row->frame_range[1] - row->frame_range[0];
}

bool mote_figure_shows(const mote_summary *summary, const mote_summary_row *row,
                       const char *scenario)
{
    if (!usable(row, scenario))
        return false;
    const mote_summary_row *widest = NULL;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        if (!usable(other, scenario))
            continue;
        if (!widest || frames_asked(other) > frames_asked(widest))
            widest = other;
    }
    return widest && mote_summary_same_block(row, widest);
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
    return fmax(row->triangles[0], row->triangles[1]);
}
