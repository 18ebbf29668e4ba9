/* Which files a scenario file may name: a scenario that somebody else wrote must not make this
   program read other files on this machine. Files that the user names on the command line are
   not checked here. */
#ifndef MOTE_HARNESS_FENCE_H
#define MOTE_HARNESS_FENCE_H

#include "core/base/status.h"

#include <stddef.h>

#define MOTE_FENCE_FOLDERS_MAX 16

/* From now on every scenario may name files in or below this folder (mote --allow). MOTE_EIO if
   the folder cannot be found, MOTE_EINVAL after MOTE_FENCE_FOLDERS_MAX of them. Not
   thread-safe. */
mote_status mote_fence_allow(const char *folder);

/* The allowed folders, by number, without links; NULL beyond the last. */
const char *mote_fence_allowed(size_t index);

/* MOTE_EINVAL unless file is in or below the folder of the scenario file, in the datasets of
   this program, or in an allowed folder. A link inside the scenario's folder is followed, since
   the folder's owner put it there; for a path with "..", the file it resolves to counts. A file
   that does not exist is not an error here; opening it is. */
mote_status mote_fence_check(const char *scenario, const char *file);

#endif
