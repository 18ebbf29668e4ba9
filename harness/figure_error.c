/* Figures of error: against speed (4), over n (5), over frames (12). */
#include "harness/figure.h"
#include "harness/front.h"

#include <stdlib.h>
#include <string.h>

/* At most this many replicates of a row take part in an interval. */
#define REPLICATES_MAX 64

/* Errors up to here are drawn as exact in a front: as plots/front.gp has it. */
#define FRONT_FLOOR 1e-5

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Quantile of the absolute errors of one cell; MOTE_NONE without an answer. */
static double cell_quantile(const mote_stored_cell *cell, double fraction, double *work)
{
    size_t count = 0;
    for (size_t k = 0; k < cell->frames; ++k) {
        if (cell->error[k] == cell->error[k])
            work[count++] = fabs(cell->error[k]);
    }
    qsort(work, count, sizeof *work, ascending);
    return count ? mote_statistics_quantile(work, count, fraction) : MOTE_NONE;
}

/* The share of a cell's contacts that it missed; MOTE_NONE without a contact. */
static double cell_missed(const mote_stored_cell *cell)
{
    double contacts = 0, missed = 0;
    for (size_t k = 0; k < cell->frames; ++k) {
        if (cell->contact_truth[k] == 1 && cell->contact[k] >= 0) {
            ++contacts;
            missed += cell->contact[k] == 0 ? 1 : 0;
        }
    }
    return contacts > 0 ? missed / contacts : MOTE_NONE;
}

/* The 95 % interval over replicates around a value: wide enough to hold it, never below 0; the
   value itself where there are too few. */
static mote_confidence interval_of(const double *values, size_t count, double value)
{
    mote_confidence found = mote_statistics_t_interval(values, count);
    if (found.low != found.low)
        found.low = found.high = value;
    found.low = found.low < value ? found.low : value;
    found.high = found.high > value ? found.high : value;
    found.low = found.low > 0 ? found.low : 0;
    return found;
}

/* "value low high " of a quantile of the error; value is that over all replicates. */
static mote_status add_quantile(const mote_summary_row *row, double fraction, double value,
                                mote_text *text)
{
    double values[REPLICATES_MAX];
    size_t count = 0;
    double *work = malloc((row->first->frames + 1) * sizeof *work);
    if (!work)
        return mote_fail(MOTE_ENOMEM, "no memory for a figure");
    for (size_t r = 0; r < row->replicates && count < REPLICATES_MAX; ++r) {
        if (row->cells[r].frames <= row->first->frames)
            values[count] = cell_quantile(&row->cells[r], fraction, work);
        else
            values[count] = MOTE_NONE;
        count += values[count] == values[count] ? 1 : 0;
    }
    free(work);
    const mote_confidence interval = interval_of(values, count, value);
    mote_text_add(text, "%.17g %.17g %.17g ", value, interval.low, interval.high);
    return MOTE_OK;
}

static void add_missed(const mote_summary_row *row, mote_text *text)
{
    double values[REPLICATES_MAX];
    size_t count = 0;
    for (size_t r = 0; r < row->replicates && count < REPLICATES_MAX; ++r) {
        values[count] = cell_missed(&row->cells[r]);
        count += values[count] == values[count] ? 1 : 0;
    }
    if (count == 0) {
        mote_text_add(text, "nan nan nan");
        return;
    }
    const double mean = mote_statistics_mean(values, count);
    mote_confidence interval = interval_of(values, count, mean);
    interval.high = interval.high < 1 ? interval.high : 1;
    mote_text_add(text, "%.17g %.17g %.17g", mean, interval.low, interval.high);
}

static bool has_error(const mote_summary_row *row)
{
    return row->error.p99 == row->error.p99;
}

/* Where n was last written beside a curve: decades of time and error. */
typedef struct place {
    double x, y;
} place;

/* Whether n has room: is away from the last place, which it then becomes. */
static bool has_room(const mote_summary_row *row, place *last)
{
    const place here = {log10(row->total.median), log10(fmax(row->error.p99, FRONT_FLOOR))};
    if (fabs(here.x - last->x) < 0.14 && fabs(here.y - last->y) < 0.25)
        return false;
    *last = here;
    return true;
}

/* One point of the front: n, median total in us and interval, 99th percentile and interval. */
static mote_status add_point(const mote_summary_row *row, place *last, mote_text *text)
{
    const mote_time *time = &row->total;
    const bool interval = time->low == time->low;
    if (row->n == row->n && has_room(row, last))
        mote_text_add(text, "%.0f ", row->n);
    else
        mote_text_add(text, "\"\" ");
    mote_text_add(text, "%.17g %.17g %.17g ", time->median * 1e-3,
                  (interval ? time->low : time->median) * 1e-3,
                  (interval ? time->high : time->median) * 1e-3);
    const mote_status status = add_quantile(row, 0.99, row->error.p99, text);
    mote_text_add(text, "\n");
    return status;
}

static mote_status add_family(const mote_summary *summary, const char *scenario,
                              const char *family, mote_text *text)
{
    mote_status status = MOTE_OK;
    place last = {HUGE_VAL, HUGE_VAL};
    for (size_t i = 0; i < summary->count && status == MOTE_OK; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char other[MOTE_FIGURE_FAMILY];
        mote_front_title(row, other, sizeof other);
        if (strcmp(family, other) == 0 && has_error(row) &&
            mote_figure_shows(summary, row, scenario))
            status = add_point(row, &last, text);
    }
    return status;
}

/* The families that have names in a front; the others are points without. */
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

static bool is_named(const char *family)
{
    for (int i = 0; i < FRONT_FAMILIES; ++i) {
        if (strcmp(front_families[i], family) == 0)
            return true;
    }
    return false;
}

/* All other families, in one block. */
static mote_status add_others(const mote_summary *summary, const char *scenario,
                              mote_text *text)
{
    mote_status status = MOTE_OK;
    bool begun = false;
    place last = {HUGE_VAL, HUGE_VAL};
    for (size_t i = 0; i < summary->count && status == MOTE_OK; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char family[MOTE_FIGURE_FAMILY];
        mote_front_title(row, family, sizeof family);
        if (is_named(family) || !has_error(row) || !mote_figure_shows(summary, row, scenario))
            continue;
        if (!begun)
            mote_figure_block(text, "others");
        begun = true;
        status = add_point(row, &last, text);
        mote_text_add(text, "\n"); /* no line joins it to the next */
    }
    return status;
}

mote_status mote_figure_front(const mote_figure_run *run, const char *scenario,
                              mote_figure *figure)
{
    const mote_summary *summary = run->summary;
    mote_status status = MOTE_OK;
    for (int i = 0; i < FRONT_FAMILIES && status == MOTE_OK; ++i) {
        const mote_summary_row *row = mote_figure_near(summary, scenario, front_families[i], 8);
        if (!row || !has_error(row))
            continue;
        mote_figure_block(&figure->data, front_families[i]);
        status = add_family(summary, scenario, front_families[i], &figure->data);
    }
    if (status == MOTE_OK)
        status = add_others(summary, scenario, &figure->data);
    if (figure->data.size == 0)
        mote_text_add(&figure->missing, "a method that tells a distance on %s", scenario);
    mote_text_add(&figure->caption,
                  "Speed against error on %s: median time of a query, deformation and refit "
                  "included, and 99th percentile of the absolute error, each with its 95 %% "
                  "interval over processes; a line a method, the number of particles beside "
                  "its points.",
                  scenario);
    return status;
}

/* One line of Figure 5: n, then median, 95th and 99th percentile and share missed, each with
   its interval. */
static mote_status add_errors(const mote_summary_row *row, mote_text *text)
{
    mote_text_add(text, "%.0f ", row->n);
    mote_status status = add_quantile(row, 0.5, row->error.median, text);
    if (status == MOTE_OK)
        status = add_quantile(row, 0.95, row->error.p95, text);
    if (status == MOTE_OK)
        status = add_quantile(row, 0.99, row->error.p99, text);
    add_missed(row, text);
    mote_text_add(text, "\n");
    return status;
}

/* A family's block, where it has rows that tell a distance; *points counts them. */
static mote_status add_series(const mote_summary *summary, const char *scenario,
                              const char *family, const char *title, size_t *points,
                              mote_text *text)
{
    mote_status status = MOTE_OK;
    bool begun = false;
    for (size_t i = 0; i < summary->count && status == MOTE_OK; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char other[MOTE_FIGURE_FAMILY];
        mote_front_title(row, other, sizeof other);
        if (strcmp(other, family) != 0 || row->n != row->n || !has_error(row) ||
            !mote_figure_shows(summary, row, scenario))
            continue;
        if (!begun)
            mote_figure_block(text, title);
        begun = true;
        status = add_errors(row, text);
        ++*points;
    }
    return status;
}

mote_status mote_figure_errors(const mote_figure_run *run, const char *scenario,
                               mote_figure *figure)
{
    static const struct {
        const char *family, *title;
    } series[] = {{"particle-paper:refine=no", "paper mode"},
                  {"particle-paper", "refined when near"},
                  {"particle-paper:refine=always", "refined always"},
                  {"particle", "tracked"}};
    mote_status status = MOTE_OK;
    size_t points = 0;
    for (size_t s = 0; s < sizeof series / sizeof series[0] && status == MOTE_OK; ++s)
        status = add_series(run->summary, scenario, series[s].family, series[s].title, &points,
                            &figure->data);
    if (points < 2) {
        figure->data.size = 0;
        mote_text_add(&figure->missing, "particles with several n on %s", scenario);
    }
    mote_text_add(
        &figure->caption,
        "Error over the number of particles on %s: median, 95th and 99th percentile of "
        "the absolute error over frames, in L, and the share of contacts missed, with "
        "95 %% intervals over processes, which start from different places. At the "
        "foot of an axis: as good as exact, or none missed.",
        scenario);
    return status;
}

/* A line a frame: frame, truth, distance, error (in L), 1 where a contact was missed. */
static void add_history(const mote_summary_row *row, const char *title, mote_text *text)
{
    const mote_stored_cell *cell = row->first;
    const double length = mote_figure_length(row);
    mote_figure_block(text, title);
    for (size_t k = 0; k < cell->frames; ++k) {
        const double truth = cell->truth[k] / length, error = cell->error[k];
        const bool missed = cell->contact_truth[k] == 1 && cell->contact[k] == 0;
        if (error != error)
            mote_text_add(text, "%u %.9g nan nan %d\n", cell->frame[k], truth, missed);
        else
            mote_text_add(text, "%u %.9g %.9g %.9g %d\n", cell->frame[k], truth, truth + error,
                          fabs(error), missed);
    }
}

mote_status mote_figure_history(const mote_figure_run *run, const char *scenario,
                                mote_figure *figure)
{
    static const struct {
        const char *family, *title;
        double n;
    } series[] = {{"particle-paper:refine=no", "paper mode", 5}, {"particle", "tracked", 8}};
    for (size_t s = 0; s < sizeof series / sizeof series[0]; ++s) {
        const mote_summary_row *row =
            mote_figure_near(run->summary, scenario, series[s].family, series[s].n);
        if (!row || !has_error(row))
            continue;
        char title[64];
        (void)snprintf(title, sizeof title, "%s, n = %.0f", series[s].title, row->n);
        if (row->n != row->n)
            (void)snprintf(title, sizeof title, "%s", series[s].title);
        add_history(row, title, &figure->data);
    }
    if (figure->data.size == 0)
        mote_text_add(&figure->missing,
                      "particle-paper:refine=no or particle on %s, telling distances",
                      scenario);
    mote_text_add(&figure->caption,
                  "Error in time on %s: exact and reported distance, in L, over frames, and "
                  "their difference below; one process of each method. Marked: frames with a "
                  "contact that the method missed.",
                  scenario);
    return MOTE_OK;
}
