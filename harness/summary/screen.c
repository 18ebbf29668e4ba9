#include "harness/summary/screen.h"

#include "harness/base/memory.h"
#include "harness/base/wrap.h"
#include "harness/summary/dominance.h"
#include "harness/summary/table.h"

#include <stdlib.h>
#include <string.h>

/* Columns for the method; the first two hold the front mark. */
#define LABEL_WIDTH 39
#define INDENT 2

/* Whether a row is marked: it is on the front. If times have no interval (one replicate), none
   is certainly faster than another, and a mark would mean nothing. */
static bool is_marked(const mote_summary_row *row)
{
    return row->on_front && row->total.low == row->total.low;
}

/* The rows of one block and one accounting. */
typedef struct choice {
    const mote_summary_row **rows; /* the best, at most MOTE_SCREEN_ROWS */
    size_t count;
    size_t others; /* omitted rows */
    bool any_marked;
} choice;

/* Prints words, indented by two spaces from the second line on. */
static void print_words(const mote_text *words, FILE *out)
{
    mote_print_wrapped(words->data, 0, INDENT, MOTE_SCREEN_WIDTH, out);
}

static bool is_best(const mote_summary_row *row)
{
    return row->status == MOTE_CELL_OK && (row->stands_for_method || row->on_front);
}

/* Rows whose times cannot be compared come last. */
static int by_time(const void *a, const void *b)
{
    const mote_summary_row *first = *(const mote_summary_row *const *)a;
    const mote_summary_row *second = *(const mote_summary_row *const *)b;
    const bool one = mote_summary_row_measured(first),
               other = mote_summary_row_measured(second);
    if (one != other)
        return one ? -1 : 1;
    const double x = first->total.median, y = second->total.median;
    return (x > y) - (x < y);
}

/* Removes the least accurate row that does not stand for its method; false if there is none. */
static bool drop_worst(choice *c)
{
    size_t worst = SIZE_MAX;
    for (size_t i = 0; i < c->count; ++i) {
        const mote_summary_row *row = c->rows[i];
        if (!row->stands_for_method &&
            (worst == SIZE_MAX || row->error.p99 > c->rows[worst]->error.p99))
            worst = i;
    }
    if (worst == SIZE_MAX)
        return false;
    c->rows[worst] = c->rows[--c->count];
    ++c->others;
    return true;
}

static choice choose(const mote_summary *summary, size_t start, size_t end, bool given)
{
    choice c = {.rows = mote_allocate(end - start, sizeof(const mote_summary_row *))};
    for (size_t i = start; i < end; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (row->given != given || row->status != MOTE_CELL_OK)
            continue;
        if (is_best(row))
            c.rows[c.count++] = row;
        else
            ++c.others;
    }
    while (c.count > MOTE_SCREEN_ROWS && drop_worst(&c))
        continue;
    for (size_t i = 0; i < c.count; ++i)
        c.any_marked = c.any_marked || is_marked(c.rows[i]);
    qsort(c.rows, c.count, sizeof(const mote_summary_row *), by_time);
    return c;
}

/* Prints a row on one line, or on two if its label is too long; its notes on a separate
   line. */
static void print_row(const mote_summary_row *row, FILE *out)
{
    (void)fprintf(out, "%-*s%-*s", INDENT, is_marked(row) ? "*" : "", LABEL_WIDTH - INDENT,
                  row->label);
    if (strlen(row->label) > LABEL_WIDTH - INDENT)
        (void)fprintf(out, "\n%*s", LABEL_WIDTH, "");
    mote_table_values(MOTE_VIEW_SCREEN, row, out);
    (void)fprintf(out, "\n");
    for (int i = 0; i < MOTE_ROW_NOTES; ++i) {
        char note[MOTE_ROW_NOTE];
        if (mote_table_note(row, i, note))
            (void)fprintf(out, "    %s\n", note);
    }
}

/* The FCL row that ratios are relative to, from the first row that has any. */
static const char *best_fcl(const choice *c)
{
    for (size_t i = 0; i < c->count; ++i) {
        if (c->rows[i]->ratio_best.to)
            return c->rows[i]->ratio_best.to->label;
    }
    return NULL;
}

/* The row of the best engine, likewise, where that is not the best FCL. */
static const mote_summary_row *best_engine(const choice *c)
{
    for (size_t i = 0; i < c->count; ++i) {
        const mote_summary_row *engine = c->rows[i]->ratio_engine.to;
        if (engine && engine != c->rows[i]->ratio_best.to)
            return engine;
    }
    return NULL;
}

static void print_foot(const choice *c, FILE *out)
{
    mote_text words = {0};
    const char *fcl = best_fcl(c), *separator = "";
    if (c->any_marked) {
        mote_text_add(&words, "* on the front: no row is surely faster and as accurate");
        separator = "; ";
    }
    if (fcl) {
        mote_text_add(&words, "%sbest FCL: %s", separator, fcl);
        separator = "; ";
    }
    const mote_summary_row *engine = best_engine(c);
    if (engine) {
        mote_text_add(&words, "%sbest engine: %s", separator, engine->label);
        separator = "; ";
    }
    if (c->others > 0)
        mote_text_add(&words, "%s%zu more in the report", separator, c->others);
    if (words.size > 0)
        print_words(&words, out);
    free(words.data);
}

static void print_choice(const choice *c, bool given, FILE *out)
{
    if (c->count == 0)
        return;
    if (given)
        (void)fprintf(out,
                      "\npositions=given: nobody is charged for deformation, FCL neither\n");
    mote_table_heads(MOTE_VIEW_SCREEN, LABEL_WIDTH, out);
    for (size_t i = 0; i < c->count; ++i)
        print_row(c->rows[i], out);
    print_foot(c, out);
}

/* Prints the rows without values, and why. */
static void print_failures(const mote_summary *summary, size_t start, size_t end, FILE *out)
{
    for (size_t i = start; i < end; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (row->status == MOTE_CELL_OK)
            continue;
        mote_text words = {0};
        mote_text_add(&words, "%s %s: %s", row->label, row->ending, row->reason);
        print_words(&words, out);
        free(words.data);
    }
}

void mote_screen_print(const mote_summary *summary, FILE *out)
{
    for (size_t start = 0; start < summary->count;) {
        const size_t end = mote_table_block_end(summary, start);
        char *what = mote_table_heading(summary, start);
        char *heading = mote_format("%s: %s", summary->rows[start].scene, what);
        (void)fprintf(out, "%s", start ? "\n" : "");
        mote_print_wrapped(heading, 0, INDENT, MOTE_SCREEN_WIDTH, out);
        free(heading);
        free(what);
        for (int given = 0; given < 2; ++given) {
            const choice c = choose(summary, start, end, given != 0);
            print_choice(&c, given != 0, out);
            free(c.rows);
        }
        print_failures(summary, start, end, out);
        start = end;
    }
}
