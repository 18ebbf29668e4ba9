/* A character playing a clip: the weights of its field over the frames of a scenario. */
#ifndef MOTE_HARNESS_PLAYER_H
#define MOTE_HARNESS_PLAYER_H

#include "core/body/body.h"
#include "harness/mesh/character.h"

/* At speed 1, a second of the clip takes this many frames. */
#define MOTE_PLAYER_RATE 60.0

/* Poses of the clip that trees are split by (core/body/body.h). The prototype used as many:
   fewer were slower, more were no faster. */
#define MOTE_PLAYER_SAMPLES 8

typedef struct mote_player {
    mote_character *character; /* owned; its mesh is NULL because the body has it */
    mote_field *field;         /* the body's, which owns it */
    uint32_t clip;             /* from 0 */
    double start;              /* time in the clip at frame 1, seconds */
    double speed;
    bool loop; /* whether it restarts after its end; otherwise it stays there */
    mote_weights samples[MOTE_PLAYER_SAMPLES];
    double *sample_values;
} mote_player;

/* Makes a player that owns the character, at its first clip, with speed 1, looping. mesh: the
   character's, borrowed for the call. *field is the character's skin with its morph targets;
   the caller owns it, and the player refers to it. MOTE_EINVAL if the core refuses the field;
   the caller then still owns the character. */
mote_status mote_player_create(mote_character *character, const mote_mesh *mesh,
                               mote_field **field, mote_player **player);
void mote_player_destroy(mote_player *player); /* NULL is allowed */

/* The weights at a frame (any real number) for a body with this rotation: x, y, z
   [field->padded]. */
void mote_player_weights(const mote_player *player, double frame, const mote_mat3 *rotation,
                         double *x, double *y, double *z);

/* Sets the samples: poses at frames spread evenly from first to last. */
void mote_player_sample(mote_player *player, double first, double last);

/* The number of frames that the whole clip takes; 1 at speed 0. */
double mote_player_frames(const mote_player *player);

#endif
