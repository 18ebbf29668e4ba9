#include "harness/summary/column_value.h"

#include "harness/base/record.h"

json_t *mote_column_counters(const mote_summary_row *row)
{
    json_t *object = json_object();
    for (int k = 0; k < MOTE_STORED_COUNTS && row->finished > 0; ++k) {
        double sum = 0, max = 0, all = 0;
        for (size_t r = 0; r < row->replicates; ++r) {
            sum += row->cells[r].counts[k].sum;
            max = row->cells[r].counts[k].max > max ? row->cells[r].counts[k].max : max;
            all += (double)row->cells[r].frames;
        }
        (void)json_object_set_new(object, mote_stored_count_names[k],
                                  json_pack("{s:f, s:f}", "mean", sum / all, "max", max));
    }
    return object;
}

json_t *mote_column_processes(const mote_summary_row *row)
{
    json_t *list = json_array();
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        if (cell->status != MOTE_CELL_OK)
            continue;
        json_t *counts = json_object();
        for (int k = 0; k < MOTE_STORED_COUNTS; ++k)
            (void)json_object_set_new(counts, mote_stored_count_names[k],
                                      json_real(cell->counts[k].sum));
        (void)json_array_append_new(
            list, json_pack("{s:i, s:o, s:o, s:o}", "replicate", (int)cell->replicate,
                            "median_ns", mote_json_number(row->processes[r].median), "ratio",
                            mote_json_number(row->processes[r].ratio), "counters", counts));
    }
    return list;
}

json_t *mote_column_quiet(const mote_summary_row *row)
{
    json_t *totals = json_array(), *ratios = json_array();
    for (int k = 0; k < MOTE_QUIET_GROUPS; ++k) {
        (void)json_array_append_new(totals, mote_json_number(row->quiet.total[k]));
        (void)json_array_append_new(ratios, mote_json_number(row->quiet.ratio[k]));
    }
    return json_pack("{s:o, s:o}", "total_ns", totals, "ratio", ratios);
}
