#include "harness/summary/until.h"

#include "harness/base/statistics.h"
#include "harness/run/progress.h"
#include "harness/summary/summary.h"

#include <math.h>
#include <string.h>

typedef struct goal {
    const char *directory;
    double share;
    double widest; /* widest interval, as a share of its median */
} goal;

/* The half width of the interval of a row's median, on its wider side, as a share of the
   median; infinite if there is none yet, 0 if more replicates would not help. */
static double interval_width(const mote_summary *summary, const mote_cell *cell)
{
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        for (size_t k = 0; k < row->replicates; ++k) {
            if (strcmp(row->cells[k].id, cell->id) != 0)
                continue;
            if (row->status != MOTE_CELL_OK)
                return 0;
            const mote_time *time = &row->total;
            return mote_statistics_half_width(time->median,
                                              (mote_confidence){time->low, time->high});
        }
    }
    return 0;
}

/* Requests a replicate of each row whose interval is too wide, and of the reference of its
   ratios. */
static mote_status want_wide(void *context, const mote_cell *cells, size_t count, bool *wanted)
{
    goal *g = context;
    mote_summary summary;
    mote_status status = mote_summary_make(g->directory, &summary);
    if (status != MOTE_OK)
        return status;
    g->widest = 0;
    for (size_t i = 0; i < count; ++i) {
        const double width = interval_width(&summary, &cells[i]);
        g->widest = fmax(g->widest, width);
        wanted[i] = width > g->share;
    }
    for (size_t i = 0; i < count && g->widest > g->share; ++i)
        wanted[i] = wanted[i] || strcmp(cells[i].choice->method->name, "fcl-aabb") == 0;
    mote_summary_free(&summary);
    return MOTE_OK;
}

mote_status mote_run_until(const mote_run_options *options, double share,
                           mote_run_outcome *outcome)
{
    goal g = {.directory = options->directory, .share = share};
    mote_run_options run = *options;
    run.further = want_wide;
    run.context = &g;
    const mote_status status = mote_run(&run, outcome);
    if (status == MOTE_OK && !options->dry_run)
        mote_progress_precision(outcome->replicates, g.widest, share);
    return status;
}
