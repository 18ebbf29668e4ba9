/* Several bodies: time of a frame over their number (15). */
#include "harness/figure/figure.h"

#include "harness/base/memory.h"
#include "harness/base/record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Panels and lines of plots/bodies.gp, which relies on their number and order. */
static const double densities[] = {0.1, 1, 4};
static const char *const methods[] = {"certified",    "fcl-aabb:refit=every",
                                      "fcl-aabb",     "aabb-tree",
                                      "particle:n=8", "particle-paper:n=5"};
enum {
    DENSITIES = sizeof densities / sizeof densities[0],
    METHODS = sizeof methods / sizeof methods[0]
};

static bool has_scenes(const json_t *root)
{
    size_t i;
    const json_t *row;
    MOTE_EACH(i, row, json_object_get(root, "rows"))
    {
        if (json_object_get(row, "bodies"))
            return true;
    }
    return false;
}

/* Reads summary.json of the run where it has more than two bodies, else of ../bodies; false,
   with a text in missing, where there is none. */
static bool read_rows(const mote_figure_run *run, mote_figure *figure, json_t **root)
{
    static const char *const names[] = {"summary.json", "../bodies/summary.json"};
    for (size_t k = 0; k < 2; ++k) {
        char *path = mote_format("%s/%s", run->directory, names[k]);
        const bool there = access(path, F_OK) == 0;
        free(path);
        if (!there)
            continue;
        if (mote_record_read_json(run->directory, names[k], root) != MOTE_OK) {
            mote_text_add(&figure->missing, "%s", mote_error_text());
            return false;
        }
        if (has_scenes(*root))
            return true;
        json_decref(*root);
        *root = NULL;
    }
    mote_text_add(&figure->missing, "rows of more than two bodies in summary.json, here or in "
                                    "../bodies; `make bodies` measures them");
    return false;
}

static double number_of(const json_t *row, const char *key)
{
    const json_t *value = json_object_get(row, key);
    return json_is_number(value) ? json_number_value(value) : (double)NAN;
}

static bool has_text(const json_t *row, const char *key, const char *text)
{
    const char *value = json_string_value(json_object_get(row, key));
    return value && strcmp(value, text) == 0;
}

/* Whether a row is that of a method (its label), on bodies with a density, and ended well. */
static bool is_row(const json_t *row, const char *method, double density)
{
    return has_text(row, "status", "ok") && has_text(row, "label", method) &&
           fabs(number_of(row, "near_pairs_wanted") - density) < 1e-9;
}

/* Mean over all frames but the first. */
static double mean_of(const json_t *row)
{
    return number_of(json_object_get(row, "active_total_ns"), "mean");
}

/* Numbers of bodies ascending; a number that is missing comes first. */
static int by_bodies(const void *a, const void *b)
{
    const double x = number_of(*(const json_t *const *)a, "bodies");
    const double y = number_of(*(const json_t *const *)b, "bodies");
    return (x > y || (x == x && y != y)) - (x < y || (y == y && x != x));
}

/* A line: N, mean of a frame in us, MB of the process. Rows come in the order of their
   scenarios' names. Returns how many points it has. */
static size_t add_line(const json_t *rows, size_t d, size_t m, mote_text *text)
{
    size_t i, count = 0;
    const json_t *row;
    const json_t **line = mote_allocate(json_array_size(rows), sizeof(const json_t *));
    MOTE_EACH(i, row, rows)
    {
        if (is_row(row, methods[m], densities[d]))
            line[count++] = row;
    }
    qsort(line, count, sizeof(const json_t *), by_bodies);
    mote_gnuplot_block(text, methods[m]);
    for (size_t k = 0; k < count; ++k)
        mote_text_add(text, "%.0f %.6g %.6g\n", number_of(line[k], "bodies"),
                      mean_of(line[k]) / 1e3, number_of(line[k], "rss_peak_bytes") / 1e6);
    if (count == 0)
        mote_text_add(text, "NaN NaN NaN\n");
    free(line);
    return count;
}

/* The time of the first control over that of certified, for 1,000 bodies. */
static void add_ratios(const json_t *rows, mote_text *caption)
{
    for (size_t d = 0; d < DENSITIES; ++d) {
        double means[2] = {(double)NAN, (double)NAN};
        size_t i;
        const json_t *row;
        MOTE_EACH(i, row, rows)
        {
            for (int m = 0; m < 2; ++m) {
                if (is_row(row, methods[m], densities[d]) &&
                    fabs(number_of(row, "bodies") - 1000) < 0.5)
                    means[m] = mean_of(row);
            }
        }
        const double ratio = means[1] / means[0];
        if (!isnan(ratio))
            mote_text_add(caption,
                          " With 1,000 bodies and %g near pairs each, a frame of certified "
                          "takes one %.0fth "
                          "of the time of fcl-aabb:refit=every.",
                          densities[d], ratio);
    }
}

mote_status mote_figure_bodies(const mote_figure_run *run, const char *scenario,
                               mote_figure *figure)
{
    json_t *root = NULL;
    (void)scenario;
    if (!read_rows(run, figure, &root))
        return MOTE_OK;
    const json_t *rows = json_object_get(root, "rows");
    size_t points = 0;
    for (size_t d = 0; d < DENSITIES; ++d) {
        for (size_t m = 0; m < METHODS; ++m)
            points += add_line(rows, d, m, &figure->data);
    }
    if (points == 0) {
        mote_text_add(&figure->missing, "rows of more than two bodies with \"near_pairs\" of "
                                        "0.1, 1 or 4; `make bodies` measures them");
        free(figure->data.data);
        figure->data = (mote_text){0};
        json_decref(root);
        return MOTE_OK;
    }
    mote_text_add(&figure->caption,
                  "Time of a frame over the number of bodies, all deforming, with 0.1, 1 and 4 "
                  "near pairs a body: letters W of 11,920 triangles; at 10,000, which only "
                  "certified ran, letters of four shapes. Points: means over the frames but "
                  "the first, which finds all pairs anew. fcl-aabb and aabb-tree refit the "
                  "bodies that have a near pair; refit=every refits all.");
    add_ratios(rows, &figure->caption);
    json_decref(root);
    return MOTE_OK;
}
