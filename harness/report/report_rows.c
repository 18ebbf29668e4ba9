#include "harness/report/report_rows.h"

#include <stdio.h>
#include <string.h>

const mote_report_column mote_report_columns[] = {
    {"total", "median", "total_ns", "median", mote_show_time, true, "total",
     "Deform, update and query together, with its 95 % interval"},
    {"total", "p95", "total_ns", "p95", mote_show_time, false, NULL,
     "95th percentile over the frames of all replicates"},
    {"fcl-aabb", "/ this", "ratio", "value", mote_show_ratio, true, "FCL/this",
     "How many times slower FCL's AABB tree is, frame by frame"},
    {"best FCL", "/ this", "ratio_best", "value", mote_show_ratio, true, "best/this",
     "How many times slower the fastest configuration of FCL is, frame by frame"},
    {"error / L", "median", "error", "median", mote_show_error, false, NULL,
     "Absolute error over L"},
    {"error / L", "p99", "error", "p99", mote_show_error, false, "p99 error",
     "99th percentile of the absolute error over L"},
    {"error / L", "max", "error", "max", mote_show_error, false, NULL,
     "Largest absolute error over L"},
    {"exact", "frames", "error", "exact_rate", mote_show_percent, false, "exact",
     "Share of frames with an error of at most 1e-9 L"},
    {"contacts", "missed", NULL, "missed", mote_show_count, false, "missed",
     "Frames in contact that the method says are not; mean over replicates"},
    {"contacts", "false", NULL, "false_contacts", mote_show_count, false, "false",
     "Frames not in contact that the method says are; mean over replicates"},
    {"heap", "live", NULL, "heap_live_bytes", mote_show_bytes, false, "heap",
     "Heap held by the method; the shared rest mesh and field left out"},
    {"active", "median", "active_total_ns", "median", mote_show_time, true, NULL,
     "The total within the scenario's active interval: near contact"},
    {"given", "median", "given_total_ns", "median", mote_show_time, true, NULL,
     "The total where nobody is charged for deforming all vertices"},
    {"deform", "median", "deform_ns", "median", mote_show_time, false, NULL,
     "Deforming all vertices, for methods that need them"},
    {"update", "median", "update_ns", "median", mote_show_time, false, NULL, "Refit"},
    {"query", "median", "query_ns", "median", mote_show_time, false, NULL, "The query"},
};
const size_t mote_report_column_count =
    sizeof mote_report_columns / sizeof mote_report_columns[0];

size_t mote_report_row_count(const mote_report *report)
{
    return json_array_size(json_object_get(report->summary, "rows"));
}

const json_t *mote_report_row(const mote_report *report, size_t i)
{
    return json_array_get(json_object_get(report->summary, "rows"), i);
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

bool mote_report_note(const json_t *row, size_t i, char text[MOTE_REPORT_NOTE])
{
    const double stride = mote_report_number(row, NULL, "stride");
    const double jobs = mote_report_number(row, NULL, "jobs");
    const double failed = mote_report_number(row, NULL, "replicates_failed");
    const double ended = mote_report_number(row, NULL, "replicates");
    const bool some[MOTE_REPORT_NOTES] = {stride > 1, jobs > 1, failed > 0 && ended > 0};
    if (some[i] && i == 0)
        (void)snprintf(text, MOTE_REPORT_NOTE, "every %.0fth frame", stride);
    else if (some[i] && i == 1)
        (void)snprintf(text, MOTE_REPORT_NOTE, "times not comparable: %.0f cells at once",
                       jobs);
    else if (some[i])
        (void)snprintf(text, MOTE_REPORT_NOTE, "%.0f of %.0f replicates ended badly", failed,
                       failed + ended);
    return some[i];
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

/* No missed contact, no false one, and no distance, if it gives any, that is not exact. */
static bool is_right(const json_t *row)
{
    const double max = mote_report_number(row, "error", "max");
    return mote_report_number(row, NULL, "missed") == 0 &&
           mote_report_number(row, NULL, "false_contacts") == 0 &&
           (max != max || max <= MOTE_EXACT_ERROR);
}

/* Whether a row was given all vertices at no charge: it is not compared with those that pay. */
static bool is_given(const json_t *row)
{
    return strcmp(mote_report_text(row, "accounting"), "given") == 0;
}

mote_report_glance mote_report_block_glance(const mote_report *report, size_t first, size_t end)
{
    mote_report_glance glance = {SIZE_MAX, SIZE_MAX};
    bool only_given = true;
    for (size_t i = first; i < end; ++i)
        only_given = only_given && is_given(mote_report_row(report, i));
    double least_right = 0, least = 0;
    for (size_t i = first; i < end; ++i) {
        const json_t *row = mote_report_row(report, i);
        const double time = mote_report_number(row, "total_ns", "median");
        if (strcmp(mote_report_text(row, "status"), "ok") != 0 || time != time ||
            is_given(row) != only_given ||
            json_is_false(json_object_get(row, "times_comparable")))
            continue;
        if (glance.fastest == SIZE_MAX || time < least) {
            glance.fastest = i;
            least = time;
        }
        if (is_right(row) && (glance.right == SIZE_MAX || time < least_right)) {
            glance.right = i;
            least_right = time;
        }
    }
    if (glance.fastest == glance.right)
        glance.fastest = SIZE_MAX;
    return glance;
}
