/* Figures of error: over n (5), over frames (12). */
#include "harness/figure/figure.h"

#include "harness/base/memory.h"
#include "harness/summary/front.h"
#include "harness/run/plan.h"

#include <stdlib.h>
#include <string.h>

/* A quantile of the absolute errors of one cell; MOTE_NONE without an answer. */
static double cell_quantile(const mote_stored_cell *cell, double fraction, double *work)
{
    size_t count = 0;
    for (size_t k = 0; k < cell->frames; ++k) {
        if (cell->error[k] == cell->error[k])
            work[count++] = fabs(cell->error[k]);
    }
    mote_statistics_sort(work, count);
    return count ? mote_statistics_quantile(work, count, fraction) : MOTE_NONE;
}

/* The share of missed contacts in a cell; MOTE_NONE without a contact. */
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

/* The 95 % interval over replicates around a value, widened to contain it and never below 0;
   the value itself if there are too few replicates. */
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

void mote_figure_quantile(const mote_summary_row *row, double fraction, double value,
                          mote_text *text)
{
    double values[MOTE_REPLICATES_MAX];
    size_t count = 0;
    double *work = mote_allocate(row->first->frames, sizeof *work);
    for (size_t r = 0; r < row->replicates && count < MOTE_REPLICATES_MAX; ++r) {
        if (row->cells[r].frames <= row->first->frames)
            values[count] = cell_quantile(&row->cells[r], fraction, work);
        else
            values[count] = MOTE_NONE;
        count += values[count] == values[count] ? 1 : 0;
    }
    free(work);
    const mote_confidence interval = interval_of(values, count, value);
    mote_text_add(text, "%.17g %.17g %.17g ", value, interval.low, interval.high);
}

static void add_missed(const mote_summary_row *row, mote_text *text)
{
    double values[MOTE_REPLICATES_MAX];
    size_t count = 0;
    for (size_t r = 0; r < row->replicates && count < MOTE_REPLICATES_MAX; ++r) {
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

/* Adds one line of Figure 5: n, then median, 95th and 99th percentile and share missed, each
   with its interval. */
static void add_errors(const mote_summary_row *row, mote_text *text)
{
    mote_text_add(text, "%.0f ", row->n);
    mote_figure_quantile(row, 0.5, row->error.median, text);
    mote_figure_quantile(row, 0.95, row->error.p95, text);
    mote_figure_quantile(row, 0.99, row->error.p99, text);
    add_missed(row, text);
    mote_text_add(text, "\n");
}

/* Adds a family's block if it has rows with distances; *points counts them. Returns whether it
   also has one with n = 0, which has no place on a logarithmic axis. */
static bool add_series(const mote_summary *summary, const char *scenario, const char *family,
                       size_t *points, mote_text *text)
{
    bool begun = false, zero = false;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char other[MOTE_FIGURE_FAMILY];
        mote_front_title(row, other, sizeof other);
        if (strcmp(other, family) != 0 || row->n != row->n || !mote_figure_has_error(row) ||
            !mote_figure_shows(summary, row, scenario))
            continue;
        zero = zero || row->n < 1;
        if (row->n < 1)
            continue;
        if (!begun)
            mote_gnuplot_block(text, family);
        begun = true;
        add_errors(row, text);
        ++*points;
    }
    return zero;
}

mote_status mote_figure_errors(const mote_figure_run *run, const char *scenario,
                               mote_figure *figure)
{
    static const char *const families[] = {"particle-paper:refine=no", "particle-paper",
                                           "particle-paper:refine=always", "particle"};
    size_t points = 0;
    bool zero = false;
    for (size_t s = 0; s < sizeof families / sizeof families[0]; ++s)
        zero = add_series(run->summary, scenario, families[s], &points, &figure->data) || zero;
    if (points < 2) {
        figure->data.size = 0;
        mote_text_add(&figure->missing, "particles with several n on %s", scenario);
    }
    mote_text_add(
        &figure->caption,
        "Median, 95th and 99th percentile of the absolute error over frames, in L, and the "
        "share of contacts missed, with 95 %% intervals over processes, whose particles start "
        "in different places. Errors of at most 1e-6 L are drawn on the lowest line.");
    if (zero)
        mote_text_add(&figure->caption,
                      " Rows with n = 0 are left out, as the axis of n is logarithmic.");
    return MOTE_OK;
}

/* Adds a line per frame: frame, truth, distance, error (in L), 1 if a contact was missed. */
static void add_history(const mote_summary_row *row, mote_text *text)
{
    const mote_stored_cell *cell = row->first;
    const double length = mote_figure_length(row);
    mote_gnuplot_block(text, row->label);
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
        const char *family;
        double n;
    } series[] = {{"particle-paper:refine=no", 5}, {"particle", 8}};
    for (size_t s = 0; s < sizeof series / sizeof series[0]; ++s) {
        const mote_summary_row *row =
            mote_figure_near(run->summary, scenario, series[s].family, series[s].n);
        if (!row || !mote_figure_has_error(row))
            continue;
        add_history(row, &figure->data);
    }
    if (figure->data.size == 0)
        mote_text_add(&figure->missing,
                      "particle-paper:refine=no or particle on %s, reporting distances",
                      scenario);
    mote_text_add(
        &figure->caption,
        "The exact and the reported distance of each frame, in L, and below them the absolute "
        "error; one process of each method. Errors of at most 1e-6 L are drawn on the lowest "
        "line. Crosses mark contacts that the method missed.");
    return MOTE_OK;
}
