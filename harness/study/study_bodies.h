/* make bodies: several bodies by every method, over their number and density. */
#ifndef MOTE_HARNESS_STUDY_BODIES_H
#define MOTE_HARNESS_STUDY_BODIES_H

#include "core/base/status.h"

#include <stdbool.h>

/* Letters W of 11,920 triangles, 10, 100 and 1,000 of them, and 10,000 letters of 4 shapes,
   with 0.1, 1 and 4 near pairs per body, all deforming: the certified scene with and without
   threads, FCL and aabb-tree with every body or only near ones refitted, particles. A resumable
   run in directory: scenarios in directory/scenarios, cells (of pairs, only those in contact),
   summary.json; also bodies.json ({"schema": 1, "profile", "gains", "requirements", "met"}) and
   bodies.csv. Draws the figures and prints the table. *met: every requirement is met. quick:
   fewer frames per cell, about 3 minutes in all. argc, argv: the command line, for the
   manifest. */
mote_status mote_study_bodies(const char *directory, bool quick, int argc, char **argv,
                              bool *met);

#endif
