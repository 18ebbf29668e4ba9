#include "harness/scene/catalog.h"

#include "harness/base/data.h"
#include "harness/base/file.h"
#include "harness/base/json_read.h"
#include "harness/base/memory.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define FOLDER "datasets/scenarios"

/* The scenario files below FOLDER, sorted by their names without folders. */
typedef struct listing {
    char **paths;
    size_t count, capacity;
} listing;

static const char *file_name(const char *path)
{
    return strrchr(path, '/') + 1;
}

static int by_file_name(const void *a, const void *b)
{
    return strcmp(file_name(*(char *const *)a), file_name(*(char *const *)b));
}

static bool is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

/* deeper: the folders in this one too. */
static mote_status list_folder(const char *folder, bool deeper, listing *files)
{
    struct dirent **entries;
    const int count = scandir(folder, &entries, is_visible, alphasort);
    if (count < 0)
        return mote_fail(MOTE_EIO, "%s: %s", folder, strerror(errno));
    mote_status status = MOTE_OK;
    for (int i = 0; i < count; ++i) {
        char *path = mote_format("%s/%s", folder, entries[i]->d_name);
        if (mote_name_ends(entries[i]->d_name, ".json")) {
            files->paths = mote_reserve(files->paths, files->count + 1, &files->capacity,
                                        sizeof *files->paths);
            files->paths[files->count++] = path;
        } else {
            if (status == MOTE_OK && deeper && is_folder(path))
                status = list_folder(path, false, files);
            free(path);
        }
        free(entries[i]);
    }
    free(entries);
    return status;
}

static void free_listing(listing *files)
{
    for (size_t i = 0; i < files->count; ++i)
        free(files->paths[i]);
    free(files->paths);
}

/* A name is given once, in whatever folder. */
static mote_status list_files(listing *files)
{
    char *folder = mote_format("%s/%s", mote_data_directory(), FOLDER);
    mote_status status = list_folder(folder, true, files);
    free(folder);
    if (files->count)
        qsort(files->paths, files->count, sizeof *files->paths, by_file_name);
    for (size_t i = 1; i < files->count && status == MOTE_OK; ++i) {
        if (by_file_name(&files->paths[i - 1], &files->paths[i]) == 0)
            status = mote_fail(MOTE_EINVAL, "%s: %s has the same name; rename one of the two",
                               files->paths[i], files->paths[i - 1]);
    }
    return status;
}

char *mote_catalog_path(const char *name)
{
    char *file = mote_format("%s.json", name);
    char *path = NULL;
    listing files = {0};
    if (list_files(&files) == MOTE_OK) {
        for (size_t i = 0; i < files.count && !path; ++i) {
            if (strcmp(file_name(files.paths[i]), file) == 0)
                path = mote_duplicate(files.paths[i]);
        }
    }
    free_listing(&files);
    if (!path)
        path = mote_format("%s/%s/%s", mote_data_directory(), FOLDER, file);
    free(file);
    return path;
}

static mote_status read_entry(const char *path, mote_catalog_entry *entry)
{
    mote_json_file read = {0};
    mote_status status = mote_json_open(path, &read);
    const char *purpose = json_string_value(json_object_get(read.root, "purpose"));
    if (status == MOTE_OK && !purpose)
        status = mote_fail(MOTE_EINVAL, "%s: no purpose; add a sentence", path);
    if (status == MOTE_OK) {
        const char *name = file_name(path);
        entry->name = mote_format("%.*s", (int)(strlen(name) - strlen(".json")), name);
        entry->purpose = mote_duplicate(purpose);
        entry->several = json_is_object(json_object_get(read.root, "bodies"));
    }
    mote_json_close(&read);
    return status;
}

mote_status mote_catalog_read(mote_catalog *catalog)
{
    listing files = {0};
    mote_catalog read = {0};
    mote_status status = list_files(&files);
    read.entries = mote_allocate(files.count, sizeof *read.entries);
    while (status == MOTE_OK && read.count < files.count) {
        status = read_entry(files.paths[read.count], &read.entries[read.count]);
        read.count += status == MOTE_OK;
    }
    free_listing(&files);
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
