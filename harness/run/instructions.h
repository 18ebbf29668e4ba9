/* Instructions executed by methods, counted by valgrind's callgrind: almost the same number
   every time, however busy the machine. */
#ifndef MOTE_HARNESS_INSTRUCTIONS_H
#define MOTE_HARNESS_INSTRUCTIONS_H

#include "harness/run/plan.h"

/* Whether valgrind can be run. */
bool mote_instructions_possible(void);

/* Builds a method and runs it over frames first .. last of a scenario in this process, under
   callgrind. MOTE_EINVAL for frames that the scenario does not have, and if the method rejects
   its input. */
mote_status mote_instructions_run(const char *scenario, uint32_t first, uint32_t last,
                                  const mote_method_choice *choice);

/* Runs this program once under callgrind for each choice, and adds to
   directory/instructions.json {"schema": 1, "program", "rows": [{"scenario" (its name),
   "fingerprint", "faces", "ask", "step" (0: no impacts), "method", "label", "parameters",
   "frames": [A, B], "instructions", "per_frame"}]}; counts cover deformation, update and query;
   rows of the same configuration
   are replaced, and all rows that another build of the program counted are dropped. The file is
   written after each choice. Makes the directory. MOTE_EIO if valgrind or the program fails:
   what was counted before is kept. */
mote_status mote_instructions_count(const char *scenario, uint32_t first, uint32_t last,
                                    const mote_choices *choices, const char *directory);

#endif
