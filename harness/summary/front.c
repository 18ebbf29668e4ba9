#include "harness/summary/front.h"

#include "harness/base/memory.h"

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
    const char *after = n + 3 + strcspn(n + 3, ",");
    /* Both moves include the 0 byte. */
    if (*after == ',' && *n == ':')
        // NOLINTNEXTLINE(bugprone-not-null-terminated-result)
        memmove(n + 1, after + 1, strlen(after));
    else
        memmove(n, after, strlen(after) + 1);
}

bool mote_front_has(const mote_summary_row *row)
{
    return mote_summary_row_measured(row) && row->error.p99 == row->error.p99;
}

/* Where the front reaches an error: at the point `at`, or a fraction of the way from there to
   the faster `towards`, on logarithmic scales. */
typedef struct route {
    size_t at, towards;
    double share;
} route;

/* False when no point has an error of at most `error`. */
static bool find_route(const double *times, const double *errors, size_t count, double error,
                       route *found)
{
    size_t good = SIZE_MAX, next = SIZE_MAX;
    for (size_t i = 0; i < count; ++i) {
        if (errors[i] <= error && (good == SIZE_MAX || times[i] < times[good]))
            good = i;
    }
    if (good == SIZE_MAX)
        return false;
    for (size_t i = 0; i < count; ++i) {
        if (errors[i] > error && times[i] < times[good] &&
            (next == SIZE_MAX || errors[i] < errors[next]))
            next = i;
    }
    const route direct = {good, good, 0};
    *found = direct;
    if (next == SIZE_MAX || errors[good] <= MOTE_EXACT_ERROR)
        return true;
    found->towards = next;
    found->share = log(error / errors[good]) / log(errors[next] / errors[good]);
    return true;
}

static double time_between(double at, double towards, double share)
{
    return at * pow(towards / at, share);
}

double mote_front_time(const double *times, const double *errors, size_t count, double error)
{
    route way;
    if (!find_route(times, errors, count, error, &way))
        return MOTE_NONE;
    return time_between(times[way.at], times[way.towards], way.share);
}

/* Data for computing fronts. */
typedef struct workshop {
    const mote_summary *summary;
    size_t processes;      /* replicates of the run */
    double *total, *given; /* [rows][processes] medians, with and without deformation;
                              MOTE_NONE if a row has none */
    size_t *rows;          /* of a family */
    size_t *rivals[MOTE_RIVALS];
    double *times, *errors; /* [rows] */
    double *drawn;          /* [processes] */
    size_t *shared;         /* [processes] */
} workshop;

/* The rows of one side at one error level, and where they reach it. */
typedef struct side {
    const size_t *rows;
    size_t count;
    route way;
    double time; /* from the rows' times over all processes, or MOTE_NONE */
} side;

/* A comparison of one family with one kind of rivals at one level. */
typedef struct comparison {
    const workshop *shop;
    bool given; /* times exclude deformation */
    side mine, theirs;
    size_t shared; /* processes that all their rows have: the first ones of shop->shared */
} comparison;

static void find_side(const workshop *w, bool given, double level, side *s)
{
    for (size_t i = 0; i < s->count; ++i) {
        const mote_summary_row *row = &w->summary->rows[s->rows[i]];
        w->times[i] = given ? row->given_total.median : row->total.median;
        /* A row counts as exact if it is exact in every frame. */
        w->errors[i] = level <= MOTE_EXACT_ERROR ? row->error.max : row->error.p99;
    }
    s->time = MOTE_NONE;
    if (find_route(w->times, w->errors, s->count, level, &s->way))
        s->time = time_between(w->times[s->way.at], w->times[s->way.towards], s->way.share);
}

static const double *row_times(const comparison *c, size_t row)
{
    const workshop *w = c->shop;
    return (c->given ? w->given : w->total) + row * w->processes;
}

/* Finds the processes that every row of both sides has: a row may have fewer replicates than
   others of the run, and only what it has itself says how much its times vary. */
static void find_shared(comparison *c)
{
    const workshop *w = c->shop;
    const size_t rows[] = {c->mine.rows[c->mine.way.at], c->mine.rows[c->mine.way.towards],
                           c->theirs.rows[c->theirs.way.at],
                           c->theirs.rows[c->theirs.way.towards]};
    c->shared = 0;
    for (size_t k = 0; k < w->processes; ++k) {
        bool in_all = true;
        for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
            const double time = row_times(c, rows[i])[k];
            in_all = in_all && time == time;
        }
        if (in_all)
            w->shared[c->shared++] = k;
    }
}

/* The median of a row's times over the drawn processes. */
static double drawn_median(const comparison *c, size_t row, const size_t *drawn, size_t count)
{
    const workshop *w = c->shop;
    const double *times = row_times(c, row);
    for (size_t i = 0; i < count; ++i)
        w->drawn[i] = times[w->shared[drawn[i]]];
    return mote_statistics_median(w->drawn, count);
}

static double drawn_time(const comparison *c, const side *s, const size_t *drawn, size_t count)
{
    const double at = drawn_median(c, s->rows[s->way.at], drawn, count);
    const double towards = drawn_median(c, s->rows[s->way.towards], drawn, count);
    return time_between(at, towards, s->way.share);
}

/* The speedup over the rival in the drawn processes. All processes together decide which
   configurations reach the error, and this is not resampled: otherwise a process in which fewer
   particles happen to suffice would estimate a different quantity. */
static double drawn_speed(void *context, const size_t *drawn, size_t count)
{
    const comparison *c = context;
    return drawn_time(c, &c->theirs, drawn, count) / drawn_time(c, &c->mine, drawn, count);
}

static void free_workshop(workshop *w)
{
    free(w->total);
    free(w->rows);
    free(w->times);
    free(w->shared);
}

/* Fills in the processes of one row; work holds the frames of each. */
static void fill_row(const workshop *w, size_t index, double *work)
{
    const mote_summary_row *row = &w->summary->rows[index];
    double *total = w->total + index * w->processes, *given = w->given + index * w->processes;
    for (size_t k = 0; k < w->processes; ++k)
        total[k] = given[k] = MOTE_NONE;
    const mote_process *process = row->processes;
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        if (!mote_stored_ran(cell))
            continue;
        for (size_t k = 0; k < cell->frames; ++k)
            work[k] = cell->update_ns[k] + cell->query_ns[k];
        total[cell->replicate - 1] = process++->median;
        given[cell->replicate - 1] = mote_statistics_median(work, cell->frames);
    }
}

static void fill_rows(const workshop *w)
{
    const mote_stored *stored = &w->summary->stored;
    size_t frames = 0;
    for (size_t i = 0; i < stored->count; ++i)
        frames = stored->cells[i].frames > frames ? stored->cells[i].frames : frames;
    double *work = mote_allocate(frames, sizeof *work);
    for (size_t i = 0; i < w->summary->count; ++i)
        fill_row(w, i, work);
    free(work);
}

static void make_workshop(const mote_summary *summary, workshop *w)
{
    w->summary = summary;
    for (size_t i = 0; i < summary->stored.count; ++i) {
        size_t number = summary->stored.cells[i].replicate;
        w->processes = number > w->processes ? number : w->processes;
    }
    const size_t rows = summary->count, times = rows * w->processes;
    w->total = mote_allocate(2 * times, sizeof *w->total);
    w->rows = mote_allocate((1 + MOTE_RIVALS) * rows, sizeof *w->rows);
    w->times = mote_allocate(2 * rows + w->processes, sizeof *w->times);
    w->shared = mote_allocate(w->processes, sizeof *w->shared);
    w->given = w->total + times;
    for (size_t k = 0; k < MOTE_RIVALS; ++k)
        w->rivals[k] = w->rows + (1 + k) * rows;
    w->errors = w->times + rows;
    w->drawn = w->errors + rows;
    fill_rows(w);
}

/* The interval of the speedup: the spread of the shared processes around their own centre,
   shifted to the estimate, which uses the frames of all processes. */
static void find_interval(const comparison *c, mote_front_ratio *ratio)
{
    comparison context = *c;
    find_shared(&context);
    const mote_confidence spread =
        mote_statistics_process_interval(drawn_speed, &context, context.shared, BOOTSTRAP_SEED);
    double centre = sqrt(spread.low * spread.high); /* of Student's t interval */
    if (context.shared >= MOTE_BOOTSTRAP_REPLICATES) {
        size_t *all = mote_allocate(context.shared, sizeof *all);
        for (size_t k = 0; k < context.shared; ++k)
            all[k] = k;
        centre = drawn_speed(&context, all, context.shared);
        free(all);
    }
    ratio->interval.low = ratio->faster * (spread.low / centre);
    ratio->interval.high = ratio->faster * (spread.high / centre);
}

/* Whether both sides are the same rows, so that the ratio is 1 whatever was measured. */
static bool same_side(const side *a, const side *b)
{
    return a->rows[a->way.at] == b->rows[b->way.at] &&
           a->rows[a->way.towards] == b->rows[b->way.towards];
}

/* How many rows of each sort there are in the workshop. */
typedef struct census {
    size_t rows, rivals[MOTE_RIVALS];
} census;

static mote_front_ratio find_ratio(const comparison *c)
{
    mote_front_ratio ratio = {.faster = c->theirs.time / c->mine.time,
                              .interval = {MOTE_NONE, MOTE_NONE},
                              .rival = SIZE_MAX};
    if (c->theirs.time == c->theirs.time)
        ratio.rival = c->theirs.rows[c->theirs.way.at];
    if (ratio.faster == ratio.faster && !same_side(&c->mine, &c->theirs))
        find_interval(c, &ratio);
    return ratio;
}

/* Fills in one family; its rows are w->rows, those of rivals w->rivals. */
static void make_front(const workshop *w, const census *count, mote_front *front)
{
    const bool given = w->summary->rows[front->first].given;
    for (size_t k = 0; k < MOTE_FRONT_LEVELS; ++k) {
        mote_front_speed *speed = &front->speed[k];
        comparison c = {
            .shop = w, .given = given, .mine = {.rows = w->rows, .count = count->rows}};
        find_side(w, given, mote_front_levels[k], &c.mine);
        speed->time_ns = c.mine.time;
        for (size_t r = 0; r < MOTE_RIVALS; ++r) {
            c.theirs = (side){.rows = w->rivals[r], .count = count->rivals[r]};
            find_side(w, given, mote_front_levels[k], &c.theirs);
            speed->to[r] = find_ratio(&c);
        }
    }
}

/* Collects the rows of one family, and its rivals in the same block with the same accounting:
   without deformation if positions are given. False if a row before first is of that family. */
static bool collect(const workshop *w, size_t first, const char *title, census *count)
{
    static bool (*const is_rival[MOTE_RIVALS])(const mote_summary_row *) = {
        [MOTE_RIVAL_FCL] = mote_summary_is_fcl,
        [MOTE_RIVAL_ENGINE] = mote_summary_is_right_engine};
    const mote_summary_row *of = &w->summary->rows[first];
    memset(count, 0, sizeof *count);
    for (size_t i = 0; i < w->summary->count; ++i) {
        const mote_summary_row *row = &w->summary->rows[i];
        char name[MOTE_FRONT_TITLE];
        if (!mote_front_has(row) || !mote_summary_same_block(row, of))
            continue;
        mote_front_title(row, name, sizeof name);
        bool member = strcmp(name, title) == 0;
        if (member && i < first)
            return false;
        if (member)
            w->rows[count->rows++] = i;
        for (size_t r = 0; r < MOTE_RIVALS; ++r) {
            if (is_rival[r](row) && (of->given || !row->given))
                w->rivals[r][count->rivals[r]++] = i;
        }
    }
    return true;
}

static void make_families(const workshop *w, mote_fronts *fronts)
{
    for (size_t i = 0; i < w->summary->count; ++i) {
        if (!mote_front_has(&w->summary->rows[i]))
            continue;
        mote_front *front = &fronts->items[fronts->count];
        census count;
        front->first = i;
        mote_front_title(&w->summary->rows[i], front->title, sizeof front->title);
        if (!collect(w, i, front->title, &count))
            continue;
        make_front(w, &count, front);
        ++fronts->count;
    }
}

mote_fronts mote_fronts_make(const mote_summary *summary)
{
    mote_fronts made = {.summary = summary};
    workshop w = {0};
    made.items = mote_allocate(summary->count, sizeof *made.items);
    make_workshop(summary, &w);
    make_families(&w, &made);
    free_workshop(&w);
    return made;
}

void mote_fronts_free(mote_fronts *fronts)
{
    free(fronts->items);
    fronts->items = NULL;
    fronts->count = 0;
}
