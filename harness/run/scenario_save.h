/* Writes a scenario that was derived from another one. */
#ifndef MOTE_HARNESS_SCENARIO_SAVE_H
#define MOTE_HARNESS_SCENARIO_SAVE_H

#include "harness/base/json_read.h"
#include "harness/scene/scenario.h"

/* Checks that the scenario is as intended. */
typedef mote_status (*mote_scenario_verify)(void *context, const mote_scenario *scenario);

/* Writes file->root, which was changed, to the path `to`, with this many significant digits;
   the rest of file belongs to the original scenario. The names of meshes are rewritten for
   their new folder (harness/scene/scenario_move.h). The text is read back before anything is
   written, and verified unless verify is NULL. An "active" interval that no longer holds is
   replaced with the longest that does, with a line on stderr; this computes the truth of every
   frame, unless there is no interval. Errors of reading and of verify; MOTE_EIO; MOTE_EINVAL if
   the text is larger than a file that is read. */
mote_status mote_scenario_save(mote_json_file *file, int digits, mote_scenario_verify verify,
                               void *context, const char *to);

#endif
