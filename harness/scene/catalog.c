#include "harness/scene/catalog.h"

#include "harness/base/data.h"
#include "harness/base/file.h"
#include "harness/base/json_read.h"
#include "harness/base/memory.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define FOLDER "datasets/scenarios"

char *mote_catalog_path(const char *name)
{
    return mote_format("%s/%s/%s.json", mote_data_directory(), FOLDER, name);
}

static int is_scenario(const struct dirent *entry)
{
    return entry->d_name[0] != '.' && mote_name_ends(entry->d_name, ".json");
}

static mote_status read_entry(const char *file, mote_catalog_entry *entry)
{
    char *name = mote_format("%.*s", (int)(strlen(file) - 5), file);
    char *path = mote_catalog_path(name);
    mote_json_file read = {0};
    mote_status status = mote_json_open(path, &read);
    const char *purpose = json_string_value(json_object_get(read.root, "purpose"));
    if (status == MOTE_OK && !purpose)
        status = mote_fail(MOTE_EINVAL, "%s: no purpose; add a sentence", path);
    if (status == MOTE_OK)
        entry->purpose = mote_duplicate(purpose);
    entry->several = json_is_object(json_object_get(read.root, "bodies"));
    mote_json_close(&read);
    free(path);
    if (status == MOTE_OK)
        entry->name = name;
    else
        free(name);
    return status;
}

mote_status mote_catalog_read(mote_catalog *catalog)
{
    struct dirent **files;
    char *folder = mote_format("%s/%s", mote_data_directory(), FOLDER);
    int count = scandir(folder, &files, is_scenario, alphasort);
    mote_status status =
        count < 0 ? mote_fail(MOTE_EIO, "%s: %s", folder, strerror(errno)) : MOTE_OK;
    free(folder);
    if (count < 0)
        return status;
    mote_catalog read = {.entries = mote_allocate((size_t)count, sizeof *read.entries)};
    for (int i = 0; i < count; ++i) {
        if (status == MOTE_OK)
            status = read_entry(files[i]->d_name, &read.entries[read.count]);
        if (status == MOTE_OK)
            ++read.count;
        free(files[i]);
    }
    free(files);
    if (status == MOTE_OK)
        *catalog = read;
    else
        mote_catalog_free(&read);
    return status;
}

void mote_catalog_free(mote_catalog *catalog)
{
    for (size_t i = 0; i < catalog->count; ++i) {
        free(catalog->entries[i].name);
        free(catalog->entries[i].purpose);
    }
    free(catalog->entries);
    catalog->entries = NULL;
    catalog->count = 0;
}
