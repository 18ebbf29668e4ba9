/* A body of which only positions are known, between two of its frames: every vertex goes
   straight from where it is in the first to where it is in the second.

   It becomes a field of the certificate: with the amounts a and b of the two frames, vertex i
   is at a p_i + b q_i, so that a = 1 - u, b = u is the body at the local time u, and a = -h, b
   = h what it moves by in a step h. The boxes of a node around both frames' positions bound all
   of that: if p is in the box from l to h, and q in the one from l' to h', then a p + b q is in
   the box from a l + b l' to a h + b h' for a, b >= 0; and a displacement changes a box's
   middle and half width by what both change by in the step, even where a half width becomes
   less than before. So bounds of a moving node are linear in time, and as tight as its boxes.
 */
#ifndef MOTE_CORE_IMPACT_LINES_H
#define MOTE_CORE_IMPACT_LINES_H

#include "core/body/path.h"
#include "core/certificate/certificate_tree.h"

/* Boxes of a block's children, in the tree's units, relative to the middle of all. A lane
   without a child holds 0. */
typedef struct mote_lines_block {
    float low[3][MOTE_CERT_WIDTH], high[3][MOTE_CERT_WIDTH];
} mote_lines_block;

/* A frame of which the boxes are known. */
typedef struct mote_lines_frame {
    const mote_positions *from; /* borrowed; NULL: none yet */
    mote_positions positions;   /* what it holds */
    mote_vec3 middle;           /* of the box around all positions */
    double radius;              /* the largest coordinate from there, in the tree's units */
    double size;                /* the largest coordinate, in the world */
    mote_lines_block *blocks;   /* [block_count] */
} mote_lines_frame;

typedef struct mote_lines {
    const mote_cert_tree *tree; /* borrowed */
    mote_lines_frame frame[2];
} mote_lines;

/* Bounds of the motion in a piece. */
typedef struct mote_lines_motion {
    mote_vec3 mean; /* a vector near all displacements */
    double stray;   /* no displacement differs from it by more */
    double size;    /* the largest coordinate at either end */
} mote_lines_motion;

/* Makes the field; its lines have no tree yet. MOTE_ENOMEM. Free with mote_field_destroy. */
mote_status mote_lines_create(mote_field **field);

/* The lines of a field that was made by it. */
mote_lines *mote_lines_of(const mote_field *field);

/* Allocates the boxes for the tree of a body with the field. MOTE_ENOMEM. */
mote_status mote_lines_use(mote_lines *lines, const mote_cert_tree *tree, size_t *bytes);

/* Begins a question: forgets all boxes, since the numbers may have changed. */
void mote_lines_begin(mote_lines *lines);

/* MOTE_EINVAL, naming body `number`, the frame and the vertex, for positions that cannot be
   read, are not finite, or are 10^18 L or more from the origin. */
mote_status mote_lines_check(const mote_lines *lines, const mote_positions *positions,
                             int number, uint32_t frame);

/* As mote_path_state and mote_path_velocity, of a path of positions. Makes the boxes of frames
   that are new: O(vertices). */
void mote_lines_state(mote_lines *lines, const mote_path *path, double time, double *weights,
                      mote_body_state *state);
void mote_lines_velocity(mote_lines *lines, const mote_path *path, uint32_t piece,
                         double factor, double *weights, mote_body_state *state);

/* O(vertices). */
mote_lines_motion mote_lines_motion_of(const mote_lines *lines, const mote_path *path,
                                       uint32_t piece);

#endif
