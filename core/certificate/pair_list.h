/* What scenes of several bodies have in common, whatever answers for their pairs: the near
   pairs of a step, and what each keeps for its next query. */
#ifndef MOTE_CORE_PAIR_LIST_H
#define MOTE_CORE_PAIR_LIST_H

#include "core/certificate/scene.h"

/* Checks what a scene is made of: MOTE_EINVAL without a shape or body, for a shape that does
   not exist, for options out of range. */
mote_status mote_scene_refuse_bad(uint32_t shape_count, const uint32_t *shape_of,
                                  uint32_t body_count, const mote_scene_options *options);

/* Zero-initialise, with memory_size set. */
typedef struct mote_pair_list {
    mote_scene_pair *pairs; /* [count] */
    char *memories;         /* [count][memory_size]; all zeros before a pair's first query */
    size_t memory_size, count, room;
} mote_pair_list;

void mote_pair_list_free(mote_pair_list *list);

size_t mote_pair_list_bytes(const mote_pair_list *list);

/* MOTE_EINVAL, naming the pair, unless i < j < bodies in each, ascending by i, then j, each
 * once.
 */
mote_status mote_pair_list_check(const uint32_t (*pairs)[2], size_t count, uint32_t bodies);

/* Makes pairs[count] those of `now`: each with its memory from the step before, if it was near
   then, and the number of steps for which it has been near; `before` is room for the next step.
   MOTE_EINVAL as mote_pair_list_check; MOTE_ENOMEM. Then both lists are as they were. Allocates
   only when there are more pairs than ever before. */
mote_status mote_pair_list_renew(mote_pair_list *now, mote_pair_list *before,
                                 const uint32_t (*pairs)[2], size_t count, uint32_t bodies);

#endif
