#include "harness/summary/summary.h"

#include "harness/base/memory.h"
#include "harness/summary/dominance.h"
#include "harness/summary/scene_contacts.h"
#include "harness/summary/summary_quiet.h"

#include <stdlib.h>
#include <string.h>

void mote_summary_free(mote_summary *summary)
{
    for (size_t i = 0; i < summary->count; ++i)
        mote_summary_row_free(&summary->rows[i]);
    free(summary->rows);
    mote_stored_free(&summary->stored);
    json_decref(summary->document);
    mote_summary none = {0};
    *summary = none;
}

static int by_place(const void *a, const void *b)
{
    const mote_summary_row *first = a, *second = b;
    int order = mote_summary_by_scene(first, second);
    if (order == 0)
        order = mote_summary_by_frames(first, second);
    if (order == 0)
        order = strcmp(first->method, second->method);
    if (order == 0)
        order = (int)first->given - (int)second->given;
    if (order == 0 && (first->n < second->n || first->n > second->n))
        order = first->n < second->n ? -1 : 1;
    return order ? order : strcmp(first->first->group, second->first->group);
}

/* Whether two rows' times may be compared. A row charged for deformation is compared with
   others that are; a row with positions given is compared with the time that others need
   without deformation. */
static bool comparable(const mote_summary_row *row, const mote_summary_row *other)
{
    return row->status == MOTE_CELL_OK && other->status == MOTE_CELL_OK &&
           row->times_comparable && other->times_comparable &&
           mote_summary_by_scene(row, other) == 0 && (row->given || !other->given);
}

/* The part of a frame's time that is compared with other rows. */
static mote_part compared_part(const mote_summary_row *row)
{
    return row->given ? MOTE_PART_GIVEN : MOTE_PART_TOTAL;
}

bool mote_summary_machines_differ(const mote_summary *summary)
{
    for (size_t i = 1; i < summary->count; ++i) {
        if (strcmp(summary->rows[i].machine, summary->rows[0].machine) != 0)
            return true;
    }
    return false;
}

/* Whether another row was asked for all frames of this one and, of many bodies, has them. */
static bool covers(const mote_summary_row *other, const mote_summary_row *row)
{
    return other->frame_range[0] <= row->frame_range[0] &&
           other->frame_range[1] >= row->frame_range[1] &&
           (row->bodies == 0 || other->frames >= row->frames);
}

/* FCL's AABB tree as its users call it: with the default of each parameter, wherever the
   positions come from. */
static bool is_plain_fcl(const mote_summary_row *row)
{
    return strcmp(row->label, row->given ? "fcl-aabb:positions=given" : "fcl-aabb") == 0;
}

/* The row that this one's ratio is relative to: fcl-aabb with its defaults (seed=none,
   queue=2), or any fcl-aabb, on all of this row's frames; preferably with positions from the
   same source and on exactly these frames, measured in turn with it. */
static const mote_summary_row *find_reference(const mote_summary *summary,
                                              const mote_summary_row *row)
{
    const mote_summary_row *reference = NULL;
    int highest = -1;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        if (!comparable(row, other) || strcmp(other->method, "fcl-aabb") != 0)
            continue;
        const int rank = (covers(other, row) ? 8 : 0) + (is_plain_fcl(other) ? 4 : 0) +
                         (other->given == row->given ? 2 : 0) +
                         (mote_summary_by_frames(other, row) == 0 ? 1 : 0);
        reference = rank > highest ? other : reference;
        highest = rank > highest ? rank : highest;
    }
    return reference;
}

/* The fastest row over these frames, among rows on all of this row's frames, otherwise among
   all rows. */
static const mote_summary_row *find_best(const mote_summary *summary,
                                         const mote_summary_row *row,
                                         bool (*competes)(const mote_summary_row *))
{
    double least = MOTE_NONE;
    bool covered = false;
    const mote_summary_row *best = NULL;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        if (!comparable(row, other) || !competes(other))
            continue;
        const double median = mote_summary_median_within(
            other, row->frame_range[0], row->frame_range[1], compared_part(row));
        const bool all = covers(other, row);
        if (median != median || (covered && !all))
            continue;
        if (all != covered || !(median >= least)) {
            least = median;
            best = other;
        }
        covered = all;
    }
    return best;
}

static void make_ratio(const mote_summary_row *row, const mote_summary_row *to, mote_part part,
                       mote_ratio *ratio)
{
    ratio->to = to;
    if (to)
        mote_summary_ratio(row, to, part, ratio);
    if (to == row)
        ratio->low = ratio->high = MOTE_NONE; /* always 1 */
}

static void make_row_ratios(const mote_summary *summary, mote_summary_row *row)
{
    const mote_summary_row *reference = find_reference(summary, row);
    const mote_part part = compared_part(row);
    make_ratio(row, reference, part, &row->ratio);
    make_ratio(row, reference, MOTE_PART_GIVEN, &row->ratio_given);
    if (reference)
        mote_summary_process_ratios(row, reference, part);
    mote_summary_quiet(row, reference);
    make_ratio(row, find_best(summary, row, mote_summary_is_fcl), part, &row->ratio_best);
    make_ratio(row, find_best(summary, row, mote_summary_is_right_engine), part,
               &row->ratio_engine);
}

static void make_rows(mote_summary *summary)
{
    const mote_stored *stored = &summary->stored;
    for (size_t i = 0; i < stored->count;) {
        size_t end = i + 1;
        while (end < stored->count &&
               strcmp(stored->cells[end].group, stored->cells[i].group) == 0)
            ++end;
        summary->rows[summary->count++] = mote_summary_row_make(&stored->cells[i], end - i);
        i = end;
    }
}

/* Displayed digits of a hash. */
#define SHOWN_DIGITS 8

/* Names the scene of a row by its scenario and, if several scenes have that name, by its
   hashes: a file may have changed between two runs, or different folders may have files of
   one name. */
static char *name_scene(const mote_summary *summary, const mote_summary_row *row)
{
    bool scenes = false, faces = false, intervals = false, questions = false, steps = false,
         tolerances = false;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        if (strcmp(other->scenario, row->scenario) != 0)
            continue;
        const double a = row->tolerance, b = other->tolerance;
        scenes = scenes || strcmp(other->fingerprint, row->fingerprint) != 0;
        faces = faces || strcmp(other->faces, row->faces) != 0;
        intervals = intervals || mote_summary_by_interval(row, other) != 0;
        steps = steps || (row->step > 0 && row->step != other->step);
        questions = questions || strcmp(other->ask, row->ask) != 0;
        tolerances = tolerances || a < b || a > b || (a == a) != (b == b);
    }
    mote_text text = {0};
    mote_text_add(&text, "%s", row->scenario);
    if (scenes)
        mote_text_add(&text, " (scene %.*s)", SHOWN_DIGITS, row->fingerprint);
    else if (faces)
        mote_text_add(&text, " (faces %.*s)", SHOWN_DIGITS,
                      row->faces[0] ? row->faces : "unknown");
    if (intervals)
        mote_text_add(&text, " (active %u-%u)", row->active[0], row->active[1]);
    if (questions)
        mote_text_add(&text, " (asks for %s)", row->ask[0] ? row->ask : "anything");
    if (steps)
        mote_text_add(&text, " (step %u)", row->step);
    if (tolerances)
        mote_text_add(&text, " (tolerance %g)", row->tolerance);
    return text.data;
}

/* The median over the cells of one of their numbers. */
static double cells_median(const mote_summary *summary, const char *key, double *work)
{
    size_t known = 0;
    for (size_t i = 0; i < summary->stored.count; ++i) {
        double value = mote_stored_number(&summary->stored.cells[i], key);
        if (value == value)
            work[known++] = value;
    }
    return mote_statistics_median(work, known);
}

static void find_overhead(mote_summary *summary)
{
    double fastest = MOTE_NONE;
    double *work = mote_allocate(summary->stored.count, sizeof *work);
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        double calls = 1 + (row->update.median > 0 ? 1 : 0) + (row->deform.median > 0 ? 1 : 0);
        double share = calls / row->total.median;
        if (row->total.median > 0 && !(share <= fastest))
            fastest = share;
    }
    summary->overhead.clock_ns = cells_median(summary, "clock_ns", work);
    summary->overhead.left_ns = cells_median(summary, "overhead_ns", work);
    summary->overhead.share = fabs(summary->overhead.left_ns) * fastest;
    free(work);
}

mote_status mote_summary_make(const char *directory, mote_summary *summary)
{
    return mote_summary_make_whole(directory, NULL, summary);
}

mote_status mote_summary_make_whole(const char *directory, mote_text *damaged,
                                    mote_summary *summary)
{
    mote_summary made = {0};
    mote_status status = mote_stored_read(directory, damaged, &made.stored);
    if (status != MOTE_OK)
        return status;
    made.rows = mote_allocate(made.stored.count, sizeof *made.rows);
    make_rows(&made);
    qsort(made.rows, made.count, sizeof *made.rows, by_place);
    for (size_t i = 0; i < made.count; ++i)
        made.rows[i].scene = name_scene(&made, &made.rows[i]);
    for (size_t i = 0; i < made.count; ++i)
        make_row_ratios(&made, &made.rows[i]);
    status = mote_scene_contacts_count(directory, made.rows, made.count);
    mote_find_dominated(made.rows, made.count);
    mote_find_method_rows(made.rows, made.count);
    made.noise_floor = mote_summary_noise_floor(made.rows, made.count);
    find_overhead(&made);
    made.smallest_change = mote_summary_smallest_change(made.rows, made.count);
    if (status == MOTE_OK)
        *summary = made;
    else
        mote_summary_free(&made);
    return status;
}
