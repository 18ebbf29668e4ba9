/* The boxes of a body's groups in a frame, and of the levels above, by one pass over the
   positions. */
#ifndef MOTE_CORE_STREAM_BOXES_H
#define MOTE_CORE_STREAM_BOXES_H

#include "core/base/pool.h"
#include "core/body/positions.h"
#include "core/stream/stream_tree.h"

/* Boxes of a node's children. A lane without a child has low = infinity, high = -infinity. */
typedef struct mote_stream_block {
    float low[3][MOTE_STREAM_WIDTH], high[3][MOTE_STREAM_WIDTH];
} mote_stream_block;

typedef struct mote_stream_box {
    float low[3], high[3];
} mote_stream_box;

/* A body in a frame. Boxes hold scale * (position - origin) in world axes, each number the
   nearest float of a value that is exact to 2^-52 of itself. */
typedef struct mote_stream_body {
    const mote_stream_tree *tree; /* borrowed */
    mote_positions positions;     /* borrowed for the frame */
    mote_vec3 origin;
    double scale;              /* a power of two */
    mote_stream_block *blocks; /* of all levels, aligned to 64 */
    mote_stream_box root;
    bool placed;  /* the boxes are those of the positions */
    bool checked; /* all positions are known to be finite */
} mote_stream_body;

/* MOTE_ENOMEM. Free with mote_stream_body_free, also after a failure. */
mote_status mote_stream_body_init(mote_stream_body *body, const mote_stream_tree *tree);
void mote_stream_body_free(mote_stream_body *body);
size_t mote_stream_body_bytes(const mote_stream_body *body);

/* Whether positions can be read: MOTE_EINVAL, naming body `number`. */
mote_status mote_stream_check(const mote_positions *positions, int number);

/* Checks every position, once a frame: MOTE_EINVAL, naming the first vertex that is not
   finite. */
mote_status mote_stream_finite(mote_stream_body *body, int number);

/* Makes the boxes, by the threads of a pool (NULL: by this one) where the body is large:
   MOTE_EINVAL, as mote_stream_finite. */
mote_status mote_stream_pass(mote_stream_body *body, mote_vec3 origin, double scale,
                             mote_pool *pool, int number);

/* The box of a node. */
static inline mote_stream_box mote_stream_box_of(const mote_stream_body *body, uint32_t level,
                                                 uint32_t node)
{
    if (level == 0)
        return body->root;
    const mote_stream_block *block =
        &body->blocks[body->tree->first_block[level - 1] + node / MOTE_STREAM_WIDTH];
    mote_stream_box box;
    for (size_t k = 0; k < 3; ++k) {
        box.low[k] = block->low[k][node % MOTE_STREAM_WIDTH];
        box.high[k] = block->high[k][node % MOTE_STREAM_WIDTH];
    }
    return box;
}

/* The boxes of a node's children. */
static inline const mote_stream_block *mote_stream_children(const mote_stream_body *body,
                                                            uint32_t level, uint32_t node)
{
    return &body->blocks[body->tree->first_block[level] + node];
}

#endif
