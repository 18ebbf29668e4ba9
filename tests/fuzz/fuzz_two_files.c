#include "tests/fuzz/fuzz.h"

#include "tests/support/plain_file.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* In memory where possible: on a disk most of the time would be spent waiting. */
static char folder[] = "/dev/shm/mote-fuzz-XXXXXX";
static char paths[2][128];

/* The folder of a file if it lies below the one made here, or NULL. */
static const char *folder_of(const char *path, char *text, size_t size)
{
    (void)snprintf(text, size, "%s", path);
    *strrchr(text, '/') = '\0';
    return strcmp(text, folder) == 0 ? NULL : text;
}

static void clean_up(void)
{
    char text[128];
    for (int k = 0; k < 2; ++k)
        (void)remove(paths[k]);
    const char *below = folder_of(paths[0], text, sizeof text);
    if (below)
        (void)rmdir(below);
    (void)rmdir(folder);
}

static void make_folder(const char *const names[2])
{
    char text[128];
    if (access("/dev/shm", W_OK) != 0)
        strcpy(folder, "/tmp/mote-fuzz-XXXXXX");
    if (!mkdtemp(folder))
        abort();
    for (int k = 0; k < 2; ++k)
        (void)snprintf(paths[k], sizeof paths[k], "%s/%s", folder, names[k]);
    const char *below = folder_of(paths[0], text, sizeof text);
    if ((below && mkdir(below, 0700) != 0) || atexit(clean_up) != 0)
        abort();
}

const char *fuzz_two_files(const uint8_t *data, size_t size, const char *const names[2])
{
    static const char between[] = "\n====\n";
    const size_t length = sizeof between - 1;
    if (!paths[0][0])
        make_folder(names);
    size_t cut = 0;
    while (cut + length <= size && memcmp(data + cut, between, length) != 0)
        ++cut;
    const bool both = cut + length <= size;
    const size_t behind = both ? cut + length : size;
    if (!plain_file_write(paths[0], data, both ? cut : size) ||
        !plain_file_write(paths[1], data + behind, size - behind))
        abort();
    return folder;
}
