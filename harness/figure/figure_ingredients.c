/* Figures of tracked particles: the effect of each ingredient (13), and the front over the
   parameters (14). Their rows are measured by harness/scripts/ingredients.sh. */
#include "harness/figure/figure.h"

#include "harness/base/record.h"
#include "harness/figure/figure_room.h"

#include <stdlib.h>
#include <string.h>

/* The reference configuration. */
#define WHOLE "particle:n=8"

/* This matches plots/ingredients.gp and plots/tracked.gp: smaller percentages are drawn as
   zero. */
#define LEAST_PERCENT 0.02

/* Ingredients are shown if some scenario has at least this many rows; otherwise the run
   measured something else. */
#define ROWS_WANTED 6

typedef struct variant {
    const char *label, *title; /* parameters in the method's order, as in rows */
} variant;

static const variant variants[] = {
    {WHOLE, "as it is, n = 8"},
    {"particle:n=8,leap=off", "no leaps"},
    {"particle:n=8,track=0", "nothing tracked"},
    {"particle:n=0", "last pair only"},
    {"particle:n=8,refine=1", "one pair refined"},
    {"particle:n=8,descend=off", "no descent"},
    {"particle:n=8,descend=off,forces=on", "no descent, forces"},
    {"particle:n=8,start=random", "random start"},
    {"particle:n=8,reseed=off", "no reseeding"},
    {"particle:n=8,reseed=off,forces=on", "no reseeding, forces"},
    {"particle:n=8,forces=on", "forces"},
    {"particle:n=8,positions=given", "positions given"},
    {"particle:n=8,launch=8", "8 launches a query"},
    {"particle:n=32,launch=32,track=64,refine=64", "n = 32, all of all"},
};
enum { VARIANTS = sizeof variants / sizeof variants[0] };

static const char *const scenarios[] = {"ww", "fast-100", "jump", "comb", "ww-1m"};
enum { SCENARIOS = sizeof scenarios / sizeof scenarios[0] };

/* Percentage of the frames with a distance that are not exact. */
static double percent_wrong(const mote_summary_row *row)
{
    const double exact = row->error.exact_rate_separated;
    return exact == exact ? 100 * (1 - exact) : 100 * (1 - row->error.exact_rate);
}

/* Percentage of missed contacts; MOTE_NONE if there are no contacts. */
static double percent_missed(const mote_summary_row *row)
{
    return row->contacts > 0 ? 100 * row->missed / row->contacts : MOTE_NONE;
}

static void add_number(mote_text *text, double value)
{
    if (value == value)
        mote_text_add(text, "%.6g ", value);
    else
        mote_text_add(text, "NaN ");
}

/* Adds the names of the rows from top to bottom: "line name". */
static void add_titles(mote_text *data)
{
    mote_gnuplot_block(data, "ingredients");
    for (int v = 0; v < VARIANTS; ++v) {
        mote_text_add(data, "%d ", v);
        mote_gnuplot_quote(data, variants[v].title);
        mote_text_add(data, "\n");
    }
}

/* Adds a line for each ingredient measured on a scenario: line, percentage wrong, percentage
   missed, time relative to the whole method and its interval. Returns their number. */
static int add_scenario(const mote_summary *summary, const char *scenario, mote_text *data)
{
    const mote_summary_row *whole = mote_figure_row(summary, scenario, WHOLE);
    int count = 0;
    for (int v = 0; whole && v < VARIANTS; ++v) {
        const mote_summary_row *row = mote_figure_row(summary, scenario, variants[v].label);
        if (!row || !mote_figure_has_error(row))
            continue;
        if (count++ == 0)
            mote_gnuplot_block(data, scenario);
        mote_text_add(data, "%d ", v);
        add_number(data, percent_wrong(row));
        add_number(data, percent_missed(row));
        mote_figure_time(&row->total, whole->total.median, data);
        mote_text_add(data, " \n");
    }
    return count;
}

/* Adds the scenarios of the run on which the whole method fails, and why. */
static void add_failures(const mote_summary *summary, mote_text *caption)
{
    int count = 0;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        const char *scenario = row->scenario;
        if (row != mote_figure_row(summary, scenario, WHOLE) || !mote_figure_has_error(row) ||
            !(percent_wrong(row) >= LEAST_PERCENT || row->missed > 0))
            continue;
        mote_text_add(caption, "%s %s (%.3g %% not exact, %.3g of %.0f contacts missed)",
                      count++ == 0 ? " It fails on" : ",", scenario, percent_wrong(row),
                      row->missed, row->contacts);
    }
    if (count > 0)
        mote_text_add(caption, ": the search is local, and reports a minimum that is not the "
                               "smallest until a leap or a launch finds a lower one; both "
                               "start from one of at most 200 places on a body.");
}

mote_status mote_figure_ingredients(const mote_figure_run *run, const char *scenario,
                                    mote_figure *figure)
{
    (void)scenario;
    int most = 0;
    mote_text data = {0};
    add_titles(&data);
    for (int i = 0; i < SCENARIOS; ++i) {
        const int count = add_scenario(run->summary, scenarios[i], &data);
        most = count > most ? count : most;
    }
    if (most < ROWS_WANTED) {
        free(data.data);
        mote_text_add(&figure->missing, "the rows of `make ingredients`");
        return MOTE_OK;
    }
    figure->data = data;
    mote_text_add(
        &figure->caption,
        "In each row one ingredient is left out, or added. From left to right: frames without "
        "the exact distance (error above 1e-9 L, of those in which the bodies are apart), "
        "contacts missed, and the median time of a query, deformation included, relative to "
        "that of the whole method, with its 95 %% interval over processes. `last pair only` is "
        "n = 0; forces are the paper's. Shares below %g %% are drawn as none.",
        LEAST_PERCENT);
    add_failures(run->summary, &figure->caption);
    return MOTE_OK;
}

/* Configurations that differ in one parameter, in its order, including the whole method. */
static const char *const series[][7] = {
    {"n", "particle:n=2", "particle:n=4", WHOLE, "particle:n=16", "particle:n=32"},
    {"launch", WHOLE, "particle:n=8,launch=1", "particle:n=8,launch=4",
     "particle:n=8,launch=8"},
    {"track", "particle:n=8,track=0", "particle:n=8,track=4", WHOLE, "particle:n=8,track=16",
     "particle:n=8,track=64"},
};
enum { SERIES = sizeof series / sizeof series[0], LONGEST = 6 };

/* These match plots/tracked.gp: how far the axes extend beyond the first and last point, and
   their lengths in its units. */
#define BEYOND_X 1.5
#define WIDTH 459.0
#define HEIGHT 222.0
#define HIGHEST_PERCENT 150.0

/* The state of a figure while its points are placed. */
typedef struct front {
    const mote_summary_row *row[SERIES][LONGEST];
    double low_x, per_x, per_y;
    mote_room room;
    mote_rectangle taken[2 * SERIES * LONGEST];
} front;

static mote_rectangle place_of(const front *f, const mote_summary_row *row)
{
    const double wrong = fmax(percent_wrong(row), LEAST_PERCENT);
    return mote_room_point((log10(row->total.median) - f->low_x) * f->per_x,
                           log10(3 * wrong / LEAST_PERCENT) * f->per_y);
}

/* Finds the rows and the axes; returns the number of rows, 0 if they vary fewer than two
   parameters. */
static int open_front(const mote_summary *summary, const char *scenario, front *f)
{
    double low = HUGE_VAL, high = 0;
    int count = 0, lines = 0;
    bool varied[SERIES] = {false};
    memset(f, 0, sizeof *f);
    f->room.taken = f->taken;
    for (int s = 0; s < SERIES; ++s) {
        for (int k = 0; k < LONGEST && series[s][k + 1]; ++k) {
            const mote_summary_row *row = mote_figure_row(summary, scenario, series[s][k + 1]);
            if (!row || !mote_figure_has_error(row) || !(row->total.median > 0))
                continue;
            f->row[s][k] = row;
            low = fmin(low, row->total.median);
            high = fmax(high, row->total.median);
            varied[s] = varied[s] || strcmp(series[s][k + 1], WHOLE) != 0;
            ++count;
        }
    }
    for (int s = 0; s < SERIES; ++s)
        lines += varied[s];
    if (lines < 2)
        return 0;
    f->low_x = log10(low / BEYOND_X);
    f->per_x = WIDTH / (log10(high * BEYOND_X) - f->low_x);
    f->per_y = HEIGHT / log10(3 * HIGHEST_PERCENT / LEAST_PERCENT);
    return count;
}

/* The value of a series' parameter. */
static double value_of(const mote_summary_row *row, const char *key)
{
    const double value = mote_number_at(row->parameters, key);
    return value == value ? value : 0; /* launch=auto */
}

/* Adds the lines of a series: its value or nothing, time in us and its interval, percentage
   wrong, the place of the value. */
static void add_series(front *f, int s, mote_text *data)
{
    mote_gnuplot_block(data, series[s][0]);
    for (int k = 0; k < LONGEST; ++k) {
        const mote_summary_row *row = f->row[s][k];
        if (!row)
            continue;
        const double value = value_of(row, series[s][0]);
        mote_rectangle at = place_of(f, row);
        const bool whole = strcmp(series[s][k + 1], WHOLE) == 0;
        if ((!whole || s == 0) && mote_room_find(&f->room, at, value, &at))
            mote_text_add(data, "%.0f ", value);
        else
            mote_text_add(data, "\"\" ");
        mote_figure_time(&row->total, 1e3, data);
        mote_text_add(data, " %.6g %.6g %.6g\n", percent_wrong(row),
                      pow(10, f->low_x + at.x / f->per_x) * 1e-3,
                      LEAST_PERCENT / 3 * pow(10, at.y / f->per_y));
    }
}

mote_status mote_figure_tracked(const mote_figure_run *run, const char *scenario,
                                mote_figure *figure)
{
    front f;
    if (open_front(run->summary, scenario, &f) < ROWS_WANTED) {
        mote_text_add(&figure->missing, "the rows of `make ingredients`");
        return MOTE_OK;
    }
    for (int s = 0; s < SERIES; ++s) {
        for (int k = 0; k < LONGEST; ++k) {
            if (f.row[s][k])
                f.room.taken[f.room.count++] = place_of(&f, f.row[s][k]);
        }
    }
    for (int s = 0; s < SERIES; ++s)
        add_series(&f, s, &figure->data);
    mote_text_add(
        &figure->caption,
        "Median time of a query, deformation included, with its 95 %% interval over processes, "
        "against the share of frames without the exact distance (error above 1e-9 L, of those "
        "in which the bodies are apart). Each line varies one parameter and keeps the others "
        "at n = 8, launch = auto, track = 8; its value stands beside the point where there is "
        "room. n: seeds on a body; launch: searches started in each query, besides those that "
        "motion calls for; track: minima followed. Shares below %g %% are drawn as none.",
        LEAST_PERCENT);
    return MOTE_OK;
}
