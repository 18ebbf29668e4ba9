#include "harness/summary/table.h"

#include "harness/base/number_text.h"

#include <string.h>

typedef char field[MOTE_NUMBER_TEXT];

/* A change that is larger than this says nothing. */
#define CHANGE_MAX 10.0

static bool same_block(const mote_summary_row *a, const mote_summary_row *b)
{
    return mote_stored_by_scene(a->first, b->first) == 0 &&
           mote_stored_by_frames(a->first, b->first) == 0;
}

static size_t label_width(const mote_summary *summary)
{
    size_t width = strlen("method");
    for (size_t i = 0; i < summary->count; ++i) {
        size_t length = strlen(summary->rows[i].label);
        width = length > width ? length : width;
    }
    return width;
}

/* The largest number of frames and of replicates in the block that starts at a row. */
static void print_head(const mote_summary *summary, size_t start, int width, FILE *out)
{
    const mote_summary_row *row = &summary->rows[start];
    size_t frames = 0, replicates = 0;
    for (size_t i = start; i < summary->count && same_block(row, &summary->rows[i]); ++i) {
        const mote_summary_row *other = &summary->rows[i];
        frames = other->frames > frames ? other->frames : frames;
        replicates = other->replicates > replicates ? other->replicates : replicates;
    }
    const json_t *triangles = json_object_get(row->first->json, "triangles");
    bool several = mote_summary_machines_differ(summary);
    (void)fprintf(out, "%s%s: %d and %d triangles, %zu frames, %zu replicates, caches %s%s%s\n",
                  start ? "\n" : "", row->first->scenario,
                  (int)json_integer_value(json_array_get(triangles, 0)),
                  (int)json_integer_value(json_array_get(triangles, 1)), frames, replicates,
                  row->first->cache, several ? ", on " : "",
                  several ? row->first->machine : "");
    (void)fprintf(out, "%-*s %5s %9s %9s %9s %9s %9s %8s %8s %8s %8s %8s %8s %7s %6s %6s %9s\n",
                  width, "", "", "total", "", "deform", "update", "query", "fcl-aabb", "given",
                  "best FCL", "error/L", "", "", "exact", "missed", "false", "heap");
    (void)fprintf(out, "%-*s %5s %9s %9s %9s %9s %9s %8s %8s %8s %8s %8s %7s %6s %6s %9s\n",
                  width, "method", "n", "median", "p95", "median", "median", "median", "/ this",
                  "/ this", "median", "p99", "max", "", "", "", "");
}

static void print_row(const mote_summary_row *row, int width, FILE *out)
{
    field f[16];
    (void)fprintf(out, "%-*s %5s ", width, row->label, mote_show_count(row->n, f[0]));
    if (row->status != MOTE_CELL_OK) {
        const char *reason = json_string_value(json_object_get(row->first->json, "reason"));
        (void)fprintf(out, "%s: %s\n", mote_cell_status_names[row->status],
                      reason ? reason : "");
        return;
    }
    (void)fprintf(
        out, "%9s %9s %9s %9s %9s %8s %8s %8s %8s %8s %8s %7s %6s %6s %9s",
        mote_show_time(row->total.median, f[1]), mote_show_time(row->total.p95, f[2]),
        mote_show_time(row->deform.median, f[3]), mote_show_time(row->update.median, f[4]),
        mote_show_time(row->query.median, f[5]), mote_show_ratio(row->ratio.value, f[6]),
        mote_show_ratio(row->ratio_given.value, f[15]),
        mote_show_ratio(row->ratio_best.value, f[7]), mote_show_error(row->error.median, f[8]),
        mote_show_error(row->error.p99, f[9]), mote_show_error(row->error.max, f[10]),
        mote_show_percent(row->error.exact_rate, f[11]), mote_show_count(row->missed, f[12]),
        mote_show_count(row->false_contacts, f[13]),
        mote_show_bytes(row->heap_live_bytes, f[14]));
    if (row->first->stride > 1)
        (void)fprintf(out, "  every %uth frame", row->first->stride);
    if (row->jobs > 1)
        (void)fprintf(out, "  times not comparable: %u cells at once", row->jobs);
    if (row->finished < row->replicates)
        (void)fprintf(out, "  %zu of %zu replicates ended badly",
                      row->replicates - row->finished, row->replicates);
    (void)fprintf(out, "\n");
}

/* What the two columns of ratios are taken to, below a block. */
static void print_foot(const mote_summary *summary, const mote_summary_row *row, FILE *out)
{
    if (row->ratio.to != SIZE_MAX && row->ratio_best.to != SIZE_MAX)
        (void)fprintf(
            out,
            "fcl-aabb: %s; given: the same where nobody pays for deforming all vertices; "
            "best FCL: %s\n",
            summary->rows[row->ratio.to].label, summary->rows[row->ratio_best.to].label);
}

/* How far the times can be trusted. */
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
    int width = (int)label_width(summary);
    for (size_t i = 0; i < summary->count;) {
        size_t start = i;
        const mote_summary_row *measured = &summary->rows[i];
        print_head(summary, i, width, out);
        for (; i < summary->count && same_block(&summary->rows[start], &summary->rows[i]);
             ++i) {
            print_row(&summary->rows[i], width, out);
            if (summary->rows[i].status == MOTE_CELL_OK)
                measured = &summary->rows[i];
        }
        print_foot(summary, measured, out);
    }
    print_quality(summary, out);
    if (summary->stored.left_out > 0)
        (void)fprintf(out, "%zu cells were measured by another build and are left out\n",
                      summary->stored.left_out);
}

static void csv_number(double value, FILE *out)
{
    if (value == value)
        (void)fprintf(out, ",%.17g", value);
    else
        (void)fputc(',', out);
}

/* A quoted field. */
static void csv_text(const char *text, FILE *out)
{
    (void)fputc('"', out);
    for (; *text; ++text) {
        if (*text == '"')
            (void)fputc('"', out);
        (void)fputc(*text, out);
    }
    (void)fputc('"', out);
}

static void csv_time(const mote_time *time, FILE *out)
{
    csv_number(time->median, out);
    csv_number(time->low, out);
    csv_number(time->high, out);
    csv_number(time->mean, out);
    csv_number(time->p95, out);
    csv_number(time->max, out);
}

void mote_table_print_csv(const mote_summary *summary, FILE *out)
{
    (void)fprintf(out, "scenario,cache,method,label,n,stride,frames,replicates,status");
#define PRINT_NAMES(name, key)                                                                 \
    (void)fprintf(out, ",%s_median,%s_ci_low,%s_ci_high,%s_mean,%s_p95,%s_max", key, key, key, \
                  key, key, key);
    MOTE_TIMES(PRINT_NAMES)
#undef PRINT_NAMES
    (void)fprintf(out, ",ratio,ratio_ci_low,ratio_ci_high,ratio_best,error_median,error_p95,"
                       "error_p99,error_max,exact_rate,contacts,missed,false_contacts,"
                       "heap_live_bytes,heap_peak_bytes,rss_peak_bytes,machine,"
                       "replicates_failed,jobs\n");
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        csv_text(row->first->scenario, out);
        (void)fprintf(out, ",%s,%s,", row->first->cache, row->first->method);
        csv_text(row->label, out);
        csv_number(row->n, out);
        (void)fprintf(out, ",%u,%zu,%zu,%s", row->first->stride, row->frames, row->finished,
                      mote_cell_status_names[row->status]);
#define PRINT_TIME(name, key) csv_time(&row->name, out);
        MOTE_TIMES(PRINT_TIME)
#undef PRINT_TIME
        const double rest[] = {
            row->ratio.value,      row->ratio.low,       row->ratio.high,
            row->ratio_best.value, row->error.median,    row->error.p95,
            row->error.p99,        row->error.max,       row->error.exact_rate,
            row->contacts,         row->missed,          row->false_contacts,
            row->heap_live_bytes,  row->heap_peak_bytes, row->rss_peak_bytes};
        for (size_t k = 0; k < sizeof rest / sizeof rest[0]; ++k)
            csv_number(rest[k], out);
        (void)fputc(',', out);
        if (row->first->machine[0])
            csv_text(row->first->machine, out);
        (void)fprintf(out, ",%zu,%u\n", row->replicates - row->finished, row->jobs);
    }
}
