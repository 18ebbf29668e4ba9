/* The second half of the oracle study: whether two independent methods agree on every frame of
   the scenarios. */
#ifndef MOTE_TESTS_ORACLE_FRAMES_H
#define MOTE_TESTS_ORACLE_FRAMES_H

#include "core/base/status.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

/* Asks aabb-tree and fcl-aabb for the distance of every stride-th frame of a built-in scenario.
   Where they differ by more than agreement * L, aabb-tree with triangle distances in 113 bits
   settles the frame, and brute force as well for the first 20 such frames. *study: {"scenario",
   "frames", "difference_max" (over L), "disputed": [{"frame", "aabb_tree", "fcl_aabb",
   "settled", "brute_force"}], "aabb_tree_wrong", "fcl_aabb_wrong"}; the caller owns it. *right:
   aabb-tree was within 1e-12 L of the settled distance everywhere. */
mote_status oracle_frames(const char *scenario, uint32_t stride, double agreement,
                          json_t **study, bool *right);

#endif
