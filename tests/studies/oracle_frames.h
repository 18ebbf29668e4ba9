/* The second half of the oracle study: whether two independent methods agree on every frame of
   the scenarios. */
#ifndef MOTE_TESTS_ORACLE_FRAMES_H
#define MOTE_TESTS_ORACLE_FRAMES_H

#include "tests/studies/oracle_methods.h"

/* Asks aabb-tree and fcl-aabb for the distance of every stride-th frame of a built-in scenario.
   Where they differ by more than agreement * L, aabb-tree with triangle distances in 113 bits
   settles the frame, and brute force as well for the first 20 such frames. *study: {"scenario",
   "frames", "difference_max" (over L), "disputed": [{"frame", "aabb_tree", "fcl_aabb",
   "settled", "brute_force"}], "aabb_tree_wrong", "fcl_aabb_wrong"}; the caller owns it. *right:
   aabb-tree was within 1e-12 L of the settled distance everywhere.

   Then judges methods by these distances, those of aabb-tree where both agree: "methods" has a
   row of each (oracle_methods.h). method_right: [methods->count], false once a method was not
   right; others stay. */
mote_status oracle_frames(const char *scenario, uint32_t stride, double agreement,
                          const oracle_methods *methods, json_t **study, bool *right,
                          bool *method_right);

#endif
