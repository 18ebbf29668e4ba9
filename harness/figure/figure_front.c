/* Figure 4: speed against error, with n beside the curves where there is room. */
#include "harness/base/memory.h"
#include "harness/figure/figure.h"
#include "harness/figure/figure_room.h"
#include "harness/summary/front.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* These match plots/front.gp: errors up to this are drawn on the lowest line; how far the axes
   extend beyond the first and last point, and their lengths in its units. */
#define FLOOR 1e-5
#define BEYOND_X 3.0
#define LOWEST_Y (FLOOR / 3)
#define HIGHEST_Y 2.0
#define WIDTH 448.0
#define HEIGHT 269.0

typedef struct canvas {
    double low_x, per_x, per_y; /* log10 of nanoseconds at the left; units per decade */
    mote_room room;
} canvas;

/* The families named in a front beside the best engine's; the others are points without a
   name. */
static const char *const front_families[] = {"particle-paper:refine=no",
                                             "particle-paper",
                                             "particle-paper:refine=always",
                                             "particle",
                                             "certified",
                                             "fcl-aabb",
                                             "fcl-aabb:queue=64,seed=previous",
                                             "fcl-obbrss",
                                             "fcl-obb",
                                             "aabb-tree",
                                             "hybrid-fcl"};
enum { FRONT_FAMILIES = sizeof front_families / sizeof front_families[0] };

/* Whether a family is named: `engine` is that of the best engine of others, or "". */
static bool is_named(const char *family, const char *engine)
{
    for (int i = 0; i < FRONT_FAMILIES; ++i) {
        if (strcmp(front_families[i], family) == 0)
            return true;
    }
    return strcmp(engine, family) == 0;
}

static mote_rectangle place_of(const canvas *c, const mote_summary_row *row)
{
    const double error = row->error.p99 > FLOOR ? row->error.p99 : FLOOR;
    return mote_room_point((log10(row->total.median) - c->low_x) * c->per_x,
                           (log10(error) - log10(LOWEST_Y)) * c->per_y);
}

static bool is_point(const mote_summary *summary, const mote_summary_row *row,
                     const char *scenario)
{
    return mote_figure_has_error(row) && row->total.median > 0 && !row->given &&
           mote_figure_shows(summary, row, scenario);
}

/* Computes the axes and marks the places of all points as taken; the caller frees
   c->room.taken. */
static void open_canvas(const mote_summary *summary, const char *scenario, canvas *c)
{
    double low = HUGE_VAL, high = DBL_MIN;
    memset(c, 0, sizeof *c);
    c->room.taken = mote_allocate(2 * summary->count, sizeof *c->room.taken);
    for (size_t i = 0; i < summary->count; ++i) {
        if (!is_point(summary, &summary->rows[i], scenario))
            continue;
        low = fmin(low, summary->rows[i].total.median);
        high = fmax(high, summary->rows[i].total.median);
    }
    c->low_x = log10(low / BEYOND_X);
    c->per_x = WIDTH / (log10(high * BEYOND_X) - c->low_x);
    c->per_y = HEIGHT / (log10(HIGHEST_Y) - log10(LOWEST_Y));
    for (size_t i = 0; i < summary->count; ++i) {
        if (is_point(summary, &summary->rows[i], scenario))
            c->room.taken[c->room.count++] = place_of(c, &summary->rows[i]);
    }
}

/* Adds one point: n or nothing, median total in us and its interval, 99th percentile and its
   interval, the place of n. */
static void add_point(canvas *c, const mote_summary_row *row, bool named, mote_text *text)
{
    mote_rectangle at = place_of(c, row);
    if (named && row->n == row->n && mote_room_find(&c->room, at, row->n, &at))
        mote_text_add(text, "%.0f ", row->n);
    else
        mote_text_add(text, "\"\" ");
    mote_figure_time(&row->total, 1e3, text);
    mote_text_add(text, " ");
    mote_figure_quantile(row, 0.99, row->error.p99, text);
    mote_text_add(text, "%.6g %.6g\n", pow(10, c->low_x + at.x / c->per_x) * 1e-3,
                  LOWEST_Y * pow(10, at.y / c->per_y));
}

/* The fastest engine of others without a wrong answer among the points; NULL: none. */
static const mote_summary_row *best_engine(const mote_summary *summary, const char *scenario)
{
    const mote_summary_row *best = NULL;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (is_point(summary, row, scenario) && mote_summary_is_right_engine(row) &&
            (!best || row->total.median < best->total.median))
            best = row;
    }
    return best;
}

/* Adds the block of a family, or, if family is NULL, of all families without a name, which are
   not joined by lines. */
static void add_family(canvas *c, const mote_summary *summary, const char *scenario,
                       const char *family, const char *engine, mote_text *text)
{
    bool begun = false;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char title[MOTE_FIGURE_FAMILY];
        mote_front_title(row, title, sizeof title);
        const bool wanted = family ? strcmp(family, title) == 0 : !is_named(title, engine);
        if (!wanted || !is_point(summary, row, scenario))
            continue;
        if (!begun)
            mote_gnuplot_block(text, family ? family : "others");
        begun = true;
        add_point(c, row, family != NULL, text);
        if (!family)
            mote_text_add(text, "\n");
    }
}

mote_status mote_figure_front(const mote_figure_run *run, const char *scenario,
                              mote_figure *figure)
{
    canvas c;
    open_canvas(run->summary, scenario, &c);
    const mote_summary_row *best = best_engine(run->summary, scenario);
    char engine[MOTE_FIGURE_FAMILY] = "";
    if (best)
        mote_front_title(best, engine, sizeof engine);
    for (int i = 0; i < FRONT_FAMILIES; ++i)
        add_family(&c, run->summary, scenario, front_families[i], engine, &figure->data);
    if (best && !is_named(engine, ""))
        add_family(&c, run->summary, scenario, engine, engine, &figure->data);
    add_family(&c, run->summary, scenario, NULL, engine, &figure->data);
    free(c.room.taken);
    if (figure->data.size == 0)
        mote_text_add(&figure->missing, "a method that reports a distance on %s", scenario);
    mote_text_add(
        &figure->caption,
        "Median time of a query, deformation and refitting included, against the 99th "
        "percentile of the absolute error, each with its 95 %% interval over processes. Lines "
        "join configurations of one method that differ in the number of particles, which "
        "stands beside a point where there is room. Errors of at most %g L are drawn on the "
        "lowest line.",
        FLOOR);
    if (best)
        mote_text_add(&figure->caption, " %s is the fastest engine of others in this run.",
                      best->label);
    return MOTE_OK;
}
