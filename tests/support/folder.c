#define _XOPEN_SOURCE 700 /* nftw, mkdtemp */
#include "tests/support/folder.h"

#include "harness/base/file.h"
#include "tests/support/plain_file.h"
#include "tests/support/test.h"

#include <dirent.h>
#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[128];

bool folder_enter(const char *program)
{
    (void)snprintf(folder, sizeof folder, "/tmp/mote-%s-XXXXXX", program);
    if (mkdtemp(folder) && chdir(folder) == 0)
        return true;
    (void)fprintf(stderr, "%s: %s\n", folder, strerror(errno));
    return false;
}

const char *folder_path(void)
{
    return folder;
}

bool folder_leave(void)
{
    if (chdir("/") == 0 && folder_remove(folder) == 0)
        return true;
    (void)fprintf(stderr, "%s: %s\n", folder, strerror(errno));
    return false;
}

int folder_next(void)
{
    static int number;
    char name[16];
    (void)snprintf(name, sizeof name, "%d", ++number);
    return chdir(folder) || mkdir(name, 0777) || chdir(name);
}

int folder_count(const char *path, const char *ending)
{
    DIR *entries = opendir(path);
    int count = 0;
    for (const struct dirent *entry = entries ? readdir(entries) : NULL; entry;
         entry = readdir(entries)) {
        const size_t length = strlen(entry->d_name), end = strlen(ending);
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 &&
                 length >= end && strcmp(entry->d_name + length - end, ending) == 0;
    }
    if (entries)
        (void)closedir(entries);
    return count;
}

static int remove_one(const char *path, const struct stat *info, int type, struct FTW *place)
{
    (void)info, (void)type, (void)place;
    return remove(path);
}

int folder_remove(const char *path)
{
    return nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

bool file_exists(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0;
}

void file_put(const char *path, const char *text)
{
    file_write(path, text, strlen(text));
}

void file_write(const char *path, const void *data, size_t size)
{
    const char *slash = strrchr(path, '/');
    if (slash && slash > path) {
        char above[256];
        (void)snprintf(above, sizeof above, "%.*s", (int)(slash - path), path);
        (void)mote_directory_make(above);
    }
    const bool written = plain_file_write(path, data, size);
    if (!written)
        print_error("%s: cannot be written\n", path);
    assert_true(written);
}

char *file_text(const char *path)
{
    char *text = NULL;
    size_t size;
    const bool read = mote_file_read(path, 64 << 20, &text, &size) == MOTE_OK;
    if (!read)
        print_error("%s\n", mote_error_text());
    assert_true(read);
    return text;
}
