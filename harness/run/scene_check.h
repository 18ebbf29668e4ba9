/* What `mote check` reports about a scenario of more than two bodies. */
#ifndef MOTE_HARNESS_SCENE_CHECK_H
#define MOTE_HARNESS_SCENE_CHECK_H

#include "harness/run/subject.h"

typedef struct mote_scene_facts {
    double near_pairs;      /* mean per frame */
    uint64_t pair_contacts; /* near pairs in contact, over all frames */
    uint32_t contacts;      /* frames with some pair in contact */
    uint32_t checked;       /* pairs that brute force confirmed */
} mote_scene_facts;

/* Asks certified (stream, where a shape has no field) about all near pairs of every frame;
   brute force judges some of them (scene_referee.h). */
mote_status mote_scene_check(const mote_subject *subject, mote_scene_facts *facts);

#endif
