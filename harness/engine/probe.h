/* Bodies whose places are looked for: boxes around them, and whether two are too near. Asked of
   the certified scene, or, where a shape has no field, of the streamed one. */
#ifndef MOTE_HARNESS_PROBE_H
#define MOTE_HARNESS_PROBE_H

#include "core/certificate/scene.h"
#include "harness/engine/engine.h"

typedef struct mote_probe mote_probe;

/* clearance: absolute; pairs at most this far apart are too near. Of setup, only the bodies are
   looked at, and borrowed. Errors of mote_scene_create and mote_stream_scene_create. */
mote_status mote_probe_create(const mote_engine_setup *setup, double clearance,
                              mote_probe **probe);
void mote_probe_destroy(mote_probe *probe); /* NULL is allowed */

/* Boxes around all bodies: boxes[count]. states[count]: as for mote_engine_show. */
mote_status mote_probe_all(mote_probe *probe, const mote_body_state *states,
                           mote_scene_box *boxes);

/* The same for body i, if only that one has moved since. boxes[count]: only [i] changes. */
mote_status mote_probe_one(mote_probe *probe, const mote_body_state *states, uint32_t i,
                           mote_scene_box *boxes);

/* Whether bodies i < j, of which boxes have been made as they are, are too near; *distance is
   then at most the clearance and at least theirs. */
mote_status mote_probe_pair(mote_probe *probe, const mote_body_state *states, uint32_t i,
                            uint32_t j, bool *too_near, double *distance);

#endif
