/* A body of which only positions are given, as the page can show it: the page deforms by
   fields, and positions at a few key frames are one, of as many modes, with weights that go
   straight from one to the next. */
#ifndef MOTE_HARNESS_REPLAY_KEYS_H
#define MOTE_HARNESS_REPLAY_KEYS_H

#include "harness/scene/scenario.h"

/* Coordinates of all key frames of a body at most: half a megabyte of the page, packed. */
#define MOTE_REPLAY_KEYED 300000u

/* Zero-initialise. */
typedef struct mote_replay_keys {
    mote_field *field; /* of 3 count functions; NULL: the body has a field of its own */
    uint32_t count;
    uint32_t *frame; /* [count], ascending, from the first frame shown to the last */
} mote_replay_keys;

/* Of body i of a scenario, over frames first .. last. Does nothing where it has a field. Errors
   of mote_scenario_frame and mote_field_create_modes. Free with mote_replay_keys_free. */
mote_status mote_replay_keys_make(const mote_scenario *scenario, int i, uint32_t first,
                                  uint32_t last, mote_replay_keys *keys);
void mote_replay_keys_free(mote_replay_keys *keys);

/* weights[9 count] of a frame: those of function j are weights[3 j ..], in rest axes. */
void mote_replay_keys_weights(const mote_replay_keys *keys, uint32_t frame, double *weights);

#endif
