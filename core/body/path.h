/* How a body moves and deforms between two moments: a path over the time 0 .. 1.

   The path is made of pieces of equal length, one after the other: piece k of n lasts from k /
   n to (k + 1) / n. In a piece with the local time u in [0, 1],

       vertex i is at  R(u) (x_i - pivot + sum over j of phi_j(x_i) w_j(u)) + c(u),

   where c, the place of the pivot, and the weights w_j, in the body's own axes, are cubic
   polynomials, and the rotation R either turns about one axis with constant angular velocity,
   by any number of turns, or is that of a cubic quaternion. Cubics are given by their four
   control points b (Bezier, Bernstein): (1-u)^3 b_0 + 3 u (1-u)^2 b_1 + 3 u^2 (1-u) b_2 + u^3
   b_3. Its derivative then lies within the hull of 3 (b_{i+1} - b_i), from which speeds are
   bounded.

   Of a body of which only positions are known (mote_body_is_given), the path is made of where
   its vertices are at the times 0, 1 / n, .. 1: in piece k every vertex goes straight, at
   constant speed, from where it is in frame k to where it is in frame k + 1. */
#ifndef MOTE_CORE_PATH_H
#define MOTE_CORE_PATH_H

#include "core/base/quaternion.h"
#include "core/body/body.h"
#include "core/body/positions.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* A body that spins turns by at most this in a piece, in radians. */
#define MOTE_PATH_SPIN_MAX 1e6

typedef struct mote_path_piece {
    mote_vec3 centre[4];     /* control points of where the pivot is, in the world */
    bool spins;              /* true: constant angular velocity; false: cubic quaternions */
    mote_quaternion turn[4]; /* control points of the rotation, not 0 anywhere between them; of
                                a piece that spins the first is its rotation at the start, of
                                length 1, and the others are not read */
    mote_vec3 spin;          /* of a piece that spins: the whole turn, in radians, as a vector
                                along its axis in the world, right-handed */
    const double *weights;   /* [4][3][padded] control points, coordinate by coordinate, in the
                                body's axes, 0 in the padding; NULL: all 0. With morph targets
                                as mote_morph_weights writes them for an identity rotation */
} mote_path_piece;

typedef struct mote_path {
    mote_vec3 pivot;               /* a rest point */
    const mote_path_piece *pieces; /* [count], each beginning where the one before ends */
    uint32_t count;                /* >= 1 */
    /* [count + 1], of a body of which only positions are known: of all of its vertices, in the
       world. Pivot and pieces are then not looked at. Else NULL. */
    const mote_positions *positions;
} mote_path;

/* Control points of a straight line from a to b at constant speed, in numbers of any kind. */
void mote_path_line(mote_vec3 a, mote_vec3 b, mote_vec3 control[4]);

/* Control points of the cubic that begins at a with the derivative da, for the piece's local
   time, and ends at b with db. */
void mote_path_hermite(mote_vec3 a, mote_vec3 da, mote_vec3 b, mote_vec3 db,
                       mote_vec3 control[4]);

/* Pose and weights at a time in [0, 1]. weights[3 * field->padded] holds what state->weights
   then refers to; NULL where padded is 0. All of the state is set; its positions are NULL, and
   everything counts as changed. Not of a path of positions. No allocation. Cost O(J). */
void mote_path_state(const mote_path *path, const mote_body *body, double time, double *weights,
                     mote_body_state *state);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
