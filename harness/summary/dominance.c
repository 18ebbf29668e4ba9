#include "harness/summary/dominance.h"

#include <math.h>
#include <string.h>

/* Whether a is no worse than b, for values of which less is better; two unknown values are
   equal. */
static bool no_worse(double a, double b)
{
    return a <= b || (a != a && b != b);
}

static bool error_no_worse(double a, double b)
{
    return no_worse(a <= MOTE_EXACT_ERROR ? 0 : a, b <= MOTE_EXACT_ERROR ? 0 : b);
}

/* What part of a row's frames a count is: of the rows of one block some have every frame and
   others every K-th, so their counts say nothing beside each other. */
static double share_of_frames(const mote_summary_row *row, double count)
{
    return count / fmax(1, (double)row->frames);
}

static bool contacts_no_worse(const mote_summary_row *a, const mote_summary_row *b)
{
    return no_worse(share_of_frames(a, a->missed), share_of_frames(b, b->missed)) &&
           no_worse(share_of_frames(a, a->false_contacts),
                    share_of_frames(b, b->false_contacts));
}

/* In a scene that asks only for contacts, some methods give distances and others do not, so
   errors do not count. */
static bool distances_no_worse(const mote_summary_row *a, const mote_summary_row *b)
{
    return strcmp(a->ask, "contact") == 0 ||
           (error_no_worse(a->error.p99, b->error.p99) &&
            error_no_worse(a->error.max, b->error.max) &&
            no_worse(-a->error.exact_rate, -b->error.exact_rate));
}

bool mote_dominates(const mote_summary_row *a, const mote_summary_row *b)
{
    return mote_summary_row_measured(a) && mote_summary_row_measured(b) &&
           mote_summary_same_block(a, b) && a->given == b->given &&
           a->total.high < b->total.low && distances_no_worse(a, b) && contacts_no_worse(a, b);
}

void mote_find_dominated(mote_summary_row *rows, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        mote_summary_row *row = &rows[i];
        row->dominated_by = NULL;
        for (size_t k = 0; k < count; ++k) {
            if (mote_dominates(&rows[k], row) &&
                (!row->dominated_by || rows[k].total.median < row->dominated_by->total.median))
                row->dominated_by = &rows[k];
        }
        row->on_front = mote_summary_row_measured(row) && !row->dominated_by;
    }
}

/* Share of wrong contacts, error and time of a row; among rows that are good enough, the time
   decides. */
typedef struct standing {
    double wrong, error, time;
} standing;

static standing standing_of(const mote_summary_row *row)
{
    const double wrong = share_of_frames(row, row->missed + row->false_contacts);
    const double time = row->total.median;
    const bool asked = strcmp(row->ask, "contact") != 0;
    const bool timed = row->status == MOTE_CELL_OK && row->times_comparable && time == time;
    return (standing){wrong == wrong ? wrong : HUGE_VAL,
                      asked && row->error.p99 > MOTE_CLOSE_ERROR ? row->error.p99 : 0,
                      timed ? time : HUGE_VAL};
}

static bool is_better(const standing *a, const standing *b)
{
    if (a->wrong < b->wrong || a->wrong > b->wrong)
        return a->wrong < b->wrong;
    if (a->error < b->error || a->error > b->error)
        return a->error < b->error;
    return a->time < b->time;
}

static bool stands_for_method(const mote_summary_row *rows, size_t count, size_t index)
{
    const mote_summary_row *row = &rows[index];
    const standing own = standing_of(row);
    for (size_t k = 0; k < count; ++k) {
        const mote_summary_row *other = &rows[k];
        if (k == index || other->given != row->given ||
            strcmp(other->method, row->method) != 0 || !mote_summary_same_block(other, row))
            continue;
        const standing theirs = standing_of(other);
        if (is_better(&theirs, &own) || (k < index && !is_better(&own, &theirs)))
            return false;
    }
    return true;
}

void mote_find_method_rows(mote_summary_row *rows, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        rows[i].stands_for_method = stands_for_method(rows, count, i);
}
