#include "harness/summary/dominance.h"

#include <string.h>

/* Whether a figure of which less is better is no worse; not known on both sides is equal. */
static bool no_worse(double a, double b)
{
    return a <= b || (a != a && b != b);
}

static bool error_no_worse(double a, double b)
{
    return no_worse(a <= MOTE_EXACT_ERROR ? 0 : a, b <= MOTE_EXACT_ERROR ? 0 : b);
}

/* A scene that asks for contacts only gives distances to some methods and to others not: they
   do not count there. */
static bool distances_no_worse(const mote_summary_row *a, const mote_summary_row *b)
{
    return strcmp(a->first->ask, "contact") == 0 ||
           (error_no_worse(a->error.p99, b->error.p99) &&
            error_no_worse(a->error.max, b->error.max) &&
            no_worse(-a->error.exact_rate, -b->error.exact_rate));
}

bool mote_dominates(const mote_summary_row *a, const mote_summary_row *b)
{
    return mote_summary_row_measured(a) && mote_summary_row_measured(b) &&
           mote_summary_same_block(a, b) && a->given == b->given &&
           a->total.high < b->total.low && distances_no_worse(a, b) &&
           no_worse(a->missed, b->missed) && no_worse(a->false_contacts, b->false_contacts);
}

void mote_find_dominated(mote_summary_row *rows, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        size_t *by = &rows[i].dominated_by;
        *by = SIZE_MAX;
        for (size_t k = 0; k < count; ++k) {
            if (mote_dominates(&rows[k], &rows[i]) &&
                (*by == SIZE_MAX || rows[k].total.median < rows[*by].total.median))
                *by = k;
        }
    }
}

bool mote_on_front(const mote_summary_row *row)
{
    return mote_summary_row_measured(row) && row->dominated_by == SIZE_MAX;
}
