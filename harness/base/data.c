#include "harness/base/data.h"

#include "harness/base/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define INSTALLED "/../share/mote"

const char *mote_data_directory(void)
{
    static char directory[4096];
    if (directory[0] != '\0')
        return directory;
    char path[sizeof directory];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - sizeof INSTALLED - 16);
    path[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(path, '/');
    if (slash) {
        memcpy(slash, INSTALLED "/datasets", sizeof INSTALLED "/datasets");
        if (access(path, R_OK) == 0)
            (void)snprintf(directory, sizeof directory, "%.*s%s", (int)(slash - path), path,
                           INSTALLED);
    }
    if (directory[0] == '\0')
        (void)snprintf(directory, sizeof directory, "%s", MOTE_SOURCE_DIR);
    return directory;
}

mote_status mote_data_read(const char *name, size_t limit, char **text, size_t *size)
{
    char *path = mote_format("%s/%s", mote_data_directory(), name);
    mote_status status = mote_file_read(path, limit, text, size);
    free(path);
    return status;
}
