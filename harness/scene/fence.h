/* Which files a scenario file may name: a scenario that somebody else wrote must not make this
   program read other files on this machine. Files that the user names on the command line are
   not checked here. */
#ifndef MOTE_HARNESS_FENCE_H
#define MOTE_HARNESS_FENCE_H

#include "core/base/status.h"

/* From now on every scenario may name files in or below this folder (mote --allow). MOTE_EIO if
   the folder cannot be found, MOTE_EINVAL after 16 of them. Not thread-safe. */
mote_status mote_fence_allow(const char *folder);

/* MOTE_EINVAL unless file is in or below the folder of the scenario file, in the datasets of
   this program, or in an allowed folder. A link inside the scenario's folder is followed, since
   the folder's owner put it there; for a path with "..", the file it resolves to counts. A file
   that does not exist is not an error here; opening it is. */
mote_status mote_fence_check(const char *scenario, const char *file);

#endif
