/* The last steps of projecting a block on the plane's normal and of placing its boxes, which
   are the same for all kinds of bounds. Inline, so that they are vectorised together with what
   is before them. */
#ifndef MOTE_CORE_CERTIFICATE_PROJECT_H
#define MOTE_CORE_CERTIFICATE_PROJECT_H

#include "core/base/clones.h"
#include "core/certificate/certificate_side.h"

#include <math.h>

/* A box that crosses the plane by more than this part of its extent is not worth opening, since
   most of what is inside crosses the plane too. Leaves are cheaper to open. */
#define MOTE_CERT_CROSSING 0.4F
#define MOTE_CERT_CROSSING_LEAF 0.5F
/* Looseness that is more than this part of a box's extent does not count as crossing. Measured
   on twist (14 % fewer instructions) against ww and mv (0.1 % more); docs/certified.md. */
#define MOTE_CERT_LOOSE 0.5F

MOTE_INLINE uint32_t mote_cert_bits_at_most(const float x[MOTE_CERT_WIDTH], float limit)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < MOTE_CERT_WIDTH; ++l)
        bits |= x[l] <= limit ? 1u << l : 0;
    return bits;
}

/* Writes lane l of a projected node: middle, slant and loose as they are given, and from them
   reach and extent. */
MOTE_INLINE void mote_cert_project_lane(const mote_cert_block *MOTE_RESTRICT block,
                                        mote_cert_node *MOTE_RESTRICT node, size_t l,
                                        float middle, const float axis[3], float loose)
{
    const float size0 = fabsf(axis[0]);
    const float size1 = fabsf(axis[1]);
    const float size2 = fabsf(axis[2]);
    const float empty01 = (float)mote_cert_cut_of(block->cut[0][l], axis[0], axis[1]) *
                          (size0 < size1 ? size0 : size1);
    const float empty02 = (float)mote_cert_cut_of(block->cut[1][l], axis[0], axis[2]) *
                          (size0 < size2 ? size0 : size2);
    const float empty12 = (float)mote_cert_cut_of(block->cut[2][l], axis[1], axis[2]) *
                          (size1 < size2 ? size1 : size2);
    const float empty0 = empty01 > empty02 ? empty01 : empty02;
    const float empty = (empty0 > empty12 ? empty0 : empty12) * (1.0F / 255);
    const float half = ((size0 + size1 + size2) - empty) + loose;
    node->middle[l] = middle;
    node->slant[0][l] = axis[0];
    node->slant[1][l] = axis[1];
    node->slant[2][l] = axis[2];
    node->loose[l] = loose;
    node->reach[l] = middle + half;
    node->extent[l] = 2 * half;
}

/* From reach, extent and loose of a node: clear and crossing. A box that is much larger than
   what it holds often crosses a plane that nothing inside it reaches: there, what is loose does
   not count as crossing. tight: boxes mostly fit, and what is loose counts unless it is most of
   the box. */
MOTE_INLINE void mote_cert_finish_projection(const mote_cert_side *MOTE_RESTRICT side,
                                             const mote_cert_block *MOTE_RESTRICT block,
                                             mote_cert_node *MOTE_RESTRICT node, bool tight)
{
    const float threshold = side->threshold_f;
    float excess[MOTE_CERT_WIDTH];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < MOTE_CERT_WIDTH; ++l) {
        const float twice = 2 * node->loose[l];
        const float loose = tight && twice <= MOTE_CERT_LOOSE * node->extent[l] ? 0 : twice;
        const float part =
            block->child[l] >= 0 && tight ? MOTE_CERT_CROSSING : MOTE_CERT_CROSSING_LEAF;
        excess[l] = (node->reach[l] - loose) - part * (node->extent[l] - loose);
    }
    node->clear = mote_cert_bits_at_most(node->reach, threshold) & block->mask;
    node->crossing = mote_cert_bits_at_most(excess, threshold) & block->mask & ~node->clear;
}

/* From the axes of a node: size. */
MOTE_INLINE void mote_cert_finish_boxes(mote_cert_node *MOTE_RESTRICT node)
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < MOTE_CERT_WIDTH; ++l) {
        const float ax = node->axis[0][0][l];
        const float ay = node->axis[0][1][l];
        const float az = node->axis[0][2][l];
        const float bx = node->axis[1][0][l];
        const float by = node->axis[1][1][l];
        const float bz = node->axis[1][2][l];
        node->size[l] = (ax * ax + ay * ay + az * az) + (bx * bx + by * by + bz * bz);
    }
}

#endif
