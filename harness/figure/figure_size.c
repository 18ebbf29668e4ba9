/* Figures over triangles: time with fitted exponents (6), memory (7). Their rows are the
   scenarios with ww at other sizes: ww, ww-1k, ww-100k, ww-1m. */
#include "harness/base/memory.h"
#include "harness/base/number_text.h"
#include "harness/figure/figure.h"

#include <stdlib.h>
#include <string.h>

#define SIZES_MAX 16
#define SERIES_MAX 8 /* colours in plots/style.gp */
#define SIZES_LEAST 3

/* Whether a name is "ww", or "ww-" and a size: digits, then k or m or nothing. */
static bool is_size(const char *scenario)
{
    if (strcmp(scenario, "ww") == 0)
        return true;
    if (strncmp(scenario, "ww-", 3) != 0)
        return false;
    const size_t digits = strspn(scenario + 3, "0123456789");
    const char *rest = scenario + 3 + digits;
    return digits > 0 && (*rest == '\0' || ((*rest == 'k' || *rest == 'm') && rest[1] == '\0'));
}

/* One method's rows by triangles, one per size: of several the one with the fewest frames,
   which covers the frames that all sizes have. */
typedef struct size_series {
    const char *label;
    const mote_summary_row *rows[SIZES_MAX];
    size_t count;
} size_series;

static void put_row(const mote_summary_row *row, size_series *series)
{
    for (size_t i = 0; i < series->count; ++i) {
        if (strcmp(series->rows[i]->scenario, row->scenario) != 0)
            continue;
        if (row->frames < series->rows[i]->frames)
            series->rows[i] = row;
        return;
    }
    if (series->count == SIZES_MAX)
        return;
    size_t at = series->count++;
    for (; at > 0 && mote_figure_triangles(series->rows[at - 1]) > mote_figure_triangles(row);
         --at)
        series->rows[at] = series->rows[at - 1];
    series->rows[at] = row;
}

/* One method's rows at all sizes. */
static size_series make_series(const mote_summary *summary, const mote_summary_row *row)
{
    size_series made = {.label = row->label};
    for (size_t k = 0; k < summary->count; ++k) {
        const mote_summary_row *other = &summary->rows[k];
        if (other->status == MOTE_CELL_OK && other->times_comparable &&
            is_size(other->scenario) && strcmp(other->label, made.label) == 0 &&
            strcmp(other->cache, mote_cache_names[MOTE_CACHE_HOT]) == 0 &&
            strcmp(other->machine, row->machine) == 0)
            put_row(other, &made);
    }
    return made;
}

/* Finds the first SERIES_MAX methods with enough sizes, and returns how many there are; *more
   is how many there are beyond these. */
static size_t find_series(const mote_summary *summary, size_series series[SERIES_MAX],
                          size_t *more)
{
    const char **labels = mote_allocate(summary->count, sizeof *labels);
    size_t count = 0;
    for (size_t i = 0; i < summary->count; ++i) {
        bool is_new = true;
        for (size_t k = 0; k < count; ++k)
            is_new = is_new && strcmp(labels[k], summary->rows[i].label) != 0;
        if (!is_new)
            continue;
        const size_series made = make_series(summary, &summary->rows[i]);
        if (made.count < SIZES_LEAST)
            continue;
        if (count < SERIES_MAX)
            series[count] = made;
        labels[count++] = made.label;
    }
    free(labels);
    *more = count > SERIES_MAX ? count - SERIES_MAX : 0;
    return count - *more;
}

static void say_more(size_t more, mote_text *caption)
{
    if (more > 0)
        mote_text_add(caption, " %zu more method%s of this run %s not shown.", more,
                      more == 1 ? "" : "s", more == 1 ? "is" : "are");
}

static void say_missing(mote_figure *figure)
{
    mote_text_add(
        &figure->missing,
        "a method on %d sizes of ww (ww-1k, ww-10k, ww, ww-100k, ...); run `make sweep`",
        SIZES_LEAST);
}

/* "certified t^0.35": the fitted exponent, if there is one; the interval goes into the
   caption. */
static mote_status fit_title(const size_series *series, char *title, size_t size,
                             mote_text *caption)
{
    double x[SIZES_MAX], y[SIZES_MAX], exponent;
    mote_confidence interval;
    for (size_t i = 0; i < series->count; ++i) {
        x[i] = mote_figure_triangles(series->rows[i]);
        y[i] = series->rows[i]->total.median;
    }
    (void)snprintf(title, size, "%s", series->label);
    const mote_status status =
        mote_statistics_exponent(x, y, series->count, &exponent, &interval);
    if (status != MOTE_OK || exponent != exponent)
        return status;
    (void)snprintf(title, size, "%s ~ t^%.2f", series->label, exponent);
    mote_text_add(caption, " %s: %.2f (%.2f to %.2f).", series->label, exponent, interval.low,
                  interval.high);
    return MOTE_OK;
}

/* The rows of all series, one series after the other. */
typedef struct size_rows {
    const mote_summary_row *row[SERIES_MAX * SIZES_MAX];
    size_t count;
} size_rows;

static size_rows rows_of(const size_series *series, size_t count)
{
    size_rows rows = {.count = 0};
    for (size_t s = 0; s < count; ++s) {
        for (size_t i = 0; i < series[s].count; ++i)
            rows.row[rows.count++] = series[s].rows[i];
    }
    return rows;
}

/* Adds ", with its 95 % interval", if any row has one. */
static void say_intervals(const size_rows *rows, mote_text *caption)
{
    size_t having = 0;
    for (size_t i = 0; i < rows->count; ++i)
        having += rows->row[i]->total.low == rows->row[i]->total.low ? 1 : 0;
    if (having > 0)
        mote_text_add(caption, ", with its 95 %% interval");
    if (having > 0 && having < rows->count)
        mote_text_add(caption, " where two or more processes ran");
}

static bool same_range(const mote_summary_row *a, const mote_summary_row *b)
{
    return a->frame_range[0] == b->frame_range[0] && a->frame_range[1] == b->frame_range[1];
}

static bool same_range_and_scenario(const mote_summary_row *a, const mote_summary_row *b)
{
    return same_range(a, b) && strcmp(a->scenario, b->scenario) == 0;
}

static bool same_stride(const mote_summary_row *a, const mote_summary_row *b)
{
    return a->stride == b->stride;
}

/* Whether no row before row i is the same. */
static bool is_first(const size_rows *rows, size_t i,
                     bool (*same)(const mote_summary_row *, const mote_summary_row *))
{
    size_t k = 0;
    while (!same(rows->row[k], rows->row[i]))
        ++k;
    return k == i;
}

/* Adds ". Frames: 1-200 of ww-1k, ww; 1-30 of ww-10m." */
static void say_frames(const size_rows *rows, mote_text *caption)
{
    const char *before = ". Frames, which each scenario numbers from its own start:";
    for (size_t i = 0; i < rows->count; ++i) {
        const mote_summary_row *row = rows->row[i];
        if (!is_first(rows, i, same_range))
            continue;
        mote_text_add(caption, "%s %u-%u of", before, row->frame_range[0], row->frame_range[1]);
        before = ";";
        for (size_t k = i; k < rows->count; ++k) {
            if (same_range(rows->row[k], row) && is_first(rows, k, same_range_and_scenario))
                mote_text_add(caption, "%s %s", k > i ? "," : "", rows->row[k]->scenario);
        }
    }
    mote_text_add(caption, ".");
}

/* Adds " Every 16th of these only: fcl-aabb on ww-100k, ww-1m; aabb-tree on ww-1m." for each
   stride but 1. */
static void say_strides(const size_rows *rows, mote_text *caption)
{
    for (size_t i = 0; i < rows->count; ++i) {
        if (rows->row[i]->stride <= 1 || !is_first(rows, i, same_stride))
            continue;
        char ordinal[MOTE_NUMBER_TEXT];
        mote_text_add(caption, " Every %s of these only:",
                      mote_show_ordinal(rows->row[i]->stride, ordinal));
        const char *label = NULL;
        for (size_t k = i; k < rows->count; ++k) {
            const mote_summary_row *row = rows->row[k];
            if (!same_stride(row, rows->row[i]))
                continue;
            if (label && strcmp(label, row->label) == 0)
                mote_text_add(caption, ", %s", row->scenario);
            else
                mote_text_add(caption, "%s %s on %s", label ? ";" : "", row->label,
                              row->scenario);
            label = row->label;
        }
        mote_text_add(caption, ".");
    }
}

static void say_what_is_shown(const size_series *series, size_t count, mote_text *caption)
{
    const size_rows rows = rows_of(series, count);
    mote_text_add(caption, "Two letters W: median time of a query, deformation and refitting "
                           "included");
    say_intervals(&rows, caption);
    say_frames(&rows, caption);
    say_strides(&rows, caption);
}

mote_status mote_figure_size_time(const mote_figure_run *run, const char *scenario,
                                  mote_figure *figure)
{
    (void)scenario;
    size_series series[SERIES_MAX];
    size_t more;
    const size_t count = find_series(run->summary, series, &more);
    mote_text exponents = {0};
    mote_status status = MOTE_OK;
    if (count == 0)
        say_missing(figure);
    for (size_t s = 0; s < count && status == MOTE_OK; ++s) {
        char title[320];
        status = fit_title(&series[s], title, sizeof title, &exponents);
        mote_gnuplot_block(&figure->data, title);
        for (size_t i = 0; i < series[s].count; ++i) {
            mote_text_add(&figure->data, "%.0f ", mote_figure_triangles(series[s].rows[i]));
            mote_figure_time(&series[s].rows[i]->total, 1e3, &figure->data);
            mote_text_add(&figure->data, "\n");
        }
    }
    say_what_is_shown(series, count, &figure->caption);
    say_more(more, &figure->caption);
    if (exponents.size > 0)
        mote_text_add(&figure->caption,
                      " Exponents of the number of triangles t, from robust fits, with 95 %% "
                      "intervals:%s",
                      exponents.data);
    free(exponents.data);
    return status;
}

static double vertices_of(const mote_summary_row *row)
{
    return (double)row->vertices[0] + (double)row->vertices[1];
}

mote_status mote_figure_size_bytes(const mote_figure_run *run, const char *scenario,
                                   mote_figure *figure)
{
    (void)scenario;
    size_series series[SERIES_MAX];
    size_t more;
    const size_t count = find_series(run->summary, series, &more);
    for (size_t s = 0; s < count; ++s) {
        mote_gnuplot_block(&figure->data, series[s].label);
        for (size_t i = 0; i < series[s].count; ++i) {
            const mote_summary_row *row = series[s].rows[i];
            const double vertices = vertices_of(row);
            if (row->heap_live_bytes > 0 && vertices > 0)
                mote_text_add(&figure->data, "%.0f %.17g %.17g\n", mote_figure_triangles(row),
                              row->heap_live_bytes, row->heap_live_bytes / vertices);
        }
    }
    if (count == 0)
        say_missing(figure);
    mote_text_add(
        &figure->caption,
        "Two letters W: the heap that a method holds after its run, without meshes and "
        "fields, and the same per vertex of both bodies. Bytes are counted, not "
        "sampled, and so have no interval.");
    say_more(more, &figure->caption);
    return MOTE_OK;
}
