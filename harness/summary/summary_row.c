#include "harness/summary/summary_row.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/summary/row_label.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A fixed seed, so the same data give the same intervals. */
#define BOOTSTRAP_SEED 20030901u

/* The values of a time over the frames that count. */
typedef struct slice {
    double *all;              /* values of all replicates */
    mote_replicate *replicas; /* [count], inside all */
    size_t count, total;
} slice;

static void free_slice(slice *s)
{
    free(s->all);
    free(s->replicas);
}

typedef double (*value_of)(const mote_stored_cell *cell, size_t frame);

#define DEFINE_VALUE(name, expression)                                                         \
    static double name(const mote_stored_cell *cell, size_t frame)                             \
    {                                                                                          \
        return expression;                                                                     \
    }
DEFINE_VALUE(total_of, cell->total_ns[frame])
DEFINE_VALUE(deform_of, cell->deform_ns[frame])
DEFINE_VALUE(update_of, cell->update_ns[frame])
DEFINE_VALUE(query_of, cell->query_ns[frame])
DEFINE_VALUE(given_of, cell->update_ns[frame] + cell->query_ns[frame])
DEFINE_VALUE(read_of, cell->update_ns[frame] + cell->query_ns[frame] + cell->read_ns)
DEFINE_VALUE(error_of, cell->error[frame])
DEFINE_VALUE(bracket_of, cell->impact[MOTE_IMPACT_COLUMN_to][frame] -
                             cell->impact[MOTE_IMPACT_COLUMN_from][frame])
DEFINE_VALUE(delay_of, cell->step *fabs(cell->impact[MOTE_IMPACT_COLUMN_to][frame] -
                                        cell->impact[MOTE_IMPACT_COLUMN_to_truth][frame]))
DEFINE_VALUE(iterations_of, cell->impact[MOTE_IMPACT_COLUMN_iterations][frame])
#undef DEFINE_VALUE

/* Gathers the values of a row's replicates over the frames first .. last (0, 0: all). */
static slice gather(const mote_summary_row *row, value_of value, uint32_t first, uint32_t last)
{
    slice made = {0};
    size_t most = 0;
    for (size_t r = 0; r < row->replicates; ++r)
        most += mote_stored_ran(&row->cells[r]) ? row->cells[r].frames : 0;
    made.all = mote_allocate(most, sizeof *made.all);
    made.replicas = mote_allocate(row->replicates, sizeof *made.replicas);
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        if (!mote_stored_ran(cell))
            continue;
        mote_replicate *replicate = &made.replicas[made.count++];
        replicate->values = made.all + made.total;
        for (size_t k = 0; k < cell->frames; ++k) {
            double here = value(cell, k);
            if (cell->frame[k] < first || cell->frame[k] > last || here != here)
                continue;
            made.all[made.total++] = here;
            ++replicate->count;
        }
    }
    return made;
}

static mote_time make_time(const mote_summary_row *row, value_of value, uint32_t first,
                           uint32_t last)
{
    mote_time time = {MOTE_NONE, MOTE_NONE, MOTE_NONE, MOTE_NONE,
                      MOTE_NONE, MOTE_NONE, MOTE_NONE};
    slice s = gather(row, value, first, last);
    if (s.total > 0) {
        /* A time that is always 0 (no refit) has no logarithm. */
        double least = s.all[0];
        for (size_t i = 0; i < s.total; ++i)
            least = s.all[i] < least ? s.all[i] : least;
        const mote_confidence interval =
            mote_statistics_median_interval(s.replicas, s.count, least > 0, BOOTSTRAP_SEED);
        time.mean = mote_statistics_mean(s.all, s.total);
        time.sum = time.mean * (double)s.total / (double)s.count;
        mote_statistics_sort(s.all, s.total);
        time.median = mote_statistics_quantile(s.all, s.total, 0.5);
        time.p95 = mote_statistics_quantile(s.all, s.total, 0.95);
        time.max = s.all[s.total - 1];
        time.low = interval.low;
        time.high = interval.high;
    }
    free_slice(&s);
    return time;
}

static void make_times(mote_summary_row *row)
{
    row->total = make_time(row, total_of, 0, UINT32_MAX);
    row->deform = make_time(row, deform_of, 0, UINT32_MAX);
    row->update = make_time(row, update_of, 0, UINT32_MAX);
    row->query = make_time(row, query_of, 0, UINT32_MAX);
    row->given_total = make_time(row, given_of, 0, UINT32_MAX);
    row->read_total = make_time(row, read_of, 0, UINT32_MAX);
    /* active_last is 0 without an active interval: then there is no value */
    row->active_total =
        make_time(row, total_of, row->first->active_first, row->first->active_last);
}

static value_of value_of_part(mote_part part)
{
    return part == MOTE_PART_TOTAL ? total_of : given_of;
}

double mote_summary_median_within(const mote_summary_row *row, uint32_t first, uint32_t last,
                                  mote_part part)
{
    slice s = gather(row, value_of_part(part), first, last);
    const double median = mote_statistics_median(s.all, s.total);
    free_slice(&s);
    return median;
}

static void count_exact(const mote_summary_row *row, mote_error_summary *error)
{
    double answers = 0, exact = 0, separated = 0, exact_separated = 0;
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        for (size_t k = 0; k < cell->frames; ++k) {
            if (cell->error[k] != cell->error[k])
                continue;
            bool is_exact = fabs(cell->error[k]) <= MOTE_EXACT_ERROR;
            answers += 1;
            exact += is_exact ? 1 : 0;
            separated += cell->truth[k] > 0 ? 1 : 0;
            exact_separated += cell->truth[k] > 0 && is_exact ? 1 : 0;
        }
    }
    error->exact_rate = answers > 0 ? exact / answers : MOTE_NONE;
    error->exact_rate_separated = separated > 0 ? exact_separated / separated : MOTE_NONE;
}

static void make_error(const mote_summary_row *row, mote_error_summary *error)
{
    mote_error_summary none = {MOTE_NONE, MOTE_NONE, MOTE_NONE, MOTE_NONE,
                               MOTE_NONE, MOTE_NONE, MOTE_NONE, MOTE_NONE};
    *error = none;
    slice s = gather(row, error_of, 0, UINT32_MAX);
    if (s.total > 0) {
        mote_statistics_sort(s.all, s.total);
        error->min_signed = s.all[0];
        error->max_signed = s.all[s.total - 1];
        for (size_t i = 0; i < s.total; ++i)
            s.all[i] = fabs(s.all[i]);
        mote_statistics_sort(s.all, s.total);
        error->median = mote_statistics_quantile(s.all, s.total, 0.5);
        error->p95 = mote_statistics_quantile(s.all, s.total, 0.95);
        error->p99 = mote_statistics_quantile(s.all, s.total, 0.99);
        error->max = s.all[s.total - 1];
    }
    free_slice(&s);
    count_exact(row, error);
}

/* A quantile of a value over all questions about impacts. */
static double impact_quantile(const mote_summary_row *row, value_of value, double part)
{
    slice s = gather(row, value, 0, UINT32_MAX);
    double found = MOTE_NONE;
    if (s.total > 0) {
        mote_statistics_sort(s.all, s.total);
        found = mote_statistics_quantile(s.all, s.total, part);
    }
    free_slice(&s);
    return found;
}

static void make_impact(mote_summary_row *row)
{
    row->impact = (mote_impact_summary){MOTE_NONE, MOTE_NONE, MOTE_NONE, MOTE_NONE, MOTE_NONE};
    if (row->step == 0 || row->finished == 0)
        return;
    double undecided = 0;
    for (size_t r = 0; r < row->replicates; ++r) {
        for (size_t k = 0; k < row->cells[r].frames; ++k)
            undecided += row->cells[r].contact[k] < 0 ? 1 : 0;
    }
    row->impact.undecided = undecided / (double)row->finished;
    row->impact.bracket = impact_quantile(row, bracket_of, 1);
    row->impact.delay = impact_quantile(row, delay_of, 1);
    row->impact.iterations_median = impact_quantile(row, iterations_of, 0.5);
    row->impact.iterations_p95 = impact_quantile(row, iterations_of, 0.95);
}

/* What the first impact of the truth may be off by, as a part of a question's time: it was
   bisected. */
#define IMPACT_ROUNDING 1e-9

/* Whether a method says that there is no impact before a time at which there is one. */
static bool is_too_late(const mote_stored_cell *cell, size_t frame)
{
    return cell->step > 0 &&
           cell->impact[MOTE_IMPACT_COLUMN_from][frame] >
               cell->impact[MOTE_IMPACT_COLUMN_to_truth][frame] + IMPACT_ROUNDING;
}

static void count_contacts(mote_summary_row *row)
{
    double answers = 0, contacts = 0, missed = 0, false_contacts = 0;
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        for (size_t k = 0; k < cell->frames; ++k) {
            contacts += cell->contact_truth[k] == 1 ? 1 : 0;
            if (cell->contact[k] < 0 || cell->contact_truth[k] < 0)
                continue;
            answers += 1;
            missed += cell->contact_truth[k] > cell->contact[k] || is_too_late(cell, k) ? 1 : 0;
            false_contacts += cell->contact_truth[k] < cell->contact[k] ? 1 : 0;
        }
    }
    double finished = (double)row->finished;
    row->contacts = row->finished ? contacts / finished : MOTE_NONE;
    row->missed = answers > 0 ? missed / finished : MOTE_NONE;
    row->false_contacts = answers > 0 ? false_contacts / finished : MOTE_NONE;
}

/* The largest over the replicates of one of their numbers. */
static double largest(const mote_summary_row *row, const char *key)
{
    double most = MOTE_NONE;
    for (size_t r = 0; r < row->replicates; ++r) {
        double value = mote_stored_number(&row->cells[r], key);
        most = value > most || most != most ? value : most;
    }
    return most;
}

/* The processes that succeeded, and the sums of their counts. */
static void make_processes(mote_summary_row *row)
{
    size_t most = 0;
    for (size_t r = 0; r < row->replicates; ++r)
        most = row->cells[r].frames > most ? row->cells[r].frames : most;
    double *work = mote_allocate(most, sizeof *work);
    row->processes = mote_allocate(row->finished, sizeof *row->processes);
    row->sums = mote_allocate(row->finished * row->count_count, sizeof *row->sums);
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        if (!mote_stored_ran(cell))
            continue;
        memcpy(work, cell->total_ns, cell->frames * sizeof *work);
        double *sums = row->sums + row->process_count * row->count_count;
        for (size_t k = 0; k < row->count_count; ++k)
            sums[k] = cell->counts[k].sum;
        row->processes[row->process_count++] =
            (mote_process){.replicate = cell->replicate,
                           .median = mote_statistics_median(work, cell->frames),
                           .ratio = MOTE_NONE,
                           .sums = sums};
    }
    free(work);
}

static void make_counts(mote_summary_row *row)
{
    row->count_count = row->finished > 0 ? MOTE_STORED_COUNTS : 0;
    row->counts = mote_allocate(row->count_count, sizeof *row->counts);
    for (size_t k = 0; k < row->count_count; ++k) {
        double sum = 0, max = 0, frames = 0;
        for (size_t r = 0; r < row->replicates; ++r) {
            const mote_stored_cell *cell = &row->cells[r];
            sum += cell->counts[k].sum;
            max = cell->counts[k].max > max ? cell->counts[k].max : max;
            frames += (double)cell->frames;
        }
        row->counts[k] = (mote_row_count){mote_stored_count_names[k], sum / frames, max};
    }
}

bool mote_summary_row_measured(const mote_summary_row *row)
{
    return row->status == MOTE_CELL_OK && row->times_comparable && row->total.median > 0;
}

bool mote_summary_contacts_right(const mote_summary_row *row)
{
    return row->missed == 0 && row->false_contacts == 0;
}

bool mote_summary_row_right(const mote_summary_row *row)
{
    return mote_summary_contacts_right(row) && !(row->error.max > MOTE_EXACT_ERROR);
}

bool mote_summary_is_fcl(const mote_summary_row *row)
{
    return strncmp(row->method, "fcl-", 4) == 0;
}

bool mote_summary_engine_name(const char *method)
{
    static const char *const single[] = {"ode", "bullet-gimpact", "embree-contact"};
    bool is = strncmp(method, "fcl-", 4) == 0 || strncmp(method, "coal-", 5) == 0;
    for (size_t i = 0; i < sizeof single / sizeof *single; ++i)
        is = is || strcmp(method, single[i]) == 0;
    return is;
}

bool mote_summary_is_engine(const mote_summary_row *row)
{
    return mote_summary_engine_name(row->method);
}

bool mote_summary_is_right_engine(const mote_summary_row *row)
{
    return mote_summary_is_engine(row) && mote_summary_row_right(row);
}

static int by_number(double a, double b)
{
    if (a < b || a > b)
        return a < b ? -1 : 1;
    return (a == a) - (b == b);
}

int mote_summary_by_interval(const mote_summary_row *a, const mote_summary_row *b)
{
    for (int k = 0; k < 2 && a->bodies == 0; ++k) {
        if (a->active[k] != b->active[k])
            return a->active[k] < b->active[k] ? -1 : 1;
    }
    return 0;
}

int mote_summary_by_scene(const mote_summary_row *a, const mote_summary_row *b)
{
    int order = strcmp(a->scenario, b->scenario);
    if (order == 0)
        order = strcmp(b->cache, a->cache); /* hot, then evict */
    if (order == 0)
        order = strcmp(a->machine, b->machine);
    if (order == 0)
        order = strcmp(a->fingerprint, b->fingerprint);
    if (order == 0)
        order = strcmp(a->faces, b->faces);
    if (order == 0)
        order = mote_summary_by_interval(a, b);
    if (order == 0)
        order = strcmp(a->ask, b->ask);
    if (order == 0)
        order = (a->step > b->step) - (a->step < b->step);
    return order ? order : by_number(a->tolerance, b->tolerance);
}

int mote_summary_by_asked_frames(const mote_summary_row *a, const mote_summary_row *b)
{
    const int order =
        (a->frame_range[0] > b->frame_range[0]) - (a->frame_range[0] < b->frame_range[0]);
    return order ? order
                 : (a->frame_range[1] < b->frame_range[1]) -
                       (a->frame_range[1] > b->frame_range[1]);
}

int mote_summary_by_frames(const mote_summary_row *a, const mote_summary_row *b)
{
    int order = mote_summary_by_asked_frames(a, b);
    if (order == 0 && a->bodies > 0 && b->bodies > 0)
        order = (a->frames < b->frames) - (a->frames > b->frames);
    return order;
}

bool mote_summary_same_block(const mote_summary_row *a, const mote_summary_row *b)
{
    return mote_summary_by_scene(a, b) == 0 && mote_summary_by_frames(a, b) == 0;
}

void mote_summary_row_free(mote_summary_row *row)
{
    if (row->cells) { /* otherwise the document owns them */
        free(row->label);
        free(row->scene);
    }
    free(row->counts);
    free(row->processes);
    free(row->sums);
}

static const mote_ratio no_ratio = {NULL, MOTE_NONE, MOTE_NONE, MOTE_NONE};

/* How bad a status is; 0: ok. */
static int badness(mote_cell_status status)
{
    return status == MOTE_CELL_OK ? 0 : MOTE_CELL_STATUSES - (int)status;
}

/* Whether the method was given the positions of all vertices without being charged. */
static bool is_given(const mote_stored_cell *cell)
{
    return strcmp(mote_text_at(cell->parameters, "positions"), "given") == 0;
}

static void read_two(const json_t *json, const char *key, uint32_t numbers[2])
{
    const json_t *list = json_object_get(json, key);
    for (size_t k = 0; k < 2; ++k) {
        const json_int_t number = json_integer_value(json_array_get(list, k));
        numbers[k] = number >= 0 && number <= UINT32_MAX ? (uint32_t)number : 0;
    }
}

/* Vertices of all bodies; 0: unknown. */
static double all_vertices(const mote_summary_row *row)
{
    const double total = mote_stored_number(row->first, "vertices_total"); /* for more than two
                                                                              bodies */
    return total > 0 ? total : (double)row->vertices[0] + (double)row->vertices[1];
}

static const char *seeds_of(const mote_stored_cell *cell)
{
    const json_t *fixed = json_object_get(cell->json, "fixed_seed");
    return !fixed ? "" : json_is_true(fixed) ? "fixed" : "own";
}

/* Fills in what was measured, from the row's first cell. */
static void describe(mote_summary_row *row)
{
    const mote_stored_cell *cell = row->first;
    row->scenario = cell->scenario;
    row->fingerprint = cell->fingerprint;
    row->faces = cell->faces;
    row->cache = cell->cache;
    row->machine = cell->machine;
    row->ask = cell->ask;
    row->method = cell->method;
    row->label = mote_row_label(cell);
    row->status = cell->status;
    row->ending = mote_cell_status_names[cell->status];
    row->reason = mote_text_at(cell->json, "reason");
    row->given = is_given(cell);
    row->accounting = row->given ? "given" : "charged";
    row->told = mote_text_at(cell->json, "told");
    row->seeds = seeds_of(cell);
    row->parameters = cell->parameters;
    row->n = mote_number_at(cell->parameters, "n");
    row->tolerance = mote_stored_number(cell, "tolerance");
    row->seed = cell->seed;
    row->frame_range[0] = cell->first;
    row->frame_range[1] = cell->last;
    row->active[0] = cell->active_first;
    row->active[1] = cell->active_last;
    row->stride = cell->stride;
    row->step = cell->step;
    row->jobs = cell->jobs;
    row->times_comparable = cell->jobs == 1;
    read_two(cell->json, "triangles", row->triangles);
    read_two(cell->json, "vertices", row->vertices);
    row->bodies = cell->bodies;
    const double shapes = mote_stored_number(cell, "shapes");
    row->shapes = shapes >= 1 && shapes <= MOTE_BODIES_MAX ? (uint32_t)shapes : 0;
    row->near_pairs_wanted = mote_stored_number(cell, "near_pairs_wanted");
    row->frames = cell->frames;
}

void mote_summary_row_answers(mote_summary_row *row)
{
    count_contacts(row);
    make_error(row, &row->error);
}

mote_summary_row mote_summary_row_make(const mote_stored_cell *cells, size_t replicates)
{
    mote_summary_row made = {.cells = cells, .replicates = replicates, .first = &cells[0]};
    for (size_t r = 0; r < replicates; ++r) {
        const bool worse = badness(cells[r].status) > badness(made.first->status);
        if (mote_stored_ran(&cells[r]))
            made.first = made.finished++ > 0 ? made.first : &cells[r];
        else if (made.finished == 0 && worse)
            made.first = &cells[r];
    }
    made.failed = replicates - made.finished;
    describe(&made);
    made.smallest_change = made.near_pairs = MOTE_NONE;
    made.ratio = made.ratio_given = made.ratio_best = made.ratio_engine = no_ratio;
    made.heap_live_bytes = largest(&made, "heap_live_bytes");
    made.heap_peak_bytes = largest(&made, "heap_peak_bytes");
    made.rss_peak_bytes = largest(&made, "rss_peak_bytes");
    const double vertices = all_vertices(&made);
    made.heap_bytes_per_vertex = vertices > 0 ? made.heap_live_bytes / vertices : MOTE_NONE;
    mote_summary_row_answers(&made);
    make_counts(&made);
    make_processes(&made);
    make_times(&made);
    make_impact(&made);
    return made;
}

/* The ratios other / row of the frames that two cells share; returns their number. */
static size_t pair_frames(const mote_stored_cell *row, const mote_stored_cell *other,
                          value_of value, double *ratios)
{
    size_t count = 0;
    for (size_t i = 0, k = 0; mote_stored_common(row, &i, other, &k); ++i, ++k) {
        const double mine = value(row, i), theirs = value(other, k);
        if (mine > 0 && theirs > 0)
            ratios[count++] = theirs / mine;
    }
    return count;
}

const mote_stored_cell *mote_summary_replicate(const mote_summary_row *row, uint32_t number)
{
    for (size_t r = 0; r < row->replicates; ++r) {
        if (row->cells[r].replicate == number && mote_stored_ran(&row->cells[r]))
            return &row->cells[r];
    }
    return NULL;
}

void mote_summary_ratio(const mote_summary_row *row, const mote_summary_row *other,
                        mote_part part, mote_ratio *ratio)
{
    slice s = {0};
    size_t most = 0;
    for (size_t r = 0; r < row->replicates; ++r)
        most += row->cells[r].frames;
    s.all = mote_allocate(most, sizeof *s.all);
    s.replicas = mote_allocate(row->replicates, sizeof *s.replicas);
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *mine = &row->cells[r];
        const mote_stored_cell *theirs = mote_summary_replicate(other, mine->replicate);
        if (!mote_stored_ran(mine) || !theirs)
            continue;
        mote_replicate *replicate = &s.replicas[s.count];
        replicate->values = s.all + s.total;
        replicate->count = pair_frames(mine, theirs, value_of_part(part), s.all + s.total);
        s.total += replicate->count;
        s.count += replicate->count ? 1 : 0;
    }
    const mote_confidence interval =
        mote_statistics_median_interval(s.replicas, s.count, true, BOOTSTRAP_SEED);
    ratio->value = mote_statistics_median(s.all, s.total);
    ratio->low = interval.low;
    ratio->high = interval.high;
    free_slice(&s);
}

void mote_summary_process_ratios(mote_summary_row *row, const mote_summary_row *other,
                                 mote_part part)
{
    mote_process *process = row->processes;
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *mine = &row->cells[r];
        const mote_stored_cell *theirs = mote_summary_replicate(other, mine->replicate);
        if (!mote_stored_ran(mine))
            continue;
        double *ratios = mote_allocate(mine->frames, sizeof *ratios);
        if (theirs)
            process->ratio = mote_statistics_median(
                ratios, pair_frames(mine, theirs, value_of_part(part), ratios));
        ++process;
        free(ratios);
    }
}
