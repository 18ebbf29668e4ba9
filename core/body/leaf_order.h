/* An order of a mesh's triangles in which those of each leaf of a tree follow each other: the
   tree then needs no pointers. Triangles are halved at the middle along the longest axis, or,
   for a body with sample poses, along the direction that leaves the smallest boxes in these
   (core/body/sample_split.h). */
#ifndef MOTE_CORE_LEAF_ORDER_H
#define MOTE_CORE_LEAF_ORDER_H

#include "core/body/body.h"

/* Children of a node. */
#define MOTE_LEAF_ORDER_WIDTH 8

/* Writes order[triangle_count]: leaf i has the triangles order[i * leaf] .. order[i * leaf +
   leaf - 1], fewer in the last leaf. From the first leaf on, eight leaves in a row are a node
   of the level above, and so on up; each level is full but for its last node. leaf >= 1.
   MOTE_ENOMEM. Cost O(t log t). */
mote_status mote_leaf_order(const mote_body *body, uint32_t leaf, uint32_t *order);

#endif
