/* Boxes added one after the other, and which of them are near another one. Each box lies in one
   cell, by its middle; cells are as large as boxes are, in powers of two. For boxes that
   overlap few others, adding and asking cost about as much however many boxes there are. */
#ifndef MOTE_HARNESS_BOX_GRID_H
#define MOTE_HARNESS_BOX_GRID_H

#include "core/certificate/scene.h"

typedef struct mote_box_grid mote_box_grid;

/* For at most count boxes, which are borrowed: box i is boxes[i], finite, and stays as it is
   once it has been added. About 60 bytes a box. */
mote_box_grid *mote_box_grid_create(const mote_scene_box *boxes, uint32_t count);
void mote_box_grid_destroy(mote_box_grid *grid); /* NULL is allowed */

/* Adds box i; each once. */
void mote_box_grid_add(mote_box_grid *grid, uint32_t i);

/* The boxes added that are at most `near` >= 0 from this one in every coordinate:
   found[*count], ascending, valid until the next call. */
const uint32_t *mote_box_grid_near(mote_box_grid *grid, const mote_scene_box *box, double near,
                                   size_t *count);

#endif
