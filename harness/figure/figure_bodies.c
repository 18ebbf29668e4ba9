/* Several bodies: time per frame over their number (15). */
#include "harness/figure/figure.h"

#include "harness/base/memory.h"
#include "harness/base/number_text.h"
#include "harness/base/record.h"
#include "harness/summary/summary_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Panels and lines; plots/bodies.gp relies on their number and order. */
static const double densities[] = {0.1, 1, 4};
static const char *const methods[] = {"certified",    "fcl-aabb:refit=every",
                                      "fcl-aabb",     "aabb-tree",
                                      "particle:n=8", "particle-paper:n=5"};
enum {
    DENSITIES = sizeof densities / sizeof densities[0],
    METHODS = sizeof methods / sizeof methods[0]
};

static bool has_scenes(const mote_summary *summary)
{
    size_t i = 0;
    while (i < summary->count && summary->rows[i].bodies == 0)
        ++i;
    return i < summary->count;
}

/* The summary of the run if it has more than two bodies, otherwise that of ../bodies, read into
 *other, which the caller frees; NULL, with a text in missing, if there is none. */
static const mote_summary *find_summary(const mote_figure_run *run, mote_figure *figure,
                                        mote_summary *other)
{
    static const char *const names[] = {"summary.json", "../bodies/summary.json"};
    if (has_scenes(run->summary))
        return run->summary;
    for (size_t k = 0; k < 2; ++k) {
        if (!mote_record_exists(run->directory, names[k]))
            continue;
        if (mote_summary_read(run->directory, names[k], other) != MOTE_OK) {
            mote_text_add(&figure->missing, "%s", mote_error_text());
            return NULL;
        }
        if (has_scenes(other))
            return other;
        mote_summary_free(other);
    }
    mote_text_add(&figure->missing, "rows of more than two bodies in summary.json, here or in "
                                    "../bodies; `make bodies` measures them");
    return NULL;
}

/* Whether a row is that of a method (its label) at a density of bodies, and succeeded. */
static bool is_row(const mote_summary_row *row, const char *method, double density)
{
    return row->status == MOTE_CELL_OK && strcmp(row->label, method) == 0 &&
           fabs(row->near_pairs_wanted - density) < 1e-9;
}

static int by_bodies(const void *a, const void *b)
{
    const mote_summary_row *const *x = a, *const *y = b;
    return ((*x)->bodies > (*y)->bodies) - ((*x)->bodies < (*y)->bodies);
}

/* Adds a line: N, mean time of a frame in us, MB of the process. Rows are in the order of their
   scenarios' names. Returns its number of points. */
static size_t add_line(const mote_summary *summary, size_t d, size_t m, mote_text *text)
{
    size_t count = 0;
    const mote_summary_row **line =
        mote_allocate(summary->count, sizeof(const mote_summary_row *));
    for (size_t i = 0; i < summary->count; ++i) {
        if (is_row(&summary->rows[i], methods[m], densities[d]))
            line[count++] = &summary->rows[i];
    }
    qsort(line, count, sizeof(const mote_summary_row *), by_bodies);
    mote_gnuplot_block(text, methods[m]);
    for (size_t k = 0; k < count; ++k)
        mote_text_add(text, "%u %.6g %.6g\n", line[k]->bodies, line[k]->active_total.mean / 1e3,
                      line[k]->rss_peak_bytes / 1e6);
    if (count == 0)
        mote_text_add(text, "NaN NaN NaN\n");
    free(line);
    return count;
}

/* Adds the time of the first baseline divided by that of certified, for 1,000 bodies. */
static void add_ratios(const mote_summary *summary, mote_text *caption)
{
    for (size_t d = 0; d < DENSITIES; ++d) {
        double means[2] = {(double)NAN, (double)NAN};
        for (size_t i = 0; i < summary->count; ++i) {
            const mote_summary_row *row = &summary->rows[i];
            for (int m = 0; m < 2; ++m) {
                if (row->bodies == 1000 && is_row(row, methods[m], densities[d]))
                    means[m] = row->active_total.mean; /* over all frames but the first */
            }
        }
        const double ratio = means[1] / means[0];
        if (!isnan(ratio))
            mote_text_add(caption,
                          " With 1,000 bodies and %g near pairs each, a frame of certified "
                          "takes 1/%.0f of "
                          "the time of fcl-aabb:refit=every.",
                          densities[d], ratio);
    }
}

static bool is_drawn(const mote_summary_row *row)
{
    for (size_t d = 0; d < DENSITIES; ++d) {
        for (size_t m = 0; m < METHODS; ++m) {
            if (is_row(row, methods[m], densities[d]))
                return true;
        }
    }
    return false;
}

/* The least and the most of a number that rows have. */
typedef struct extent {
    double least, most;
} extent;

static void widen(extent *e, double least, double most)
{
    e->least = fmin(e->least, least);
    e->most = fmax(e->most, most);
}

/* Adds "11,920" or "1,380 to 11,920". */
static void add_extent(extent e, mote_text *caption)
{
    char least[MOTE_NUMBER_TEXT], most[MOTE_NUMBER_TEXT];
    if (e.least < e.most)
        mote_text_add(caption, "%s to ", mote_show_whole(e.least, least));
    mote_text_add(caption, "%s", mote_show_whole(e.most, most));
}

/* Adds ": 1,380 to 11,920 triangles each, of 1 to 4 shapes", as far as the rows say it. */
static void say_which_bodies(const mote_summary *summary, mote_text *caption)
{
    extent triangles = {HUGE_VAL, 0}, shapes = {HUGE_VAL, 0};
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (!is_drawn(row) || row->triangles[0] == 0 || row->shapes == 0)
            continue;
        widen(&triangles, row->triangles[0], row->triangles[1]);
        widen(&shapes, row->shapes, row->shapes);
    }
    if (triangles.most == 0)
        return;
    mote_text_add(caption, ": ");
    add_extent(triangles, caption);
    mote_text_add(caption, " triangles each, of ");
    add_extent(shapes, caption);
    mote_text_add(caption, " shape%s", shapes.most == 1 ? "" : "s");
}

mote_status mote_figure_bodies(const mote_figure_run *run, const char *scenario,
                               mote_figure *figure)
{
    mote_summary other = {0};
    (void)scenario;
    const mote_summary *summary = find_summary(run, figure, &other);
    if (!summary)
        return MOTE_OK;
    size_t points = 0;
    for (size_t d = 0; d < DENSITIES; ++d) {
        for (size_t m = 0; m < METHODS; ++m)
            points += add_line(summary, d, m, &figure->data);
    }
    if (points == 0) {
        mote_text_add(&figure->missing, "rows of more than two bodies with \"near_pairs\" of "
                                        "0.1, 1 or 4; `make bodies` measures them");
        free(figure->data.data);
        figure->data = (mote_text){0};
        mote_summary_free(&other);
        return MOTE_OK;
    }
    mote_text_add(&figure->caption,
                  "Time of a frame over the number of bodies, with 0.1, 1 and 4 near pairs a "
                  "body");
    say_which_bodies(summary, &figure->caption);
    mote_text_add(&figure->caption,
                  ". Points: means over the frames but the first, which finds all pairs anew. "
                  "fcl-aabb and aabb-tree refit the bodies that have a near pair; refit=every "
                  "refits all.");
    add_ratios(summary, &figure->caption);
    mote_summary_free(&other);
    return MOTE_OK;
}
