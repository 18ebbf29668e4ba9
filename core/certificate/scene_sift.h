/* Which pairs of a scene's bodies may be near, by the outlines of the bodies. */
#ifndef MOTE_CORE_SCENE_SIFT_H
#define MOTE_CORE_SCENE_SIFT_H

#include "core/base/pool.h"
#include "core/certificate/certificate_outline.h"

/* What a scene lends to a sift. */
typedef struct mote_sift_scene {
    mote_pool *pool;
    mote_certificate *const *workspaces; /* one for each thread of the pool */
    mote_cert_tree *const *trees;        /* of one scale */
    const uint32_t *shape_of;            /* [body_count], indices of trees */
    uint32_t body_count;
    const mote_body_state *states; /* [body_count] */
} mote_sift_scene;

/* Zero-initialise. */
typedef struct mote_sift {
    mote_cert_outline *outlines; /* [outline_room] */
    uint32_t *bodies;            /* [outline_room] of outlines */
    uint32_t *outline_of;        /* [body_count] */
    uint32_t outline_room;
    uint32_t (*pairs)[2]; /* [pair_room] that may be near */
    bool *near;           /* [pair_room] of the pairs asked about */
    size_t pair_room, count;
} mote_sift;

void mote_sift_free(mote_sift *sift);

size_t mote_sift_bytes(const mote_sift *sift, uint32_t body_count);

/* Sets sift->pairs[sift->count] to those of pairs[count] (of bodies that exist) that are not
   shown to be more than `near` >= 0 apart, in the same order. MOTE_ENOMEM. Allocates only when
   there are more pairs, or bodies in pairs, than ever before. */
mote_status mote_sift_pairs(mote_sift *sift, const mote_sift_scene *scene, double near,
                            const uint32_t (*pairs)[2], size_t count);

#endif
