/* A clip that a character plays: the weights of its field over the frames of a scenario. */
#ifndef MOTE_HARNESS_PLAYER_H
#define MOTE_HARNESS_PLAYER_H

#include "core/body/body.h"
#include "harness/mesh/character.h"

/* At speed 1 a second of the clip takes so many frames. */
#define MOTE_PLAYER_RATE 60.0

/* Poses of the clip that trees are split by (core/body/body.h): as many as the prototype took,
   in which fewer were slower and more no faster. */
#define MOTE_PLAYER_SAMPLES 8

typedef struct mote_player {
    mote_character *character; /* owned; its mesh is NULL, since it is the body's */
    mote_field *field;         /* the body's, which owns it */
    uint32_t clip;             /* from 0 */
    double start;              /* of the clip at frame 1, seconds */
    double speed;
    bool loop; /* it starts again after its end; else it stays there */
    mote_weights samples[MOTE_PLAYER_SAMPLES];
    double *sample_values;
} mote_player;

/* A player that owns the character, at its first clip, with speed 1, in a loop. mesh: that of
   the character, borrowed for the call. *field is the character's skin, with its morph targets;
   owned by the caller, and kept by the player. MOTE_EINVAL where the core refuses
   it; the character is then the caller's. */
mote_status mote_player_create(mote_character *character, const mote_mesh *mesh,
                               mote_field **field, mote_player **player);
void mote_player_destroy(mote_player *player); /* NULL is allowed */

/* The weights at a frame (any real number), for a body turned so: x, y, z [field->padded]. */
void mote_player_weights(const mote_player *player, double frame, const mote_mat3 *rotation,
                         double *x, double *y, double *z);

/* Sets the samples: poses at frames spread evenly between two. */
void mote_player_sample(mote_player *player, double first, double last);

/* Frames that the whole clip takes; 1 at speed 0. */
double mote_player_frames(const mote_player *player);

#endif
