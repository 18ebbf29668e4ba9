/* Which files a scenario file may name: a scenario of somebody else's must not have other files
   of this machine read. */
#ifndef MOTE_HARNESS_REACH_H
#define MOTE_HARNESS_REACH_H

#include "core/base/status.h"

/* Files in this folder and below may be named by every scenario from now on (mote --allow).
   MOTE_EIO when it cannot be found, MOTE_EINVAL when there are too many. Not for threads. */
mote_status mote_reach_allow(const char *folder);

/* MOTE_EINVAL when file lies neither in the folder of the scenario file nor below it, nor in
   the datasets of this program, nor in an allowed folder; links are followed first. What does
   not exist is left to whoever opens it. */
mote_status mote_reach_check(const char *scenario, const char *file);

#endif
