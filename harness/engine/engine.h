/* Asks a method about bodies, frame by frame: deforms what it needs, finds the pairs that are
   near, asks about each, and counts what that costs. Two bodies are always near: nothing is
   looked for and nothing is paid for looking. Measurements, the closed loop, truth, exports and
   single queries all ask through an engine. */
#ifndef MOTE_HARNESS_ENGINE_H
#define MOTE_HARNESS_ENGINE_H

#include "core/method/method.h"
#include "harness/base/method_choice.h"

/* The largest number of shapes. */
#define MOTE_ENGINE_SHAPES_MAX 256

/* What is asked about. Bodies and shape_of are borrowed. */
typedef struct mote_engine_setup {
    const mote_body *shapes[MOTE_ENGINE_SHAPES_MAX]; /* [shape_count] */
    uint32_t shape_count;
    const uint32_t *shape_of; /* [count] */
    uint32_t count;           /* of bodies, >= 2 */
    double length;            /* L */
    mote_ask ask;
    double tolerance; /* absolute */
    double near;   /* absolute; pairs whose bounds are at most this far apart are near. Infinite
                      for two bodies, which need not be near: then any method can answer */
    uint64_t seed; /* of methods that draw random numbers, the same for every pair */
    uint64_t clock_ns; /* what reading the clock costs: taken off the times of two bodies */
} mote_engine_setup;

/* Two bodies that are always near. */
mote_engine_setup mote_engine_setup_of_two(const mote_body *a, const mote_body *b);

/* Checks that a choice ("certified:threads=2", "fcl-aabb:refit=every",
   "particle:n=8,threads=2,ahead=3") works with more than two bodies: MOTE_EUNSUPPORTED for a
   method that does not, for keys that are not for it, and for its own parameters where only
   the defaults are supported. */
mote_status mote_engine_check_choice(const mote_method_choice *choice);

/* A near pair of a frame. */
typedef struct mote_near_pair {
    uint32_t body[2]; /* body[0] < body[1] */
    uint32_t steps;   /* number of frames that the pair has been near without a break */
    mote_answer answer;
} mote_near_pair;

/* What asking about a frame cost: times in nanoseconds, and counts. */
typedef struct mote_engine_cost {
    uint64_t deform_ns; /* all vertices of two bodies, of those in near pairs, or of all */
    uint64_t update_ns; /* refits */
    uint64_t query_ns;  /* the rest: answers, and finding near pairs */
    uint64_t bounds_ns; /* of this, boxes of all bodies from deformed roots */
    uint64_t broad_ns;  /* and near pairs by the boxes */
    size_t pairs, fresh, contacts;
    mote_counters counters;
    uint64_t allocations; /* after deforming */
} mote_engine_cost;

typedef struct mote_engine mote_engine;

/* Checks the choice and makes what no method is charged for. MOTE_EUNSUPPORTED where the method
   cannot answer what is asked. */
mote_status mote_engine_create(const mote_engine_setup *setup, const mote_method_choice *choice,
                               mote_engine **engine);
void mote_engine_destroy(mote_engine *engine); /* NULL is allowed */

/* Builds what the method needs, once. Errors are the method's. */
mote_status mote_engine_build(mote_engine *engine);

/* Bytes of what two bodies are deformed with, where the method is charged for that; else 0. */
int64_t mote_engine_deform_bytes(const mote_engine *engine);

/* The bodies of a frame [count], borrowed until the next one; their vertices may be NULL
   where they have fields.
   Deforms two bodies for a method that is given their positions and charged nothing. */
void mote_engine_show(mote_engine *engine, const mote_body_state *states);

/* Answers for the near pairs of the frame that is shown. Nothing is allocated for two bodies
   but what the method allocates. */
mote_status mote_engine_ask(mote_engine *engine, mote_engine_cost *cost);

/* The pairs of the last frame, ascending; valid until the next one. Where a method gives a
   distance and no contact, the contact follows from the tolerance. */
const mote_near_pair *mote_engine_pairs(const mote_engine *engine, size_t *count);

/* How much bookkeeping adds to a time of two bodies beyond the clock's cost, measured with a
   method that does nothing. May be below 0. */
double mote_engine_overhead_ns(uint64_t clock_ns);

/* Single queries of two bodies, for whoever measures nothing. */

/* Creates and builds; tolerance is absolute. */
mote_status mote_engine_open_two(const mote_body *a, const mote_body *b,
                                 const mote_method_choice *choice, mote_ask ask,
                                 double tolerance, uint64_t seed, mote_engine **engine);

/* The same for the distance of bodies[2] by a method given by its text. */
mote_status mote_engine_open_distance(const mote_body *bodies, const char *method,
                                      mote_engine **engine);

/* Deforms what the method needs, updates it and asks it: its own answer, as it gives it. The
   frame's vertices may be NULL where its body has a field. frame NULL: the failure of
   mote_scenario_frame is passed on. */
mote_status mote_engine_answer(mote_engine *engine, const mote_frame *frame,
                               mote_answer *answer);

/* The particles of body i after the last answer: see mote_method.particles. 0 for a method
   without, and for more than two bodies. */
size_t mote_engine_particles(const mote_engine *engine, int i, mote_vec3 *positions,
                             size_t capacity);

#endif
