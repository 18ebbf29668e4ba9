#include "harness/summary/summary_quiet.h"

#include "harness/base/memory.h"

#include <stdlib.h>

static uint32_t last_replicate(const mote_summary_row *row)
{
    uint32_t last = 1;
    for (size_t r = 0; r < row->replicates; ++r)
        last = row->cells[r].replicate > last ? row->cells[r].replicate : last;
    return last;
}

/* The group of one of the replicates 1 .. last: blocks of consecutive numbers, so that groups
   differ as much as the machine does from one minute to the next. */
static uint32_t group_of(uint32_t replicate, uint32_t last, uint32_t groups)
{
    return (uint32_t)((uint64_t)(replicate - 1) * groups / last);
}

/* For each frame the fastest time among the replicates of a group of 1 .. last, without
   deformation if positions are given; returns the number of replicates. times holds
   row->frames. */
static size_t fastest(const mote_summary_row *row, bool given, uint32_t last, uint32_t groups,
                      uint32_t group, double *times)
{
    size_t count = 0;
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        if (!mote_stored_ran(cell) || group_of(cell->replicate, last, groups) != group ||
            cell->frames != row->frames)
            continue;
        for (size_t k = 0; k < row->frames; ++k) {
            const double time = cell->total_ns[k] - (given ? cell->deform_ns[k] : 0);
            if (count == 0 || time < times[k])
                times[k] = time;
        }
        ++count;
    }
    return count;
}

/* The quiet total of a group, and its ratio to that of the reference's replicates with these
   numbers; MOTE_NONE without replicates. */
static void quiet_group(const mote_summary_row *row, const mote_summary_row *reference,
                        uint32_t groups, uint32_t group, double *total, double *ratio)
{
    size_t frames = row->frames, others = reference ? reference->frames : 0;
    const uint32_t last = last_replicate(row);
    double *mine = mote_allocate(2 * frames + others, sizeof *mine);
    *total = *ratio = MOTE_NONE;
    double *ratios = mine + frames, *theirs = ratios + frames;
    bool measured = fastest(row, row->given, last, groups, group, mine) > 0;
    if (measured && reference &&
        fastest(reference, row->given, last, groups, group, theirs) > 0) {
        size_t count = 0;
        for (size_t i = 0, k = 0; mote_stored_common(row->first, &i, reference->first, &k);
             ++i, ++k) {
            if (mine[i] > 0)
                ratios[count++] = theirs[k] / mine[i];
        }
        *ratio = mote_statistics_median(ratios, count);
    }
    if (measured)
        *total = mote_statistics_median(mine, frames);
    free(mine);
}

/* The sum of the times of frames in which a method has all that it needs. */
static double settled_sum(const double *times, size_t frames)
{
    double sum = 0;
    for (size_t k = frames < MOTE_SETTLED_LEAST ? 0 : MOTE_SETTLED_FROM - 1; k < frames; ++k)
        sum += times[k];
    return sum;
}

/* All replicates are one group. */
static mote_least least_times(const mote_summary_row *row)
{
    mote_least least = {MOTE_NONE, MOTE_NONE};
    double *times = mote_allocate(row->frames, sizeof *times);
    if (fastest(row, row->given, last_replicate(row), 1, 0, times) > 0) {
        least.settled_sum = settled_sum(times, row->frames);
        least.median = mote_statistics_median(times, row->frames);
    }
    free(times);
    return least;
}

void mote_summary_quiet(mote_summary_row *row, const mote_summary_row *reference)
{
    row->least = least_times(row);
    for (uint32_t k = 0; k < MOTE_QUIET_GROUPS; ++k) {
        row->quiet.total[k] = row->quiet.ratio[k] = MOTE_NONE;
        if (row->finished >= MOTE_QUIET_REPLICATES)
            quiet_group(row, reference, MOTE_QUIET_GROUPS, k, &row->quiet.total[k],
                        &row->quiet.ratio[k]);
    }
}

/* Whether a row's times are relative to the reference. Either all are or none: a time in
   nanoseconds among ratios would look like a change by a factor of a thousand. */
static bool is_relative(const mote_summary_row *row)
{
    for (size_t p = 0; p < row->process_count; ++p) {
        if (row->processes[p].ratio == row->processes[p].ratio)
            return true;
    }
    return false;
}

/* The mean logarithm of the medians of a row's early or late processes. */
static double half_of_processes(const mote_summary_row *row, uint32_t half)
{
    double sum = 0, count = 0;
    const bool relative = is_relative(row);
    const uint32_t last = last_replicate(row);
    for (size_t p = 0; p < row->process_count; ++p) {
        const mote_process *process = &row->processes[p];
        const double value = relative ? process->ratio : process->median;
        if (group_of(process->replicate, last, 2) != half || !(value > 0))
            continue;
        sum += log(value);
        count += 1;
    }
    return count > 0 ? exp(sum / count) : MOTE_NONE;
}

static double halves_differ(const mote_summary_row *row, const mote_summary_row *reference)
{
    double halves[2];
    for (uint32_t half = 0; half < 2; ++half) {
        halves[half] = half_of_processes(row, half);
        if (row->finished < MOTE_QUIET_REPLICATES)
            continue;
        double total, ratio;
        quiet_group(row, reference, 2, half, &total, &ratio);
        halves[half] = is_relative(row) ? ratio : total;
    }
    return exp(fabs(log(halves[0] / halves[1]))) - 1;
}

/* Whether a row's times can be compared; the reference's ratio to itself is always 1. */
static bool is_compared(const mote_summary_row *row)
{
    return row->ratio.to != row && row->finished > 0 && row->times_comparable;
}

/* The 90 % quantile; MOTE_NONE without values. values are reordered. */
static double most_of(double *values, size_t count)
{
    mote_statistics_sort(values, count);
    return mote_statistics_quantile(values, count, 0.9);
}

double mote_summary_noise_floor(const mote_summary_row *rows, size_t count)
{
    double *shares = mote_allocate(count, sizeof *shares);
    size_t known = 0;
    for (size_t i = 0; i < count; ++i) {
        if (!is_compared(&rows[i]))
            continue;
        const double share = halves_differ(&rows[i], rows[i].ratio.to);
        if (share == share)
            shares[known++] = share;
    }
    const double floor = most_of(shares, known);
    free(shares);
    return floor;
}

/* The logarithms used by comparisons; returns their number. */
static size_t comparable_logs(const mote_summary_row *row, double *logs)
{
    size_t count = 0;
    bool quiet = row->finished >= MOTE_QUIET_REPLICATES, relative = is_relative(row);
    size_t some = quiet ? MOTE_QUIET_GROUPS : row->process_count;
    for (size_t i = 0; i < some; ++i) {
        const double ratio = quiet ? row->quiet.ratio[i] : row->processes[i].ratio;
        const double total = quiet ? row->quiet.total[i] : row->processes[i].median;
        const double value = relative ? ratio : total;
        if (value > 0)
            logs[count++] = log(value);
    }
    return count;
}

double mote_summary_smallest_change(mote_summary_row *rows, size_t count)
{
    size_t compared = 0, known = 0, most = MOTE_QUIET_GROUPS;
    for (size_t i = 0; i < count; ++i) {
        compared += is_compared(&rows[i]) ? 1 : 0;
        most = rows[i].replicates > most ? rows[i].replicates : most;
    }
    double *logs = mote_allocate(most + count, sizeof *logs);
    double *changes = logs + most;
    for (size_t i = 0; i < count; ++i) {
        rows[i].smallest_change = MOTE_NONE;
        if (is_compared(&rows[i]))
            rows[i].smallest_change =
                mote_statistics_detectable(logs, comparable_logs(&rows[i], logs), compared) - 1;
        if (rows[i].smallest_change == rows[i].smallest_change)
            changes[known++] = rows[i].smallest_change;
    }
    const double smallest = most_of(changes, known);
    free(logs);
    return smallest;
}
