#include "harness/compare/compared_run.h"

#include "core/method/method.h"
#include "harness/base/record.h"
#include "harness/summary/row_label.h"
#include "harness/summary/summary_json.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The directory of a path, freed by the caller, and the name of its summary file. */
static char *split(const char *path, const char **name)
{
    struct stat info;
    const bool is_file = stat(path, &info) == 0 && S_ISREG(info.st_mode);
    const char *slash = is_file ? strrchr(path, '/') : NULL;
    *name = slash ? slash + 1 : is_file ? path : "summary.json";
    if (!is_file)
        return mote_format("%s", path);
    return slash ? mote_format("%.*s", (int)(slash - path), path) : mote_format(".");
}

/* Rows of a file from elsewhere may lack what says which rows are the same. */
static mote_status check_rows(const char *directory, const char *name,
                              const mote_summary *summary)
{
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        const char *missing = row->scenario[0] == '\0'      ? "scenario"
                              : row->method[0] == '\0'      ? "method"
                              : row->fingerprint[0] == '\0' ? "fingerprint"
                                                            : NULL;
        if (missing)
            return mote_fail(MOTE_EINVAL,
                             "%s/%s: row %zu has no %s; rows are compared where scenario, "
                             "fingerprint and method are the same",
                             directory, name, i + 1, missing);
    }
    return MOTE_OK;
}

static mote_status read_summary(const char *directory, const char *name, mote_summary *summary)
{
    if (strcmp(name, "summary.json") == 0 && mote_record_exists(directory, "cells"))
        return mote_summary_make(directory, summary);
    if (!mote_record_exists(directory, name))
        return mote_fail(MOTE_EIO,
                         "%s: neither cells nor a %s; name a run, or its summary.json",
                         directory, name);
    const mote_status status = mote_summary_read(directory, name, summary);
    return status == MOTE_OK ? check_rows(directory, name, summary) : status;
}

/* *object stays NULL if there is no such file. */
static mote_status read_beside(const char *directory, const char *name, json_t **object)
{
    return mote_record_exists(directory, name) ? mote_record_read_json(directory, name, object)
                                               : MOTE_OK;
}

mote_status mote_compared_run_read(const char *path, mote_compared_run *run)
{
    const char *name;
    char *directory = split(path, &name);
    mote_compared_run made = {.directory = directory};
    const bool simulated =
        strcmp(name, "summary.json") == 0 && mote_simulations_exist(directory);
    mote_status status = MOTE_OK;
    if (!simulated || mote_record_exists(directory, "cells"))
        status = read_summary(directory, name, &made.summary);
    if (status == MOTE_OK && simulated)
        status = mote_simulations_read(directory, &made.simulations);
    if (status == MOTE_OK)
        status = read_beside(directory, "manifest.json", &made.manifest);
    if (status == MOTE_OK)
        status = read_beside(directory, "instructions.json", &made.instructions);
    if (status == MOTE_OK)
        *run = made;
    else
        mote_compared_run_free(&made);
    return status;
}

void mote_compared_run_free(mote_compared_run *run)
{
    mote_summary_free(&run->summary);
    mote_simulations_free(&run->simulations);
    json_decref(run->manifest);
    json_decref(run->instructions);
    free(run->directory);
    run->manifest = run->instructions = NULL;
    run->directory = NULL;
}

/* Whether each parameter of row a has the same value in row b, or is missing there because run
   b predates it and has its default in a. */
static bool has_parameters(const mote_summary_row *a, const mote_summary_row *b)
{
    const mote_method *method = mote_method_find(a->method);
    const char *key;
    json_t *value;
    bool same = true;
    MOTE_EACH_MEMBER(key, value, a->parameters)
    {
        bool usual, other_usual;
        const json_t *other = json_object_get(b->parameters, key);
        char *text = mote_row_value(method, key, value, &usual);
        char *other_text = other ? mote_row_value(method, key, other, &other_usual) : NULL;
        same = same && (other ? strcmp(text, other_text) == 0 : usual);
        free(text);
        free(other_text);
    }
    return same;
}

bool mote_compared_agree(const char *a, const char *b)
{
    return a[0] == '\0' || b[0] == '\0' || strcmp(a, b) == 0;
}

/* Whether two numbers are equal, as far as both are known. */
static bool numbers_agree(double a, double b)
{
    return !(a < b) && !(a > b);
}

bool mote_compared_same_range(const uint32_t a[2], const uint32_t b[2])
{
    return a[0] == 0 || b[0] == 0 || (a[0] == b[0] && a[1] == b[1]);
}

/* Whether two rows were asked the same about the same scene. */
static bool same_question(const mote_summary_row *a, const mote_summary_row *b)
{
    return strcmp(a->scenario, b->scenario) == 0 &&
           strcmp(a->fingerprint, b->fingerprint) == 0 &&
           mote_compared_agree(a->faces, b->faces) && a->stride == b->stride &&
           a->frames == b->frames && mote_compared_same_range(a->frame_range, b->frame_range) &&
           mote_compared_agree(a->ask, b->ask) && a->step == b->step &&
           numbers_agree(a->tolerance, b->tolerance);
}

bool mote_compared_same_method(const mote_summary_row *a, const mote_summary_row *b)
{
    return strcmp(a->method, b->method) == 0 && has_parameters(a, b) && has_parameters(b, a);
}

/* Whether two rows have the same configuration. What an older run does not say is taken for
   what the other one says. */
static bool same_configuration(const mote_summary_row *a, const mote_summary_row *b)
{
    return same_question(a, b) && mote_compared_same_method(a, b) &&
           strcmp(a->cache, b->cache) == 0 && a->seed == b->seed &&
           mote_compared_agree(a->seeds, b->seeds);
}

const mote_summary_row *mote_compared_partner(const mote_summary *summary,
                                              const mote_summary_row *row)
{
    const mote_summary_row *found = NULL;
    int highest = -1;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *other = &summary->rows[i];
        const int rank = (row->times_comparable == other->times_comparable ? 2 : 0) +
                         (row->machine[0] && strcmp(row->machine, other->machine) == 0 ? 1 : 0);
        if (rank <= highest || !same_configuration(row, other))
            continue;
        found = other;
        highest = rank;
    }
    return found;
}
