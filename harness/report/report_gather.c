#include "harness/base/record.h"
#include "harness/base/data.h"
#include "harness/base/memory.h"
#include "harness/report/report.h"
#include "harness/report/report_rows.h"
#include "harness/summary/summary_json.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define DEFECTS_LIMIT ((size_t)1 << 20)

/* Adds a text to a list; takes ownership of it. */
static void add_text(json_t *list, char *what)
{
    (void)json_array_append_new(list, json_string(what));
    free(what);
}

/* Whether the run has a file; notes it if it is missing. */
static bool is_there(mote_report *report, const char *name, const char *remedy)
{
    const bool there = mote_record_exists(report->directory, name);
    if (!there)
        add_text(report->missing, mote_format("%s: not there; %s", name, remedy));
    return there;
}

/* Reads directory/name. A missing or unreadable file is noted, which is not a failure. */
static void read_json(mote_report *report, const char *name, const char *remedy,
                      json_t **object)
{
    if (is_there(report, name, remedy) &&
        mote_record_read_json(report->directory, name, object) != MOTE_OK)
        add_text(report->damaged, mote_format("%s: %s", name, mote_error_text()));
}

/* Adds a text to `damaged` for each line. */
static void add_lines(mote_report *report, const char *text)
{
    while (*text) {
        text += strncmp(text, "mote: ", 6) == 0 ? 6 : 0;
        size_t length = strcspn(text, "\n");
        if (length > 0)
            add_text(report->damaged, mote_format("a cell: %.*s", (int)length, text));
        text += length + 1; /* each line has an end */
    }
}

/* Reads the stored rows. */
static void read_summary(mote_report *report)
{
    static const char name[] = "summary.json";
    if (!is_there(report, name, "`mote summarize` writes it from the cells"))
        return;
    report->has_summary =
        mote_summary_read(report->directory, name, &report->summary) == MOTE_OK;
    if (!report->has_summary)
        add_text(report->damaged, mote_format("%s: %s", name, mote_error_text()));
}

/* Makes the rows from the cells that can be read, otherwise reads the stored ones. */
static void read_rows(mote_report *report)
{
    mote_text damaged = {0};
    const bool made =
        mote_summary_make_whole(report->directory, &damaged, &report->summary) == MOTE_OK;
    if (made && damaged.size > 0)
        add_lines(report, damaged.data);
    free(damaged.data);
    report->has_cells = report->has_summary = made && report->summary.count > 0;
    if (report->has_cells)
        return;
    if (made) {
        mote_summary_free(&report->summary);
        add_text(report->missing,
                 mote_format("cells: none that can be read; `mote run --out %s` measures them",
                             report->directory));
    } else {
        add_text(report->missing, mote_format("cells: %s", mote_error_text()));
    }
    read_summary(report);
}

/* Claims are measured by a separate run, which `make claims` writes beside the others. */
static void read_claims(mote_report *report)
{
    static const char *const folders[] = {"", "../claims/"};
    size_t k = 0;
    while (k < 2) {
        char name[64];
        (void)snprintf(name, sizeof name, "%sclaims.json", folders[k]);
        if (mote_record_exists(report->directory, name))
            break;
        ++k;
    }
    if (k == 2) {
        add_text(report->missing, mote_format("claims.json: neither in the run nor in "
                                              "../claims; `make claims` measures them"));
        return;
    }
    report->claims_folder = mote_duplicate(folders[k]);
    char claims[64], requirements[64];
    (void)snprintf(claims, sizeof claims, "%sclaims.json", folders[k]);
    (void)snprintf(requirements, sizeof requirements, "%srequirements.json", folders[k]);
    read_json(report, claims, "`make claims` measures them", &report->claims);
    read_json(report, requirements, "`make claims` measures them", &report->requirements);
}

static void read_defects(mote_report *report)
{
    size_t size;
    if (mote_data_read("datasets/defects.md", DEFECTS_LIMIT, &report->defects, &size) !=
        MOTE_OK)
        add_text(report->missing, mote_format("known defects: %s", mote_error_text()));
}

/* The last part of a path; for ".", that of the working directory. */
static char *last_part(const char *directory)
{
    char here[4096];
    const char *path = directory;
    if (strcmp(path, ".") == 0 && getcwd(here, sizeof here))
        path = here;
    size_t end = strlen(path);
    while (end > 1 && path[end - 1] == '/')
        --end;
    size_t start = end;
    while (start > 0 && path[start - 1] != '/')
        --start;
    return mote_format("%.*s", (int)(end - start), path + start);
}

mote_status mote_report_gather(const char *directory, mote_report *report)
{
    mote_report made = {.directory = directory};
    struct stat info;
    if (stat(directory, &info) != 0)
        return mote_fail(MOTE_EIO, "%s: %s; name the directory of a run", directory,
                         strerror(errno));
    if (!S_ISDIR(info.st_mode))
        return mote_fail(MOTE_EIO, "%s: not a directory; name the directory of a run",
                         directory);
    made.damaged = json_array();
    made.missing = json_array();
    made.name = last_part(directory);
    read_json(&made, "manifest.json", "`mote run` writes it", &made.manifest);
    read_rows(&made);
    mote_report_sort(&made);
    mote_report_figures(&made);
    if (mote_simulations_exist(directory) &&
        mote_simulations_read(directory, &made.simulations) != MOTE_OK)
        add_text(made.damaged, mote_format("simulations: %s", mote_error_text()));
    if (made.simulations.left_out > 0)
        add_text(made.missing, mote_format("%zu simulations, which are of another build",
                                           made.simulations.left_out));
    if (!made.has_summary && !made.figure_count && !made.simulations.count &&
        !mote_record_exists(directory, "claims.json")) {
        mote_report_free(&made);
        return mote_fail(
            MOTE_EIO,
            "%s: nothing to report: no cells that can be read, no summary.json, no "
            "simulations, no claims.json, no figures; name the directory of a run",
            directory);
    }
    read_claims(&made);
    read_defects(&made);
    *report = made;
    return MOTE_OK;
}

void mote_report_free(mote_report *report)
{
    mote_summary_free(&report->summary);
    mote_simulations_free(&report->simulations);
    json_decref(report->manifest);
    json_decref(report->claims);
    json_decref(report->requirements);
    json_decref(report->damaged);
    json_decref(report->missing);
    free(report->order);
    for (size_t i = 0; i < report->figure_count; ++i) {
        free(report->figures[i].file);
        free(report->figures[i].title);
        free(report->figures[i].caption);
    }
    free(report->figures);
    free(report->claims_folder);
    free(report->defects);
    free(report->name);
}

mote_status mote_report_write(const char *directory)
{
    mote_report report;
    mote_status status = mote_report_gather(directory, &report);
    if (status != MOTE_OK)
        return status;
    mote_text html = {0}, markdown = {0};
    status = mote_report_html(&report, &html);
    if (status == MOTE_OK) {
        mote_report_markdown(&report, &markdown);
        status = mote_record_text(directory, "report.html", &html);
    }
    if (status == MOTE_OK)
        status = mote_record_text(directory, "report.md", &markdown);
    free(html.data);
    free(markdown.data);
    mote_report_free(&report);
    return status;
}
