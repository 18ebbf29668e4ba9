#include "harness/report/report_rows.h"

#include "harness/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t mote_report_row_count(const mote_report *report)
{
    return json_array_size(json_object_get(report->summary, "rows"));
}

const json_t *mote_report_row(const mote_report *report, size_t i)
{
    return json_array_get(json_object_get(report->summary, "rows"), report->order[i]);
}

const mote_summary_row *mote_report_cells(const mote_report *report, size_t i)
{
    return report->has_cells ? &report->cells.rows[report->order[i]] : NULL;
}

double mote_report_number(const json_t *row, const char *object, const char *key)
{
    const json_t *value = json_object_get(object ? json_object_get(row, object) : row, key);
    return json_is_number(value) ? json_number_value(value) : MOTE_NONE;
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

const char *mote_report_text(const json_t *row, const char *key)
{
    const char *text = json_string_value(json_object_get(row, key));
    return text ? text : "";
}

const char *mote_report_scene(const json_t *row)
{
    const char *scene = mote_report_text(row, "scene");
    return scene[0] ? scene : mote_report_text(row, "scenario");
}

bool mote_report_note(const json_t *row, size_t i, char text[MOTE_REPORT_NOTE])
{
    const mote_row_facts facts = {.stride = mote_report_number(row, NULL, "stride"),
                                  .jobs = mote_report_number(row, NULL, "jobs"),
                                  .replicates = mote_report_number(row, NULL, "replicates"),
                                  .replicates_failed =
                                      mote_report_number(row, NULL, "replicates_failed")};
    return mote_row_note(&facts, (int)i, text);
}

bool mote_report_same_block(const json_t *a, const json_t *b)
{
    static const char *const keys[] = {"scenario", "cache",     "machine",    "fingerprint",
                                       "ask",      "tolerance", "frame_range"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; ++i) {
        const json_t *here = json_object_get(a, keys[i]), *there = json_object_get(b, keys[i]);
        if (here != there && !json_equal(here, there))
            return false;
    }
    return true;
}

size_t mote_report_block_end(const mote_report *report, size_t first)
{
    size_t end = first;
    while (end < mote_report_row_count(report) &&
           mote_report_same_block(mote_report_row(report, first), mote_report_row(report, end)))
        ++end;
    return end;
}

/* Whether a row has no missed contact, no false one, and, if it gives distances, only exact
   ones. */
static bool is_right(const json_t *row)
{
    const double max = mote_report_number(row, "error", "max");
    return mote_report_number(row, NULL, "missed") == 0 &&
           mote_report_number(row, NULL, "false_contacts") == 0 &&
           (max != max || max <= MOTE_EXACT_ERROR);
}

/* The median total time of a row that can be compared with others; else infinity. */
static double time_of(const json_t *row)
{
    const double time = mote_report_number(row, "total_ns", "median");
    const bool usable = strcmp(mote_report_text(row, "status"), "ok") == 0 && time == time &&
                        !json_is_false(json_object_get(row, "times_comparable"));
    return usable ? time : HUGE_VAL;
}

bool mote_report_is_given(const json_t *row)
{
    return strcmp(mote_report_text(row, "accounting"), "given") == 0;
}

/* Insertion sort of the block: stable, and a block has some hundred rows at most. */
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
    const size_t count = mote_report_row_count(report);
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
        only_given = only_given && mote_report_is_given(mote_report_row(report, i));
    for (size_t i = first; i < end && glance.right == SIZE_MAX; ++i) {
        const json_t *row = mote_report_row(report, i);
        if (time_of(row) == HUGE_VAL || mote_report_is_given(row) != only_given)
            continue;
        if (glance.fastest == SIZE_MAX)
            glance.fastest = i;
        if (is_right(row))
            glance.right = i;
    }
    if (glance.fastest == glance.right)
        glance.fastest = SIZE_MAX;
    return glance;
}

bool mote_report_stands_for_method(const json_t *row)
{
    return !json_is_false(json_object_get(row, "stands_for_method"));
}
