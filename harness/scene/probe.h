/* Asks one method about frames outside of a measurement: for truth, exports and single
   queries. */
#ifndef MOTE_HARNESS_PROBE_H
#define MOTE_HARNESS_PROBE_H

#include "core/method/method.h"
#include "harness/base/method_choice.h"

typedef struct mote_probe mote_probe;

/* Builds a method for a pair of bodies (borrowed). tolerance is absolute. MOTE_EUNSUPPORTED as
   the method says. */
mote_status mote_probe_create(const mote_body *a, const mote_body *b,
                              const mote_method_choice *choice, mote_ask ask, double tolerance,
                              uint64_t seed, mote_probe **probe);

/* Builds a method, given by its text, that is asked for the distance of bodies[2]. */
mote_status mote_probe_create_distance(const mote_body *bodies, const char *method,
                                       mote_probe **probe);
void mote_probe_destroy(mote_probe *probe); /* NULL is allowed */

/* Deforms what the method needs, updates it and asks it. The frame's vertices may be NULL. */
mote_status mote_probe_answer(mote_probe *probe, const mote_frame *frame, mote_answer *answer);

/* The particles of body i after the last answer: see mote_method.particles. 0 for a method
   without. */
size_t mote_probe_particles(const mote_probe *probe, int i, mote_vec3 *positions,
                            size_t capacity);

/* World vertices of body i at a frame, deformed now: valid until the next call. */
const mote_vec3 *mote_probe_vertices(mote_probe *probe, const mote_frame *frame, int i);

#endif
