#include "harness/summary/merge.h"

#include "harness/base/record.h"
#include "harness/loop/simulations.h"
#include "harness/summary/stored.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Copies the CSV first, as when it was measured: a cell exists once its JSON does. */
static mote_status copy_cell(const mote_stored_cell *cell, const char *from, const char *to,
                             mote_merged *merged)
{
    char *json = mote_format("cells/%s.json", cell->id);
    char *csv = mote_format("cells/%s.csv", cell->id);
    char *pairs = mote_format("cells/%s.pairs.csv", cell->id);
    mote_status status = MOTE_OK;
    if (!mote_record_is_wanted(from, to, json)) {
        ++merged->present;
    } else {
        if (cell->status == MOTE_CELL_OK)
            status = mote_record_copy(from, to, csv);
        if (status == MOTE_OK && mote_record_exists(from, pairs)) /* more than two bodies */
            status = mote_record_copy(from, to, pairs);
        if (status == MOTE_OK)
            status = mote_record_copy(from, to, json);
        merged->copied += status == MOTE_OK ? 1 : 0;
    }
    free(json);
    free(csv);
    free(pairs);
    return status;
}

/* Adds the sessions (when and where was measured) that another manifest has and this one
   lacks. */
static mote_status add_sessions(const char *directory, json_t *here, const json_t *there)
{
    json_t *mine = json_object_get(here, "sessions");
    const json_t *sessions = json_object_get(there, "sessions");
    size_t before = json_array_size(mine);
    if (!json_is_array(mine))
        return mote_fail(MOTE_EINVAL, "%s/manifest.json: no list of sessions; remove it",
                         directory);
    for (size_t i = 0; i < json_array_size(sessions); ++i) {
        json_t *session = json_array_get(sessions, i);
        bool known = false;
        for (size_t k = 0; k < before && !known; ++k)
            known = json_equal(json_array_get(mine, k), session);
        if (!known)
            (void)json_array_append(mine, session);
    }
    if (json_array_size(mine) == before)
        return MOTE_OK;
    return mote_record_json(directory, "manifest.json", json_incref(here));
}

/* The first run's manifest becomes the directory's; the others must be from the same program,
   and add their sessions. */
static mote_status merge_manifest(const char *directory, const char *run)
{
    json_t *here = NULL, *there = NULL;
    mote_status status = mote_record_read_json(run, "manifest.json", &there);
    if (status != MOTE_OK)
        return status;
    if (!mote_record_exists(directory, "manifest.json")) {
        status = mote_record_copy(run, directory, "manifest.json");
    } else {
        status = mote_record_read_json(directory, "manifest.json", &here);
        if (status == MOTE_OK &&
            !json_equal(json_object_get(here, "program"), json_object_get(there, "program")))
            status = mote_fail(
                MOTE_EINVAL, "%s: measured by another build than %s; merge runs of one program",
                run, directory);
        if (status == MOTE_OK)
            status = add_sessions(directory, here, there);
    }
    json_decref(here);
    json_decref(there);
    return status;
}

static mote_status merge_cells(const char *directory, const char *run, mote_merged *merged)
{
    mote_stored stored;
    mote_status status = mote_stored_read(run, NULL, &stored);
    if (status != MOTE_OK)
        return status;
    char *cells = mote_format("%s/cells", directory);
    status = mote_directory_make(cells);
    if (status == MOTE_OK)
        status = merge_manifest(directory, run);
    for (size_t i = 0; i < stored.count && status == MOTE_OK; ++i)
        status = copy_cell(&stored.cells[i], run, directory, merged);
    free(cells);
    mote_stored_free(&stored);
    return status;
}

static mote_status merge_simulations(const char *directory, const char *run, bool has_cells,
                                     mote_merged *merged)
{
    mote_status status = mote_directory_make(directory);
    if (status == MOTE_OK && !has_cells)
        status = merge_manifest(directory, run);
    if (status == MOTE_OK)
        status = mote_simulations_copy(run, directory, &merged->simulations, &merged->present);
    return status;
}

mote_status mote_merge(const char *directory, const char *run, mote_merged *merged)
{
    const bool simulated = mote_simulations_exist(run);
    const bool has_cells = !simulated || mote_record_exists(run, "cells");
    mote_status status = MOTE_OK;
    if (has_cells)
        status = merge_cells(directory, run, merged);
    if (status == MOTE_OK && simulated)
        status = merge_simulations(directory, run, has_cells, merged);
    return status;
}
