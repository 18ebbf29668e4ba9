/* Rewrites a scenario file for another folder. */
#ifndef MOTE_HARNESS_SCENARIO_MOVE_H
#define MOTE_HARNESS_SCENARIO_MOVE_H

#include "harness/base/json_read.h"

/* Rewrites the names of meshes and characters in an opened scenario so that they are correct in
   a file at `to`. Meshes in the folder of `to`, or in the datasets of this program, are named
   where they are. A scenario may not name any others, so those are copied beside `to` as
   TO-body0.obj and so on; the file of a character is copied unchanged. If `to` is a stream
   (/dev/stdout), nothing is copied and the names are absolute. MOTE_EIO if a mesh is missing or
   a copy cannot be written. */
mote_status mote_scenario_move(mote_json_file *file, const char *to);

#endif
