/* Boxes around bodies over pieces of their paths. Private to core/impact. */
#ifndef MOTE_CORE_IMPACT_SWEPT_H
#define MOTE_CORE_IMPACT_SWEPT_H

#include "core/certificate/scene.h"
#include "core/impact/impact_state.h"

/* The box of `count` vertices that go straight between the frames k and k + 1 of a path of
   positions. Numbers that are not finite make a box that is not. */
void mote_impact_swept_lines(const mote_path *path, uint32_t count, uint32_t k,
                             mote_scene_box *box);

/* The box of a body, of which these are the groups, over all of piece k of its path. Numbers
   that are not finite make a box that is not; no more of the path is checked. */
void mote_impact_swept_box(const mote_impact_groups *groups, const mote_body *body,
                           const mote_path *path, uint32_t k, mote_scene_box *box);

#endif
