#include "harness/summary/compared_run.h"

#include "harness/base/record.h"
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
    mote_compared_run made = {.manifest = NULL};
    const char *name;
    char *directory = split(path, &name);
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
    free(directory);
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
    run->manifest = run->instructions = NULL;
}
