/* How a body is placed and deformed in many frames, as plain arrays of numbers: for callers
   that have arrays and not the structs of body.h, such as other languages. */
#ifndef MOTE_CORE_CONTROLS_H
#define MOTE_CORE_CONTROLS_H

#include "core/body/body.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* The poses and weights of a body. Each array begins with the first frame's numbers; a step is
   how many numbers further those of the next frame are, and 0 where all frames have the same.
   Every member is 8 bytes long. */
typedef struct mote_controls {
    /* Rows of (rotation | translation), 4 numbers each; NULL: the body is where its mesh is. */
    const double *pose;
    /* In the body's axes, so that they turn with it; NULL: at rest. Of linear modes one number
       a mode; of skins a matrix of 3 rows of 4 numbers a bone, as mote_skin_weights takes them;
       of every other kind x, y, z of one weight vector a basis function. */
    const double *weights;
    const double *amounts; /* of morph targets, one each; NULL: all are 0 */
    size_t pose_step, weights_step, amounts_step;
    size_t pose_rows; /* 3, or 4 where the last row is 0 0 0 1 */
} mote_controls;

/* The number of weights in one frame; 0 for a field without weights. */
size_t mote_controls_weights(const mote_field *field);

/* How many morph targets a field has; 0 for a field that is no skin. */
size_t mote_controls_amounts(const mote_field *field);

/* Makes a body's state in a frame, counted from 0. length > 0: L of the pair or scene. room [3
   * field->padded] is for the state's weights, which are borrowed from it; padding is written
   too. MOTE_EINVAL, saying which of pose, weights and amounts is wrong: a number that is not
   finite, a matrix that is no rotation (rows orthonormal to 1e-6, determinant positive), a last
   row other than 0 0 0 1, a number of rows other than 3 and 4; where double precision has lost
   the shape, which is a translation or weight beyond 2^50 L, a weight of a linear mode or an
   amount that times the mode's or target's largest displacement is beyond 2^50 L, a number of a
   bone's matrix beyond 2^50 and 2^50 L, and an amount beyond 2^50; or numbers that leave the
   range of doubles times what they move. No allocation. Cost O(weights). */
mote_status mote_controls_read(const mote_body *body, const mote_controls *controls,
                               size_t frame, double length, double *room,
                               mote_body_state *state);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
