/* Where a time lies on a path. */
#ifndef MOTE_CORE_PATH_PLACE_H
#define MOTE_CORE_PATH_PLACE_H

#include "core/body/path.h"

typedef struct mote_place {
    uint32_t piece;
    double u; /* in it, 0 .. 1 */
} mote_place;

/* time: 0 .. 1; a time where two pieces meet is the start of the second. */
mote_place mote_path_place(const mote_path *path, double time);

/* At most the least length of the quaternions of a piece that does not spin; <= 0, or NaN,
   where they may pass 0. */
double mote_path_least_turn(const mote_path_piece *piece);

/* What mote_path_state sets, differentiated by the local time of the place's piece and
   multiplied by factor: with this state, mote_body_position gives the velocity of a vertex,
   times factor. Not of a body with morph targets, whose velocities have another form. */
void mote_path_velocity(const mote_path *path, const mote_body *body, mote_place at,
                        double factor, double *weights, mote_body_state *state);

/* The rotation of a piece at u in [0, 1]. */
mote_mat3 mote_path_rotation(const mote_path_piece *piece, double u);

#endif
