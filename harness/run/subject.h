/* The subject of a measurement: a scenario of two or more bodies, with the hashes that
   identify it, and its truth. */
#ifndef MOTE_HARNESS_SUBJECT_H
#define MOTE_HARNESS_SUBJECT_H

#include "harness/engine/engine.h"
#include "harness/run/impact_truth.h"
#include "harness/run/truth.h"
#include "harness/scene/bodies.h"
#include "harness/scene/scenario_path.h"

/* Zero-initialise. */
typedef struct mote_subject {
    mote_scenario *scenario; /* two bodies; NULL if bodies is set */
    mote_bodies *bodies;     /* more than two; NULL if scenario is set */
    uint64_t fingerprint;    /* of the vertices in all frames */
    uint64_t faces;          /* of the triangles */
    mote_truth
        *truth; /* two bodies; NULL until something is measured. There is none for more bodies:
                   contacts are compared with those of an exact method of the run */
    mote_impact_truth *impacts; /* likewise of a scenario that asks for impacts, in its place */
} mote_subject;

/* Whether it asks for impacts. */
bool mote_subject_asks_impacts(const mote_subject *subject);

/* The frames that a question spans: the scenario's step if it asks for impacts, otherwise 0. */
uint32_t mote_subject_step(const mote_subject *subject);

/* mote_subject_open loads a scenario of two or more bodies (names as for mote_scenario_load and
   mote_bodies_load); mote_subject_identify computes both hashes, which reads its frames;
   mote_subject_load does both. Free with mote_subject_free even after a failure. */
mote_status mote_subject_open(const char *name_or_path, mote_subject *subject);
mote_status mote_subject_identify(mote_subject *subject);
mote_status mote_subject_load(const char *name_or_path, mote_subject *subject);
void mote_subject_free(mote_subject *subject);

/* The facts common to scenarios of two and of more bodies. */
typedef struct mote_subject_facts {
    const char *name;
    uint32_t bodies; /* 2 or more */
    uint32_t frames;
    mote_ask ask;
    double tolerance, length; /* absolute */
    mote_interval active;     /* 0, 0 if the scenario names none */
    uint32_t triangles[2];    /* of each of two bodies, otherwise of the smallest and the
                                 largest shape */
    uint32_t vertices[2];     /* of the same */
    double vertices_total;    /* of all bodies */
    double near_pairs_wanted; /* per body; 0: not requested, or two bodies */
} mote_subject_facts;

mote_subject_facts mote_subject_facts_of(const mote_subject *subject);

/* The setup of an engine for its bodies and its question; seed and clock_ns are 0, and the step
   is the scenario's. */
mote_engine_setup mote_subject_engine(const mote_subject *subject);

/* The bodies of one frame, with memory for their weights. */
typedef struct mote_subject_frame {
    const mote_body_state *states; /* [bodies], of the frame set last; vertices are NULL unless
                                      positions are given */
    mote_frame_buffer *pair;
    mote_bodies_frame scene;
    mote_scenario_path *path; /* in place of states: the bodies between this frame and a later
                                 one; NULL: frames */
} mote_subject_frame;

/* step: frames that paths span, where impacts are asked for; 0: frames, no paths. */
mote_subject_frame mote_subject_frame_create(const mote_subject *subject, uint32_t step);
void mote_subject_frame_free(mote_subject_frame *frame);

/* Sets poses and weights of all bodies at a frame (1 .. frames). previous: the frame that the
   method was last asked about, 0 for none; it determines what has changed. Errors of
   mote_scenario_frame. */
mote_status mote_subject_frame_set(const mote_subject *subject, uint32_t number,
                                   uint32_t previous, mote_subject_frame *frame);

#endif
