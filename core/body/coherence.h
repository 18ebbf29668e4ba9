/* How far two bodies have moved relative to each other from one query to the next, which says
   how far the results of the last query can still be used (paper 3.5, temporal coherence). */
#ifndef MOTE_CORE_COHERENCE_H
#define MOTE_CORE_COHERENCE_H

#include "core/body/body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where positions are given, the motion of at most this many vertices stands for that of all.
 */
#define MOTE_PROBES_MAX 16

/* How one body stood at the last frame. */
typedef struct mote_stance {
    mote_vec3 *weights; /* [field->padded], in the body's axes */
    uint32_t probe[MOTE_PROBES_MAX], probe_count;
    mote_vec3 probe_local[MOTE_PROBES_MAX]; /* positions in the body's axes */
} mote_stance;

typedef struct mote_coherence {
    const mote_body *body[2];
    double length;
    bool known;         /* there has been a frame */
    mote_mat3 rotation; /* of body 1 in the axes of body 0 */
    mote_vec3 centre;   /* of body 1's box at rest, relative to that of body 0, in its axes */
    mote_stance stance[2];
} mote_coherence;

/* bodies and what they point to are borrowed. length: L of the pair. probes[b][counts[b]]:
   vertices spread over body b, copied, the first MOTE_PROBES_MAX of them. The caller frees
   *coherence, also after an error. */
mote_status mote_coherence_init(mote_coherence *coherence, const mote_body *const bodies[2],
                                double length, const uint32_t *const probes[2],
                                const uint32_t counts[2]);

void mote_coherence_free(mote_coherence *coherence);

/* Estimates how far any point of one body has moved relative to the other body since the last
   call, deformation included; L of the pair at the first call. use_given, or a body whose
   positions are given: the shape is taken from state->vertices, otherwise from the weights.
   Cost: linear in the weights or probes. */
double mote_coherence_motion(mote_coherence *coherence, const mote_frame *frame,
                             bool use_given);

#ifdef __cplusplus
}
#endif
#endif
