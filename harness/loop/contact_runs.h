/* Compares the contacts that a method reports with the truth, by runs: a run is a maximal
   sequence of steps at which a pair of bodies touches. */
#ifndef MOTE_HARNESS_CONTACT_RUNS_H
#define MOTE_HARNESS_CONTACT_RUNS_H

#include "core/certificate/scene.h"
#include "harness/engine/engine.h"

/* A run that has not ended. */
typedef struct mote_contact_run {
    uint32_t body[2];
    uint32_t began;
    bool reported;   /* by the method */
    bool intersects; /* at some step, by the truth */
    double depth;    /* the deepest so far, absolute */
} mote_contact_run;

/* Zero-initialise, and set depth_unreported if wanted. */
typedef struct mote_contact_runs {
    bool depth_unreported; /* measure depth only until a run is reported, since depth takes
                              longest */
    mote_contact_run *current, *next; /* in pair order */
    size_t count, current_capacity, next_capacity;
    uint64_t contact_steps; /* pairs and steps with a true contact */
    uint64_t missed_steps;  /* of these, not reported by the method */
    uint64_t false_steps;   /* pairs and steps at which the method reported a contact and there
                               was none */
    uint64_t approaches;    /* runs that ended */
    uint64_t passes;        /* of these, never reported by the method */
    uint64_t deep_passes;   /* of these, with a vertex of one body inside the other */
    uint64_t intersections; /* runs that ended, in which the surfaces intersected at a step */
    uint64_t delay_sum, delay_max;  /* steps from the beginning of a run to its first report */
    double depth_max, depth_passes; /* absolute */
} mote_contact_runs;

/* The deepest vertex of a pair, or `above` if none is deeper. */
typedef mote_status (*mote_contact_depth)(void *context, const uint32_t body[2], double above,
                                          double *depth);

/* Counts step k: near pairs with the true answers and the method's, both in pair order. depth
   is called for pairs whose surfaces intersect. */
mote_status mote_contact_runs_step(mote_contact_runs *runs, uint32_t k,
                                   const mote_near_pair *truth, size_t truth_count,
                                   const mote_near_pair *said, size_t said_count,
                                   mote_contact_depth depth, void *context);

/* Ends the runs still open. */
void mote_contact_runs_end(mote_contact_runs *runs);

void mote_contact_runs_free(mote_contact_runs *runs);

#endif
