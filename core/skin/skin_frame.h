/* The weights of a frame as the bounds of a skin need them. */
#ifndef MOTE_CORE_SKIN_FRAME_H
#define MOTE_CORE_SKIN_FRAME_H

#include "core/certificate/certificate_bounds.h"

/* Numbers of a matrix by columns. */
#define MOTE_SKIN_COLUMNS 16

/* In the tree's units, relative to the query's origin. A bone's row has four numbers, those of
   all bones are side by side. */
typedef struct mote_skin_frame {
    float hull_width;
    float *row[3]; /* [4 bones] of the bones' matrices, by coordinate */
    float *along;  /* [4 bones] the same along the plane's normal */
    float *amount; /* [targets] of morph targets, for displacements in their size */
    /* [bones][column][coordinate] the matrices again, for vertices; the fourth coordinate is 0.
       Made when the first vertex is placed (mote_skin_frame_columns). */
    float *column;
    bool has_columns;
    float numbers[];
} mote_skin_frame;

/* Of each target, kept in tree->fixed: a bound of |f| + |g_1| + |g_2| + |g_3| + |m| in any
   mote_skin_morph_row. */
typedef double mote_skin_morph_bound;

static inline const mote_skin_frame *mote_skin_frame_of(const mote_cert_side *side)
{
    return (const mote_skin_frame *)side->frame;
}

/* The columns of a side's frame. */
const float *mote_skin_frame_columns(const mote_cert_side *side);

/* mote_cert_bounds.frame_bytes, begin and face. Cost 2 ns a bone for begin, 1 for face. */
size_t mote_skin_frame_bytes(const mote_cert_tree *tree);
void mote_skin_begin(mote_cert_side *side);
void mote_skin_face(mote_cert_side *side);

#endif
