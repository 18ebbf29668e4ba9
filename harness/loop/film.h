/* An animation of a simulation: the bodies lit, where the method reports a contact, and of two
   bodies its particles and the closest points. A GIF, drawn by gnuplot from
   plots/simulation.gp. */
#ifndef MOTE_HARNESS_FILM_H
#define MOTE_HARNESS_FILM_H

#include "harness/loop/simulator.h"

/* About how many pictures there are; one more is added wherever a contact is first reported,
   up to twice as many in all. */
#define MOTE_FILM_PICTURES 120u

typedef struct mote_film mote_film;

/* For a simulation of that many steps by a method (its name as shown), into the GIF file
   path. The simulator is borrowed until the film is destroyed. Geometry is kept in the
   folder path.frames, up to some 200 bytes a triangle and picture, until then. MOTE_EIO;
   MOTE_ENOMEM for what a shape's deformation needs. */
mote_status mote_film_create(const mote_simulator *simulator, const char *method,
                             uint32_t steps, const char *path, mote_film **film);
void mote_film_destroy(mote_film *film); /* NULL is allowed */

/* A mote_simulation_watch: the film is its context. */
mote_status mote_film_watch(void *film, const mote_simulation_view *view);

/* Draws it. MOTE_EIO when gnuplot is missing or refuses. */
mote_status mote_film_draw(const mote_film *film);

#endif
