#include "harness/summary/screen.h"

#include "harness/base/memory.h"
#include "harness/base/wrap.h"
#include "harness/summary/dominance.h"
#include "harness/summary/table.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* Columns for the method, by the view; the first two hold the mark. */
static const int label_width[MOTE_VIEWS] = {[MOTE_VIEW_SCREEN] = 30, [MOTE_VIEW_ENGINES] = 28};
#define INDENT 2

/* The rows of one block and one accounting. */
typedef struct choice {
    mote_view view;
    const mote_summary_row **rows; /* the best, at most MOTE_SCREEN_ROWS; of engines, all */
    size_t count;
    size_t others; /* omitted rows */
    bool any_marked;
} choice;

/* Whether a row is marked: it is on the front, or the best engine. If times have no interval
   (one replicate), none is certainly faster than another, and a mark of the front would mean
   nothing. */
static bool is_marked(const choice *c, const mote_summary_row *row)
{
    if (c->view == MOTE_VIEW_ENGINES)
        return row->ratio_engine.to == row;
    return row->on_front && row->total.low == row->total.low;
}

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

static choice choose(const mote_summary *summary, size_t start, size_t end, mote_view view,
                     bool given)
{
    choice c = {.view = view,
                .rows = mote_allocate(end - start, sizeof(const mote_summary_row *))};
    for (size_t i = start; i < end; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (row->given != given || row->status != MOTE_CELL_OK)
            continue;
        if (view == MOTE_VIEW_ENGINES || is_best(row))
            c.rows[c.count++] = row;
        else
            ++c.others;
    }
    while (view == MOTE_VIEW_SCREEN && c.count > MOTE_SCREEN_ROWS && drop_worst(&c))
        continue;
    for (size_t i = 0; i < c.count; ++i)
        c.any_marked = c.any_marked || is_marked(&c, c.rows[i]);
    qsort(c.rows, c.count, sizeof(const mote_summary_row *), by_time);
    return c;
}

/* Prints a row on one line, or on two if its label is too long; its notes on separate lines.
   All engines of others are told the positions. */
static void print_row(const choice *c, const mote_summary_row *row, FILE *out)
{
    const int width = label_width[c->view];
    (void)fprintf(out, "%-*s%-*s", INDENT, is_marked(c, row) ? "*" : "", width - INDENT,
                  row->label);
    if (strlen(row->label) > (size_t)(width - INDENT))
        (void)fprintf(out, "\n%*s", width, "");
    mote_table_values(c->view, row, out);
    (void)fprintf(out, "\n");
    for (int i = 0; i < MOTE_ROW_NOTES; ++i) {
        char note[MOTE_ROW_NOTE];
        if (mote_table_note(row, i, note) &&
            !(c->view == MOTE_VIEW_ENGINES && strcmp(note, "told the positions") == 0))
            (void)fprintf(out, "    %s\n", note);
    }
}

/* Adds the rows that ratios are relative to, from the first row that has any. */
static void add_rivals(const choice *c, const char *separator, mote_text *words)
{
    const mote_summary_row *fcl = NULL, *engine = NULL;
    for (size_t i = 0; i < c->count; ++i) {
        fcl = fcl ? fcl : c->rows[i]->ratio_best.to;
        engine = engine ? engine : c->rows[i]->ratio_engine.to;
    }
    if (fcl && fcl == engine)
        mote_text_add(words, "%sbest engine and best FCL: %s", separator, fcl->label);
    else if (engine)
        mote_text_add(words, "%sbest engine: %s", separator, engine->label);
    if (fcl && fcl != engine)
        mote_text_add(words, "%sbest FCL: %s", words->size > 0 ? "; " : "", fcl->label);
}

static void print_foot(const choice *c, FILE *out)
{
    mote_text words = {0};
    if (c->any_marked)
        mote_text_add(&words, "* on the front: no row is surely faster and as accurate");
    add_rivals(c, words.size > 0 ? "; " : "", &words);
    if (c->others > 0)
        mote_text_add(&words, "%s%zu more in the report", words.size > 0 ? "; " : "",
                      c->others);
    if (words.size > 0)
        print_words(&words, out);
    free(words.data);
}

/* The four statistics of engines. */
static const struct statistic {
    const char *name;
    size_t offset; /* in mote_summary_row */
} statistics[] = {{"median", offsetof(mote_summary_row, total.median)},
                  {"mean", offsetof(mote_summary_row, total.mean)},
                  {"p95", offsetof(mote_summary_row, total.p95)},
                  {"worst", offsetof(mote_summary_row, total.max)}};

static double statistic_of(const mote_summary_row *row, const struct statistic *s)
{
    double value;
    memcpy(&value, (const char *)row + s->offset, sizeof value);
    return mote_summary_row_measured(row) ? value : MOTE_NONE;
}

static bool is_right_fcl(const mote_summary_row *row)
{
    return mote_summary_is_fcl(row) && mote_summary_row_right(row);
}

/* The row that competes with the least of a statistic; NULL without any. */
static const mote_summary_row *least_row(const choice *c,
                                         bool (*competes)(const mote_summary_row *),
                                         const struct statistic *s)
{
    const mote_summary_row *least = NULL;
    for (size_t i = 0; i < c->count; ++i) {
        const double value = statistic_of(c->rows[i], s);
        if (competes(c->rows[i]) && value == value &&
            (!least || value < statistic_of(least, s)))
            least = c->rows[i];
    }
    return least;
}

/* Prints which row that competes has the least of each statistic, a row that has several in
   turn once; nothing without any. */
static void print_least(const choice *c, bool (*competes)(const mote_summary_row *),
                        const char *what, FILE *out)
{
    mote_text words = {0};
    const mote_summary_row *last = NULL;
    for (size_t k = 0; k < sizeof statistics / sizeof *statistics; ++k) {
        const mote_summary_row *least = least_row(c, competes, &statistics[k]);
        if (!least)
            continue;
        if (last && least != last)
            mote_text_add(&words, ": %s; ", last->label);
        char shown[MOTE_NUMBER_TEXT];
        mote_text_add(&words, "%s%s %s",
                      !last           ? what
                      : least == last ? ", "
                                      : "",
                      statistics[k].name,
                      mote_show_time(statistic_of(least, &statistics[k]), shown));
        last = least;
    }
    if (last) {
        mote_text_add(&words, ": %s", last->label);
        print_words(&words, out);
    }
    free(words.data);
}

static void print_engines_foot(const choice *c, FILE *out)
{
    print_least(c, mote_summary_is_right_engine, "best engine of others (*): ", out);
    print_least(c, is_right_fcl, "best FCL: ", out);
}

static void print_choice(const choice *c, bool given, FILE *out)
{
    if (c->count == 0)
        return;
    if (given)
        (void)fprintf(out,
                      "\npositions=given: nobody is charged for deformation, FCL neither\n");
    mote_table_heads(c->view, label_width[c->view], out);
    for (size_t i = 0; i < c->count; ++i)
        print_row(c, c->rows[i], out);
    if (c->view == MOTE_VIEW_ENGINES)
        print_engines_foot(c, out);
    else
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

static void print_screen(const mote_summary *summary, mote_view view, FILE *out)
{
    for (size_t start = 0; start < summary->count;) {
        const size_t end = mote_table_block_end(summary, start);
        char *what = mote_table_heading(summary, start);
        const mote_summary_row *row = &summary->rows[start];
        const bool asks = view == MOTE_VIEW_ENGINES && row->ask[0];
        char *heading = mote_format("%s%s%s: %s", row->scene, asks ? ", asked for " : "",
                                    asks ? row->ask : "", what);
        (void)fprintf(out, "%s", start ? "\n" : "");
        mote_print_wrapped(heading, 0, INDENT, MOTE_SCREEN_WIDTH, out);
        free(heading);
        free(what);
        for (int given = 0; given < 2; ++given) {
            const choice c = choose(summary, start, end, view, given != 0);
            print_choice(&c, given != 0, out);
            free(c.rows);
        }
        print_failures(summary, start, end, out);
        start = end;
    }
}

void mote_screen_print(const mote_summary *summary, FILE *out)
{
    print_screen(summary, MOTE_VIEW_SCREEN, out);
}

void mote_screen_engines(const mote_summary *summary, FILE *out)
{
    print_screen(summary, MOTE_VIEW_ENGINES, out);
}
