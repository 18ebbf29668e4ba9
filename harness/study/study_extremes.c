#include "harness/study/study_extremes.h"

#include "core/method/impact_method.h"
#include "harness/base/memory.h"
#include "harness/study/extreme.h"
#include "harness/figure/figures.h"
#include "harness/base/record.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define METHODS_MAX 64

/* Our own methods, none of which may be wrong. */
static const char *const ours[] = {"particle-paper", "particle",  "certified",   "stream",
                                   "auto",           "aabb-tree", "brute-force", "hybrid-fcl"};

/* One letter for each verdict, as printed. */
static const char letters[MOTE_EXTREME_VERDICTS + 1] = " .ixWNHC";

/* One scene's results. */
typedef struct scene_row {
    const char *family;
    char label[24];
    double length, condition;
    double truth[MOTE_EXTREME_FRAMES], rounding; /* over L */
    mote_extreme_cell cells[METHODS_MAX];
} scene_row;

typedef struct study {
    bool quick;
    size_t method_count;
    const char *method[METHODS_MAX];
    bool is_ours[METHODS_MAX];
    scene_row *rows;
    size_t row_count, row_capacity;
    size_t counts[METHODS_MAX][MOTE_EXTREME_VERDICTS];
} study;

static bool answers_impacts_alone(const char *name)
{
    const mote_impact_method *impact = mote_impact_method_find(name);
    return impact && impact->alone;
}

/* only: the name of the one method; NULL: every method that answers for distances or contacts.
 */
static void list_methods(study *s, const char *only)
{
    for (size_t m = 0; mote_method_at(m) && s->method_count < METHODS_MAX; ++m) {
        const char *name = mote_method_at(m)->name;
        if (only ? strcmp(name, only) != 0 : answers_impacts_alone(name))
            continue;
        const size_t i = s->method_count++;
        s->method[i] = name;
        for (size_t k = 0; k < sizeof ours / sizeof ours[0]; ++k)
            s->is_ours[i] = s->is_ours[i] || strcmp(ours[k], s->method[i]) == 0;
    }
}

static scene_row *add_row(study *s)
{
    s->rows = mote_reserve(s->rows, s->row_count + 1, &s->row_capacity, sizeof *s->rows);
    scene_row *row = &s->rows[s->row_count++];
    memset(row, 0, sizeof *row);
    return row;
}

static void print_header(const study *s)
{
    (void)printf(". right, i inexact as allowed, x refused, W wrong, N no number, H hung, "
                 "C crashed\n");
    for (size_t m = 0; m < s->method_count; ++m)
        (void)printf("%zu %s%s", m + 1, s->method[m], m + 1 < s->method_count ? ", " : "\n\n");
}

static void print_row(const study *s, const scene_row *row)
{
    (void)printf("%-13s %-20s ", row->family, row->label);
    for (size_t m = 0; m < s->method_count; ++m)
        (void)printf(" %c", letters[row->cells[m].verdict]);
    (void)printf("\n");
    (void)fflush(stdout);
}

static void describe_scene(const mote_extreme *e, scene_row *row)
{
    row->family = e->family;
    (void)snprintf(row->label, sizeof row->label, "%s", e->label);
    row->length = e->length;
    row->condition = e->condition;
    for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES && e->length > 0; ++f) {
        row->truth[f] = e->truth[f] / e->length;
        row->rounding = fmax(row->rounding, fabs(e->truth[f] - e->unrounded[f]) / e->length);
    }
}

static mote_status measure_scene(study *s, const mote_extreme_recipe *plain,
                                 const mote_extreme_family *family, int k)
{
    static mote_extreme_recipe recipe; /* 25 kB */
    mote_extreme e = {.family = family->name};
    scene_row *row = NULL;
    mote_extreme_label(family, k, e.label, sizeof e.label);
    if (family->parameters)
        e.parameters = family->parameters[k - family->first];
    mote_status status = family->change(plain, k, &recipe);
    if (status == MOTE_OK)
        status = mote_extreme_make(&recipe, &e);
    if (status == MOTE_OK && !e.refusal[0])
        mote_extreme_measure(&e);
    if (status == MOTE_OK) {
        row = add_row(s);
        describe_scene(&e, row);
    }
    for (size_t m = 0; m < s->method_count && status == MOTE_OK; ++m) {
        status = mote_extreme_run(&e, s->method[m], &row->cells[m]);
        s->counts[m][row->cells[m].verdict]++;
    }
    if (status == MOTE_OK)
        print_row(s, row);
    mote_extreme_free(&e);
    return status;
}

/* only: the name of the one family; NULL: every family. */
static mote_status measure_all(study *s, const char *only)
{
    static mote_extreme_recipe plain;
    mote_status status = mote_extreme_plain(&plain);
    for (size_t i = 0; i < mote_extreme_family_count && status == MOTE_OK; ++i) {
        const mote_extreme_family *family = &mote_extreme_families[i];
        const int step = s->quick ? family->quick : 1;
        if (only && strcmp(family->name, only) != 0)
            continue;
        for (int k = family->first; k <= family->last && status == MOTE_OK; k += step)
            status = measure_scene(s, &plain, family, k);
    }
    return status;
}

static bool is_failure(const study *s, size_t m, mote_extreme_verdict verdict)
{
    return verdict >= MOTE_EXTREME_NAN || (verdict == MOTE_EXTREME_WRONG && s->is_ours[m]);
}

static json_t *cell_json(const study *s, const scene_row *row, size_t m)
{
    const mote_extreme_cell *cell = &row->cells[m];
    const bool answered = cell->frame > 0;
    json_t *object = json_pack(
        "{s:s, s:s, s:s, s:s, s:o, s:o, s:o, s:o}", "family", row->family, "extreme",
        row->label, "method", s->method[m], "verdict", mote_extreme_verdicts[cell->verdict],
        "error", answered ? json_real(cell->error) : json_null(), "frame",
        answered ? json_integer(cell->frame) : json_null(), "build_ns",
        answered ? json_integer((json_int_t)cell->build_ns) : json_null(), "query_ns",
        answered ? json_integer((json_int_t)cell->query_ns) : json_null());
    if (object && cell->reason[0])
        (void)json_object_set_new(object, "reason", json_string(cell->reason));
    return object;
}

static json_t *scene_json(const scene_row *row)
{
    const bool made = row->length > 0;
    json_t *truth = made ? json_array() : json_null();
    for (uint32_t f = 0; made && f < MOTE_EXTREME_FRAMES; ++f)
        (void)json_array_append_new(truth, json_real(row->truth[f]));
    return json_pack("{s:s, s:s, s:o, s:o, s:o, s:o}", "family", row->family, "extreme",
                     row->label, "length", made ? json_real(row->length) : json_null(), "truth",
                     truth, "rounding", made ? json_real(row->rounding) : json_null(),
                     "condition",
                     row->condition > 0 ? mote_json_number(row->condition) : json_null());
}

static mote_status write_json(const study *s, bool met, const char *directory)
{
    json_t *scenes = json_array(), *cells = json_array(), *methods = json_array();
    for (size_t m = 0; m < s->method_count; ++m) {
        json_t *counts = json_object();
        for (int v = MOTE_EXTREME_RIGHT; v < MOTE_EXTREME_VERDICTS; ++v)
            (void)json_object_set_new(counts, mote_extreme_verdicts[v],
                                      json_integer((json_int_t)s->counts[m][v]));
        (void)json_array_append_new(methods,
                                    json_pack("{s:s, s:b, s:o}", "name", s->method[m], "ours",
                                              s->is_ours[m], "verdicts", counts));
    }
    for (size_t i = 0; i < s->row_count; ++i) {
        (void)json_array_append_new(scenes, scene_json(&s->rows[i]));
        for (size_t m = 0; m < s->method_count; ++m) {
            if (s->rows[i].cells[m].verdict != MOTE_EXTREME_NONE)
                (void)json_array_append_new(cells, cell_json(s, &s->rows[i], m));
        }
    }
    return mote_record_json(directory, "extremes.json",
                            json_pack("{s:i, s:s, s:o, s:o, s:o, s:b}", "schema", 1, "profile",
                                      s->quick ? "quick" : "full", "methods", methods, "scenes",
                                      scenes, "cells", cells, "met", met));
}

static mote_status write_csv(const study *s, const char *directory)
{
    mote_text text = {0};
    mote_text_add(&text, "family,extreme,method,verdict,error,frame,rounding,build_ns,query_ns,"
                         "reason\n");
    for (size_t i = 0; i < s->row_count; ++i) {
        const scene_row *row = &s->rows[i];
        for (size_t m = 0; m < s->method_count; ++m) {
            const mote_extreme_cell *cell = &row->cells[m];
            if (cell->verdict == MOTE_EXTREME_NONE)
                continue;
            mote_text_add(&text, "%s,\"%s\",%s,%s,", row->family, row->label, s->method[m],
                          mote_extreme_verdicts[cell->verdict]);
            if (cell->frame > 0)
                mote_text_add(&text, "%.17g,%u,%.17g,%" PRIu64 ",%" PRIu64, cell->error,
                              cell->frame, row->rounding, cell->build_ns, cell->query_ns);
            else
                mote_text_add(&text, ",,,,");
            /* Error texts contain no quotes. */
            mote_text_add(&text, ",\"%s\"\n", cell->reason);
        }
    }
    return mote_record_text(directory, "extremes.csv", &text);
}

/* Lists the cells with one verdict, a line each. */
static void list_cells(const study *s, mote_extreme_verdict verdict, mote_text *text)
{
    for (size_t m = 0; m < s->method_count; ++m) {
        for (size_t i = 0; i < s->row_count; ++i) {
            const mote_extreme_cell *cell = &s->rows[i].cells[m];
            if (cell->verdict != verdict)
                continue;
            mote_text_add(text, "| %s | %s | %s | ", s->method[m], s->rows[i].family,
                          s->rows[i].label);
            if (cell->frame > 0)
                mote_text_add(text, "%.2g", cell->error);
            mote_text_add(text, " | %s |\n", cell->reason);
        }
    }
}

static size_t count_of(const study *s, mote_extreme_verdict verdict)
{
    size_t count = 0;
    for (size_t m = 0; m < s->method_count; ++m)
        count += s->counts[m][verdict];
    return count;
}

static void add_counts(const study *s, mote_text *text)
{
    mote_text_add(text, "| method |");
    for (int v = MOTE_EXTREME_RIGHT; v < MOTE_EXTREME_VERDICTS; ++v)
        mote_text_add(text, " %s |", mote_extreme_verdicts[v]);
    mote_text_add(text, "\n| --- |");
    for (int v = MOTE_EXTREME_RIGHT; v < MOTE_EXTREME_VERDICTS; ++v)
        mote_text_add(text, " ---: |");
    for (size_t m = 0; m < s->method_count; ++m) {
        mote_text_add(text, "\n| %s |", s->method[m]);
        for (int v = MOTE_EXTREME_RIGHT; v < MOTE_EXTREME_VERDICTS; ++v)
            mote_text_add(text, " %zu |", s->counts[m][v]);
    }
    mote_text_add(text, "\n");
}

static mote_status write_markdown(const study *s, const char *directory)
{
    static const struct {
        mote_extreme_verdict verdict;
        const char *title, *says;
    } parts[] = {
        {MOTE_EXTREME_CRASHED, "Crashed", "The process died."},
        {MOTE_EXTREME_HUNG, "Hung", "No answer within 10 seconds."},
        {MOTE_EXTREME_NAN, "No number", "An answer that is not finite."},
        {MOTE_EXTREME_WRONG, "Wrong",
         "Not what the method promises, and not reported by it: not the exact distance where "
         "it claims exactness, below the truth, or points that are not on the surfaces."},
        {MOTE_EXTREME_REFUSED, "Refused", "An error with a text instead of an answer."},
        {MOTE_EXTREME_INEXACT, "Inexact as allowed",
         "By methods that only approximate, or within 16 units in the last place of the "
         "largest coordinate."},
    };
    mote_text text = {0};
    mote_text_add(&text,
                  "# Numerical extremes\n\n%zu scenes of %d frames, %zu methods. Errors "
                  "are (answer - truth) / L, the largest of a scene.\n\n",
                  s->row_count, MOTE_EXTREME_FRAMES, s->method_count);
    add_counts(s, &text);
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; ++i) {
        mote_text_add(&text, "\n## %s: %zu\n\n%s\n", parts[i].title,
                      count_of(s, parts[i].verdict), parts[i].says);
        if (count_of(s, parts[i].verdict) == 0)
            continue;
        mote_text_add(&text, "\n| method | extreme | how far | error / L | what |\n"
                             "| --- | --- | --- | ---: | --- |\n");
        list_cells(s, parts[i].verdict, &text);
    }
    return mote_record_text(directory, "extremes.md", &text);
}

/* The minimum number of columns of a family in the figure, so that single extremes remain
   visible. */
#define FAMILY_WIDTH 6.0

static size_t family_size(const study *s, size_t first)
{
    size_t count = 1;
    while (first + count < s->row_count &&
           strcmp(s->rows[first + count].family, s->rows[first].family) == 0)
        ++count;
    return count;
}

/* Blocks: starts of families, their names, and the end; the methods; the cells as left edge,
   width, row, verdict. */
static void add_figure_data(const study *s, mote_text *text)
{
    mote_text cells = {0};
    double left = 0;
    for (size_t first = 0; first < s->row_count; first += family_size(s, first)) {
        const size_t count = family_size(s, first);
        const double width = fmax(1, FAMILY_WIDTH / (double)count);
        mote_text_add(text, "%.6g \"%s\"\n", left, s->rows[first].family);
        for (size_t i = first; i < first + count; ++i, left += width) {
            for (size_t m = 0; m < s->method_count; ++m)
                mote_text_add(&cells, "%.6g %.6g %zu %d\n", left, width, m,
                              (int)s->rows[i].cells[m].verdict);
        }
    }
    mote_text_add(text, "%.6g \"\"\n\n\n", left);
    for (size_t m = 0; m < s->method_count; ++m)
        mote_text_add(text, "%zu \"%s\"\n", m, s->method[m]);
    mote_text_add(text, "\n\n%s", cells.data ? cells.data : "");
    free(cells.data);
}

static mote_status write_figure(const study *s, const char *directory)
{
    mote_text text = {0};
    add_figure_data(s, &text);
    char *folder = mote_format("%s/figures", directory);
    mote_status status = mote_directory_make(folder);
    if (status == MOTE_OK)
        status = mote_record_text(directory, "figures/extremes.dat", &text);
    else
        free(text.data);
    free(folder);
    return status == MOTE_OK ? mote_figures_plot(directory, "extremes", "extremes") : status;
}

/* Prints the requirements that were not met to stderr, a line each. */
static bool check(const study *s)
{
    bool met = true;
    for (size_t i = 0; i < s->row_count; ++i) {
        for (size_t m = 0; m < s->method_count; ++m) {
            const mote_extreme_cell *cell = &s->rows[i].cells[m];
            if (!is_failure(s, m, cell->verdict))
                continue;
            met = false;
            (void)fprintf(stderr, "mote: extremes: %s, %s, %s: %s: %s\n", s->method[m],
                          s->rows[i].family, s->rows[i].label,
                          mote_extreme_verdicts[cell->verdict], cell->reason);
        }
    }
    return met;
}

static mote_status write_all(const study *s, bool met, const char *directory)
{
    mote_status status = write_json(s, met, directory);
    if (status == MOTE_OK)
        status = write_csv(s, directory);
    if (status == MOTE_OK)
        status = write_markdown(s, directory);
    return status == MOTE_OK ? write_figure(s, directory) : status;
}

mote_status mote_study_extremes(const char *directory, const mote_extremes_wish *wish,
                                bool *met)
{
    study s = {.quick = wish->quick};
    list_methods(&s, wish->method);
    mote_status status = mote_directory_make(directory);
    print_header(&s);
    if (status == MOTE_OK)
        status = measure_all(&s, wish->family);
    const bool fine = status == MOTE_OK && check(&s);
    if (status == MOTE_OK)
        status = write_all(&s, fine, directory);
    if (status == MOTE_OK) {
        mote_text counts = {0};
        add_counts(&s, &counts);
        (void)printf("\n%s\n%s/extremes.md lists every answer that was not right\n",
                     counts.data ? counts.data : "", directory);
        free(counts.data);
        *met = fine;
    }
    free(s.rows);
    return status;
}
