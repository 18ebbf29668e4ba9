#define _DEFAULT_SOURCE /* realpath */
#include "harness/scene/reach.h"

#include "harness/base/data.h"
#include "harness/base/file.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { ALLOWED_MAX = 16 };

static char *allowed[ALLOWED_MAX]; /* without links; live on */
static size_t allowed_count;

mote_status mote_reach_allow(const char *folder)
{
    if (allowed_count == ALLOWED_MAX)
        return mote_fail(MOTE_EINVAL, "%s: %d folders are allowed at most", folder,
                         ALLOWED_MAX);
    char *whole = realpath(folder, NULL);
    if (!whole)
        return mote_fail(MOTE_EIO, "%s: %s; name a folder to allow", folder, strerror(errno));
    allowed[allowed_count++] = whole;
    return MOTE_OK;
}

/* Both without links. */
static bool is_below(const char *folder, const char *path)
{
    const size_t length = strlen(folder);
    return strncmp(folder, path, length) == 0 &&
           (path[length] == '/' || folder[length - 1] == '/');
}

/* Whether path lies in folder, whose links are followed; false where it cannot be found. */
static bool lies_in(char *folder, const char *path)
{
    char *whole = folder ? realpath(folder, NULL) : NULL;
    const bool lies = whole && is_below(whole, path);
    free(whole);
    free(folder);
    return lies;
}

static bool may_be_named(const char *scenario, const char *path)
{
    const char *slash = strrchr(scenario, '/');
    for (size_t k = 0; k < allowed_count; ++k) {
        if (is_below(allowed[k], path))
            return true;
    }
    return lies_in(slash ? mote_format("%.*s/", (int)(slash - scenario), scenario)
                         : mote_format("."),
                   path) ||
           lies_in(mote_format("%s/datasets", mote_data_directory()), path);
}

mote_status mote_reach_check(const char *scenario, const char *file)
{
    char *whole = realpath(file, NULL);
    if (!whole)
        return MOTE_OK;
    const bool may = may_be_named(scenario, whole);
    free(whole);
    return may ? MOTE_OK
               : mote_fail(MOTE_EINVAL,
                           "%s lies outside of the scenario's folder; put it there, or allow "
                           "its folder: mote --allow DIR COMMAND",
                           file);
}
