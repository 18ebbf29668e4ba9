/* The positions of a method's particles in the frames of a cell. Cells do not store them, so
   the method answers the same frames again, untimed; these answers must equal the stored ones
   bit for bit. */
#ifndef MOTE_HARNESS_PARTICLE_PLACES_H
#define MOTE_HARNESS_PARTICLE_PLACES_H

#include "harness/scene/scenario.h"
#include "harness/summary/stored.h"

/* If a body has more particles than this, none are shown. */
#define MOTE_PARTICLE_PLACES_MAX 64

typedef struct mote_particle_places {
    size_t rows;  /* frames, as in the cell */
    size_t count; /* largest number on a body; 0: nothing to show */
    mote_vec3
        *at; /* [rows * 2 * count], by frame, then body; x is MOTE_NONE for missing particles */
    char why[256]; /* if count is 0: the reason, "" for a method without particles */
} mote_particle_places;

/* Asks the method with this label ("particle-paper:n=3") about the first `rows` frames of the
   cell (at most all). The caller frees places->at. */
mote_status mote_particle_places_find(const mote_scenario *scenario, const char *label,
                                      const mote_stored_cell *cell, size_t rows,
                                      mote_particle_places *places);

#endif
