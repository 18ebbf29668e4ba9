/* Brute force over deformed meshes as the judge of what a method says about more than two
   bodies: what it answers about near pairs, and whether it has missed one. */
#ifndef MOTE_HARNESS_SCENE_REFEREE_H
#define MOTE_HARNESS_SCENE_REFEREE_H

#include "harness/run/subject.h"

/* Whether a frame is one of those that are judged: 24 evenly spread ones, or all of fewer. */
bool mote_scene_referee_wants(const mote_subject *subject, uint32_t frame);

/* Judges a frame. pairs[count]: all near pairs with their answers, ascending. Two pairs, one in
   contact and one not, where there are such, are measured by brute force; distances must agree
   to 1e-12 L, contacts exactly, except where a distance is within 1e-12 L of the tolerance. Of
   one body, every other body up to 2,000,000 vertices in total must be listed as its
   neighbour, or be farther away than the scene's `near`. Which pairs and which body depends on
   the frame's number alone. Adds to *checked the pairs measured. MOTE_ENUMERIC naming frame and
   bodies where they differ. Cost: two brute-force distances, and evaluating those vertices. */
mote_status mote_scene_referee_judge(const mote_subject *subject, uint32_t frame,
                                     const mote_body_state *states, const mote_near_pair *pairs,
                                     size_t count, uint32_t *checked);

#endif
