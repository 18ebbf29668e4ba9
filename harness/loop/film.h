/* An animation of a simulation: the shaded bodies, the contacts that the method reports, and
   for two bodies its particles and the closest points. A GIF, drawn by gnuplot from
   plots/simulation.gp. */
#ifndef MOTE_HARNESS_FILM_H
#define MOTE_HARNESS_FILM_H

#include "harness/loop/simulator.h"

/* The approximate number of pictures; one more is added whenever a contact is first reported,
   up to twice as many in all. */
#define MOTE_FILM_PICTURES 120u

typedef struct mote_film mote_film;

/* Films a simulation of that many steps by a method (its displayed name) into the GIF file
   path. The simulator is borrowed until the film is destroyed. Until then, geometry is stored
   in the folder path.frames, up to some 200 bytes per triangle and picture. MOTE_EINVAL of one
   body; MOTE_EIO;
   MOTE_ENOMEM for what a shape's deformation needs. */
mote_status mote_film_create(const mote_simulator *simulator, const char *method,
                             uint32_t steps, const char *path, mote_film **film);
void mote_film_destroy(mote_film *film); /* NULL is allowed */

/* A mote_simulation_watch with the film as its context. */
mote_status mote_film_watch(void *film, const mote_simulation_view *view);

/* Draws the film. MOTE_EIO if gnuplot is missing or fails. */
mote_status mote_film_draw(const mote_film *film);

#endif
