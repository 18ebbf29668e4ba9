#define _DEFAULT_SOURCE /* realpath */
#include "harness/scene/fence.h"

#include "harness/base/data.h"
#include "harness/base/file.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static char *allowed[MOTE_FENCE_FOLDERS_MAX]; /* without links; never freed */
static size_t allowed_count;

mote_status mote_fence_allow(const char *folder)
{
    if (allowed_count == MOTE_FENCE_FOLDERS_MAX)
        return mote_fail(MOTE_EINVAL, "%s: %d folders are allowed at most", folder,
                         MOTE_FENCE_FOLDERS_MAX);
    char *whole = realpath(folder, NULL);
    if (!whole)
        return mote_fail(MOTE_EIO, "%s: %s; name a folder to allow", folder, strerror(errno));
    allowed[allowed_count++] = whole;
    return MOTE_OK;
}

const char *mote_fence_allowed(size_t index)
{
    return index < allowed_count ? allowed[index] : NULL;
}

/* Neither path contains links. */
static bool is_below(const char *folder, const char *path)
{
    const size_t length = strlen(folder);
    return strncmp(folder, path, length) == 0 &&
           (path[length] == '/' || folder[length - 1] == '/');
}

/* Whether path, without links, lies in folder, which is freed; false if folder does not
   exist. */
static bool lies_in(char *folder, const char *path)
{
    char *whole = folder ? realpath(folder, NULL) : NULL;
    const bool lies = whole && is_below(whole, path);
    free(whole);
    free(folder);
    return lies;
}

/* Whether file, as written, starts in the scenario's folder and never goes up. */
static bool is_written_below(const char *scenario, const char *file)
{
    const char *slash = strrchr(scenario, '/');
    const size_t length = slash ? (size_t)(slash - scenario) + 1 : 0;
    return strncmp(scenario, file, length) == 0 && mote_path_goes_down(file + length);
}

static bool may_be_named(const char *scenario, const char *file, const char *without_links)
{
    const char *slash = strrchr(scenario, '/');
    if (is_written_below(scenario, file))
        return true;
    for (size_t k = 0; k < allowed_count; ++k) {
        if (is_below(allowed[k], without_links))
            return true;
    }
    return lies_in(slash ? mote_format("%.*s/", (int)(slash - scenario), scenario)
                         : mote_format("."),
                   without_links) ||
           lies_in(mote_format("%s/datasets", mote_data_directory()), without_links);
}

mote_status mote_fence_check(const char *scenario, const char *file)
{
    char *without_links = realpath(file, NULL);
    if (!without_links)
        return MOTE_OK;
    const bool may = may_be_named(scenario, file, without_links);
    free(without_links);
    return may ? MOTE_OK
               : mote_fail(MOTE_EINVAL,
                           "%s lies outside of the scenario's folder; put it there, or allow "
                           "its folder: mote --allow DIR COMMAND",
                           file);
}
