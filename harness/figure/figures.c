#include "harness/figure/figures.h"

#include "harness/base/number_text.h"
#include "harness/figure/figure.h"
#include "harness/base/hash.h"
#include "harness/base/record.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The scenarios that a figure shows. */
typedef enum figure_scope {
    SCOPE_ONE,  /* a named one */
    SCOPE_EACH, /* every one of the run */
    SCOPE_RUN   /* of the run as a whole */
} figure_scope;

/* Drawn by plots/NAME.gp as figures/NAME, or NAME-SCENARIO for each scenario. The test of
   figures compares this table with results/README.md. */
typedef struct figure_kind {
    int number;
    const char *name, *title;
    figure_scope scope;
    const char *scenario;
    mote_figure_writer *write;
    const char *formats;
    const char *command; /* the command that measures the figure's data; OUT=DIR names the run's
                            directory */
} figure_kind;

#define PAPER "svg png pdf"

#define QUICK "make bench PROFILE=quick"
#define BENCH "make bench"
#define SWEEP "make sweep"
#define INGREDIENTS "make ingredients"
#define BODIES "make bodies"

static const figure_kind kinds[] = {
    {1, "fig1", "Particles on two letters T", SCOPE_ONE, "tt", mote_figure_particles, PAPER,
     QUICK},
    {2, "fig2", "M against V, deforming", SCOPE_ONE, "mv", mote_figure_deformed, PAPER, BENCH},
    {2, "animation", "M against V, moving", SCOPE_ONE, "mv", mote_figure_animation, "gif",
     BENCH},
    {3, "fig3", "Time of each query", SCOPE_ONE, "ww", mote_figure_queries, PAPER, QUICK},
    {4, "front", "Speed against error", SCOPE_EACH, NULL, mote_figure_front, PAPER, QUICK},
    {5, "errors", "Error over particles", SCOPE_EACH, NULL, mote_figure_errors, PAPER, QUICK},
    {6, "size-time", "Time over triangles", SCOPE_RUN, NULL, mote_figure_size_time, PAPER,
     SWEEP},
    {7, "size-bytes", "Memory over triangles", SCOPE_RUN, NULL, mote_figure_size_bytes, PAPER,
     SWEEP},
    {8, "shares", "Where the time goes", SCOPE_EACH, NULL, mote_figure_shares, PAPER, QUICK},
    {9, "ratios", "Against the best engine of others", SCOPE_EACH, NULL, mote_figure_ratios,
     PAPER, QUICK},
    {10, "extremes", "Numerical extremes", SCOPE_RUN, NULL, mote_figure_extremes, PAPER,
     "make extremes OUT=DIR"},
    {11, "claims", "The paper's claims", SCOPE_RUN, NULL, mote_figure_claims, PAPER,
     "make claims OUT=DIR"},
    {12, "error-time", "Distance and error over frames", SCOPE_EACH, NULL, mote_figure_history,
     PAPER, QUICK},
    {13, "ingredients", "Ingredients of the tracked particles", SCOPE_RUN, NULL,
     mote_figure_ingredients, PAPER, INGREDIENTS},
    {14, "tracked", "Tracked particles, speed against error", SCOPE_EACH, NULL,
     mote_figure_tracked, PAPER, INGREDIENTS},
    {15, "bodies", "Several bodies", SCOPE_RUN, NULL, mote_figure_bodies, PAPER, BODIES},
    {15, "letters", "100 letters in a box", SCOPE_RUN, NULL, mote_figure_letters, "gif",
     BODIES},
};

/* The state while a run's figures are drawn. */
typedef struct drawing {
    mote_figure_run run;
    char identity[160]; /* identifies the run, as in the footer */
    char *folder;       /* DIRECTORY/figures */
    json_t *index;      /* figures.json's figures */
    json_t *missing;    /* missing figures, a line each */
    json_t *not_drawn;  /* figures that another command measures */
    size_t failed;
    mote_figures *result;
} drawing;

/* "20261121T104057Z-320b2871, commit 3b32655+": when the run began, with which program, and
   from which sources (+: modified since); "unknown" without a manifest. */
static void run_identity(const char *directory, char *text, size_t size)
{
    json_t *manifest = NULL;
    (void)snprintf(text, size, "unknown");
    if (mote_record_read_json(directory, "manifest.json", &manifest) != MOTE_OK)
        return;
    const json_t *session = json_array_get(json_object_get(manifest, "sessions"), 0);
    const char *commit = mote_text_at(manifest, "commit");
    char when[32] = "";
    size_t used = 0;
    for (const char *p = mote_text_at(session, "started"); *p && used + 1 < sizeof when; ++p) {
        if (*p != '-' && *p != ':')
            when[used++] = *p;
    }
    when[used] = '\0';
    (void)snprintf(text, size, "%s-%.8s, commit %.7s%s", when,
                   mote_text_at(manifest, "program"), commit[0] ? commit : "unknown",
                   json_is_true(json_object_get(manifest, "dirty")) ? "+" : "");
    json_decref(manifest);
}

static void make_footer(const char *identity, uint64_t data, char *footer, size_t size)
{
    (void)snprintf(footer, size, "run %s \xc2\xb7 data %016" PRIx64, identity, data);
}

/* A file name that any program accepts: letters, digits, '-' and '_'; followed by a hash of the
   original if a character had to be replaced. */
static char *file_name(const figure_kind *kind, const char *scenario)
{
    if (kind->scope != SCOPE_EACH)
        return mote_format("%s", kind->name);
    char safe[64];
    size_t length = 0;
    bool same = true;
    for (const char *p = scenario; *p; ++p) {
        const bool good = (*p >= 'a' && *p <= 'z') || (*p >= 'A' && *p <= 'Z') ||
                          (*p >= '0' && *p <= '9') || *p == '-' || *p == '_';
        same = same && good && length + 1 < sizeof safe;
        if (length + 1 < sizeof safe)
            safe[length++] = good ? *p : '_';
    }
    safe[length] = '\0';
    if (same)
        return mote_format("%s-%s", kind->name, safe);
    return mote_format("%s-%s-%08" PRIx32, kind->name, safe,
                       (uint32_t)mote_hash_text(scenario));
}

/* "ww, 11,920 triangles each", "mv, 2,968 and 1,764 triangles", "letters, 100 bodies"; for a
   figure of the run, its title. */
static void make_heading(const drawing *d, const figure_kind *kind, const char *scenario,
                         char *heading, size_t size)
{
    const mote_summary *summary = d->run.summary;
    const mote_summary_row *row = NULL;
    for (size_t i = 0; scenario && i < summary->count && !row; ++i)
        row = strcmp(summary->rows[i].scenario, scenario) == 0 ? &summary->rows[i] : NULL;
    if (!row) {
        (void)snprintf(heading, size, "%s", scenario ? scenario : kind->title);
        return;
    }
    char a[MOTE_NUMBER_TEXT], b[MOTE_NUMBER_TEXT];
    (void)mote_show_whole(row->triangles[0], a);
    (void)mote_show_whole(row->triangles[1], b);
    if (row->bodies > 0)
        (void)snprintf(heading, size, "%s, %s bodies", scenario,
                       mote_show_whole(row->bodies, a));
    else if (row->triangles[0] == row->triangles[1])
        (void)snprintf(heading, size, "%s, %s triangles each", scenario, a);
    else
        (void)snprintf(heading, size, "%s, %s and %s triangles", scenario, a, b);
}

/* Appends the figure to figures.json, and its files to the result. */
static void add_index(drawing *d, const figure_kind *kind, const char *scenario,
                      const char *name, const mote_figure *figure, uint64_t data)
{
    char hash[20], formats[32];
    (void)snprintf(hash, sizeof hash, "%016" PRIx64, data);
    (void)snprintf(formats, sizeof formats, "%s", kind->formats);
    json_t *files = json_array();
    char *rest = formats;
    for (const char *format; (format = strtok_r(rest, " ", &rest)) != NULL;) {
        char *file = mote_format("%s.%s", name, format);
        (void)json_array_append_new(files, json_string(file));
        mote_text_add(&d->result->files, "%s/figures/%s\n", d->run.directory, file);
        free(file);
    }
    json_t *entry =
        json_pack("{s:i, s:s, s:s?, s:s, s:s, s:s, s:s, s:o}", "number", kind->number, "name",
                  name, "scenario", scenario, "title", kind->title, "caption",
                  figure->caption.data, "run", d->identity, "data", hash, "files", files);
    (void)json_array_append_new(d->index, entry);
    ++d->result->drawn;
}

/* Writes the data and draws the figure. */
static mote_status draw_data(drawing *d, const figure_kind *kind, const char *scenario,
                             mote_figure *figure)
{
    char heading[160], footer[256];
    const uint64_t data =
        mote_hash_bytes(MOTE_HASH_START, figure->data.data, figure->data.size);
    char *name = file_name(kind, scenario);
    char *file = mote_format("figures/%s.dat", name);
    mote_status status = mote_record_text(d->run.directory, file, &figure->data);
    make_heading(d, kind, scenario, heading, sizeof heading);
    make_footer(d->identity, data, footer, sizeof footer);
    if (status == MOTE_OK)
        status = mote_gnuplot_draw(d->folder, kind->name, name, heading, footer, kind->formats);
    if (status == MOTE_OK)
        add_index(d, kind, scenario, name, figure, data);
    free(file);
    free(name);
    return status;
}

/* The command that measures a figure, for this run. */
static char *command_text(const drawing *d, const figure_kind *kind)
{
    const char *place = strstr(kind->command, "DIR");
    if (!place)
        return mote_format("%s", kind->command);
    return mote_format("%.*s%s", (int)(place - kind->command), kind->command, d->run.directory);
}

/* Records a figure that the run lacks data for, with the command that measures them. */
static void add_not_drawn(drawing *d, const figure_kind *kind)
{
    char *command = command_text(d, kind);
    (void)json_array_append_new(d->not_drawn,
                                json_pack("{s:i, s:s, s:s}", "number", kind->number, "name",
                                          kind->name, "command", command));
    free(command);
}

/* state: "not drawn" or "not whole". If told, a command also prints it. */
static void add_missing(drawing *d, const figure_kind *kind, const mote_figure *figure,
                        const char *state, bool told)
{
    char *text = mote_format("figure %d (%s) is %s; missing: %s", kind->number, kind->name,
                             state, figure->missing.data);
    if (told)
        mote_text_add(&d->result->notices, "mote: %s: %s\n", d->run.directory, text);
    (void)json_array_append_new(d->missing, json_string(text));
    free(text);
}

/* Draws one figure; *done: the run has its data. quiet: missing data is not reported. */
static mote_status draw(drawing *d, const figure_kind *kind, const char *scenario, bool quiet,
                        bool *done)
{
    mote_figure figure = {0};
    mote_status status = kind->write(&d->run, scenario, &figure);
    const bool some = status == MOTE_OK && figure.data.size > 0;
    const bool refused = status == MOTE_EINVAL; /* the scenario has changed since the run */
    if (refused) {
        mote_text_add(&figure.missing, "%s", mote_error_text());
        status = MOTE_OK;
    }
    if (status == MOTE_OK && some && figure.missing.size > 0) {
        add_missing(d, kind, &figure, "not whole", false); /* its caption reports it */
        mote_text_add(&figure.caption, " Not in it: %s.", figure.missing.data);
    } else if (status == MOTE_OK && figure.missing.size > 0 && !quiet) {
        add_missing(d, kind, &figure, "not drawn", refused);
        add_not_drawn(d, kind);
    }
    if (status == MOTE_OK && some)
        status = draw_data(d, kind, scenario, &figure);
    if (status == MOTE_EIO) { /* gnuplot failed: the other figures are still drawn */
        figure.missing.size = 0;
        mote_text_add(&figure.missing, "%s", mote_error_text());
        add_missing(d, kind, &figure, "not drawn", true);
        ++d->failed;
        status = MOTE_OK;
    }
    *done = some;
    free(figure.data.data);
    free(figure.caption.data);
    free(figure.missing.data);
    return status;
}

static bool first_of_scenario(const mote_summary *summary, size_t index)
{
    for (size_t i = 0; i < index; ++i) {
        if (strcmp(summary->rows[i].scenario, summary->rows[index].scenario) == 0)
            return false;
    }
    return true;
}

/* Draws a figure for every scenario whose rows allow it; if there is none, reports what is
   missing. */
static mote_status draw_each(drawing *d, const figure_kind *kind)
{
    const mote_summary *summary = d->run.summary;
    mote_status status = MOTE_OK;
    bool any = false, done;
    for (size_t i = 0; i < summary->count && status == MOTE_OK; ++i) {
        if (!first_of_scenario(summary, i))
            continue;
        status = draw(d, kind, summary->rows[i].scenario, true, &done);
        any = any || done;
    }
    if (status == MOTE_OK && !any)
        status = draw(d, kind, summary->count ? summary->rows[0].scenario : "any scenario",
                      false, &done);
    return status;
}

static mote_status draw_kind(drawing *d, const figure_kind *kind)
{
    bool done;
    if (kind->scope == SCOPE_EACH)
        return draw_each(d, kind);
    return draw(d, kind, kind->scenario, false, &done);
}

/* Appends "2, 6": the numbers of the figures from entry `first` on with the same command,
   without repetition. */
static void add_numbers(const json_t *list, size_t first, mote_text *text)
{
    const json_t *command = json_object_get(json_array_get(list, first), "command");
    json_int_t last = -1;
    for (size_t i = first; i < json_array_size(list); ++i) {
        const json_t *entry = json_array_get(list, i);
        const json_int_t number = json_integer_value(json_object_get(entry, "number"));
        if (!json_equal(json_object_get(entry, "command"), command) || number == last)
            continue;
        mote_text_add(text, "%s%" JSON_INTEGER_FORMAT, i > first ? ", " : "", number);
        last = number;
    }
}

/* Whether an earlier entry has the command of entry i, or entry i has none. */
static bool is_told(const json_t *list, size_t i)
{
    const json_t *command = json_object_get(json_array_get(list, i), "command");
    bool told = !json_is_string(command);
    for (size_t k = 0; k < i && !told; ++k)
        told = json_equal(json_object_get(json_array_get(list, k), "command"), command);
    return told;
}

void mote_figures_elsewhere(const json_t *not_drawn, mote_text *text)
{
    for (size_t i = 0; i < json_array_size(not_drawn); ++i) {
        if (is_told(not_drawn, i))
            continue;
        mote_text_add(text, "%s", text->size ? ", " : "figures that other commands measure: ");
        add_numbers(not_drawn, i, text);
        mote_text_add(text, " (`%s`)", mote_text_at(json_array_get(not_drawn, i), "command"));
    }
}

static mote_status draw_all(drawing *d)
{
    d->folder = mote_format("%s/figures", d->run.directory);
    mote_status status = mote_directory_make(d->folder);
    d->index = json_array();
    d->missing = json_array();
    d->not_drawn = json_array();
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0] && status == MOTE_OK; ++k) {
        status = draw_kind(d, &kinds[k]);
        if (kinds[k].write == mote_figure_animation || kinds[k].write == mote_figure_letters)
            mote_figure_animation_clear(d->run.directory);
    }
    free(d->folder);
    if (status != MOTE_OK) {
        json_decref(d->index);
        json_decref(d->missing);
        json_decref(d->not_drawn);
        return status;
    }
    mote_figures_elsewhere(d->not_drawn, &d->result->elsewhere);
    return mote_record_json(d->run.directory, "figures/figures.json",
                            json_pack("{s:o, s:o, s:o}", "figures", d->index, "missing",
                                      d->missing, "not_drawn", d->not_drawn));
}

/* Reads the run's rows; a run without cells has none, which is reported. */
static mote_status read_run(const char *directory, mote_summary *summary, mote_text *notices)
{
    mote_text damaged = {0};
    memset(summary, 0, sizeof *summary);
    if (!mote_record_exists(directory, "cells")) {
        mote_text_add(notices, "mote: %s/cells: not there; no cell of a run\n", directory);
        return MOTE_OK;
    }
    const mote_status status = mote_summary_make_whole(directory, &damaged, summary);
    if (status == MOTE_OK && damaged.size)
        mote_text_add(notices, "%s", damaged.data);
    free(damaged.data);
    return status;
}

/* claims.json, or NULL if it does not exist or cannot be read. */
static json_t *read_claims(const char *directory, mote_text *notices)
{
    json_t *claims = NULL;
    if (mote_record_exists(directory, "claims.json") &&
        mote_record_read_json(directory, "claims.json", &claims) != MOTE_OK)
        mote_text_add(notices, "mote: %s\n", mote_error_text());
    return claims;
}

/* Draws the figures that a directory's run has data for. */
static mote_status draw_run(drawing *d)
{
    const char *directory = d->run.directory;
    if (!mote_record_exists(directory, "manifest.json"))
        mote_text_add(&d->result->notices,
                      "mote: %s/manifest.json: not there; figures name no run\n", directory);
    if (d->run.summary->count == 0 && !d->run.claims &&
        !mote_record_exists(directory, "summary.json"))
        return mote_fail(MOTE_EINVAL, "%s: nothing to draw; name the directory of a run",
                         directory);
    run_identity(directory, d->identity, sizeof d->identity);
    const mote_status status = draw_all(d);
    if (status == MOTE_OK && d->failed > 0)
        return mote_fail(MOTE_EIO, "%s: %zu figures could not be drawn", directory, d->failed);
    return status;
}

mote_status mote_figures_draw(const char *directory, mote_figures *result)
{
    *result = (mote_figures){0};
    if (!mote_record_exists(directory, "."))
        return mote_fail(MOTE_EIO, "%s: %s; name the directory of a run", directory,
                         strerror(errno));
    mote_summary summary;
    mote_status status = read_run(directory, &summary, &result->notices);
    if (status != MOTE_OK)
        return status;
    json_t *claims = read_claims(directory, &result->notices);
    drawing d = {.run = {directory, &summary, claims}, .result = result};
    status = draw_run(&d);
    json_decref(claims);
    mote_summary_free(&summary);
    return status;
}

void mote_figures_free(mote_figures *result)
{
    free(result->files.data);
    free(result->notices.data);
    free(result->elsewhere.data);
    *result = (mote_figures){0};
}

mote_status mote_figures_plot(const char *directory, const char *name, const char *script)
{
    char identity[160], footer[256];
    char *folder = mote_format("%s/figures", directory);
    char *path = mote_format("%s/figures/%s.dat", directory, name);
    char *text = NULL;
    size_t size = 0;
    mote_status status = mote_file_read(path, (size_t)1 << 30, &text, &size);
    if (status == MOTE_OK) {
        run_identity(directory, identity, sizeof identity);
        make_footer(identity, mote_hash_bytes(MOTE_HASH_START, text, size), footer,
                    sizeof footer);
        status = mote_gnuplot_draw(folder, script, name, "", footer, PAPER);
    }
    free(folder);
    free(text);
    free(path);
    return status;
}
