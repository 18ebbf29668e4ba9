#include "harness/summary/compare.h"

#include "harness/base/memory.h"
#include "harness/summary/column.h"
#include "harness/summary/compared_run.h"

#include <stdlib.h>
#include <string.h>

/* Counts are equal when they differ by less than this share. */
#define EXACT_SHARE 1e-9
/* Instructions may grow by this share: a few branches depend on memory addresses. */
#define INSTRUCTIONS_SHARE 0.01
/* At most this many replicates are paired. */
#define PAIRS_MAX 1000

void mote_comparison_free(mote_comparison *comparison)
{
    for (size_t i = 0; i < comparison->count; ++i) {
        free(comparison->changes[i].name);
        free(comparison->changes[i].what.data);
    }
    free(comparison->changes);
    mote_comparison none = {0};
    *comparison = none;
}

static const char *row_text(const json_t *row, const char *key)
{
    const char *text = json_string_value(json_object_get(row, key));
    return text ? text : "";
}

static double number_at(const json_t *row, const char *group, const char *key)
{
    const json_t *value =
        group ? json_object_get(json_object_get(row, group), key) : json_object_get(row, key);
    return json_is_number(value) ? json_number_value(value) : MOTE_NONE;
}

/* Rows are of one configuration when all of this is equal. */
static bool same_configuration(const json_t *a, const json_t *b)
{
    static const char *const keys[] = {"scenario", "fingerprint", "method", "parameters",
                                       "cache",    "stride",      "seed",   "frames"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; ++i) {
        if (!json_equal(json_object_get(a, keys[i]), json_object_get(b, keys[i])))
            return false;
    }
    return true;
}

/* The row of that configuration, on the same machine where there is one. */
static const json_t *find_partner(const json_t *rows, const json_t *row)
{
    const json_t *found = NULL;
    for (size_t i = 0; i < json_array_size(rows); ++i) {
        const json_t *other = json_array_get(rows, i);
        if (!same_configuration(row, other))
            continue;
        if (json_equal(json_object_get(row, "machine"), json_object_get(other, "machine")))
            return other;
        found = found ? found : other;
    }
    return found;
}

static const json_t *find_process(const json_t *row, const json_t *replicate)
{
    const json_t *processes = json_object_get(row, "processes");
    for (size_t i = 0; i < json_array_size(processes); ++i) {
        const json_t *process = json_array_get(processes, i);
        if (json_equal(json_object_get(process, "replicate"), replicate))
            return process;
    }
    return NULL;
}

static bool is_reference(const json_t *row)
{
    const char *to = row_text(json_object_get(row, "ratio"), "to");
    return to[0] != '\0' && strcmp(to, row_text(row, "label")) == 0;
}

/* The logarithm of new / base of a time: relative to fcl-aabb, which takes out most of what
   differs between two machines, or else as it is, on one machine. */
static double log_change(double base_ratio, double new_ratio, double base_ns, double new_ns,
                         bool other_machine)
{
    if (base_ratio > 0 && new_ratio > 0)
        return log(base_ratio / new_ratio);
    if (other_machine)
        return MOTE_NONE;
    return base_ns > 0 && new_ns > 0 ? log(new_ns / base_ns) : MOTE_NONE;
}

static double element(const json_t *row, const char *key, size_t index)
{
    const json_t *value =
        json_array_get(json_object_get(json_object_get(row, "quiet"), key), index);
    return json_is_number(value) ? json_number_value(value) : MOTE_NONE;
}

/* The changes of the quiet times, group by group; returns how many. */
static size_t quiet_changes(const json_t *base, const json_t *fresh, bool other_machine,
                            double *logs)
{
    size_t count = 0;
    for (size_t k = 0; k < MOTE_QUIET_GROUPS; ++k) {
        double value = log_change(element(base, "ratio", k), element(fresh, "ratio", k),
                                  element(base, "total_ns", k), element(fresh, "total_ns", k),
                                  other_machine);
        if (value == value)
            logs[count++] = value;
    }
    return count;
}

/* The changes of the processes' medians. Replicates with one number draw the same random
   numbers: they are compared in pairs. */
static size_t process_changes(const json_t *base, const json_t *fresh, bool other_machine,
                              double *logs)
{
    size_t count = 0;
    const json_t *processes = json_object_get(base, "processes");
    for (size_t i = 0; i < json_array_size(processes) && count < PAIRS_MAX; ++i) {
        const json_t *process = json_array_get(processes, i);
        const json_t *partner = find_process(fresh, json_object_get(process, "replicate"));
        double value = MOTE_NONE;
        if (partner)
            value =
                log_change(number_at(process, NULL, "ratio"), number_at(partner, NULL, "ratio"),
                           number_at(process, NULL, "median_ns"),
                           number_at(partner, NULL, "median_ns"), other_machine);
        if (value == value)
            logs[count++] = value;
    }
    return count;
}

/* Notes that something the base has cannot be compared, so that the row is undecided. */
static void say_unknown(mote_change *change, const char *what)
{
    change->unknown = true;
    mote_text_add(&change->what, "%s%s", change->what.size ? "; " : "", what);
}

static bool has_time(const json_t *row)
{
    const json_t *processes = json_object_get(row, "processes");
    for (size_t i = 0; i < json_array_size(processes); ++i) {
        const json_t *process = json_array_get(processes, i);
        if (number_at(process, NULL, "median_ns") > 0 || number_at(process, NULL, "ratio") > 0)
            return true;
    }
    return element(row, "total_ns", 0) > 0 || element(row, "ratio", 0) > 0;
}

static void compare_times(const json_t *base, const json_t *fresh, bool other_machine,
                          mote_change *change)
{
    static double logs[PAIRS_MAX];
    size_t count = quiet_changes(base, fresh, other_machine, logs);
    if (count < MOTE_QUIET_GROUPS)
        count = process_changes(base, fresh, other_machine, logs);
    /* Between machines a row without a ratio to fcl-aabb has no time that compares. */
    if (count == 0 && !other_machine && has_time(base))
        say_unknown(change, "no time to compare");
    change->smallest_change = fmax(number_at(base, NULL, "smallest_change"),
                                   number_at(fresh, NULL, "smallest_change"));
    change->ratio = exp(mote_statistics_mean(logs, count));
    change->interval = mote_statistics_t_interval(logs, count);
    change->interval.low = exp(change->interval.low);
    change->interval.high = exp(change->interval.high);
    change->p = mote_statistics_t_test(logs, count);
}

static void say(mote_change *change, const char *name, double base, double fresh)
{
    const char *separator = change->what.size ? "; " : "";
    if (base > 0)
        mote_text_add(&change->what, "%s%s %.6g to %.6g (%+.2g %%)", separator, name, base,
                      fresh, 100 * (fresh / base - 1));
    else
        mote_text_add(&change->what, "%s%s %.6g to %.6g", separator, name, base, fresh);
}

/* Compares a value of which more is worse, equal within a share, and notes a difference. */
static void compare_figure(mote_change *change, const char *name, double base, double fresh,
                           double share)
{
    double slack = share * fmax(fabs(base), fabs(fresh));
    bool known = base == base && fresh == fresh;
    if (!known && (base == base) == (fresh == fresh))
        return;
    if (known && fabs(fresh - base) <= slack)
        return;
    say(change, name, base, fresh);
    if (!known || fresh > base)
        change->worse = true;
    else
        change->better = true;
}

/* Whether the two rows have a replicate in common. */
static bool has_pair(const json_t *base, const json_t *fresh)
{
    const json_t *processes = json_object_get(base, "processes");
    for (size_t i = 0; i < json_array_size(processes); ++i) {
        const json_t *process = json_array_get(processes, i);
        if (find_process(fresh, json_object_get(process, "replicate")))
            return true;
    }
    return false;
}

/* The sums of a count over the replicates that both have. */
static void compare_counts(const json_t *base, const json_t *fresh, mote_change *change)
{
    const json_t *processes = json_object_get(base, "processes");
    if (json_array_size(processes) > 0 && !has_pair(base, fresh)) {
        say_unknown(change, "no replicate in common: counts are not compared");
        return;
    }
    json_t *counters = json_object_get(json_array_get(processes, 0), "counters");
    const char *name;
    json_t *first;
    json_object_foreach(counters, name, first)
    {
        double sums[2] = {0, 0};
        for (size_t i = 0; i < json_array_size(processes); ++i) {
            const json_t *process = json_array_get(processes, i);
            const json_t *partner = find_process(fresh, json_object_get(process, "replicate"));
            if (!partner)
                continue;
            sums[0] += number_at(process, "counters", name);
            sums[1] += number_at(partner, "counters", name);
        }
        change->counted =
            change->counted || fabs(sums[0] - sums[1]) > EXACT_SHARE * fmax(sums[0], sums[1]);
        compare_figure(change, name, sums[0], sums[1], EXACT_SHARE);
    }
}

/* Compares the columns by their own rules (mote_column_rule). */
static void compare_columns(const json_t *base, const json_t *fresh, mote_change *change)
{
    for (size_t i = 0; i < mote_column_count; ++i) {
        const mote_column *column = &mote_columns[i];
        const mote_column_rule *rule = &column->rule;
        double values[2] = {mote_column_stored(column, base),
                            mote_column_stored(column, fresh)};
        if (!rule->name)
            continue;
        for (size_t k = 0; k < 2; ++k) {
            if (rule->assumed && values[k] != values[k])
                values[k] = 0;
            if (rule->complement)
                values[k] = 1 - values[k];
        }
        if (!(fabs(values[0]) <= rule->negligible && fabs(values[1]) <= rule->negligible))
            compare_figure(change, rule->name, values[0], values[1], rule->share);
    }
}

static bool times_comparable(const json_t *row)
{
    return !json_is_false(json_object_get(row, "times_comparable"));
}

static void compare_row(const json_t *base, const json_t *fresh, bool other_machine,
                        mote_change *change)
{
    const char *scene = row_text(base, "scene"); /* older summaries have none */
    change->name = mote_format("%s/%s/%s", scene[0] ? scene : row_text(base, "scenario"),
                               row_text(base, "label"), row_text(base, "cache"));
    change->is_reference = is_reference(base) && is_reference(fresh);
    change->ratio = change->interval.low = change->interval.high = change->p = MOTE_NONE;
    change->smallest_change = MOTE_NONE;
    const char *was = row_text(base, "status"), *is = row_text(fresh, "status");
    if (strcmp(was, is) != 0) {
        mote_text_add(&change->what, "status %s to %s", was, is);
        change->worse = strcmp(was, "ok") == 0;
        change->better = strcmp(is, "ok") == 0;
        change->unknown = was[0] == '\0' && !change->better;
        return;
    }
    if (strcmp(is, "ok") != 0) {
        if (is[0] == '\0')
            say_unknown(change, "no status");
        return;
    }
    if (!times_comparable(base) || !times_comparable(fresh))
        mote_text_add(&change->what, "times not comparable: measured with --jobs");
    else if (!change->is_reference)
        compare_times(base, fresh, other_machine, change);
    compare_columns(base, fresh, change);
    compare_counts(base, fresh, change);
}

/* Why a time changed, as far as counts and instructions explain it. */
static void explain(mote_change *change, bool instructions)
{
    if (change->counted)
        mote_text_add(&change->what, "; the time changed with the counts");
    else if (change->executed)
        mote_text_add(&change->what,
                      "; counts are the same: more or fewer instructions a count");
    else
        mote_text_add(
            &change->what, "%scost per count changed%s", change->what.size ? "; " : "",
            instructions ? ", at the same instructions: memory, the layout of code, or "
                           "the machine"
                         : "");
}

/* Corrects p over all rows, and says of each what its time means. */
static void judge(mote_comparison *c)
{
    double *p = mote_allocate(2 * c->count, sizeof *p);
    for (size_t i = 0; i < c->count; ++i)
        p[i] = c->changes[i].p;
    mote_statistics_holm(p, c->count, p + c->count);
    for (size_t i = 0; i < c->count; ++i) {
        mote_change *change = &c->changes[i];
        change->p = p[i];
        change->verdict =
            mote_statistics_verdict(change->ratio, change->interval, change->p, c->floor);
        bool changed =
            change->verdict == MOTE_VERDICT_SLOWER || change->verdict == MOTE_VERDICT_FASTER;
        if (changed && fabs(log(change->ratio)) <= log(1 + change->smallest_change)) {
            change->verdict = MOTE_VERDICT_UNDECIDED;
            changed = false;
        }
        if (changed)
            explain(change, c->instructions);
        change->worse = change->worse || change->verdict == MOTE_VERDICT_SLOWER;
        change->better = !change->worse && !change->unknown &&
                         (change->better || change->verdict == MOTE_VERDICT_FASTER);
        bool timed = change->ratio == change->ratio;
        c->worse = c->worse || change->worse;
        c->undecided = c->undecided || change->unknown ||
                       (timed && change->verdict == MOTE_VERDICT_UNDECIDED);
    }
    free(p);
}

static double raised_floor(double floor, const json_t *base, const json_t *fresh)
{
    double noise[2] = {number_at(base, NULL, "noise_floor"),
                       number_at(fresh, NULL, "noise_floor")};
    for (int i = 0; i < 2; ++i)
        floor = noise[i] > floor ? noise[i] : floor;
    return floor;
}

static mote_status compare_rows(const json_t *base_rows, const json_t *new_rows,
                                mote_comparison *c)
{
    c->changes = mote_allocate(json_array_size(base_rows), sizeof *c->changes);
    for (size_t i = 0; i < json_array_size(base_rows); ++i) {
        const json_t *row = json_array_get(base_rows, i);
        const json_t *partner = find_partner(new_rows, row);
        if (partner)
            compare_row(row, partner, c->other_machine, &c->changes[c->count++]);
        else
            ++c->only_base;
    }
    /* Several rows of the base, of different machines, may have one partner. */
    for (size_t i = 0; i < json_array_size(new_rows); ++i)
        c->only_new += find_partner(base_rows, json_array_get(new_rows, i)) ? 0 : 1;
    c->undecided = c->only_base > 0; /* nothing is known of them now */
    if (c->count == 0)
        return mote_fail(MOTE_EINVAL, "the two runs have no configuration in common; compare "
                                      "runs of the same scenarios, methods, frames and seed");
    return MOTE_OK;
}

/* Whether both manifests are there and differ in something. */
static bool manifests_differ(const mote_compared_run runs[2], const char *key)
{
    return runs[0].manifest && runs[1].manifest &&
           !json_equal(json_object_get(runs[0].manifest, key),
                       json_object_get(runs[1].manifest, key));
}

static bool same_frames(const json_t *a, const json_t *b)
{
    const json_t *first = json_object_get(a, "frames"), *second = json_object_get(b, "frames");
    return first == second || json_equal(first, second); /* or neither has any */
}

/* The counted row of a row of the summary, over the frames of `like` where it is given; NULL
   when there is none. */
static const json_t *find_counted(const json_t *counted, const json_t *row, const json_t *like)
{
    const json_t *rows = json_object_get(counted, "rows");
    for (size_t i = 0; i < json_array_size(rows); ++i) {
        const json_t *other = json_array_get(rows, i);
        if (json_equal(json_object_get(other, "scenario"), json_object_get(row, "scenario")) &&
            json_equal(json_object_get(other, "method"), json_object_get(row, "method")) &&
            json_equal(json_object_get(other, "parameters"),
                       json_object_get(row, "parameters")) &&
            (!like || same_frames(other, like)))
            return other;
    }
    return NULL;
}

/* Compares the instructions of the rows of both runs. judged: more of them are worse. */
static void compare_instructions(const mote_compared_run runs[2], bool judged,
                                 mote_comparison *c)
{
    const json_t *base_rows = json_object_get(runs[0].summary, "rows");
    const json_t *new_rows = json_object_get(runs[1].summary, "rows");
    size_t index = 0;
    for (size_t i = 0; i < json_array_size(base_rows); ++i) {
        const json_t *row = json_array_get(base_rows, i);
        if (!find_partner(new_rows, row))
            continue;
        mote_change *change = &c->changes[index++];
        const json_t *was = find_counted(runs[0].instructions, row, NULL);
        const double a = number_at(was, NULL, "per_frame");
        const double b =
            number_at(find_counted(runs[1].instructions, row, was), NULL, "per_frame");
        bool known = a == a && b == b;
        change->executed = known && fabs(b - a) > INSTRUCTIONS_SHARE * fmax(a, b);
        if (judged && known)
            compare_figure(change, "instructions", a, b, INSTRUCTIONS_SHARE);
        else if (change->executed)
            say(change, "instructions (another processor or compiler)", a, b);
        else if (judged && a == a)
            say_unknown(change, "instructions are not counted over the same frames");
    }
}

static mote_status compare_runs(const mote_compared_run runs[2], double floor,
                                mote_comparison *c)
{
    c->other_machine = manifests_differ(runs, "processor");
    c->floor = raised_floor(floor, runs[0].summary, runs[1].summary);
    if (c->other_machine && c->floor < MOTE_OTHER_MACHINE_FLOOR)
        c->floor = MOTE_OTHER_MACHINE_FLOOR;
    const mote_status status = compare_rows(json_object_get(runs[0].summary, "rows"),
                                            json_object_get(runs[1].summary, "rows"), c);
    if (status != MOTE_OK)
        return status;
    c->instructions = runs[0].instructions && runs[1].instructions;
    if (c->instructions)
        compare_instructions(runs, !c->other_machine && !manifests_differ(runs, "compiler"), c);
    judge(c);
    return MOTE_OK;
}

mote_status mote_compare(const char *base, const char *new_run, double floor,
                         mote_comparison *comparison)
{
    mote_compared_run runs[2] = {{NULL, NULL, NULL}, {NULL, NULL, NULL}};
    mote_comparison c = {0};
    mote_status status = mote_compared_run_read(base, &runs[0]);
    if (status == MOTE_OK)
        status = mote_compared_run_read(new_run, &runs[1]);
    if (status == MOTE_OK)
        status = compare_runs(runs, floor, &c);
    mote_compared_run_free(&runs[0]);
    mote_compared_run_free(&runs[1]);
    if (status == MOTE_OK)
        *comparison = c;
    else
        mote_comparison_free(&c);
    return status;
}
