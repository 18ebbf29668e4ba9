/* cells/ID.pairs.csv: a row for each near pair and frame of a cell of more than two bodies. */
#ifndef MOTE_HARNESS_CELL_PAIRS_H
#define MOTE_HARNESS_CELL_PAIRS_H

#include "harness/run/cell.h"

#include <stdio.h>

/* The file, written while its cell is measured. Zero-initialise. */
typedef struct mote_cell_pairs {
    FILE *file;         /* NULL: nothing is recorded */
    char *part, *name;  /* its path while being written, and its final path */
    bool contacts_only; /* only rows of pairs in contact */
} mote_cell_pairs;

/* Opens the file under a temporary name beside the final one. MOTE_EIO. */
mote_status mote_cell_pairs_open(const mote_cell *cell, const char *directory,
                                 mote_cell_pairs *pairs);

/* Adds the near pairs of a frame. Write errors are reported when the file is closed. */
void mote_cell_pairs_add(const mote_cell_pairs *pairs, uint32_t frame,
                         const mote_near_pair *list, size_t count);

/* Renames a complete file to its final name; removes an incomplete one. MOTE_EIO if writing
   failed. */
mote_status mote_cell_pairs_close(mote_cell_pairs *pairs, bool whole);

#endif
