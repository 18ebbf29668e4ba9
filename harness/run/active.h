/* The active interval of a scenario: the frames in which its bodies are close. */
#ifndef MOTE_HARNESS_ACTIVE_H
#define MOTE_HARNESS_ACTIVE_H

#include "harness/run/truth.h"

#define MOTE_ACTIVE_NEAR 0.1  /* in L: a frame with this distance or less is near */
#define MOTE_ACTIVE_SHARE 0.9 /* at least this share of an active interval's frames is near */

/* How many frames of the interval are near. */
uint32_t mote_active_near(const mote_scenario *scenario, const mote_truth *truth,
                          mote_interval interval);

/* Whether the interval is active; an empty interval (0, 0) counts as active. */
bool mote_active_holds(const mote_scenario *scenario, const mote_truth *truth,
                       mote_interval interval);

/* The longest active interval, the first one on a tie; 0, 0 if no frame is near. O(frames^2)
   additions at worst. */
mote_interval mote_active_longest(const mote_scenario *scenario, const mote_truth *truth);

#endif
