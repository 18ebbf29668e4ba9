/* What is measured: a scenario of two bodies or of more, with its fingerprint and truth. */
#ifndef MOTE_HARNESS_SUBJECT_H
#define MOTE_HARNESS_SUBJECT_H

#include "harness/engine/engine.h"
#include "harness/run/truth.h"
#include "harness/scene/bodies.h"

/* Zero-initialise. */
typedef struct mote_subject {
    mote_scenario *scenario; /* of two bodies; NULL where bodies is set */
    mote_bodies *bodies;     /* of more than two; NULL where scenario is set */
    uint64_t fingerprint;
    mote_truth
        *truth; /* of two bodies, NULL until something is measured; of more there is none:
                   contacts are compared with those of an exact method of the run */
} mote_subject;

/* Loads a scenario of two bodies or of more (as mote_scenario_load and mote_bodies_load take
   it); computes the fingerprint of one, which looks at its frames; does both. Free with
   mote_subject_free also after a failure. */
mote_status mote_subject_open(const char *name_or_path, mote_subject *subject);
mote_status mote_subject_identify(mote_subject *subject);
mote_status mote_subject_load(const char *name_or_path, mote_subject *subject);
void mote_subject_free(mote_subject *subject);

/* What scenarios of two bodies and of more have in common. */
typedef struct mote_subject_facts {
    const char *name;
    uint32_t bodies; /* 2 or more */
    uint32_t frames;
    mote_ask ask;
    double tolerance, length; /* absolute */
    mote_interval active;     /* 0, 0: the scenario names none */
    uint32_t triangles[2];    /* of each of two bodies; of the smallest and the largest shape */
    uint32_t vertices[2];     /* of the same */
    double vertices_total;    /* of all bodies */
    double near_pairs_wanted; /* a body; 0: not asked for, or two bodies */
} mote_subject_facts;

mote_subject_facts mote_subject_facts_of(const mote_subject *subject);

/* Its bodies and its question, for an engine; seed and clock_ns are 0. */
mote_engine_setup mote_subject_engine(const mote_subject *subject);

/* The bodies of one frame, with the memory of their weights. */
typedef struct mote_subject_frame {
    const mote_body_state *states; /* [bodies], of the frame set last; vertices are NULL but
                                      where positions are given */
    mote_frame_buffer *pair;
    mote_bodies_frame scene;
} mote_subject_frame;

mote_subject_frame mote_subject_frame_create(const mote_subject *subject);
void mote_subject_frame_free(mote_subject_frame *frame);

/* Poses and weights of all bodies at a frame (1 .. frames). previous: the frame that the method
   was asked about last, 0 for none, which tells what has changed. Errors of
   mote_scenario_frame. */
mote_status mote_subject_frame_set(const mote_subject *subject, uint32_t number,
                                   uint32_t previous, mote_subject_frame *frame);

#endif
