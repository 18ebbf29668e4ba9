/* A body with given positions, as the page can show it. The page deforms by fields, so
   positions at a few key frames become a field with as many modes, whose weights change
   linearly from one to the next. */
#ifndef MOTE_HARNESS_REPLAY_KEYS_H
#define MOTE_HARNESS_REPLAY_KEYS_H

#include "harness/scene/scenario.h"

/* The largest number of coordinates in all key frames of a body: half a megabyte of the page,
   packed. */
#define MOTE_REPLAY_KEYED 300000u

/* Zero-initialise. */
typedef struct mote_replay_keys {
    mote_field *field; /* with 3 count functions; NULL: the body has its own field */
    uint32_t count;
    uint32_t *frame; /* [count], ascending, from the first frame shown to the last */
} mote_replay_keys;

/* Makes the keys of body i of a scenario over frames first .. last. Does nothing if it has a
   field. Errors of mote_scenario_frame and mote_field_create_modes. Free with
   mote_replay_keys_free. */
mote_status mote_replay_keys_make(const mote_scenario *scenario, int i, uint32_t first,
                                  uint32_t last, mote_replay_keys *keys);
void mote_replay_keys_free(mote_replay_keys *keys);

/* Computes weights[9 count] of a frame: those of function j are weights[3 j ..], in rest
   axes. */
void mote_replay_keys_weights(const mote_replay_keys *keys, uint32_t frame, double *weights);

#endif
