/* The places of a method's particles in the frames of a cell. Cells do not store them, so
   the method answers the same frames once more, untimed, and these answers are checked to be
   the stored ones, to the bit. */
#ifndef MOTE_HARNESS_PARTICLE_PLACES_H
#define MOTE_HARNESS_PARTICLE_PLACES_H

#include "harness/scene/scenario.h"
#include "harness/summary/stored.h"

/* More particles than this on a body are not shown. */
#define MOTE_PARTICLE_PLACES_MAX 64

typedef struct mote_particle_places {
    size_t rows;  /* frames, as the cell has them */
    size_t count; /* the most on a body; 0: there is nothing to show */
    mote_vec3
        *at; /* [rows * 2 * count], by frame, then body; x MOTE_NONE where a body has fewer */
    char why[256]; /* where count is 0: the reason, "" for a method without particles */
} mote_particle_places;

/* Asks the method of this label ("particle-paper:n=3") the first `rows` frames of the cell, at
   most all of them. The caller frees places->at. */
mote_status mote_particle_places_find(const mote_scenario *scenario, const char *label,
                                      const mote_stored_cell *cell, size_t rows,
                                      mote_particle_places *places);

#endif
