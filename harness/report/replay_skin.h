/* The skin of a body in the page's replay, which evaluates it itself. */
#ifndef MOTE_HARNESS_REPLAY_SKIN_H
#define MOTE_HARNESS_REPLAY_SKIN_H

#include "harness/base/file.h"
#include "harness/scene/scenario.h"

/* Whether a body has a skin. */
bool mote_replay_has_skin(const mote_body *body);

/* Appends `"skin": {...}`: for each vertex its bones and weights, in steps of "weightStep", and
   its displacements by morph targets over their size, in steps of "moveStep". All are
   differences, as numbers of vertices are small. plots/page/data.js reads it. */
void mote_replay_add_skin(mote_text *text, const mote_body *body);

/* Appends what the bones and targets do in frames first .. last of body i: "weights", four
   vectors a bone (columns of its matrix, core/skin/skin.h), in steps of "weightStep", and
   "amounts", a number a target times its size, in steps of "amountStep", both as second
   differences. */
void mote_replay_add_skin_motion(mote_text *text, const mote_scenario *scenario, int i,
                                 uint32_t first, uint32_t last);

#endif
