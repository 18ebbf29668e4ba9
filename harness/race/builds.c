#include "harness/race/race.h"

#include "harness/base/memory.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void mote_race_builds_free(mote_race_builds *builds)
{
    for (size_t i = 0; i < builds->count; ++i)
        free(builds->path[i]);
    *builds = (mote_race_builds){0};
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool is_program(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode) && access(path, X_OK) == 0;
}

static mote_status find_in_folder(const char *folder, mote_race_builds *builds)
{
    DIR *entries = opendir(folder);
    if (!entries)
        return mote_fail(MOTE_EIO, "%s: cannot be read: %s", folder, strerror(errno));
    mote_status status = MOTE_OK;
    for (const struct dirent *entry; status == MOTE_OK && (entry = readdir(entries));) {
        char *path = mote_format("%s/%s", folder, entry->d_name);
        if (!is_program(path))
            free(path);
        else if (builds->count < MOTE_RACE_BUILDS)
            builds->path[builds->count++] = path;
        else {
            free(path);
            status = mote_fail(MOTE_EINVAL, "%s: more than %d programs; keep fewer", folder,
                               MOTE_RACE_BUILDS);
        }
    }
    (void)closedir(entries);
    qsort(builds->path, builds->count, sizeof builds->path[0], by_name);
    if (status == MOTE_OK && builds->count == 0)
        status = mote_fail(MOTE_EIO, "%s: no program in this folder", folder);
    return status;
}

mote_status mote_race_builds_find(const char *path, mote_race_builds *builds)
{
    struct stat info;
    mote_race_builds found = {.count = 0};
    mote_status status = MOTE_OK;
    if (stat(path, &info) != 0)
        status = mote_fail(MOTE_EIO, "%s: %s; name a program, or a folder of its builds", path,
                           strerror(errno));
    else if (S_ISDIR(info.st_mode))
        status = find_in_folder(path, &found);
    else if (!is_program(path))
        status = mote_fail(MOTE_EIO, "%s: not a program that can be run", path);
    else
        found.path[found.count++] =
            strchr(path, '/') ? mote_duplicate(path) : mote_format("./%s", path);
    if (status == MOTE_OK)
        *builds = found;
    else
        mote_race_builds_free(&found);
    return status;
}
