#define _DEFAULT_SOURCE /* realpath */
#include "harness/report/site.h"

#include "harness/base/escape.h"
#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/report/page.h"
#include "harness/report/report_data.h"
#include "harness/report/report_facts.h"
#include "harness/report/report_rows.h"
#include "harness/summary/summary_json.h"
#include "harness/summary/table.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define SUMMARY "summary.json"
#define SUMMARY_LIMIT ((size_t)1 << 30)

/* --- runs --- */

static mote_status check_rows(const mote_results_site_run *run)
{
    const json_t *schema = json_object_get(run->summary.document, "schema");
    if (!json_is_integer(schema) || json_integer_value(schema) != 1)
        return mote_fail(MOTE_EINVAL,
                         "%s/" SUMMARY ": its schema is not 1, the one that this program "
                         "knows; use the version of mote that wrote it, or a newer one",
                         run->directory);
    for (size_t i = 0; i < run->summary.count; ++i) {
        const mote_summary_row *row = &run->summary.rows[i];
        if (!row->scenario[0] || !row->method[0] || !row->label[0])
            return mote_fail(MOTE_EINVAL,
                             "%s/" SUMMARY ": row %zu has no scenario, method or label; "
                             "`mote summarize` writes the file again from the cells",
                             run->directory, i + 1);
    }
    return MOTE_OK;
}

static void free_run(mote_results_site_run *run)
{
    mote_summary_free(&run->summary);
    json_decref(run->manifest);
    free(run->directory);
    free(run->path);
    free(run->name);
}

static mote_status read_run(mote_results_site_run *run)
{
    char *text = NULL;
    size_t size = 0;
    struct stat info;
    run->path = realpath(run->directory, NULL);
    if (!run->path || stat(run->path, &info) != 0)
        return mote_fail(MOTE_EIO, "%s: %s; name the directories of runs", run->directory,
                         strerror(errno));
    if (!S_ISDIR(info.st_mode))
        return mote_fail(MOTE_EIO, "%s: not a directory; name the directories of runs",
                         run->directory);
    if (!mote_record_exists(run->directory, SUMMARY))
        return mote_fail(MOTE_EIO,
                         "%s: no " SUMMARY " there; name the directories of runs "
                         "(`mote summarize` writes the file from a run's cells)",
                         run->directory);
    char *file = mote_format("%s/" SUMMARY, run->directory);
    mote_status status = mote_file_read(file, SUMMARY_LIMIT, &text, &size);
    free(file);
    if (status == MOTE_OK)
        run->digest = mote_hash_bytes(MOTE_HASH_START, text, size);
    free(text);
    if (status == MOTE_OK)
        status = mote_summary_read(run->directory, SUMMARY, &run->summary);
    if (status == MOTE_OK)
        status = check_rows(run);
    if (status == MOTE_OK && mote_record_exists(run->directory, "manifest.json"))
        status = mote_record_read_json(run->directory, "manifest.json", &run->manifest);
    run->has_report = mote_record_exists(run->directory, "report.html");
    return status;
}

mote_status mote_results_site_add(mote_results_site *site, const char *directory)
{
    mote_results_site_run run = {.directory = mote_duplicate(directory)};
    const mote_status status = read_run(&run);
    if (status != MOTE_OK) {
        free_run(&run);
        return status;
    }
    if (!site->left_out)
        site->left_out = json_array();
    for (size_t i = 0; i < site->count; ++i) {
        const mote_results_site_run *other = &site->runs[i];
        if (strcmp(other->path, run.path) != 0 && other->digest != run.digest)
            continue;
        char *text = mote_format("%s: the same run as %s", directory, other->directory);
        (void)json_array_append_new(site->left_out, json_string(text));
        free(text);
        free_run(&run);
        return MOTE_OK;
    }
    site->runs = mote_reserve(site->runs, site->count + 1, &site->capacity, sizeof *site->runs);
    site->runs[site->count++] = run;
    return MOTE_OK;
}

/* --- names and links --- */

/* The last `parts` parts of a path. */
static const char *tail_of(const char *path, size_t parts)
{
    const char *at = path + strlen(path);
    while (at > path && parts > 0) {
        --at;
        if (*at == '/')
            --parts;
    }
    return *at == '/' && at[1] ? at + 1 : at;
}

/* Names each run by as few last parts of its path as tell all of them apart. */
static void name_runs(mote_results_site *site)
{
    size_t parts = 1;
    for (bool clash = true; clash && parts < 32; parts += clash ? 1 : 0) {
        clash = false;
        for (size_t i = 0; i < site->count && !clash; ++i) {
            for (size_t j = 0; j < i && !clash; ++j)
                clash = strcmp(tail_of(site->runs[i].path, parts),
                               tail_of(site->runs[j].path, parts)) == 0;
        }
    }
    for (size_t i = 0; i < site->count; ++i)
        site->runs[i].name = mote_duplicate(tail_of(site->runs[i].path, parts));
}

/* The path from one folder to another, both absolute and without links; the caller frees it. */
static char *path_between(const char *from, const char *to)
{
    size_t common = 0;
    for (size_t i = 0;; ++i) {
        const bool ends =
            (from[i] == '\0' || from[i] == '/') && (to[i] == '\0' || to[i] == '/');
        if (ends)
            common = i;
        if (from[i] != to[i] || from[i] == '\0')
            break;
    }
    mote_text text = {0};
    mote_text_add(&text, ".");
    for (const char *rest = from + common; *rest; ++rest) {
        if (*rest == '/' && rest[1])
            mote_text_add(&text, "/..");
    }
    mote_text_add(&text, "%s%s", to[common] == '/' || !to[common] ? "" : "/", to + common);
    return text.data;
}

/* --- rows --- */

typedef struct placed_row {
    const mote_summary_row *row;
    size_t run, number; /* of its run, and within it */
} placed_row;

static int by_place(const void *a, const void *b)
{
    const placed_row *first = a, *second = b;
    int order = mote_summary_by_scene(first->row, second->row);
    if (order == 0)
        order = mote_summary_by_frames(first->row, second->row);
    if (order == 0)
        order = (first->run > second->run) - (first->run < second->run);
    return order ? order : (first->number > second->number) - (first->number < second->number);
}

/* The rows of all runs in the order of scenes. They borrow from the runs' own. */
static void gather_rows(mote_results_site *site)
{
    size_t count = 0;
    for (size_t r = 0; r < site->count; ++r)
        count += site->runs[r].summary.count;
    placed_row *placed = mote_allocate(count, sizeof *placed);
    for (size_t r = 0, k = 0; r < site->count; ++r) {
        for (size_t i = 0; i < site->runs[r].summary.count; ++i)
            placed[k++] = (placed_row){&site->runs[r].summary.rows[i], r, i};
    }
    if (count > 0)
        qsort(placed, count, sizeof *placed, by_place);
    mote_summary *all = &site->all.summary;
    all->rows = mote_allocate(count, sizeof *all->rows);
    all->count = count;
    all->noise_floor = MOTE_NONE;
    site->run_of = mote_allocate(count, sizeof *site->run_of);
    for (size_t i = 0; i < count; ++i) {
        all->rows[i] = *placed[i].row;
        site->run_of[i] = placed[i].run;
    }
    free(placed);
    mote_report_sort(&site->all);
}

/* --- data --- */

/* When the run began: that of its first session; "" if unknown. */
static const char *started(const mote_results_site_run *run)
{
    return mote_text_at(json_array_get(json_object_get(run->manifest, "sessions"), 0),
                        "started");
}

static json_t *run_data(const mote_results_site_run *run, const char *home)
{
    const mote_report facts = {.directory = run->directory, .manifest = run->manifest};
    char *folder = path_between(home, run->path);
    json_t *data = json_object();
    (void)json_object_set_new(data, "name", json_string(run->name));
    (void)json_object_set_new(data, "started", json_string(started(run)));
    (void)json_object_set_new(data, "commit",
                              json_string(mote_text_at(run->manifest, "commit")));
    (void)json_object_set_new(data, "program",
                              json_string(mote_text_at(run->manifest, "program")));
    (void)json_object_set_new(data, "rows", json_integer((json_int_t)run->summary.count));
    (void)json_object_set_new(data, "machine", mote_report_machine(&facts));
    (void)json_object_set_new(data, "commands", mote_report_commands(&facts));
    (void)json_object_set_new(data, "folder", json_string(folder));
    (void)json_object_set_new(data, "report", json_boolean(run->has_report));
    free(folder);
    return data;
}

/* What the rows of a block were asked, and on which machine. */
static void add_question(const mote_summary_row *row, json_t *block)
{
    (void)json_object_set_new(block, "ask", json_string(row->ask));
    (void)json_object_set_new(block, "machine", json_string(row->machine));
    (void)json_object_set_new(block, "fingerprint", json_string(row->fingerprint));
    (void)json_object_set_new(block, "faces", json_string(row->faces));
    (void)json_object_set_new(block, "tolerance", mote_json_number(row->tolerance));
    (void)json_object_set_new(
        block, "frames",
        json_pack("[i, i]", (int)row->frame_range[0], (int)row->frame_range[1]));
}

static json_t *site_data(const mote_results_site *site, const char *home)
{
    size_t i;
    json_t *data = json_object(), *runs = json_array(), *item;
    mote_report_rows_data(&site->all, data);
    MOTE_EACH(i, item, json_object_get(data, "rows"))
    {
        (void)json_object_set_new(item, "run",
                                  json_integer((json_int_t)site->run_of[site->all.order[i]]));
    }
    MOTE_EACH(i, item, json_object_get(data, "blocks"))
    {
        const size_t first = (size_t)json_integer_value(json_object_get(item, "first"));
        add_question(mote_report_row(&site->all, first), item);
    }
    for (size_t r = 0; r < site->count; ++r)
        (void)json_array_append_new(runs, run_data(&site->runs[r], home));
    (void)json_object_set_new(data, "runs", runs);
    (void)json_object_set(data, "left_out", site->left_out);
    (void)json_object_set_new(data, "scenarios", mote_report_scenarios(&site->all));
    return data;
}

/* --- files --- */

static mote_status write_page(const mote_results_site *site, const char *directory,
                              const char *home)
{
    mote_text text = {0};
    mote_status status = mote_page_begin("results", &text);
    if (status == MOTE_OK) {
        mote_text_add(&text,
                      "<header>\n<p>mote, results of runs</p>\n<h1>Results</h1>\n"
                      "<p>%zu run%s, %zu rows</p>\n</header>\n<noscript><p "
                      "class=\"notice\">The tables of this page are made by JavaScript, "
                      "which is off. <a href=\"results.csv\">results.csv</a> has the "
                      "same rows.</p></noscript>\n<nav aria-label=\"Sections\"></nav>\n"
                      "<main></main>\n",
                      site->count, site->count == 1 ? "" : "s", site->all.summary.count);
        mote_page_data("site-data", site_data(site, home), &text);
        status = mote_page_scripts("plots/page/site.js", &text);
        mote_page_end(&text);
    }
    if (status == MOTE_OK)
        status = mote_record_text(directory, "index.html", &text);
    free(text.data);
    return status;
}

/* The run of each row, as further columns. */
static mote_status write_csv(const mote_results_site *site, const char *directory)
{
    const size_t count = site->all.summary.count;
    char **origins = mote_allocate(count, sizeof *origins);
    for (size_t i = 0; i < count; ++i) {
        const mote_results_site_run *run = &site->runs[site->run_of[i]];
        mote_text fields = {0};
        mote_escape_csv(&fields, run->name, true);
        mote_text_add(&fields, ",");
        mote_escape_csv(&fields, started(run), false);
        mote_text_add(&fields, ",");
        mote_escape_csv(&fields, mote_text_at(run->manifest, "commit"), false);
        origins[i] = fields.data;
    }
    mote_text text = {0};
    mote_table_csv_with(&site->all.summary, "run,started,commit", origins, &text);
    for (size_t i = 0; i < count; ++i)
        free(origins[i]);
    free(origins);
    return mote_record_text(directory, "results.csv", &text);
}

mote_status mote_results_site_write(mote_results_site *site, const char *directory)
{
    mote_status status = mote_directory_make(directory);
    if (status != MOTE_OK)
        return status;
    char *home = realpath(directory, NULL);
    if (!home)
        return mote_fail(MOTE_EIO, "%s: %s", directory, strerror(errno));
    name_runs(site);
    gather_rows(site);
    status = write_csv(site, directory);
    if (status == MOTE_OK)
        status = write_page(site, directory, home);
    free(home);
    return status;
}

void mote_results_site_free(mote_results_site *site)
{
    for (size_t i = 0; i < site->count; ++i)
        free_run(&site->runs[i]);
    free(site->runs);
    json_decref(site->left_out);
    free(site->all.summary.rows); /* what they own belongs to the runs */
    free(site->all.order);
    free(site->run_of);
}
