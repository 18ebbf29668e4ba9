#include "harness/report/report_rows.h"

#include "harness/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const mote_summary_row *mote_report_row(const mote_report *report, size_t i)
{
    return &report->summary.rows[report->order[i]];
}

bool mote_report_interval(const json_t *value, double interval[2])
{
    const json_t *ends = json_object_get(value, "interval");
    if (json_array_size(ends) != 2)
        return false;
    for (size_t i = 0; i < 2; ++i) {
        if (!json_is_number(json_array_get(ends, i)))
            return false;
        interval[i] = json_number_value(json_array_get(ends, i));
    }
    return true;
}

size_t mote_report_block_end(const mote_report *report, size_t first)
{
    size_t end = first;
    while (
        end < report->summary.count &&
        mote_summary_same_block(mote_report_row(report, first), mote_report_row(report, end)))
        ++end;
    return end;
}

/* The median total time of a row that can be compared with others, otherwise infinity. */
static double time_of(const mote_summary_row *row)
{
    const double time = row->total.median;
    const bool usable = row->status == MOTE_CELL_OK && time == time && row->times_comparable;
    return usable ? time : HUGE_VAL;
}

/* Insertion sort of the block: stable, and fast enough, as a block has at most some hundred
   rows. */
static void sort_block(mote_report *report, size_t first, size_t end)
{
    for (size_t i = first + 1; i < end; ++i) {
        const size_t moved = report->order[i];
        const double time = time_of(mote_report_row(report, i));
        size_t k = i;
        while (k > first && time_of(mote_report_row(report, k - 1)) > time) {
            report->order[k] = report->order[k - 1];
            --k;
        }
        report->order[k] = moved;
    }
}

void mote_report_sort(mote_report *report)
{
    const size_t count = report->summary.count;
    report->order = mote_allocate(count, sizeof *report->order);
    for (size_t i = 0; i < count; ++i)
        report->order[i] = i;
    for (size_t first = 0; first < count;) {
        const size_t end = mote_report_block_end(report, first);
        sort_block(report, first, end);
        first = end;
    }
}

mote_report_glance mote_report_block_glance(const mote_report *report, size_t first, size_t end)
{
    mote_report_glance glance = {SIZE_MAX, SIZE_MAX};
    bool only_given = true;
    for (size_t i = first; i < end; ++i)
        only_given = only_given && mote_report_row(report, i)->given;
    for (size_t i = first; i < end && glance.right == SIZE_MAX; ++i) {
        const mote_summary_row *row = mote_report_row(report, i);
        if (time_of(row) == HUGE_VAL || row->given != only_given)
            continue;
        if (glance.fastest == SIZE_MAX)
            glance.fastest = i;
        if (mote_summary_row_right(row))
            glance.right = i;
    }
    if (glance.fastest == glance.right)
        glance.fastest = SIZE_MAX;
    return glance;
}
