#define _DEFAULT_SOURCE /* dirfd, unlinkat */
#include "harness/run/sweep.h"

#include "harness/base/file.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Whether a run writes a file of this name, of so many characters, at the top of its
   directory. */
static bool is_of_run(const char *name, size_t length)
{
    static const char *const names[] = {"manifest.json", "summary.json", "summary.csv",
                                        "fronts.csv", "speed.csv"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (strlen(names[i]) == length && strncmp(name, names[i], length) == 0)
            return true;
    }
    return false;
}

static bool is_json_or_csv(const char *name, size_t length)
{
    return (length > 5 && strncmp(name + length - 5, ".json", 5) == 0) ||
           (length > 4 && strncmp(name + length - 4, ".csv", 4) == 0);
}

/* Removes the parts of files whose names are ours. */
static void sweep_folder(const char *directory, const char *name,
                         bool (*is_ours)(const char *name, size_t length))
{
    char *path = mote_format("%s/%s", directory, name);
    DIR *folder = opendir(path);
    for (const struct dirent *entry = folder ? readdir(folder) : NULL; entry;
         entry = readdir(folder)) {
        const size_t length = mote_part_length(entry->d_name);
        if (length > 0 && is_ours(entry->d_name, length))
            (void)unlinkat(dirfd(folder), entry->d_name, 0);
    }
    if (folder)
        (void)closedir(folder);
    free(path);
}

void mote_run_sweep(const char *directory)
{
    sweep_folder(directory, ".", is_of_run);
    sweep_folder(directory, "cells", is_json_or_csv);
    sweep_folder(directory, "truth", is_json_or_csv);
}
