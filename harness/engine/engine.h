/* Asks a method about bodies, frame by frame: deforms what the method needs, finds the near
   pairs, asks about each, and counts the cost. Two bodies are always near: no search is made or
   charged. Measurements, the closed loop, truth, exports and single queries all use an
   engine. */
#ifndef MOTE_HARNESS_ENGINE_H
#define MOTE_HARNESS_ENGINE_H

#include "core/method/impact_method.h"
#include "harness/base/method_choice.h"

/* The largest number of shapes. */
#define MOTE_ENGINE_SHAPES_MAX 256

/* What to ask about. Bodies and shape_of are borrowed. */
typedef struct mote_engine_setup {
    const mote_body *shapes[MOTE_ENGINE_SHAPES_MAX]; /* [shape_count] */
    uint32_t shape_count;
    const uint32_t *shape_of; /* [count] */
    uint32_t count;           /* of bodies, >= 2 */
    double length;            /* L */
    mote_ask ask;
    uint32_t step;    /* of MOTE_ASK_IMPACT: pieces of the paths; else 0 */
    double tolerance; /* absolute */
    double near; /* absolute; pairs are near of which boxes around the bodies and their parts do
                    not show that they are farther apart. Infinite for two bodies, which are
                    always near, so any method can answer */
    uint64_t seed;     /* for methods that draw random numbers, the same for every pair */
    uint64_t clock_ns; /* cost of reading the clock, subtracted from the times of two bodies */
} mote_engine_setup;

/* A setup for two bodies, which are always near. */
mote_engine_setup mote_engine_setup_of_two(const mote_body *a, const mote_body *b);

/* Checks that a choice ("certified:threads=2", "fcl-aabb:refit=every",
   "particle:n=8,threads=2,ahead=3") works with more than two bodies: MOTE_EUNSUPPORTED for a
   method that does not, for keys of other methods, and for values of its own parameters if only
   the defaults are supported. */
mote_status mote_engine_check_choice(const mote_method_choice *choice);

/* A near pair of a frame. */
typedef struct mote_near_pair {
    uint32_t body[2]; /* body[0] < body[1] */
    uint32_t steps;   /* consecutive frames in which the pair has been near, this one
                         included */
    mote_answer answer;
} mote_near_pair;

/* The cost of asking about a frame: times in nanoseconds, and counts. */
typedef struct mote_engine_cost {
    uint64_t deform_ns; /* deforming: all vertices of two bodies, of bodies in near pairs, or of
                           all bodies */
    uint64_t update_ns; /* refits */
    uint64_t query_ns;  /* everything else: answers, and finding near pairs */
    uint64_t build_ns;  /* part of no other time: building trees of bodies that had none */
    uint64_t bounds_ns; /* part of query_ns: boxes of all bodies from deformed roots */
    uint64_t broad_ns;  /* part of query_ns: near pairs from the boxes */
    size_t pairs, fresh, contacts;
    mote_counters counters;
    uint64_t allocations; /* after deforming */
} mote_engine_cost;

typedef struct mote_engine mote_engine;

/* Checks the choice and makes what is charged to no method. MOTE_EUNSUPPORTED if the method
   cannot answer the question. */
mote_status mote_engine_create(const mote_engine_setup *setup, const mote_method_choice *choice,
                               mote_engine **engine);
void mote_engine_destroy(mote_engine *engine); /* NULL is allowed */

/* Builds what the method needs; call it once. Errors are the method's. */
mote_status mote_engine_build(mote_engine *engine);

/* Bytes used to deform two bodies if the method is charged for them, otherwise 0. */
int64_t mote_engine_deform_bytes(const mote_engine *engine);

/* Sets the bodies of a frame [count], borrowed until the next call; their vertices may be NULL
   if they have fields. For a method that is given positions without being charged, deforms two
   bodies. */
void mote_engine_show(mote_engine *engine, const mote_body_state *states);

/* The same of MOTE_ASK_IMPACT: the paths of the two bodies, borrowed until the next call. */
void mote_engine_show_paths(mote_engine *engine, const mote_path *const paths[2]);

/* The last answer about an impact. */
const mote_impact_answer *mote_engine_impact(const mote_engine *engine);

/* Answers for the near pairs of the current frame. For two bodies, only the method
   allocates. */
mote_status mote_engine_ask(mote_engine *engine, mote_engine_cost *cost);

/* The pairs of the last frame, ascending; valid until the next one. If a method gives a
   distance and no contact, the contact follows from the tolerance. */
const mote_near_pair *mote_engine_pairs(const mote_engine *engine, size_t *count);

/* The time that bookkeeping adds to a time of two bodies beyond the clock's cost, measured with
   a method that does nothing. May be negative. */
double mote_engine_overhead_ns(uint64_t clock_ns);

/* Single queries of two bodies, for callers that measure nothing. */

/* Creates and builds; tolerance is absolute. */
mote_status mote_engine_open_two(const mote_body *a, const mote_body *b,
                                 const mote_method_choice *choice, mote_ask ask,
                                 double tolerance, uint64_t seed, mote_engine **engine);

/* The same for the distance between bodies[2] by a method given as text. */
mote_status mote_engine_open_distance(const mote_body *bodies, const char *method,
                                      mote_engine **engine);

/* Deforms what the method needs, updates it and returns its own, unmodified answer. The frame's
   vertices may be NULL if the body has a field. If frame is NULL, the failure of
   mote_scenario_frame is passed on. */
mote_status mote_engine_answer(mote_engine *engine, const mote_frame *frame,
                               mote_answer *answer);

/* The particles of body i after the last answer: see mote_method.particles. 0 for a method
   without particles, and for more than two bodies. */
size_t mote_engine_particles(const mote_engine *engine, int i, mote_vec3 *positions,
                             size_t capacity);

#endif
