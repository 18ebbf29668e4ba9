/* Figures over triangles: time with fitted exponents (6), memory (7). Their rows are the
   scenarios with ww at other sizes: ww, ww-1k, ww-100k, ww-1m. */
#include "harness/figure/figure.h"

#include <stdlib.h>
#include <string.h>

#define SIZES_MAX 16
#define SERIES_MAX 8
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

static size_t find_series(const mote_summary *summary, size_series series[SERIES_MAX])
{
    size_t count = 0;
    for (size_t i = 0; i < summary->count && count < SERIES_MAX; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        size_series made = {.label = row->label};
        bool is_new = true;
        for (size_t k = 0; k < count; ++k)
            is_new = is_new && strcmp(series[k].label, row->label) != 0;
        for (size_t k = 0; k < summary->count && is_new; ++k) {
            const mote_summary_row *other = &summary->rows[k];
            if (other->status == MOTE_CELL_OK && other->times_comparable &&
                is_size(other->scenario) && strcmp(other->label, made.label) == 0 &&
                strcmp(other->cache, mote_cache_names[MOTE_CACHE_HOT]) == 0 &&
                strcmp(other->machine, row->machine) == 0)
                put_row(other, &made);
        }
        if (made.count >= SIZES_LEAST)
            series[count++] = made;
    }
    return count;
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

mote_status mote_figure_size_time(const mote_figure_run *run, const char *scenario,
                                  mote_figure *figure)
{
    (void)scenario;
    size_series series[SERIES_MAX];
    const size_t count = find_series(run->summary, series);
    mote_status status = MOTE_OK;
    if (count == 0)
        say_missing(figure);
    mote_text_add(
        &figure->caption,
        "Two letters W: median time of a query, deformation and refitting included, with its "
        "95 %% interval. All sizes have the same frames, except ww-10m, whose frames are "
        "around a touch. Exponents of the number of triangles t, from robust fits, with 95 %% "
        "intervals:");
    for (size_t s = 0; s < count && status == MOTE_OK; ++s) {
        char title[320];
        status = fit_title(&series[s], title, sizeof title, &figure->caption);
        mote_gnuplot_block(&figure->data, title);
        for (size_t i = 0; i < series[s].count; ++i) {
            mote_text_add(&figure->data, "%.0f ", mote_figure_triangles(series[s].rows[i]));
            mote_figure_time(&series[s].rows[i]->total, 1e3, &figure->data);
            mote_text_add(&figure->data, "\n");
        }
    }
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
    const size_t count = find_series(run->summary, series);
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
    return MOTE_OK;
}
