#include "harness/compare/compare.h"

#include "harness/base/memory.h"
#include "harness/loop/simulate_print.h"

#include <stdlib.h>

/* The row that asks the same, preferably from the same machine. */
static const mote_simulations_row *find_partner(const mote_simulations *list,
                                                const mote_simulations_row *row)
{
    const mote_simulations_row *found = NULL;
    for (size_t i = 0; i < list->count; ++i) {
        const mote_simulations_row *other = &list->rows[i];
        if (!mote_simulation_same_question(row->question, other->question))
            continue;
        if (json_equal(json_object_get(row->origin, "machine"),
                       json_object_get(other->origin, "machine")))
            return other;
        found = found ? found : other;
    }
    return found;
}

static const mote_simulation_result *find_replicate(const mote_simulations_row *row,
                                                    uint32_t number)
{
    for (uint32_t r = 0; r < row->done; ++r) {
        if (row->replicates[r].number == number)
            return &row->replicates[r].result;
    }
    return NULL;
}

/* Compares the figures of the replicates that both rows have. */
static void compare_figures(const mote_simulation_result *was, const mote_simulation_result *is,
                            mote_change *change)
{
    static const double exact = MOTE_EXACT_SHARE;
    mote_change_figure(change, "passes through", (double)was->passes, (double)is->passes,
                       exact);
    mote_change_figure(change, "missed steps", (double)was->missed_steps,
                       (double)is->missed_steps, exact);
    mote_change_figure(change, "false steps", (double)was->false_steps, (double)is->false_steps,
                       exact);
    mote_change_figure(change, "delay", (double)was->delay_sum, (double)is->delay_sum, exact);
    mote_change_figure(change, "penetration", was->depth_max, is->depth_max, exact);
}

static void compare_row(const mote_simulations_row *base, const mote_simulations_row *fresh,
                        bool other_machine, mote_change *change)
{
    mote_simulation_result was = {0}, is = {0};
    double *logs = mote_allocate(base->done, sizeof *logs);
    size_t pairs = 0;
    for (uint32_t r = 0; r < base->done; ++r) {
        const mote_simulation_result *before = &base->replicates[r].result;
        const mote_simulation_result *after = find_replicate(fresh, base->replicates[r].number);
        if (!after)
            continue;
        mote_simulation_add(&was, before);
        mote_simulation_add(&is, after);
        logs[pairs++] = log(after->query_ns / before->query_ns);
    }
    change->name = mote_format("%s/%s/simulated", base->scenario, base->method);
    change->ratio = change->interval.low = change->interval.high = change->p = MOTE_NONE;
    change->smallest_change = MOTE_NONE;
    mote_change_figure(change, "failed replicates", base->failed, fresh->failed,
                       MOTE_EXACT_SHARE);
    if (base->done > 0 && pairs == 0)
        mote_change_unknown(change, "no replicate in common");
    compare_figures(&was, &is, change);
    if (!base->alone)
        mote_text_add(&change->what, "%stimes not comparable: simulated with --jobs",
                      change->what.size ? "; " : "");
    else if (!other_machine && pairs > 0)
        mote_change_times(change, logs, pairs);
    free(logs);
}

void mote_compare_simulations(const mote_simulations *base, const mote_simulations *fresh,
                              mote_comparison *comparison)
{
    comparison->changes = mote_resize(comparison->changes, comparison->count + base->count,
                                      sizeof *comparison->changes);
    for (size_t i = 0; i < base->count; ++i) {
        const mote_simulations_row *partner = find_partner(fresh, &base->rows[i]);
        if (!partner) {
            ++comparison->only_base;
            continue;
        }
        mote_change *change = &comparison->changes[comparison->count++];
        *change = (mote_change){.name = NULL};
        compare_row(&base->rows[i], partner, comparison->other_machine, change);
    }
    for (size_t i = 0; i < fresh->count; ++i)
        comparison->only_new += find_partner(base, &fresh->rows[i]) ? 0 : 1;
}
