#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/summary/table.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MHZ_MAX 1e9 /* no core is faster */

/* Whether another row differs from this one only in frames, stride or seed. */
static bool is_ambiguous(const mote_summary *summary, const mote_summary_row *row)
{
    size_t same = 0;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        same +=
            strcmp(other->scene, row->scene) == 0 && strcmp(other->cache, row->cache) == 0 &&
            strcmp(other->machine, row->machine) == 0 && strcmp(other->label, row->label) == 0;
    }
    return same > 1;
}

/* "scene/method:key=value/evict": the name of a row in other tools; with "/machine" if there
   are several, and with frames, stride and seed if they are needed to distinguish rows. */
static char *row_name(const mote_summary *summary, const mote_summary_row *row)
{
    bool several = mote_summary_machines_differ(summary);
    char apart[96] = "";
    if (is_ambiguous(summary, row)) {
        (void)snprintf(apart, sizeof apart, "/frames:%u-%u/stride:%u/seed:%" PRIu64,
                       row->frame_range[0], row->frame_range[1], row->stride, row->seed);
    }
    return mote_format("%s/%s/%s%s%s%s", row->scene, row->label, row->cache, apart,
                       several ? "/" : "", several ? row->machine : "");
}

/* Sets a member if its value is known. */
static void set_known(json_t *object, const char *key, json_t *value)
{
    if (json_is_string(value) ? json_string_length(value) > 0 : json_is_number(value))
        (void)json_object_set(object, key, value);
}

/* When, where and with which build the run was measured, from its manifest. */
static json_t *gbench_context(const json_t *manifest, const mote_summary *summary)
{
    json_t *context = json_pack("{s:s, s:[], s:[], s:i}", "executable", "mote", "caches",
                                "load_avg", "json_schema_version", 1);
    const json_t *sessions = json_object_get(manifest, "sessions");
    const json_t *last = json_array_get(sessions, json_array_size(sessions) - 1);
    set_known(context, "date", json_object_get(last, "started"));
    set_known(context, "num_cpus", json_object_get(manifest, "cores"));
    const char *type = mote_text_at(manifest, "build_type");
    if (type[0])
        (void)json_object_set_new(
            context, "library_build_type",
            json_string(strcmp(type, "Debug") == 0 ? "debug" : "release"));
    if (summary->count > 0) {
        const mote_stored_cell *cell = summary->rows[0].first;
        json_t *host = json_stringn(cell->machine, strcspn(cell->machine, ","));
        set_known(context, "host_name", host);
        json_decref(host);
        double mhz =
            json_number_value(json_array_get(json_object_get(cell->json, "clock_mhz"), 0));
        if (mhz > 0 && mhz < MHZ_MAX)
            (void)json_object_set_new(context, "mhz_per_cpu", json_integer((json_int_t)mhz));
    }
    return context;
}

/* One replicate of a row: its median total. */
static json_t *gbench_replicate(const mote_summary_row *row, const mote_stored_cell *cell,
                                const char *name, size_t index)
{
    double *work = mote_allocate(cell->frames, sizeof *work);
    memcpy(work, cell->total_ns, cell->frames * sizeof *work);
    double median = mote_statistics_median(work, cell->frames);
    free(work);
    char *full = mote_format("%s/real_time", name);
    json_t *entry =
        json_pack("{s:s, s:s, s:s, s:i, s:i, s:i, s:i, s:f, s:f, s:s}", "name", full,
                  "run_name", full, "run_type", "iteration", "repetitions", (int)row->finished,
                  "repetition_index", (int)index, "threads", 1, "iterations", (int)cell->frames,
                  "real_time", median, "cpu_time", median, "time_unit", "ns");
    free(full);
    for (int k = 0; k < MOTE_STORED_COUNTS; ++k)
        (void)json_object_set_new(entry, mote_stored_count_names[k],
                                  json_real(cell->counts[k].sum / (double)cell->frames));
    return entry;
}

json_t *mote_gbench_json(const mote_summary *summary, const json_t *manifest)
{
    json_t *benchmarks = json_array();
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char *name = row_name(summary, row);
        size_t index = 0;
        for (size_t r = 0; row->times_comparable && r < row->replicates; ++r) {
            if (row->cells[r].frames > 0)
                (void)json_array_append_new(
                    benchmarks, gbench_replicate(row, &row->cells[r], name, index++));
        }
        free(name);
    }
    return json_pack("{s:o, s:o}", "context", gbench_context(manifest, summary), "benchmarks",
                     benchmarks);
}

json_t *mote_gha_json(const mote_summary *summary)
{
    json_t *list = json_array();
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char *name = row_name(summary, row);
        if (row->status == MOTE_CELL_OK && row->times_comparable) {
            json_t *entry = json_pack("{s:s, s:s, s:f}", "name", name, "unit", "ns", "value",
                                      row->total.median);
            char *range = mote_format("%.0f", (row->total.high - row->total.low) / 2);
            if (row->total.high == row->total.high)
                (void)json_object_set_new(entry, "range", json_string(range));
            free(range);
            (void)json_array_append_new(list, entry);
        }
        free(name);
    }
    return list;
}

json_t *mote_bencher_json(const mote_summary *summary)
{
    json_t *object = json_object();
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char *name = row_name(summary, row);
        if (row->status == MOTE_CELL_OK && row->times_comparable) {
            json_t *latency = json_pack("{s:f}", "value", row->total.median);
            if (row->total.low == row->total.low) {
                (void)json_object_set_new(latency, "lower_value", json_real(row->total.low));
                (void)json_object_set_new(latency, "upper_value", json_real(row->total.high));
            }
            (void)json_object_set_new(object, name, json_pack("{s:o}", "latency", latency));
        }
        free(name);
    }
    return object;
}
