/* The drawn figures of a run, found by their files. */
#include "harness/report.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A kind of figure: drawn as NAME.svg, or as NAME-SCENARIO.svg for each scenario. */
typedef struct kind {
    const char *name, *title, *caption;
} kind;

static const kind kinds[] = {
    {"fig3", "Query time over query number, W-W (the paper's Figure 3)",
     "Total time of each query, all deformation included: particles with n = 5 against FCL, "
     "and "
     "the paper's average and maximum. Median of the replicates."},
    {"front", "Speed against error",
     "Every configuration a point, the number of particles beside it: what one more particle "
     "costs and gives. Whiskers are 95 % intervals."},
};
#define KIND_COUNT (sizeof kinds / sizeof kinds[0])

/* The kind of a figure's name, or KIND_COUNT; *rest: the scenario's part, "" without one. */
static size_t kind_of(const char *name, const char **rest)
{
    for (size_t k = 0; k < KIND_COUNT; ++k) {
        size_t length = strlen(kinds[k].name);
        if (strncmp(name, kinds[k].name, length) != 0)
            continue;
        if (name[length] == '\0' || name[length] == '-') {
            *rest = name[length] ? name + length + 1 : "";
            return k;
        }
    }
    *rest = "";
    return KIND_COUNT;
}

static mote_status add_figure(mote_report *report, const char *file, bool animation)
{
    mote_report_figure *figures =
        realloc(report->figures, (report->figure_count + 1) * sizeof *figures);
    if (!figures)
        return mote_fail(MOTE_ENOMEM, "no memory for a figure");
    report->figures = figures;
    mote_report_figure *figure = &figures[report->figure_count++];
    const char *rest = "";
    figure->animation = animation;
    figure->name = mote_format("%.*s", (int)strlen(file) - 4, file);
    figure->file = mote_format("figures/%s", file);
    size_t k = figure->name ? kind_of(figure->name, &rest) : KIND_COUNT;
    figure->title = k == KIND_COUNT
                        ? mote_format("%s", figure->name ? figure->name : "")
                        : mote_format("%s%s%s", kinds[k].title, rest[0] ? ": " : "", rest);
    figure->caption = mote_format("%s", k == KIND_COUNT ? "" : kinds[k].caption);
    if (!figure->name || !figure->file || !figure->title || !figure->caption)
        return mote_fail(MOTE_ENOMEM, "no memory for a figure");
    return MOTE_OK;
}

/* By kind, in the order above, then by name. */
static int by_kind(const void *a, const void *b)
{
    const mote_report_figure *first = a, *second = b;
    const char *rest;
    size_t k = kind_of(first->name, &rest), l = kind_of(second->name, &rest);
    return k != l ? (k < l ? -1 : 1) : strcmp(first->file, second->file);
}

static bool ends_in(const char *name, const char *end)
{
    size_t length = strlen(name), size = strlen(end);
    return length > size && name[0] != '.' && strcmp(name + length - size, end) == 0;
}

static mote_status name_missing(mote_report *report)
{
    for (size_t k = 0; k < KIND_COUNT; ++k) {
        bool found = false;
        for (size_t i = 0; i < report->figure_count; ++i) {
            const char *rest;
            found = found || kind_of(report->figures[i].name, &rest) == k;
        }
        char *text = found ? NULL
                           : mote_format("figure \"%s\": not drawn, or the run has no data "
                                         "for it; `make figures OUT=...` draws it",
                                         kinds[k].title);
        if (!found && json_array_append_new(report->missing, json_string(text)) != 0) {
            free(text);
            return mote_fail(MOTE_ENOMEM, "no memory for a figure");
        }
        free(text);
    }
    return MOTE_OK;
}

mote_status mote_report_figures(mote_report *report)
{
    char *path = mote_format("%s/figures", report->directory);
    DIR *folder = path ? opendir(path) : NULL;
    free(path);
    mote_status status = MOTE_OK;
    for (const struct dirent *entry = folder ? readdir(folder) : NULL;
         entry && status == MOTE_OK; entry = readdir(folder)) {
        bool animation = ends_in(entry->d_name, ".gif");
        if (animation || ends_in(entry->d_name, ".svg"))
            status = add_figure(report, entry->d_name, animation);
    }
    if (folder)
        (void)closedir(folder);
    if (status == MOTE_OK && report->figure_count > 0)
        qsort(report->figures, report->figure_count, sizeof *report->figures, by_kind);
    return status == MOTE_OK ? name_missing(report) : status;
}
