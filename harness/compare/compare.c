#include "harness/compare/compare.h"

#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/compare/compared_run.h"
#include "harness/summary/column.h"
#include "harness/summary/scene_contacts.h"

#include <stdlib.h>
#include <string.h>

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

static const mote_process *find_process(const mote_summary_row *row, uint32_t replicate)
{
    for (size_t p = 0; p < row->process_count; ++p) {
        if (row->processes[p].replicate == replicate)
            return &row->processes[p];
    }
    return NULL;
}

static bool is_reference(const mote_summary_row *row)
{
    return row->ratio.to && strcmp(row->ratio.to->label, row->label) == 0;
}

/* Whether the ratios of two rows are to the same configuration of fcl-aabb, as far as their
   runs have its row. */
static bool same_reference(const mote_summary_row *a, const mote_summary_row *b)
{
    return !a->ratio.to || !b->ratio.to || mote_compared_same_method(a->ratio.to, b->ratio.to);
}

/* How the times of two runs are compared. */
typedef struct yardstick {
    bool other_machine; /* absolute times say nothing */
    bool ratios;        /* those to fcl-aabb are to the same configuration */
} yardstick;

/* The logarithm of new / base of a time: relative to fcl-aabb, which removes most of the
   difference between two machines, or otherwise absolute, on one machine. */
static double log_change(double base_ratio, double new_ratio, double base_ns, double new_ns,
                         yardstick by)
{
    if (by.ratios && base_ratio > 0 && new_ratio > 0)
        return log(base_ratio / new_ratio);
    if (by.other_machine)
        return MOTE_NONE;
    return base_ns > 0 && new_ns > 0 ? log(new_ns / base_ns) : MOTE_NONE;
}

/* The changes of the quiet times, group by group; returns their number. */
static size_t quiet_changes(const mote_summary_row *base, const mote_summary_row *fresh,
                            yardstick by, double *logs)
{
    const mote_quiet *was = &base->quiet, *is = &fresh->quiet;
    size_t count = 0;
    for (size_t k = 0; k < MOTE_QUIET_GROUPS; ++k) {
        const double value =
            log_change(was->ratio[k], is->ratio[k], was->total[k], is->total[k], by);
        if (value == value)
            logs[count++] = value;
    }
    return count;
}

/* The changes of the processes' medians. Replicates with the same number draw the same random
   numbers, so they are compared in pairs. */
static size_t process_changes(const mote_summary_row *base, const mote_summary_row *fresh,
                              yardstick by, double *logs)
{
    size_t count = 0;
    for (size_t p = 0; p < base->process_count && count < PAIRS_MAX; ++p) {
        const mote_process *was = &base->processes[p],
                           *is = find_process(fresh, was->replicate);
        const double value =
            is ? log_change(was->ratio, is->ratio, was->median, is->median, by) : MOTE_NONE;
        if (value == value)
            logs[count++] = value;
    }
    return count;
}

void mote_change_unknown(mote_change *change, const char *what)
{
    change->unknown = true;
    mote_text_add(&change->what, "%s%s", change->what.size ? "; " : "", what);
}

static bool has_time(const mote_summary_row *row)
{
    for (size_t p = 0; p < row->process_count; ++p) {
        if (row->processes[p].median > 0 || row->processes[p].ratio > 0)
            return true;
    }
    return row->quiet.total[0] > 0 || row->quiet.ratio[0] > 0;
}

void mote_change_times(mote_change *change, const double *logs, size_t count)
{
    change->ratio = exp(mote_statistics_mean(logs, count));
    change->interval = mote_statistics_t_interval(logs, count);
    change->interval.low = exp(change->interval.low);
    change->interval.high = exp(change->interval.high);
    change->p = mote_statistics_t_test(logs, count);
}

/* Says that the ratios of two rows are to different ones. On one machine times are then
   compared as they are. */
static void say_other_reference(const mote_summary_row *base, const mote_summary_row *fresh,
                                bool other_machine, mote_change *change)
{
    char *text = mote_format("ratios are to %s and to %s: %s", base->ratio.to->label,
                             fresh->ratio.to->label,
                             other_machine ? "no time to compare" : "times as they are");
    if (other_machine)
        mote_change_unknown(change, text);
    else
        mote_text_add(&change->what, "%s%s", change->what.size ? "; " : "", text);
    free(text);
}

/* Whether another row has all replicates of a row. */
static bool are_within(const mote_summary_row *row, const mote_summary_row *other)
{
    bool within = true;
    for (size_t p = 0; within && p < row->process_count; ++p)
        within = find_process(other, row->processes[p].replicate) != NULL;
    return within;
}

/* The fastest of more replicates is faster, so quiet times are compared only where both rows
   have the same replicates. */
static void compare_times(const mote_summary_row *base, const mote_summary_row *fresh,
                          bool other_machine, mote_change *change)
{
    static double logs[PAIRS_MAX];
    const yardstick by = {other_machine, same_reference(base, fresh)};
    size_t count = 0;
    if (are_within(base, fresh) && are_within(fresh, base))
        count = quiet_changes(base, fresh, by, logs);
    if (count < MOTE_QUIET_GROUPS)
        count = process_changes(base, fresh, by, logs);
    if (!by.ratios)
        say_other_reference(base, fresh, other_machine, change);
    /* Between machines, a row without a ratio to fcl-aabb has no comparable time. */
    if (count == 0 && !other_machine && has_time(base))
        mote_change_unknown(change, "no time to compare");
    change->smallest_change = fmax(base->smallest_change, fresh->smallest_change);
    mote_change_times(change, logs, count);
}

static void say(mote_change *change, const char *name, double base, double fresh)
{
    const char *separator = change->what.size ? "; " : "";
    char was[32] = "unknown", is[32] = "unknown";
    if (base == base)
        (void)snprintf(was, sizeof was, "%.6g", base);
    if (fresh == fresh)
        (void)snprintf(is, sizeof is, "%.6g", fresh);
    mote_text_add(&change->what, "%s%s %s to %s", separator, name, was, is);
    if (base > 0 && fresh == fresh)
        mote_text_add(&change->what, " (%+.2g %%)", 100 * (fresh / base - 1));
}

void mote_change_figure(mote_change *change, const char *name, double base, double fresh,
                        double share)
{
    const double slack = share * fmax(fabs(base), fabs(fresh));
    const bool was_known = base == base, is_known = fresh == fresh;
    if ((!was_known && !is_known) || fabs(fresh - base) <= slack)
        return;
    say(change, name, base, fresh);
    change->worse = change->worse || (was_known && !(fresh <= base));
    change->better = change->better || fresh < base;
}

/* Whether the two rows have a replicate in common. */
static bool has_pair(const mote_summary_row *base, const mote_summary_row *fresh)
{
    for (size_t p = 0; p < base->process_count; ++p) {
        if (find_process(fresh, base->processes[p].replicate))
            return true;
    }
    return false;
}

/* The sum of a process's count with that name; MOTE_NONE: not counted. */
static double count_in(const mote_summary_row *row, const mote_process *process,
                       const char *name)
{
    for (size_t k = 0; k < row->count_count; ++k) {
        if (strcmp(row->counts[k].name, name) == 0)
            return process->sums[k];
    }
    return MOTE_NONE;
}

/* Compares the sums of the counts over the replicates that both have. */
static void compare_counts(const mote_summary_row *base, const mote_summary_row *fresh,
                           mote_change *change)
{
    if (base->process_count > 0 && !has_pair(base, fresh)) {
        mote_change_unknown(change, "no replicate in common: counts are not compared");
        return;
    }
    for (size_t k = 0; k < base->count_count; ++k) {
        const char *name = base->counts[k].name;
        double sums[2] = {0, 0};
        for (size_t p = 0; p < base->process_count; ++p) {
            const mote_process *was = &base->processes[p];
            const mote_process *is = find_process(fresh, was->replicate);
            if (!is)
                continue;
            sums[0] += was->sums[k];
            sums[1] += count_in(fresh, is, name);
        }
        change->counted = change->counted ||
                          fabs(sums[0] - sums[1]) > MOTE_EXACT_SHARE * fmax(sums[0], sums[1]);
        mote_change_figure(change, name, sums[0], sums[1], MOTE_EXACT_SHARE);
    }
}

/* Whether all replicates of a row counted the same: they then gave the same answers. */
static bool are_alike(const mote_summary_row *row)
{
    for (size_t p = 1; p < row->process_count; ++p) {
        for (size_t k = 0; k < row->count_count; ++k) {
            if (fabs(row->processes[p].sums[k] - row->processes[0].sums[k]) > 0)
                return false;
        }
    }
    return row->count_count > 0;
}

/* A row whose answers are those of the replicates that another row has as well. */
typedef struct common_row {
    mote_summary_row row;
    mote_stored_cell *cells; /* owned; NULL: the row's own */
    bool known;              /* false: a summary.json does not have these replicates alone */
} common_row;

/* Counts the contacts of a row of more than two bodies, against the row that counts as true. */
static mote_status count_pairs(const char *directory, mote_summary_row *row)
{
    mote_summary_row rows[] = {*row, *row->contacts_of};
    const mote_status status = mote_scene_contacts_count(directory, rows, 2);
    row->contacts = rows[0].contacts;
    row->missed = rows[0].missed;
    row->false_contacts = rows[0].false_contacts;
    return status;
}

static mote_status restrict_row(const mote_compared_run *run, const mote_summary_row *row,
                                const mote_summary_row *other, common_row *common)
{
    *common = (common_row){.row = *row, .known = true};
    if (row->process_count == 0 || other->process_count == 0 || are_within(row, other) ||
        are_alike(row))
        return MOTE_OK;
    common->known = row->cells && has_pair(row, other);
    if (!common->known)
        return MOTE_OK;
    mote_summary_row *r = &common->row;
    common->cells = mote_allocate(row->replicates, sizeof *common->cells);
    r->replicates = 0;
    for (size_t k = 0; k < row->replicates; ++k) {
        if (mote_stored_ran(&row->cells[k]) && find_process(other, row->cells[k].replicate))
            common->cells[r->replicates++] = row->cells[k];
    }
    r->cells = common->cells;
    r->finished = r->replicates;
    mote_summary_row_answers(r);
    return r->contacts_of ? count_pairs(run->directory, r) : MOTE_OK;
}

/* Compares the columns by their own rules (mote_column_rule): those that depend on random
   numbers, or the others. */
static void compare_columns(const mote_summary_row *base, const mote_summary_row *fresh,
                            bool answers, mote_change *change)
{
    for (size_t i = 0; i < mote_column_count; ++i) {
        const mote_column *column = &mote_columns[i];
        const mote_column_rule *rule = &column->rule;
        double values[2] = {mote_column_number(column, base),
                            mote_column_number(column, fresh)};
        if (!rule->name || rule->answers != answers)
            continue;
        for (size_t k = 0; k < 2; ++k) {
            if (rule->complement)
                values[k] = 1 - values[k];
        }
        if (!(fabs(values[0]) <= rule->negligible && fabs(values[1]) <= rule->negligible))
            mote_change_figure(change, rule->name, values[0], values[1], rule->share);
    }
}

/* Compares errors and contacts over the replicates that both have. */
static mote_status compare_answers(const mote_compared_run runs[2],
                                   const mote_summary_row *base, const mote_summary_row *fresh,
                                   mote_change *change)
{
    common_row was = {.cells = NULL}, is = {.cells = NULL};
    mote_status status = restrict_row(&runs[0], base, fresh, &was);
    if (status == MOTE_OK)
        status = restrict_row(&runs[1], fresh, base, &is);
    if (status == MOTE_OK && was.known && is.known)
        compare_columns(&was.row, &is.row, true, change);
    else if (status == MOTE_OK)
        mote_change_unknown(change, "other replicates: errors are not compared");
    free(was.cells);
    free(is.cells);
    return status;
}

/* Names a row, with its frames where another of its run has the name. */
static char *name_row(const mote_summary *summary, const mote_summary_row *row)
{
    bool ranges = false;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        ranges = ranges || (strcmp(other->scene, row->scene) == 0 &&
                            strcmp(other->label, row->label) == 0 &&
                            strcmp(other->cache, row->cache) == 0 &&
                            !mote_compared_same_range(other->frame_range, row->frame_range));
    }
    return ranges ? mote_format("%s@%u-%u/%s/%s", row->scene, row->frame_range[0],
                                row->frame_range[1], row->label, row->cache)
                  : mote_format("%s/%s/%s", row->scene, row->label, row->cache);
}

static mote_status compare_row(const mote_compared_run runs[2], const mote_summary_row *base,
                               const mote_summary_row *fresh, bool other_machine,
                               mote_change *change)
{
    change->name = name_row(&runs[0].summary, base);
    change->is_reference = is_reference(base) && is_reference(fresh);
    change->ratio = change->interval.low = change->interval.high = change->p = MOTE_NONE;
    change->smallest_change = MOTE_NONE;
    const char *was = base->ending, *is = fresh->ending;
    if (strcmp(was, is) != 0) {
        mote_text_add(&change->what, "status %s to %s", was, is);
        change->worse = strcmp(was, "ok") == 0;
        change->better = strcmp(is, "ok") == 0;
        change->unknown = was[0] == '\0' && !change->better;
        return MOTE_OK;
    }
    if (strcmp(is, "ok") != 0) {
        if (is[0] == '\0')
            mote_change_unknown(change, "no status");
        return MOTE_OK;
    }
    if (!base->times_comparable || !fresh->times_comparable)
        mote_text_add(&change->what, "times not comparable: measured with --jobs");
    else if (!change->is_reference)
        compare_times(base, fresh, other_machine, change);
    const mote_status status = compare_answers(runs, base, fresh, change);
    compare_columns(base, fresh, false, change);
    compare_counts(base, fresh, change);
    return status;
}

/* Says why a time changed, as far as counts and instructions explain it. */
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

/* Corrects p over all rows, and sets the verdict on each row's time. */
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

static double raised_floor(double floor, const mote_compared_run runs[2])
{
    for (int i = 0; i < 2; ++i) {
        const double noise = runs[i].summary.noise_floor;
        floor = noise > floor ? noise : floor;
    }
    return floor;
}

static mote_status compare_rows(const mote_compared_run runs[2], mote_comparison *c)
{
    const mote_summary *base = &runs[0].summary, *fresh = &runs[1].summary;
    mote_status status = MOTE_OK;
    c->changes = mote_allocate(base->count, sizeof *c->changes);
    for (size_t i = 0; i < base->count && status == MOTE_OK; ++i) {
        const mote_summary_row *partner = mote_compared_partner(fresh, &base->rows[i]);
        if (partner)
            status = compare_row(runs, &base->rows[i], partner, c->other_machine,
                                 &c->changes[c->count++]);
        else
            ++c->only_base;
    }
    /* Several rows of the base, on different machines, may have the same partner. */
    for (size_t i = 0; i < fresh->count; ++i)
        c->only_new += mote_compared_partner(base, &fresh->rows[i]) ? 0 : 1;
    return status;
}

/* Whether both manifests exist and differ in this key. */
static bool manifests_differ(const mote_compared_run runs[2], const char *key)
{
    return runs[0].manifest && runs[1].manifest &&
           !json_equal(json_object_get(runs[0].manifest, key),
                       json_object_get(runs[1].manifest, key));
}

static bool same_frames(const json_t *a, const json_t *b)
{
    const json_t *first = json_object_get(a, "frames"), *second = json_object_get(b, "frames");
    return first == second || json_equal(first, second); /* or neither has one */
}

/* Whether a counted row was asked what a row of the summary was. Those of older versions do not
   say it: they are of questions that span no frames, and of what the scenario asks. */
static bool same_ask(const json_t *counted, const mote_summary_row *row)
{
    return mote_compared_agree(mote_text_at(counted, "ask"), row->ask) &&
           json_integer_value(json_object_get(counted, "step")) == (json_int_t)row->step;
}

/* The counted row for a row of the summary, over the frames of `like` if that is given; NULL if
   there is none. */
static const json_t *find_counted(const json_t *counted, const mote_summary_row *row,
                                  const json_t *like)
{
    size_t i;
    const json_t *other;
    MOTE_EACH(i, other, json_object_get(counted, "rows"))
    {
        if (strcmp(mote_text_at(other, "scenario"), row->scenario) == 0 &&
            mote_compared_agree(mote_text_at(other, "fingerprint"), row->fingerprint) &&
            mote_compared_agree(mote_text_at(other, "faces"), row->faces) &&
            same_ask(other, row) && strcmp(mote_text_at(other, "method"), row->method) == 0 &&
            json_equal(json_object_get(other, "parameters"), row->parameters) &&
            (!like || same_frames(other, like)))
            return other;
    }
    return NULL;
}

/* Compares the instructions of the rows of both runs. judged: more instructions count as
   worse. */
static void compare_instructions(const mote_compared_run runs[2], bool judged,
                                 mote_comparison *c)
{
    size_t index = 0;
    for (size_t i = 0; i < runs[0].summary.count; ++i) {
        const mote_summary_row *row = &runs[0].summary.rows[i];
        if (!mote_compared_partner(&runs[1].summary, row))
            continue;
        mote_change *change = &c->changes[index++];
        const json_t *was = find_counted(runs[0].instructions, row, NULL);
        const double a = mote_number_at(was, "per_frame");
        const double b =
            mote_number_at(find_counted(runs[1].instructions, row, was), "per_frame");
        bool known = a == a && b == b;
        change->executed = known && fabs(b - a) > INSTRUCTIONS_SHARE * fmax(a, b);
        if (judged && known)
            mote_change_figure(change, "instructions", a, b, INSTRUCTIONS_SHARE);
        else if (change->executed)
            say(change, "instructions (another processor or compiler)", a, b);
        else if (judged && a == a)
            mote_change_unknown(change, "instructions are not counted over the same frames");
    }
}

static mote_status compare_runs(const mote_compared_run runs[2], double floor,
                                mote_comparison *c)
{
    c->other_machine = manifests_differ(runs, "processor");
    c->floor = raised_floor(floor, runs);
    if (c->other_machine && c->floor < MOTE_OTHER_MACHINE_FLOOR)
        c->floor = MOTE_OTHER_MACHINE_FLOOR;
    const mote_status status = compare_rows(runs, c);
    if (status != MOTE_OK)
        return status;
    mote_compare_simulations(&runs[0].simulations, &runs[1].simulations, c);
    c->undecided = c->only_base > 0; /* rows missing from the new run */
    if (c->count == 0)
        return mote_fail(MOTE_EINVAL, "the two runs have no configuration in common; compare "
                                      "runs of the same scenarios, methods, frames and seed");
    c->instructions = runs[0].instructions && runs[1].instructions;
    if (c->instructions)
        compare_instructions(runs, !c->other_machine && !manifests_differ(runs, "compiler"), c);
    judge(c);
    return MOTE_OK;
}

mote_status mote_compare(const char *base, const char *new_run, double floor,
                         mote_comparison *comparison)
{
    mote_compared_run runs[2] = {{.manifest = NULL}, {.manifest = NULL}};
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
