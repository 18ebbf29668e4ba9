#include "harness/race/race.h"

#include "harness/base/memory.h"
#include "harness/process/child.h"
#include "harness/race/protocol.h"
#include "harness/run/cell_process.h"
#include "harness/base/clock.h"
#include "harness/summary/history.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const mote_race_state_names[] = {"measured", "left out", "failed"};

/* The state of a running race. */
typedef struct event {
    const mote_race_options *options;
    mote_race *race;
    bool *done; /* [cells]: known precisely enough, or not to be measured */
    mote_random random;
    size_t turns;                   /* see count_turns */
    size_t order[MOTE_RACE_BUILDS]; /* of builds, in these turns: shuffled */
    size_t unit;                    /* that is measured */
    double alpha;                   /* for a look at a cell */
    size_t next_look;               /* in pairs */
    uint32_t looks;
    uint64_t began;
    double longest; /* duration of a pair, seconds */
} event;

static double seconds_since(uint64_t start)
{
    return (double)(mote_clock_ns() - start) * 1e-9;
}

mote_verdict mote_race_verdict(double ratio, mote_confidence interval, double real,
                               double until)
{
    const double band = log1p(real + until);
    if (!(interval.low <= interval.high))
        return MOTE_VERDICT_UNDECIDED;
    if (interval.low > 1 && ratio >= 1 + real)
        return MOTE_VERDICT_SLOWER;
    if (interval.high < 1 && ratio <= 1 / (1 + real))
        return MOTE_VERDICT_FASTER;
    return log(interval.low) >= -band && log(interval.high) <= band ? MOTE_VERDICT_SAME
                                                                    : MOTE_VERDICT_UNDECIDED;
}

size_t mote_race_next_look(size_t pairs)
{
    const size_t next = pairs + pairs / 2;
    return next < MOTE_PAIRED_MAX ? next : MOTE_PAIRED_MAX;
}

static void shuffle(size_t *items, size_t count, mote_random *random)
{
    for (size_t i = 0; i < count; ++i)
        items[i] = i;
    for (size_t i = count; i > 1; --i) {
        const size_t j = (size_t)mote_random_below(random, i), kept = items[i - 1];
        items[i - 1] = items[j];
        items[j] = kept;
    }
}

size_t mote_race_build_pairs(const mote_race_options *options)
{
    const size_t a = options->builds[MOTE_RACE_A]->count,
                 b = options->builds[MOTE_RACE_B]->count;
    return a < b ? a : b;
}

/* How many pairs of processes have other builds than those before: all pairs of builds, or all
   builds beside a single one. */
static size_t count_turns(const mote_race_options *options)
{
    const size_t pairs = mote_race_build_pairs(options);
    const size_t a = options->builds[MOTE_RACE_A]->count,
                 b = options->builds[MOTE_RACE_B]->count;
    return pairs > 1 ? pairs : a > b ? a : b;
}

/* Chooses the builds and the unit of the next pair of processes: all builds are used once
   before any repeats. */
static void choose_builds(event *e, mote_bout_options *bout)
{
    const size_t turn = e->race->pairs % e->turns;
    if (turn == 0)
        shuffle(e->order, e->turns, &e->random);
    for (int side = 0; side < MOTE_RACE_SIDES; ++side) {
        const mote_race_builds *own = e->options->builds[side];
        bout->program[side] = own->path[own->count == 1 ? 0 : e->order[turn]];
    }
    e->unit = mote_race_build_pairs(e->options) > 1 ? e->order[turn] : e->race->pairs;
}

/* Sets why a cell is not measured, from its bout; false if it was measured. */
static bool rule_out(mote_race_row *row, const mote_bout_result *result)
{
    size_t used = 0;
    for (int side = 0; side < MOTE_RACE_SIDES; ++side) {
        const mote_race_side *s = &result->side[side];
        if (!s->refused && !s->failed)
            continue;
        row->state =
            s->failed || row->state == MOTE_RACE_FAILED ? MOTE_RACE_FAILED : MOTE_RACE_LEFT_OUT;
        row->missing[side] = true;
        used += (size_t)snprintf(row->reason + used, sizeof row->reason - used, "%s%s: %.399s",
                                 used ? "; " : "", side ? "B" : "A", s->reason);
    }
    if (used > 0 || result->same_scene)
        return used > 0;
    row->state = MOTE_RACE_LEFT_OUT;
    (void)snprintf(row->reason, sizeof row->reason,
                   "the scenario is not the same in both programs");
    return true;
}

static void keep(mote_race_row *row, const mote_bout_result *result, size_t unit)
{
    if (row->pairs == 0) {
        memcpy(row->counts, result->counts, sizeof row->counts);
        memcpy(row->total_ns, result->total_ns, sizeof row->total_ns);
        row->count_count = result->count_count;
        row->frames = result->frames;
        row->scene = result->scene;
    }
    mote_paired_add(&row->sample, unit, result->log_ratio);
    ++row->pairs;
    row->blocks += result->blocks;
    if (result->worst > row->worst) {
        row->worst = result->worst;
        row->worst_frame = result->worst_frame;
    }
}

/* Measures the cells of `order` from *place on, until all are done or a process fails. */
static mote_status run_bout(event *e, const mote_bout_options *options, const size_t *order,
                            size_t *place)
{
    mote_bout bout;
    mote_status status = mote_bout_start(options, &bout);
    bool failed = false;
    for (; status == MOTE_OK && !failed && *place < e->race->count; ++*place) {
        mote_race_row *row = &e->race->rows[order[*place]];
        mote_bout_result result;
        const uint64_t start = mote_clock_ns();
        if (e->done[order[*place]])
            continue;
        status = mote_bout_run(&bout, row->cell, &result);
        row->seconds += seconds_since(start);
        if (status != MOTE_OK)
            break;
        failed = result.side[0].failed || result.side[1].failed;
        e->done[order[*place]] = rule_out(row, &result);
        if (!e->done[order[*place]])
            keep(row, &result, e->unit);
    }
    mote_bout_stop(&bout);
    return status;
}

/* Measures a unit of each cell that is not done, in random order; new processes replace
   those that fail. */
static mote_status run_pair(event *e)
{
    size_t order[MOTE_RACE_CELLS] = {0}, place = 0;
    mote_bout_options bout = {.core = mote_process_core(),
                              .timeout = e->options->timeout,
                              .check_scene = e->race->pairs == 0,
                              .random = &e->random};
    mote_status status = MOTE_OK;
    const uint64_t start = mote_clock_ns();
    choose_builds(e, &bout);
    shuffle(order, e->race->count, &e->random);
    while (status == MOTE_OK && place < e->race->count)
        status = run_bout(e, &bout, order, &place);
    ++e->race->pairs;
    e->longest = fmax(e->longest, seconds_since(start));
    return status;
}

static double spread(const double *values, size_t count)
{
    const double mean = mote_statistics_mean(values, count);
    double sum = 0;
    for (size_t i = 0; i < count; ++i)
        sum += (values[i] - mean) * (values[i] - mean);
    return count > 1 ? sqrt(sum / (double)(count - 1)) : MOTE_NONE;
}

/* Looks at the cells that are not done; those known within `until` become done. */
static void look(event *e, bool last)
{
    const mote_race_options *o = e->options;
    ++e->looks;
    for (size_t i = 0; i < e->race->count; ++i) {
        mote_race_row *row = &e->race->rows[i];
        double values[MOTE_PAIRED_MAX];
        if (e->done[i])
            continue;
        row->looks = e->looks;
        row->units = mote_paired_values(&row->sample, values);
        row->spread = spread(values, row->units);
        row->ratio = exp(mote_paired_centre(values, row->units));
        row->interval = mote_paired_interval(values, row->units, e->alpha);
        row->interval.low = exp(row->interval.low);
        row->interval.high = exp(row->interval.high);
        row->verdict = mote_race_verdict(row->ratio, row->interval, o->real, o->until);
        const double reach =
            fmax(row->interval.high / row->ratio, row->ratio / row->interval.low) - 1;
        e->done[i] = last || reach <= o->until;
    }
    e->next_look = mote_race_next_look(e->next_look);
}

static bool all_done(const event *e)
{
    for (size_t i = 0; i < e->race->count; ++i) {
        if (!e->done[i])
            return false;
    }
    return true;
}

/* Whether another pair would exceed the budget. */
static bool is_late(const event *e)
{
    return e->options->budget > 0 && seconds_since(e->began) + e->longest > e->options->budget;
}

static mote_status run_pairs(event *e)
{
    while (!all_done(e)) {
        assert(e->race->pairs < MOTE_PAIRED_MAX); /* the last look is at so many, or before */
        const mote_status status = run_pair(e);
        if (status != MOTE_OK)
            return status;
        const bool late = is_late(e);
        if (late || e->race->pairs == e->next_look)
            look(e, late || e->looks + 1 == MOTE_RACE_LOOKS);
    }
    return MOTE_OK;
}

bool mote_race_is_worse(const mote_race_options *options, const mote_race_row *row)
{
    if (row->state == MOTE_RACE_FAILED)
        return row->missing[MOTE_RACE_B] && !row->missing[MOTE_RACE_A];
    return row->state == MOTE_RACE_MEASURED &&
           (row->verdict == MOTE_VERDICT_SLOWER ||
            (row->worst > MOTE_RACE_EXACT && !options->allow_changes));
}

/* Judges a row by its counts, answers and time together. */
static void judge(mote_race_row *row, const mote_race_options *options, mote_race *race)
{
    for (size_t i = 0; i < row->count_count; ++i) {
        const mote_race_count *count = &row->counts[i];
        row->counted = row->counted || fabs(count->sum[0] - count->sum[1]) > 0.5;
    }
    const bool lost = row->missing[MOTE_RACE_B] && !row->missing[MOTE_RACE_A];
    race->worse = race->worse || mote_race_is_worse(options, row);
    race->undecided =
        race->undecided || lost ||
        (row->state == MOTE_RACE_MEASURED && row->verdict == MOTE_VERDICT_UNDECIDED);
}

static mote_status check_rows(const mote_race *race)
{
    for (size_t i = 0; i < race->count; ++i) {
        if (race->rows[i].pairs > 0 || race->rows[i].state == MOTE_RACE_FAILED)
            return MOTE_OK;
    }
    return mote_fail(MOTE_EINVAL, "nothing to race: %s: %s", race->rows[0].name,
                     race->rows[0].reason);
}

/* Whether another cell differs from this one in its frames alone. */
static bool has_other_frames(const mote_race_options *options, const mote_race_cell *cell)
{
    for (size_t i = 0; i < options->cell_count; ++i) {
        const mote_race_cell *other = &options->cells[i];
        if (strcmp(other->scenario, cell->scenario) == 0 &&
            strcmp(other->method, cell->method) == 0 && other->cache == cell->cache &&
            (other->first != cell->first || other->last != cell->last))
            return true;
    }
    return false;
}

/* The caller frees it. A cell without a last frame is the only one of its name without
   frames. */
static char *name_row(const mote_race_options *options, const mote_race_cell *cell)
{
    const char *cache = mote_cache_names[cell->cache];
    if (cell->last == 0 || !has_other_frames(options, cell))
        return mote_format("%s/%s/%s", cell->scenario, cell->method, cache);
    return mote_format("%s@%u-%u/%s/%s", cell->scenario, cell->first, cell->last, cell->method,
                       cache);
}

char *mote_race_asked(const mote_race_row *row)
{
    const mote_race_scene *scene = &row->scene;
    uint32_t frames[2] = {0, 0};
    if (row->frames > 0 && scene->ask[0]) {
        frames[0] = row->cell->first;
        frames[1] = frames[0] + row->frames - 1 + scene->step; /* in which the last one ends */
    }
    return mote_history_asked(frames, scene->ask, scene->step, scene->tolerance);
}

static void begin(const mote_race_options *options, mote_race *race)
{
    *race = (mote_race){.rows = mote_allocate(options->cell_count, sizeof *race->rows),
                        .count = options->cell_count};
    for (size_t i = 0; i < race->count; ++i) {
        const mote_race_cell *cell = &options->cells[i];
        mote_race_row *row = &race->rows[i];
        row->cell = cell;
        row->name = name_row(options, cell);
        row->ratio = row->interval.low = row->interval.high = row->spread = MOTE_NONE;
        row->instructions[0] = row->instructions[1] = MOTE_NONE;
        row->verdict = MOTE_VERDICT_UNDECIDED;
    }
}

/* Refuses a race that could never have an interval. */
static mote_status check_builds(const mote_race_options *options, double alpha)
{
    const size_t found = mote_race_build_pairs(options), least = mote_paired_least(alpha);
    if (found == 1 || found >= least)
        return MOTE_OK;
    return mote_fail(
        MOTE_EINVAL,
        "%zu builds of A and %zu of B: %zu pairs of builds give no interval, %zu are "
        "needed (rows raced: %zu); link more by relink.sh BUILD %zu OUT (make "
        "perf-ab: ORDERS=%zu), race fewer rows, or one program of each side",
        options->builds[MOTE_RACE_A]->count, options->builds[MOTE_RACE_B]->count, found, least,
        options->cell_count, least, least);
}

mote_status mote_race_run(const mote_race_options *options, mote_race *race)
{
    mote_race made;
    const double alpha = MOTE_RACE_ALPHA / MOTE_RACE_LOOKS / (double)options->cell_count;
    if (check_builds(options, alpha) != MOTE_OK)
        return MOTE_EINVAL;
    begin(options, &made);
    event e = {.options = options,
               .race = &made,
               .done = mote_allocate(made.count, sizeof *e.done),
               .random = {options->seed},
               .turns = count_turns(options),
               .alpha = alpha,
               .next_look = mote_paired_least(alpha),
               .began = mote_clock_ns()};
    mote_status status = run_pairs(&e);
    if (status == MOTE_OK)
        status = check_rows(&made);
    for (size_t i = 0; i < made.count; ++i)
        judge(&made.rows[i], options, &made);
    made.seconds = seconds_since(e.began);
    free(e.done);
    if (status == MOTE_OK)
        *race = made;
    else
        mote_race_free(&made);
    return status;
}

void mote_race_free(mote_race *race)
{
    for (size_t i = 0; i < race->count; ++i) {
        free(race->rows[i].name);
        free(race->rows[i].uncounted);
        free(race->rows[i].what);
    }
    free(race->rows);
    *race = (mote_race){0};
}
