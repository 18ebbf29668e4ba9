#include "harness/summary/front.h"

#include <stdlib.h>
#include <string.h>

#define BOOTSTRAP_SEED 20030902u

const double mote_front_levels[MOTE_FRONT_LEVELS] = {MOTE_EXACT_ERROR, 1e-4, 1e-3, 1e-2, 1e-1};

void mote_front_title(const mote_summary_row *row, char *title, size_t size)
{
    (void)snprintf(title, size, "%s", row->label);
    char *n = strstr(title, ":n=");
    if (!n)
        n = strstr(title, ",n=");
    if (!n)
        return;
    const char *rest = n + 3 + strcspn(n + 3, ",");
    /* Both moves take the 0 byte along. */
    if (*rest == ',' && *n == ':')
        // NOLINTNEXTLINE(bugprone-not-null-terminated-result)
        memmove(n + 1, rest + 1, strlen(rest));
    else
        memmove(n, rest, strlen(rest) + 1);
}

double mote_front_time(const double *times, const double *errors, size_t count, double error)
{
    size_t good = SIZE_MAX, next = SIZE_MAX;
    for (size_t i = 0; i < count; ++i) {
        if (errors[i] <= error && (good == SIZE_MAX || times[i] < times[good]))
            good = i;
    }
    if (good == SIZE_MAX)
        return MOTE_NONE;
    for (size_t i = 0; i < count; ++i) {
        if (errors[i] > error && times[i] < times[good] &&
            (next == SIZE_MAX || errors[i] < errors[next]))
            next = i;
    }
    if (next == SIZE_MAX || errors[good] <= MOTE_EXACT_ERROR)
        return times[good];
    double share = log(error / errors[good]) / log(errors[next] / errors[good]);
    return times[good] * pow(times[next] / times[good], share);
}

static bool has_point(const mote_summary_row *row)
{
    return row->status == MOTE_CELL_OK && row->jobs == 1 && row->error.p99 == row->error.p99 &&
           row->total.median > 0;
}

static bool same_place(const mote_summary_row *a, const mote_summary_row *b)
{
    return mote_stored_by_scene(a->first, b->first) == 0 &&
           mote_stored_by_frames(a->first, b->first) == 0;
}

static bool is_fcl(const mote_summary_row *row)
{
    return strncmp(row->first->method, "fcl-", 4) == 0;
}

/* The points of a row in every process: [replicates of the run], MOTE_NONE where it has none.
 */
typedef struct track {
    double *time, *error;
} track;

/* What an interval is computed from: the rows of a family and of FCL, process by process. */
typedef struct comparison {
    const track *tracks;           /* [rows] */
    const size_t *rows, *others;   /* of the family; of FCL */
    size_t row_count, other_count; /* 0 others: only the time is asked for */
    double level;
    double *times, *errors, *work; /* [rows], [rows], [replicates] */
} comparison;

/* Median of the drawn processes that there are. */
static double drawn_median(const double *values, const size_t *drawn, size_t count,
                           double *work)
{
    size_t known = 0;
    for (size_t i = 0; i < count; ++i) {
        if (values[drawn[i]] == values[drawn[i]])
            work[known++] = values[drawn[i]];
    }
    return mote_statistics_median(work, known);
}

static double time_of(const comparison *c, const size_t *rows, size_t row_count,
                      const size_t *drawn, size_t count)
{
    size_t points = 0;
    for (size_t i = 0; i < row_count; ++i) {
        const track *t = &c->tracks[rows[i]];
        c->times[points] = drawn_median(t->time, drawn, count, c->work);
        c->errors[points] = drawn_median(t->error, drawn, count, c->work);
        points += c->times[points] == c->times[points] ? 1 : 0;
    }
    return mote_front_time(c->times, c->errors, points, c->level);
}

/* How many times faster than FCL, given which processes. */
static double faster(void *context, const size_t *drawn, size_t count)
{
    const comparison *c = context;
    double mine = time_of(c, c->rows, c->row_count, drawn, count);
    double theirs = time_of(c, c->others, c->other_count, drawn, count);
    return theirs / mine;
}

/* All that the making of fronts needs; processes counts the replicates of the run. */
typedef struct workshop {
    const mote_summary *summary;
    size_t processes;
    track *tracks;
    double *values; /* what tracks point into */
    size_t *rows, *others;
    double *times, *errors, *work;
} workshop;

/* The time at which rows reach an error, from their own figures: those over all processes. */
static double whole_time(const workshop *w, const size_t *rows, size_t row_count, double level)
{
    for (size_t i = 0; i < row_count; ++i) {
        w->times[i] = w->summary->rows[rows[i]].total.median;
        w->errors[i] = w->summary->rows[rows[i]].error.p99;
    }
    return mote_front_time(w->times, w->errors, row_count, level);
}

static void close_workshop(workshop *w)
{
    free(w->tracks);
    free(w->values);
    free(w->rows);
    free(w->times);
}

static double process_error(const mote_stored_cell *cell, double *work)
{
    size_t count = 0;
    for (size_t k = 0; k < cell->frames; ++k) {
        if (cell->error[k] == cell->error[k])
            work[count++] = fabs(cell->error[k]);
    }
    mote_statistics_sort(work, count);
    return mote_statistics_quantile(work, count, 0.99);
}

static mote_status fill_tracks(workshop *w)
{
    size_t frames = 0;
    for (size_t i = 0; i < w->summary->stored.count; ++i)
        frames = w->summary->stored.cells[i].frames > frames
                     ? w->summary->stored.cells[i].frames
                     : frames;
    double *work = malloc((frames + 1) * sizeof *work);
    if (!work)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu frames", frames);
    for (size_t i = 0; i < w->summary->count; ++i) {
        const mote_summary_row *row = &w->summary->rows[i];
        track *t = &w->tracks[i];
        t->time = w->values + 2 * i * w->processes;
        t->error = t->time + w->processes;
        for (size_t k = 0; k < w->processes; ++k)
            t->time[k] = t->error[k] = MOTE_NONE;
        for (size_t r = 0; r < row->replicates; ++r) {
            const mote_stored_cell *cell = &row->cells[r];
            if (cell->status != MOTE_CELL_OK || cell->frames == 0)
                continue;
            t->time[cell->replicate - 1] = row->processes[r].median;
            t->error[cell->replicate - 1] = process_error(cell, work);
        }
    }
    free(work);
    return MOTE_OK;
}

static mote_status open_workshop(const mote_summary *summary, workshop *w)
{
    w->summary = summary;
    for (size_t i = 0; i < summary->stored.count; ++i) {
        size_t number = summary->stored.cells[i].replicate;
        w->processes = number > w->processes ? number : w->processes;
    }
    const size_t rows = summary->count + 1;
    w->tracks = calloc(rows, sizeof *w->tracks);
    w->values = malloc(2 * rows * (w->processes + 1) * sizeof *w->values);
    w->rows = malloc(2 * rows * sizeof *w->rows);
    w->times = malloc((2 * rows + w->processes) * sizeof *w->times);
    if (!w->tracks || !w->values || !w->rows || !w->times)
        return mote_fail(MOTE_ENOMEM, "no memory for the fronts of %zu rows", rows);
    w->others = w->rows + rows;
    w->errors = w->times + rows;
    w->work = w->errors + rows;
    return fill_tracks(w);
}

/* Fills one family; FCL's rows are w->others. */
static mote_status make_front(const workshop *w, size_t row_count, size_t other_count,
                              mote_front *front)
{
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < MOTE_FRONT_LEVELS && status == MOTE_OK; ++k) {
        mote_front_speed *speed = &front->speed[k];
        comparison c = {w->tracks, w->rows,     w->others,
                        row_count, other_count, mote_front_levels[k],
                        w->times,  w->errors,   w->work};
        speed->time_ns = whole_time(w, w->rows, row_count, c.level);
        speed->faster = whole_time(w, w->others, other_count, c.level) / speed->time_ns;
        const mote_confidence none = {MOTE_NONE, MOTE_NONE};
        speed->interval = none;
        if (speed->faster == speed->faster)
            status = mote_statistics_process_interval(faster, &c, w->processes, BOOTSTRAP_SEED,
                                                      &speed->interval);
        /* What single processes reach need not be what all of them together do. */
        if (speed->interval.low == speed->interval.low) {
            speed->interval.low = fmin(speed->interval.low, speed->faster);
            speed->interval.high = fmax(speed->interval.high, speed->faster);
        }
    }
    return status;
}

/* Collects the rows of one family, and FCL's at the same place; false when a row before first
   is of that family. */
static bool collect(const workshop *w, size_t first, const char *title, size_t *row_count,
                    size_t *other_count)
{
    *row_count = *other_count = 0;
    for (size_t i = 0; i < w->summary->count; ++i) {
        const mote_summary_row *row = &w->summary->rows[i];
        char name[256];
        if (!has_point(row) || !same_place(row, &w->summary->rows[first]))
            continue;
        mote_front_title(row, name, sizeof name);
        bool member = strcmp(name, title) == 0;
        if (member && i < first)
            return false;
        if (member)
            w->rows[(*row_count)++] = i;
        if (is_fcl(row))
            w->others[(*other_count)++] = i;
    }
    return true;
}

static mote_status make_fronts(const workshop *w, mote_fronts *fronts)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < w->summary->count && status == MOTE_OK; ++i) {
        if (!has_point(&w->summary->rows[i]))
            continue;
        mote_front *front = &fronts->items[fronts->count];
        size_t rows, others;
        front->first = i;
        mote_front_title(&w->summary->rows[i], front->title, sizeof front->title);
        if (!collect(w, i, front->title, &rows, &others))
            continue;
        status = make_front(w, rows, others, front);
        ++fronts->count;
    }
    return status;
}

/* Errors that are exact for every purpose are equal. */
static double shown_error(const mote_summary_row *row)
{
    return fmax(row->error.p99, MOTE_EXACT_ERROR);
}

/* Never without intervals: one replicate says nothing sure. */
static bool dominates(const mote_summary_row *a, const mote_summary_row *b)
{
    return same_place(a, b) && a->total.high < b->total.low && shown_error(a) <= shown_error(b);
}

static void find_dominators(mote_fronts *fronts)
{
    const mote_summary *summary = fronts->summary;
    for (size_t i = 0; i < summary->count; ++i) {
        fronts->dominator[i] = SIZE_MAX;
        for (size_t k = 0; has_point(&summary->rows[i]) && k < summary->count; ++k) {
            size_t best = fronts->dominator[i];
            if (has_point(&summary->rows[k]) &&
                dominates(&summary->rows[k], &summary->rows[i]) &&
                (best == SIZE_MAX ||
                 summary->rows[k].total.median < summary->rows[best].total.median))
                fronts->dominator[i] = k;
        }
    }
}

mote_status mote_fronts_make(const mote_summary *summary, mote_fronts *fronts)
{
    mote_fronts made = {.summary = summary};
    workshop w = {0};
    made.items = calloc(summary->count + 1, sizeof *made.items);
    made.dominator = malloc((summary->count + 1) * sizeof *made.dominator);
    mote_status status = made.items && made.dominator
                             ? open_workshop(summary, &w)
                             : mote_fail(MOTE_ENOMEM, "no memory for fronts");
    if (status == MOTE_OK)
        status = make_fronts(&w, &made);
    close_workshop(&w);
    if (status == MOTE_OK) {
        find_dominators(&made);
        *fronts = made;
    } else {
        mote_fronts_free(&made);
    }
    return status;
}

void mote_fronts_free(mote_fronts *fronts)
{
    free(fronts->items);
    free(fronts->dominator);
    fronts->items = NULL;
    fronts->dominator = NULL;
    fronts->count = 0;
}
