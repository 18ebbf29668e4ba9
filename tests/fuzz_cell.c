/* Any text as the two files of a cell, the JSON up to a line of "====" and the CSV behind it,
   up to the summary of a run that holds it. */
#include "harness/summary.h"
#include "tests/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* In memory where there is such a place: on a disk most of the time would be waiting. */
static char folder[] = "/dev/shm/mote-fuzz-XXXXXX";

static void clean_up(void)
{
    char path[128];
    static const char *const names[] = {"cells/fuzz.json", "cells/fuzz.csv"};
    for (int k = 0; k < 2; ++k) {
        (void)snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        (void)remove(path);
    }
    (void)snprintf(path, sizeof path, "%s/cells", folder);
    (void)rmdir(path);
    (void)rmdir(folder);
}

static void make_folder(void)
{
    char path[128];
    if (access("/dev/shm", W_OK) != 0)
        strcpy(folder, "/tmp/mote-fuzz-XXXXXX");
    if (!mkdtemp(folder))
        abort();
    (void)snprintf(path, sizeof path, "%s/cells", folder);
    if (mkdir(path, 0700) != 0 || atexit(clean_up) != 0)
        abort();
}

static void write_file(const char *name, const uint8_t *data, size_t size)
{
    char path[128];
    (void)snprintf(path, sizeof path, "%s/cells/%s", folder, name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static bool made;
    static const char between[] = "\n====\n";
    const size_t length = sizeof between - 1;
    if (!made)
        make_folder();
    made = true;
    size_t cut = 0;
    while (cut + length <= size && memcmp(data + cut, between, length) != 0)
        ++cut;
    const bool both = cut + length <= size;
    write_file("fuzz.json", data, both ? cut : size);
    write_file("fuzz.csv", data + (both ? cut + length : 0), both ? size - cut - length : 0);
    mote_summary summary;
    if (mote_summary_make(folder, &summary) == MOTE_OK) {
        json_decref(mote_summary_json(&summary));
        mote_summary_free(&summary);
    }
    return 0;
}
