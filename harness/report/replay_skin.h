/* The skin of a body for the page's replay, which evaluates it. */
#ifndef MOTE_HARNESS_REPLAY_SKIN_H
#define MOTE_HARNESS_REPLAY_SKIN_H

#include "harness/base/file.h"
#include "harness/scene/scenario.h"

/* Whether a body has a skin. */
bool mote_replay_has_skin(const mote_body *body);

/* Appends `"skin": {...}`: for each vertex its bones and weights, in steps of "weightStep", and
   its displacements by morph targets divided by their size, in steps of "moveStep". All are
   differences, because those of vertex numbers are small. plots/page/data.js reads it. */
void mote_replay_add_skin(mote_text *text, const mote_body *body);

/* Appends the motion of bones and targets in frames first .. last of body i: "weights", four
   vectors per bone (columns of its matrix, core/skin/skin.h), in steps of "weightStep", and
   "amounts", one number per target times its size, in steps of "amountStep", both as second
   differences. */
void mote_replay_add_skin_motion(mote_text *text, const mote_scenario *scenario, int i,
                                 uint32_t first, uint32_t last);

#endif
