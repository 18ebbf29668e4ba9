/* Writes the files of a run's cells as they may be on a user's disk, edited or not. */
#ifndef MOTE_TESTS_STORED_CELLS_H
#define MOTE_TESTS_STORED_CELLS_H

#include "harness/base/file.h"
#include "tests/support/folder.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Every column that is read from a frame; a row is a line of these. */
#define STORED_COLUMNS                                                                         \
    "frame,deform_ns,update_ns,query_ns,truth,error,contact,contact_truth,steps\n"

/* A cell of 8 triangles and 6 vertices a body, measured over frames 1-4; NULL stands for the
   usual. */
typedef struct stored_cell {
    const char *id;                             /* METHOD-REPLICATE */
    const char *method;                         /* "fcl-aabb" */
    const char *scenario, *fingerprint, *cache; /* "s", "f", "hot" */
    int replicate;                              /* 0: 1 */
    uint64_t seed;
    const char *status;            /* "ok" */
    const char *frames;            /* JSON: "[1, 4]" */
    const char *parameters, *more; /* JSON: "{}"; keys after the others, ", \"jobs\": 2" */
    const char *rows;              /* below STORED_COLUMNS; "": none; NULL: no CSV */
} stored_cell;

/* Writes it into a run's directory, which is created. */
static inline void stored_cell_put(const char *directory, stored_cell of)
{
    const stored_cell *cell = &of;
    char path[512], id[64];
    const char *method = cell->method ? cell->method : "fcl-aabb";
    const int replicate = cell->replicate ? cell->replicate : 1;
    if (cell->id)
        (void)snprintf(id, sizeof id, "%s", cell->id);
    else
        (void)snprintf(id, sizeof id, "%s-%d", method, replicate);
    char *json = mote_format(
        "{\"id\": \"%s\", \"status\": \"%s\", \"scenario\": \"%s\", \"fingerprint\": \"%s\", "
        "\"method\": \"%s\", \"cache\": \"%s\", \"parameters\": %s, \"replicate\": %d, "
        "\"stride\": 1, \"active\": [2, 3], \"seed\": %" PRIu64 ", \"frames\": %s, "
        "\"triangles\": [8, 8], \"vertices\": [6, 6]%s}\n",
        id, cell->status ? cell->status : "ok", cell->scenario ? cell->scenario : "s",
        cell->fingerprint ? cell->fingerprint : "f", method, cell->cache ? cell->cache : "hot",
        cell->parameters ? cell->parameters : "{}", replicate, cell->seed,
        cell->frames ? cell->frames : "[1, 4]", cell->more ? cell->more : "");
    (void)snprintf(path, sizeof path, "%s/cells/%s.json", directory, id);
    file_put(path, json);
    free(json);
    if (!cell->rows)
        return;
    char *csv = mote_format("%s%s", STORED_COLUMNS, cell->rows);
    (void)snprintf(path, sizeof path, "%s/cells/%s.csv", directory, id);
    file_put(path, csv);
    free(csv);
}

#endif
