#include "harness/summary/tune.h"

#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/summary/column.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool same_group(const mote_summary_row *a, const mote_summary_row *b)
{
    return mote_summary_same_block(a, b) && a->given == b->given &&
           strcmp(a->method, b->method) == 0;
}

/* Enters a row into its group's comparison. */
static void compete(const mote_summary_row *row, mote_tuned *group)
{
    /* An unknown time is neither the smallest nor the largest. */
    if (row->status != MOTE_CELL_OK || !row->times_comparable ||
        row->total.median != row->total.median)
        return;
    group->configurations++;
    bool right = mote_summary_row_right(row);
    if (group->right && !right)
        return;
    /* The first correct configuration replaces incorrect ones. */
    bool first = !group->best || (right && !group->right);
    if (first || row->total.median < group->best->total.median)
        group->best = row;
    if (first || row->total.median > group->worst->total.median)
        group->worst = row;
    group->right = right;
}

mote_tuned *mote_tune_make(const mote_summary *summary, size_t *count)
{
    mote_tuned *groups = mote_allocate(summary->count, sizeof *groups);
    size_t found = 0;
    for (size_t i = 0; i < summary->count; ++i) {
        if (i > 0 && !same_group(&summary->rows[i - 1], &summary->rows[i]) &&
            groups[found].best)
            ++found;
        compete(&summary->rows[i], &groups[found]);
    }
    *count = summary->count > 0 && groups[found].best ? found + 1 : found;
    return groups;
}

/* The members of tune.json for the best row, with their names. */
static const struct told {
    const char *name, *object, *key; /* the column */
} told[] = {{"scenario", NULL, "scenario"},
            {"fingerprint", NULL, "fingerprint"},
            {"faces", NULL, "faces"},
            {"accounting", NULL, "accounting"},
            {"cache", NULL, "cache"},
            {"method", NULL, "method"},
            {"configuration", NULL, "label"},
            {"parameters", NULL, "parameters"},
            {"stride", NULL, "stride"},
            {"total_ns", "total_ns", "median"},
            {"deform_ns", "deform_ns", "median"},
            {"update_ns", "update_ns", "median"},
            {"query_ns", "query_ns", "median"}};

static json_t *row_json(const mote_tuned *group)
{
    json_t *row = json_object();
    for (size_t i = 0; i < sizeof told / sizeof told[0]; ++i) {
        const mote_column *column = mote_column_find(told[i].object, told[i].key);
        json_t *value = mote_column_write(column, group->best);
        (void)json_object_set_new(row, told[i].name, value ? value : json_null());
    }
    json_t *rest =
        json_pack("{s:b, s:i, s:{s:s, s:o}}", "right", (int)group->right, "configurations",
                  (int)group->configurations, "worst", "configuration", group->worst->label,
                  "total_ns", mote_json_number(group->worst->total.median));
    (void)json_object_update(row, rest);
    json_decref(rest);
    return row;
}

json_t *mote_tune_json(const mote_tuned *tuned, size_t count)
{
    json_t *rows = json_array();
    for (size_t i = 0; i < count; ++i)
        (void)json_array_append_new(rows, row_json(&tuned[i]));
    return json_pack("{s:i, s:o}", "schema", 1, "rows", rows);
}

/* Whether a method is one of the engines asked for. */
static bool is_asked(const char *method, bool fcl)
{
    return fcl ? strncmp(method, "fcl-", 4) == 0 : mote_summary_engine_name(method);
}

/* What tune.json says about a scenario. */
typedef struct told_best {
    const char *configuration; /* the fastest correct one, or "" */
    double total;
    bool known; /* whether the scenario is in the file */
} told_best;

static void consider(json_t *row, const char *scenario, bool fcl, told_best *best)
{
    const char *name = NULL, *cache = NULL, *method = NULL, *text = NULL;
    const char *accounting = "charged"; /* older files do not say */
    int right = 0;
    double total = 0;
    best->known = best->known || strcmp(mote_text_at(row, "scenario"), scenario) == 0;
    if (json_unpack(row, "{s:s, s:s, s:s, s:s, s:b, s:F, s?s}", "scenario", &name, "cache",
                    &cache, "method", &method, "configuration", &text, "right", &right,
                    "total_ns", &total, "accounting", &accounting) != 0 ||
        strcmp(name, scenario) != 0 || strcmp(accounting, "charged") != 0 ||
        strcmp(cache, "hot") != 0 || !is_asked(method, fcl) || !right ||
        !(total > 0 && total < best->total))
        return;
    best->total = total;
    best->configuration = text;
}

static mote_status read_tuned(const char *directory, json_t **object)
{
    char *path = mote_format("%s/tune.json", directory);
    const bool absent = access(path, F_OK) != 0 && errno == ENOENT;
    free(path);
    if (absent)
        return mote_fail(MOTE_EIO, "%s/tune.json: there is none; `mote tune %s` writes it",
                         directory, directory);
    const mote_status status = mote_record_read_json(directory, "tune.json", object);
    if (status != MOTE_OK || json_is_array(json_object_get(*object, "rows")))
        return status;
    json_decref(*object);
    return mote_fail(MOTE_EINVAL, "%s/tune.json: no rows; `mote tune %s` writes it", directory,
                     directory);
}

mote_status mote_tune_best(const char *directory, const char *scenario, bool fcl,
                           char **configuration)
{
    json_t *object = NULL;
    mote_status status = read_tuned(directory, &object);
    if (status != MOTE_OK)
        return status;
    const json_t *rows = json_object_get(object, "rows");
    told_best best = {.configuration = "", .total = HUGE_VAL};
    for (size_t i = 0; i < json_array_size(rows); ++i)
        consider(json_array_get(rows, i), scenario, fcl, &best);
    if (best.known)
        *configuration = mote_duplicate(best.configuration);
    else
        status = mote_fail(MOTE_EINVAL,
                           "%s/tune.json: scenario '%s' is not in it; name one of its rows",
                           directory, scenario);
    json_decref(object);
    return status;
}

/* Prints the best of a scene's groups that are of engines of others, or of FCL's. */
static void print_best(const mote_tuned *tuned, size_t start, size_t end, bool fcl, FILE *out)
{
    for (int given = 0; given < 2; ++given) {
        const mote_summary_row *best = NULL;
        for (size_t i = start; i < end; ++i) {
            const mote_summary_row *row = tuned[i].best;
            if (tuned[i].right && row->given == (given != 0) && is_asked(row->method, fcl) &&
                (!best || row->total.median < best->total.median))
                best = row;
        }
        if (best)
            (void)fprintf(out, "%s%s: %s\n", given ? "of positions=given, " : "",
                          fcl ? "best FCL" : "best engine of others", best->label);
    }
}

static void print_group(const mote_tuned *group, FILE *out)
{
    const mote_summary_row *best = group->best;
    (void)fprintf(out, "%-52s %11.2f %11.2f %11.2f %11.2f %8.2fx  of %zu%s\n", best->label,
                  best->total.median * 1e-3, best->deform.median * 1e-3,
                  best->update.median * 1e-3, best->query.median * 1e-3,
                  group->worst->total.median / best->total.median, group->configurations,
                  group->right ? "" : ", none of them right");
}

void mote_tune_print(const mote_tuned *tuned, size_t count, FILE *out)
{
    for (size_t start = 0, end; start < count; start = end) {
        const mote_summary_row *first = tuned[start].best;
        (void)fprintf(out, "%s%s, caches %s\n%-52s %11s %11s %11s %11s %9s\n",
                      start ? "\n" : "", first->scene, first->cache, "best configuration",
                      "total us", "deform", "update", "query", "worst");
        for (end = start; end < count && mote_summary_same_block(first, tuned[end].best); ++end)
            print_group(&tuned[end], out);
        print_best(tuned, start, end, false, out);
        print_best(tuned, start, end, true, out);
    }
}
