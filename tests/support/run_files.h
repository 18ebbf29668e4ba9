/* Watches the finished cells of a run directory over time: none may be lost, changed or
   damaged. */
#ifndef MOTE_TESTS_RUN_FILES_H
#define MOTE_TESTS_RUN_FILES_H

#include "harness/base/file.h"

#include <dirent.h>
#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A finished cell: its name, and both files as first seen. */
typedef struct run_file {
    char name[160]; /* of the JSON file */
    char *json, *csv;
} run_file;

typedef struct run_files {
    run_file *items;
    size_t count;
} run_files;

static inline void run_files_free(run_files *files)
{
    for (size_t i = 0; i < files->count; ++i) {
        free(files->items[i].json);
        free(files->items[i].csv);
    }
    free(files->items);
    files->items = NULL;
    files->count = 0;
}

/* How many files in directory/cells have this ending. */
static inline int run_files_count(const char *directory, const char *ending)
{
    char path[512];
    int count = 0;
    (void)snprintf(path, sizeof path, "%s/cells", directory);
    DIR *folder = opendir(path);
    if (!folder)
        return 0;
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        size_t length = strlen(entry->d_name), end = strlen(ending);
        count += length > end && strcmp(entry->d_name + length - end, ending) == 0;
    }
    (void)closedir(folder);
    return count;
}

/* Reads both files of a cell; false when one is missing. */
static inline bool run_files_read(const char *directory, const char *name, char **json,
                                  char **csv)
{
    char path[512];
    size_t size;
    *json = *csv = NULL;
    (void)snprintf(path, sizeof path, "%s/cells/%s", directory, name);
    bool there = mote_file_read(path, 1 << 26, json, &size) == MOTE_OK;
    (void)snprintf(path, sizeof path, "%s/cells/%.*s.csv", directory, (int)strlen(name) - 5,
                   name);
    return there && mote_file_read(path, 1 << 26, csv, &size) == MOTE_OK;
}

/* Whether the JSON is readable, and the CSV has a header, a row a frame and a complete last
   line. */
static inline bool run_files_whole(const char *json, const char *csv, int frames)
{
    json_t *object = json_loads(json, 0, NULL);
    bool whole = object != NULL;
    int lines = 0;
    json_decref(object);
    for (const char *c = csv; *c; ++c)
        lines += *c == '\n' ? 1 : 0;
    return whole && lines == frames + 1 && csv[strlen(csv) - 1] == '\n';
}

/* Adds a finished cell that is new. */
static inline const char *run_files_add(const char *directory, const char *name, int frames,
                                        run_files *known)
{
    for (size_t i = 0; i < known->count; ++i) {
        if (strcmp(known->items[i].name, name) == 0)
            return NULL;
    }
    run_file *items = realloc(known->items, (known->count + 1) * sizeof *items);
    if (!items)
        return "no memory";
    known->items = items;
    run_file *item = &items[known->count++];
    (void)snprintf(item->name, sizeof item->name, "%s", name);
    if (!run_files_read(directory, name, &item->json, &item->csv))
        return "a finished cell lacks a file";
    return run_files_whole(item->json, item->csv, frames) ? NULL : "a finished cell is damaged";
}

/* Compares a directory's finished cells with the known ones and adds the new ones, each of
   which must have that many frames. Returns what is wrong, or NULL. */
static inline const char *run_files_check(const char *directory, int frames, run_files *known)
{
    const char *wrong = NULL;
    for (size_t i = 0; i < known->count && !wrong; ++i) {
        char *json, *csv;
        if (!run_files_read(directory, known->items[i].name, &json, &csv))
            wrong = "a finished cell was lost";
        else if (strcmp(json, known->items[i].json) != 0 ||
                 strcmp(csv, known->items[i].csv) != 0)
            wrong = "a finished cell was changed";
        free(json);
        free(csv);
    }
    char path[512];
    (void)snprintf(path, sizeof path, "%s/cells", directory);
    DIR *folder = opendir(path);
    if (!folder)
        return wrong;
    for (const struct dirent *entry = readdir(folder); entry && !wrong;
         entry = readdir(folder)) {
        size_t length = strlen(entry->d_name);
        if (length > 5 && strcmp(entry->d_name + length - 5, ".json") == 0)
            wrong = run_files_add(directory, entry->d_name, frames, known);
    }
    (void)closedir(folder);
    return wrong;
}

#endif
