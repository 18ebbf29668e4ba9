/* Finds which of many boxes are near each other, with FCL's dynamic AABB tree. */
#ifndef MOTE_BASELINES_BROAD_PHASE_H
#define MOTE_BASELINES_BROAD_PHASE_H

#include "core/certificate/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct mote_broad_phase mote_broad_phase;

/* For body_count boxes, at least 1. MOTE_EINVAL, MOTE_ENOMEM. About 400 bytes a body. */
mote_status mote_broad_phase_create(uint32_t body_count, mote_broad_phase **broad_phase);

/* NULL is allowed. */
void mote_broad_phase_destroy(mote_broad_phase *broad_phase);

/* The pairs of boxes[body_count], finite, that are at most `near` >= 0 (absolute) apart in
   every coordinate: *pairs[*count], i < j, ascending, each once, valid until the next call. The
   tree of the last call is updated. MOTE_EINVAL for a box that is not finite or is
   inside out, MOTE_ENOMEM. */
mote_status mote_broad_phase_pairs(mote_broad_phase *broad_phase, const mote_scene_box *boxes,
                                   double near, const uint32_t (**pairs)[2], size_t *count);

#ifdef __cplusplus
}
#endif
#endif
