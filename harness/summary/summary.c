#include "harness/summary/summary.h"

#include "harness/summary/front.h"
#include "harness/base/record.h"
#include "harness/summary/summary_quiet.h"
#include "harness/summary/summary_row.h"

#include <stdlib.h>
#include <string.h>

void mote_summary_free(mote_summary *summary)
{
    for (size_t i = 0; i < summary->count; ++i)
        mote_summary_row_free(&summary->rows[i]);
    free(summary->rows);
    mote_stored_free(&summary->stored);
    mote_summary none = {0};
    *summary = none;
}

static int by_place(const void *a, const void *b)
{
    const mote_summary_row *first = a, *second = b;
    int order = mote_stored_by_scene(first->first, second->first);
    if (order == 0)
        order = mote_stored_by_frames(first->first, second->first);
    if (order == 0)
        order = strcmp(first->first->method, second->first->method);
    if (order == 0 && (first->n < second->n || first->n > second->n))
        order = first->n < second->n ? -1 : 1;
    return order ? order : strcmp(first->first->group, second->first->group);
}

static bool comparable(const mote_summary_row *a, const mote_summary_row *b)
{
    return a->status == MOTE_CELL_OK && b->status == MOTE_CELL_OK && a->jobs == 1 &&
           b->jobs == 1 && mote_stored_by_scene(a->first, b->first) == 0;
}

bool mote_summary_machines_differ(const mote_summary *summary)
{
    for (size_t i = 1; i < summary->count; ++i) {
        if (strcmp(summary->rows[i].first->machine, summary->rows[0].first->machine) != 0)
            return true;
    }
    return false;
}

/* Whether another row was asked for all frames that this one was. */
static bool covers(const mote_summary_row *other, const mote_summary_row *row)
{
    return other->first->first <= row->first->first && other->first->last >= row->first->last;
}

/* The row that this one's ratio is taken to: fcl-aabb as its users call it, which is its
   default (seed=none, queue=2), or any fcl-aabb; on all of this row's frames, best on these
   alone, measured in turn with it. */
static size_t find_reference(const mote_summary *summary, const mote_summary_row *row)
{
    size_t found = SIZE_MAX;
    int most = -1;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        if (!comparable(row, other) || strcmp(other->first->method, "fcl-aabb") != 0)
            continue;
        const int rank = (covers(other, row) ? 4 : 0) +
                         (strcmp(other->label, "fcl-aabb") == 0 ? 2 : 0) +
                         (mote_stored_by_frames(other->first, row->first) == 0 ? 1 : 0);
        found = rank > most ? i : found;
        most = rank > most ? rank : most;
    }
    return found;
}

/* Of rows on all of this row's frames, or else of any, the fastest over these frames. */
static mote_status find_best_fcl(const mote_summary *summary, const mote_summary_row *row,
                                 size_t *best)
{
    double least = MOTE_NONE;
    bool covered = false;
    *best = SIZE_MAX;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        if (!comparable(row, other) || strncmp(other->first->method, "fcl-", 4) != 0)
            continue;
        double median = other->total.median;
        mote_status status = MOTE_OK;
        if (mote_stored_by_frames(other->first, row->first) != 0)
            status =
                mote_summary_median_within(other, row->first->first, row->first->last, &median);
        if (status != MOTE_OK)
            return status;
        const bool all = covers(other, row);
        if (median != median || (covered && !all))
            continue;
        if (all != covered || !(median >= least)) {
            least = median;
            *best = i;
        }
        covered = all;
    }
    return MOTE_OK;
}

static mote_status take_ratio(const mote_summary *summary, const mote_summary_row *row,
                              size_t to, mote_part part, mote_ratio *ratio)
{
    ratio->to = to;
    if (to == SIZE_MAX)
        return MOTE_OK;
    return mote_summary_ratio(row, &summary->rows[to], part, ratio);
}

static mote_status take_ratios(mote_summary *summary)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < summary->count && status == MOTE_OK; ++i) {
        mote_summary_row *row = &summary->rows[i];
        size_t reference = find_reference(summary, row);
        status = take_ratio(summary, row, reference, MOTE_PART_TOTAL, &row->ratio);
        if (status == MOTE_OK)
            status = take_ratio(summary, row, reference, MOTE_PART_GIVEN, &row->ratio_given);
        if (status == MOTE_OK && reference != SIZE_MAX)
            status = mote_summary_process_ratios(row, &summary->rows[reference]);
        if (status == MOTE_OK)
            status = mote_summary_quiet(row, reference == SIZE_MAX ? NULL
                                                                   : &summary->rows[reference]);
        size_t best = SIZE_MAX;
        if (status == MOTE_OK)
            status = find_best_fcl(summary, row, &best);
        if (status == MOTE_OK)
            status = take_ratio(summary, row, best, MOTE_PART_TOTAL, &row->ratio_best);
    }
    return status;
}

static mote_status make_rows(mote_summary *summary)
{
    const mote_stored *stored = &summary->stored;
    for (size_t i = 0; i < stored->count;) {
        size_t end = i + 1;
        while (end < stored->count &&
               strcmp(stored->cells[end].group, stored->cells[i].group) == 0)
            ++end;
        mote_status status =
            mote_summary_row_make(&stored->cells[i], end - i, &summary->rows[summary->count]);
        if (status != MOTE_OK)
            return status;
        ++summary->count;
        i = end;
    }
    return MOTE_OK;
}

/* The median over the cells of a number of theirs. */
static double cells_median(const mote_summary *summary, const char *key, double *work)
{
    size_t known = 0;
    for (size_t i = 0; i < summary->stored.count; ++i) {
        double value = mote_stored_number(&summary->stored.cells[i], key);
        if (value == value)
            work[known++] = value;
    }
    return mote_statistics_median(work, known);
}

static mote_status take_overhead(mote_summary *summary)
{
    double fastest = MOTE_NONE;
    double *work = malloc((summary->stored.count + 1) * sizeof *work);
    if (!work)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu cells", summary->stored.count);
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        double calls = 1 + (row->update.median > 0 ? 1 : 0) + (row->deform.median > 0 ? 1 : 0);
        double share = calls / row->total.median;
        if (row->total.median > 0 && !(share <= fastest))
            fastest = share;
    }
    summary->overhead.clock_ns = cells_median(summary, "clock_ns", work);
    summary->overhead.left_ns = cells_median(summary, "overhead_ns", work);
    summary->overhead.share = fabs(summary->overhead.left_ns) * fastest;
    free(work);
    return MOTE_OK;
}

mote_status mote_summary_make(const char *directory, mote_summary *summary)
{
    return mote_summary_make_whole(directory, NULL, summary);
}

mote_status mote_summary_make_whole(const char *directory, mote_text *damaged,
                                    mote_summary *summary)
{
    mote_summary made = {0};
    mote_status status = mote_stored_read(directory, damaged, &made.stored);
    if (status != MOTE_OK)
        return status;
    made.rows = calloc(made.stored.count + 1, sizeof *made.rows);
    status = made.rows ? make_rows(&made) : mote_fail(MOTE_ENOMEM, "no memory for a summary");
    if (status == MOTE_OK && made.count > 0)
        qsort(made.rows, made.count, sizeof *made.rows, by_place);
    if (status == MOTE_OK)
        status = take_ratios(&made);
    double noise_floor = 0, smallest_change = 0;
    if (status == MOTE_OK)
        status = mote_summary_noise_floor(made.rows, made.count, &noise_floor);
    if (status == MOTE_OK)
        status = take_overhead(&made);
    if (status == MOTE_OK)
        status = mote_summary_smallest_change(made.rows, made.count, &smallest_change);
    made.noise_floor = noise_floor;
    made.smallest_change = smallest_change;
    if (status == MOTE_OK)
        *summary = made;
    else
        mote_summary_free(&made);
    return status;
}

static json_t *time_json(const mote_time *time)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "median",
                     mote_json_number(time->median), "ci_low", mote_json_number(time->low),
                     "ci_high", mote_json_number(time->high), "mean",
                     mote_json_number(time->mean), "p95", mote_json_number(time->p95), "max",
                     mote_json_number(time->max), "sum", mote_json_number(time->sum));
}

static json_t *ratio_json(const mote_summary *summary, const mote_ratio *ratio)
{
    if (ratio->to == SIZE_MAX)
        return json_null();
    return json_pack("{s:s, s:o, s:o, s:o}", "to", summary->rows[ratio->to].label, "value",
                     mote_json_number(ratio->value), "ci_low", mote_json_number(ratio->low),
                     "ci_high", mote_json_number(ratio->high));
}

static json_t *error_json(const mote_error_summary *error)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "median",
                     mote_json_number(error->median), "p95", mote_json_number(error->p95),
                     "p99", mote_json_number(error->p99), "max", mote_json_number(error->max),
                     "min_signed", mote_json_number(error->min_signed), "max_signed",
                     mote_json_number(error->max_signed), "exact_rate",
                     mote_json_number(error->exact_rate), "exact_rate_separated",
                     mote_json_number(error->exact_rate_separated));
}

/* Mean and largest of each count over the frames of all replicates. */
static json_t *counters_json(const mote_summary_row *row)
{
    json_t *object = json_object();
    for (int k = 0; k < MOTE_STORED_COUNTS && row->finished > 0; ++k) {
        double sum = 0, max = 0, frames = 0;
        for (size_t r = 0; r < row->replicates; ++r) {
            sum += row->cells[r].counts[k].sum;
            max = row->cells[r].counts[k].max > max ? row->cells[r].counts[k].max : max;
            frames += (double)row->cells[r].frames;
        }
        (void)json_object_set_new(object, mote_stored_count_names[k],
                                  json_pack("{s:f, s:f}", "mean", sum / frames, "max", max));
    }
    return object;
}

/* What comparisons with another run are made from. */
static json_t *processes_json(const mote_summary_row *row)
{
    json_t *processes = json_array();
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        if (cell->status != MOTE_CELL_OK)
            continue;
        json_t *counts = json_object();
        for (int k = 0; k < MOTE_STORED_COUNTS; ++k)
            (void)json_object_set_new(counts, mote_stored_count_names[k],
                                      json_real(cell->counts[k].sum));
        (void)json_array_append_new(
            processes,
            json_pack("{s:i, s:o, s:o, s:o}", "replicate", (int)cell->replicate, "median_ns",
                      mote_json_number(row->processes[r].median), "ratio",
                      mote_json_number(row->processes[r].ratio), "counters", counts));
    }
    return processes;
}

static json_t *quiet_json(const mote_quiet *quiet)
{
    json_t *totals = json_array(), *ratios = json_array();
    for (int k = 0; k < MOTE_QUIET_GROUPS; ++k) {
        (void)json_array_append_new(totals, mote_json_number(quiet->total[k]));
        (void)json_array_append_new(ratios, mote_json_number(quiet->ratio[k]));
    }
    return json_pack("{s:o, s:o}", "total_ns", totals, "ratio", ratios);
}

/* Heap over the vertices of both bodies. */
static json_t *bytes_per_vertex(const mote_summary_row *row)
{
    const json_t *vertices = json_object_get(row->first->json, "vertices");
    double count = json_number_value(json_array_get(vertices, 0)) +
                   json_number_value(json_array_get(vertices, 1));
    return count > 0 ? mote_json_number(row->heap_live_bytes / count) : json_null();
}

static json_t *integer_or_null(double value)
{
    return value == value ? json_integer((json_int_t)value) : json_null();
}

static json_t *row_json(const mote_summary *summary, const mote_summary_row *row)
{
    static const char *const scene[] = {"ask", "tolerance"};
    const json_t *cell = row->first->json;
    json_t *object =
        json_pack("{s:s, s:s, s:s, s:s, s:O, s:O, s:O, s:s, s:i, s:O, s:i, s:i, s:s}",
                  "scenario", row->first->scenario, "fingerprint", row->first->fingerprint,
                  "method", row->first->method, "label", row->label, "parameters",
                  row->first->parameters, "triangles", json_object_get(cell, "triangles"),
                  "vertices", json_object_get(cell, "vertices"), "cache", row->first->cache,
                  "stride", (int)row->first->stride, "seed", json_object_get(cell, "seed"),
                  "frames", (int)row->frames, "replicates", (int)row->finished, "status",
                  mote_cell_status_names[row->status]);
    if (!object)
        return NULL;
    if (row->first->machine[0])
        (void)json_object_set_new(object, "machine", json_string(row->first->machine));
    for (size_t i = 0; i < sizeof scene / sizeof scene[0]; ++i) {
        json_t *value = json_object_get(cell, scene[i]);
        if (value)
            (void)json_object_set(object, scene[i], value);
    }
    (void)json_object_set_new(
        object, "frame_range",
        json_pack("[I,I]", (json_int_t)row->first->first, (json_int_t)row->first->last));
    json_t *reason = json_object_get(cell, "reason");
    if (reason)
        (void)json_object_set(object, "reason", reason);
#define SET_TIME(name, key) (void)json_object_set_new(object, key, time_json(&row->name));
    MOTE_TIMES(SET_TIME)
#undef SET_TIME
    (void)json_object_set_new(object, "replicates_failed",
                              json_integer((json_int_t)(row->replicates - row->finished)));
    (void)json_object_set_new(object, "jobs", json_integer(row->jobs));
    (void)json_object_set_new(object, "times_comparable", json_boolean(row->jobs == 1));
    (void)json_object_set_new(object, "smallest_change",
                              mote_json_number(row->smallest_change));
    (void)json_object_set_new(object, "ratio", ratio_json(summary, &row->ratio));
    (void)json_object_set_new(object, "ratio_given", ratio_json(summary, &row->ratio_given));
    (void)json_object_set_new(object, "ratio_best", ratio_json(summary, &row->ratio_best));
    (void)json_object_set_new(object, "error", error_json(&row->error));
    (void)json_object_set_new(object, "contacts", mote_json_number(row->contacts));
    (void)json_object_set_new(object, "missed", mote_json_number(row->missed));
    (void)json_object_set_new(object, "false_contacts", mote_json_number(row->false_contacts));
    (void)json_object_set_new(object, "heap_live_bytes", integer_or_null(row->heap_live_bytes));
    (void)json_object_set_new(object, "heap_peak_bytes", integer_or_null(row->heap_peak_bytes));
    (void)json_object_set_new(object, "rss_peak_bytes", integer_or_null(row->rss_peak_bytes));
    (void)json_object_set_new(object, "heap_bytes_per_vertex", bytes_per_vertex(row));
    (void)json_object_set_new(object, "counters", counters_json(row));
    (void)json_object_set_new(object, "processes", processes_json(row));
    (void)json_object_set_new(object, "quiet", quiet_json(&row->quiet));
    return object;
}

static json_t *summary_json(const mote_summary *summary, const mote_fronts *fronts)
{
    json_t *rows = json_array();
    for (size_t i = 0; rows && i < summary->count; ++i) {
        json_t *row = row_json(summary, &summary->rows[i]);
        size_t by = fronts->dominator[i];
        if (row && by != SIZE_MAX)
            (void)json_object_set_new(row, "dominated_by",
                                      json_string(summary->rows[by].label));
        if (json_array_append_new(rows, row) != 0) {
            json_decref(rows);
            rows = NULL;
        }
    }
    if (!rows)
        return NULL;
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
    mote_fronts fronts;
    if (mote_fronts_make(summary, &fronts) != MOTE_OK)
        return NULL;
    json_t *object = summary_json(summary, &fronts);
    mote_fronts_free(&fronts);
    return object;
}

mote_status mote_summary_write(const mote_summary *summary, const char *directory)
{
    mote_fronts fronts;
    mote_status status = mote_fronts_make(summary, &fronts);
    if (status != MOTE_OK)
        return status;
    status = mote_fronts_write(&fronts, directory);
    if (status == MOTE_OK)
        status = mote_record_json(directory, "summary.json", summary_json(summary, &fronts));
    mote_fronts_free(&fronts);
    return status;
}
