/* The drawn figures of a run: as listed in figures.json, otherwise by their file names. */
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/figure/figures.h"
#include "harness/report/report.h"
#include "harness/report/report_rows.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

static bool is_drawn(const char *name)
{
    return name[0] != '.' && (mote_name_ends(name, ".svg") || mote_name_ends(name, ".gif"));
}

/* Adds a figure; takes ownership of title. */
static void add_figure(mote_report *report, const char *file, char *title, const char *caption)
{
    report->figures =
        mote_resize(report->figures, report->figure_count + 1, sizeof *report->figures);
    mote_report_figure *figure = &report->figures[report->figure_count++];
    figure->animation = mote_name_ends(file, ".gif");
    figure->file = mote_format("figures/%s", file);
    figure->title = title;
    figure->caption = mote_duplicate(caption);
}

/* One entry of figures.json: the drawing that a page shows. */
static void add_entry(mote_report *report, const json_t *entry)
{
    size_t i;
    const json_t *item;
    const char *scenario = mote_text_at(entry, "scenario");
    MOTE_EACH(i, item, json_object_get(entry, "files"))
    {
        const char *file = json_is_string(item) ? json_string_value(item) : "";
        char *path = mote_format("figures/%s", file);
        const bool there = mote_record_exists(report->directory, path);
        free(path);
        if (!is_drawn(file) || strchr(file, '/') || !there)
            continue;
        char *title =
            mote_format("Figure %.0f. %s%s%s", mote_number_at(entry, "number"),
                        mote_text_at(entry, "title"), scenario[0] ? ": " : "", scenario);
        add_figure(report, file, title, mote_text_at(entry, "caption"));
    }
}

/* Adds one line for all figures that other commands measure. */
static void add_elsewhere(mote_report *report, const json_t *not_drawn)
{
    mote_text text = {0};
    mote_figures_elsewhere(not_drawn, &text);
    if (text.size > 0)
        (void)json_array_append_new(report->missing, json_string(text.data));
    free(text.data);
}

static void read_list(mote_report *report, const json_t *list)
{
    size_t i;
    const json_t *item;
    MOTE_EACH(i, item, json_object_get(list, "figures"))
    {
        add_entry(report, item);
    }
    add_elsewhere(report, json_object_get(list, "not_drawn"));
}

static int by_file(const void *a, const void *b)
{
    const mote_report_figure *first = a, *second = b;
    return strcmp(first->file, second->file);
}

static void read_folder(mote_report *report)
{
    char *path = mote_format("%s/figures", report->directory);
    DIR *folder = opendir(path);
    free(path);
    for (const struct dirent *entry = folder ? readdir(folder) : NULL; entry;
         entry = readdir(folder)) {
        const char *file = entry->d_name;
        if (is_drawn(file))
            add_figure(report, file, mote_format("%.*s", (int)strlen(file) - 4, file), "");
    }
    if (folder)
        (void)closedir(folder);
    if (report->figure_count > 0)
        qsort(report->figures, report->figure_count, sizeof *report->figures, by_file);
}

void mote_report_figures(mote_report *report)
{
    json_t *list = NULL;
    if (mote_record_read_json(report->directory, "figures/figures.json", &list) == MOTE_OK) {
        read_list(report, list);
        json_decref(list);
        return;
    }
    char *text = mote_format("figures: no list of them (figures/figures.json); `mote figures "
                             "%s` draws them",
                             report->directory);
    (void)json_array_append_new(report->missing, json_string(text));
    free(text);
    read_folder(report);
}
