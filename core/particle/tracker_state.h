/* The state of a tracker and of a query, shared by tracker_*.c. */
#ifndef MOTE_CORE_TRACKER_STATE_H
#define MOTE_CORE_TRACKER_STATE_H

#include "core/body/coherence.h"
#include "core/particle/descent.h"
#include "core/body/pairs.h"
#include "core/particle/particles.h"
#include "core/particle/tracker.h"

#define MOTE_NO_VERTEX UINT32_MAX

/* Nodes around the nearest pair that are leapt to in turn. */
#define MOTE_NEAR_MAX 8

/* How a launch ended: it could hardly have come below the distance `least`, when the bodies had
   travelled that far. */
typedef struct mote_outcome {
    double least, travelled;
} mote_outcome;

/* One body as the tracker sees it. */
typedef struct mote_tracked_body {
    const mote_mesh *mesh;
    mote_lazy own_lazy;
    mote_lazy *lazy; /* own_lazy, or that of the forces */
    const mote_levels *levels;
    int seed_level;
    uint32_t count;        /* n, at least one a component */
    uint32_t seed_count;   /* >= count: cold queries launch the first, warm ones all in turn */
    uint32_t *seed;        /* [seed_count], nodes of seed_level, where launches start */
    mote_walker *place;    /* [count], of this frame */
    mote_outcome *outcome; /* [seed_count], of the last launches */
    uint32_t turn;         /* the seed that is launched next */
    double due;            /* launches that motion calls for, not yet made */
    uint32_t near[MOTE_NEAR_MAX], near_count; /* the nodes of seed_level nearest to near_to */
    uint32_t near_to;                         /* a vertex, or MOTE_NO_VERTEX */
    uint32_t near_turn;                       /* the one that is leapt to next */
    double leaps_due;                         /* that motion calls for, not yet made */
    mote_vec3 *node_rest;                     /* [nodes of seed_level], at rest */
    uint32_t *home; /* with forces: the node of seed_level in whose cell a vertex is */
} mote_tracked_body;

/* The nearest pair of the last query. */
typedef struct mote_nearest_pair {
    bool known;
    uint32_t triangle[2][3], vertex[2];
} mote_nearest_pair;

struct mote_tracker {
    mote_tracker_options options;
    double length;
    mote_levels *owned_levels[2]; /* [1] is NULL when the bodies share a mesh */
    mote_tracked_body body[2];
    mote_particles *particles; /* NULL without forces */
    mote_coherence coherence;
    double travelled; /* how far the bodies have moved against each other so far */
    mote_pairs pairs; /* of this query */
    mote_pair pair[MOTE_TRACK_MAX]; /* minima of the last query */
    uint32_t pair_count;
    mote_nearest_pair last;
};

/* A query in progress. */
typedef struct mote_request {
    mote_tracker *tracker;
    mote_ground ground[2];
    mote_lazy *lazy[2];
    double worth_squared, enough_squared;
    double nearest_squared; /* of all pairs of vertices looked at so far */
    bool looked[2];         /* the places of the first seeds are those of this frame */
    bool cold;              /* nothing is known, or the bodies have moved far since then */
    uint32_t refined;
    mote_counters *counters;
    mote_refined *best;
} mote_request;

/* Searches for nearer pairs than the last query's closest pair. */
void mote_tracker_search(mote_request *r);

/* Starts with the last query's closest pair, which must be known. */
void mote_tracker_refine_last(mote_request *r);

/* True if the search may end. */
static inline bool mote_found_enough(const mote_request *r)
{
    return r->best->squared <= r->enough_squared;
}

#endif
