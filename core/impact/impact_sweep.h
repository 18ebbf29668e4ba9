/* How long two bodies stay apart from a time on, by directions: where speeds alone would have
   the bodies collide although they pass each other.

   Over a step h from a time t, with p the position and v the velocity of a vertex at t, it is
   at p + s d + e at t + s h, 0 <= s <= 1, with d = h v and |e| <= a (s h)^2 / 2 for a bound a
   of accelerations over the step. Velocities have the form of positions: with the matrix
   [omega] R in place of R, c' in place of c, and [omega] R w + R w' in place of R w. So what
   bounds the positions in a box of the rest tree bounds the displacements d in it too, by the
   same coordinates z of the box: both are linear in z but for their residuals. Along a
   direction u the gap of two boxes at s is at least a concave function of s, less a (s h)^2 /
   2, which is concave with the minus; so it stays above the tolerance on all of [0, s] where it
   is above it at 0 and at s.

   The traversal shows this for boxes, along the line of their centres in the middle of the step
   or along the direction between the nearest points. Pairs of leaves for which it fails are
   decided triangle by triangle: conservative advancement of two triangles whose vertices move
   on p + s d, along the direction between their nearest points, each step being the root of a
   quadratic. s becomes smaller with each pair that could meet. */
#ifndef MOTE_CORE_IMPACT_SWEEP_H
#define MOTE_CORE_IMPACT_SWEEP_H

#include "core/certificate/certificate_state.h"
#include "core/impact/impact_leaf.h"

/* Leaves kept in a sweep. */
#define MOTE_SWEEP_LEAVES 32

/* The motion of a body over the step. */
typedef struct mote_sweep_side {
    mote_body_state state;    /* displacements in place of positions */
    mote_cert_side *boxes;    /* of the displacements */
    mote_cert_node *nodes;    /* [node_room] beside those of the certificate's side */
    uint64_t *stamps;         /* [node_room]: nodes of this sweep */
    mote_lazy moved;          /* displacements of vertices */
    mote_moving_leaf *leaves; /* [MOTE_SWEEP_LEAVES], each at its number modulo this */
} mote_sweep_side;

typedef struct mote_sweep {
    mote_certificate *certificate;
    mote_sweep_side side[2];
    uint64_t stamp;
    double part;                 /* s: proven so far, unless what is left says less */
    mote_leaf_question question; /* the tolerance to be kept, margins included, absolute; the
                                    bend is a h^2 / 2 */
    mote_vec3 direction;         /* of length 1, between the nearest points */
    float facing[3];             /* the same */
    float spare;                 /* of a test of boxes: its rounding, in the trees' units */
    bool failed;                 /* there was no room */
    uint64_t box_tests, triangle_tests, leaf_pairs;
} mote_sweep;

/* For the bodies of a certificate, which is borrowed. MOTE_ENOMEM. */
mote_status mote_sweep_create(mote_certificate *certificate, mote_sweep *sweep, size_t *bytes);

/* Of a sweep that is all zero, too. */
void mote_sweep_destroy(mote_sweep *sweep);

/* The part s of a step over which the bodies stay farther apart than the tolerance, from the
   moment of the certificate's last query on; 0 where nothing is shown. Both sides' states are
   set. direction: of length 1, from the first body to the second between the nearest points of
   that query; tolerance, bend: see above. No allocation. */
double mote_sweep_query(mote_sweep *sweep, mote_vec3 direction, double tolerance, double bend);

#endif
