/* Deforming all vertices of a body, in the fastest form that we have: basis values tabulated
   per vertex (of a sparse field: computed, since almost all are 0), eight vertices at a time.
   Used only by methods that need every vertex. */
#ifndef MOTE_CORE_DEFORM_H
#define MOTE_CORE_DEFORM_H

#include "core/body/body.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct mote_deform mote_deform;

/* Tabulates the basis of a body's field: vertex_count * field->padded doubles, none of a sparse
   field, and no numbers at all where positions are given. The body is borrowed. Cost
   O(vertex_count * padded). */
mote_status mote_deform_create(const mote_body *body, mote_deform **deform);

/* NULL is allowed. */
void mote_deform_destroy(mote_deform *deform);

/* Writes world[vertex_count], each equal bit for bit to mote_body_position; of a body whose
   positions are given, a copy of state->vertices. No allocation. */
void mote_deform_all(const mote_deform *deform, const mote_body_state *state, mote_vec3 *world);

size_t mote_deform_bytes(const mote_deform *deform);

#ifdef __cplusplus
}
#endif
#endif
