#include "harness/file.h"
#include "harness/table.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* "scenario/method:key=value/evict": the name of a row in other tools. */
static char *row_name(const mote_summary_row *row)
{
    return mote_format("%s/%s/%s", row->first->scenario, row->label, row->first->cache);
}

static json_t *gbench_context(void)
{
    char host[256] = "", date[32] = "";
    time_t now = time(NULL);
    struct tm utc;
    if (gmtime_r(&now, &utc))
        (void)strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S+00:00", &utc);
    (void)gethostname(host, sizeof host - 1);
    return json_pack(
        "{s:s, s:s, s:s, s:i, s:b, s:[], s:[], s:s, s:i}", "date", date, "host_name", host,
        "executable", "mote", "num_cpus", (int)sysconf(_SC_NPROCESSORS_ONLN),
        "cpu_scaling_enabled", 0, "caches", "load_avg", "library_build_type",
        strcmp(MOTE_BUILD_TYPE, "Debug") == 0 ? "debug" : "release", "json_schema_version", 1);
}

/* One replicate of a row: its median total. */
static json_t *gbench_replicate(const mote_summary_row *row, const char *name, size_t index)
{
    const mote_stored_cell *cell = &row->cells[index];
    double *work = malloc((cell->frames + 1) * sizeof *work);
    if (!work)
        return NULL;
    memcpy(work, cell->total_ns, cell->frames * sizeof *work);
    double median = mote_statistics_median(work, cell->frames);
    free(work);
    char *full = mote_format("%s/real_time", name);
    json_t *entry = json_pack(
        "{s:s, s:s, s:s, s:i, s:i, s:i, s:i, s:f, s:f, s:s}", "name", full ? full : name,
        "run_name", full ? full : name, "run_type", "iteration", "repetitions",
        (int)row->finished, "repetition_index", (int)index, "threads", 1, "iterations",
        (int)cell->frames, "real_time", median, "cpu_time", median, "time_unit", "ns");
    free(full);
    for (int k = 0; entry && k < MOTE_STORED_COUNTS; ++k)
        (void)json_object_set_new(entry, mote_stored_count_names[k],
                                  json_real(cell->counts[k].sum / (double)cell->frames));
    return entry;
}

json_t *mote_gbench_json(const mote_summary *summary)
{
    json_t *benchmarks = json_array();
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char *name = row_name(row);
        for (size_t r = 0; name && r < row->replicates; ++r) {
            if (row->cells[r].frames > 0)
                (void)json_array_append_new(benchmarks, gbench_replicate(row, name, r));
        }
        free(name);
    }
    return json_pack("{s:o, s:o}", "context", gbench_context(), "benchmarks", benchmarks);
}

json_t *mote_gha_json(const mote_summary *summary)
{
    json_t *list = json_array();
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char *name = row_name(row);
        if (name && row->status == MOTE_CELL_OK) {
            json_t *entry = json_pack("{s:s, s:s, s:f}", "name", name, "unit", "ns", "value",
                                      row->total.median);
            char *range = mote_format("%.0f", (row->total.high - row->total.low) / 2);
            if (range && row->total.high == row->total.high)
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
        char *name = row_name(row);
        if (name && row->status == MOTE_CELL_OK) {
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
