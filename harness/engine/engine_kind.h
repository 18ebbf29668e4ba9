/* The ways in which an engine asks about its bodies. Private to harness/engine.

   A pair and a scene share the engine, not the way of asking. Of two bodies all vertices are
   deformed for a method that needs them, and deforming, updating and asking are timed one by
   one, to some nanoseconds. Of a scene only bodies of near pairs are deformed, each once
   however many pairs it is in, and pairs are shared out to threads: a method of the contract
   sees one pair and cannot share, so that trees and the certified query have forms of their own
   there. */
#ifndef MOTE_HARNESS_ENGINE_KIND_H
#define MOTE_HARNESS_ENGINE_KIND_H

#include "baselines/body_trees.h"
#include "baselines/broad_phase.h"
#include "core/base/pool.h"
#include "core/body/deform.h"
#include "core/stream/stream_scene.h"
#include "harness/engine/engine.h"

/* What a pair keeps for its next query. */
typedef struct mote_pair_memory {
    mote_body_trees_memory trees;
    void *state; /* of a method of the contract */
} mote_pair_memory;

typedef struct mote_pair_list {
    mote_near_pair *pairs; /* [room] */
    mote_pair_memory *memories;
    size_t count, room;
} mote_pair_list;

/* Pairs that are asked about, ascending. */
typedef struct mote_pairs_wanted {
    const uint32_t (*pairs)[2];
    size_t count;
} mote_pairs_wanted;

/* The first failure of a thread. */
typedef struct mote_thread_failure {
    mote_status status;
    char text[256];
} mote_thread_failure;

typedef struct mote_engine_kind {
    mote_status (*create)(mote_engine *e); /* what no method is charged for; NULL: nothing */
    mote_status (*build)(mote_engine *e);
    void (*destroy)(mote_engine *e);
    void (*show)(mote_engine *e); /* NULL: nothing more is done */
    /* Sets e->now and the times of deforming and updating; of two bodies all times. */
    mote_status (*ask)(mote_engine *e, mote_engine_cost *cost);
} mote_engine_kind;

extern const mote_engine_kind mote_engine_of_two;       /* any method of the contract */
extern const mote_engine_kind mote_engine_of_pairs;     /* the contract's, for each near pair */
extern const mote_engine_kind mote_engine_of_trees;     /* FCL's and our box trees */
extern const mote_engine_kind mote_engine_of_certified; /* the certified scene */
extern const mote_engine_kind mote_engine_of_streamed;  /* the streamed scene */

struct mote_engine {
    mote_engine_setup setup;
    mote_method_choice choice;
    mote_traits traits;
    const mote_engine_kind *kind;
    const mote_body_state *states; /* of the frame that is shown */
    mote_pair_list now, before;
    mote_deform *deform[MOTE_ENGINE_SHAPES_MAX]; /* NULL: not needed, or positions are given */

    /* Two bodies: */
    mote_frame frame; /* as the method sees it: what it keeps of it outlives the call */
    mote_vec3 *world[2];
    void *state;

    /* More: */
    uint32_t threads;
    bool refits_every;     /* body in every frame */
    mote_scene *scene;     /* bounds from roots; NULL when every body is refitted */
    mote_scene_box *boxes; /* [count] */
    mote_broad_phase *broad;
    const mote_body_trees_kind *trees_kind;
    void *trees;
    bool *looked_at; /* [count] */
    mote_stream_scene *streamed;
    mote_vec3 **worlds;        /* [count]: vertices of each body, of the streamed scene */
    mote_positions *positions; /* [count] */
    mote_pool *pool;
    mote_thread_failure *failures; /* [threads] */
};

/* For kinds of more than two bodies (engine_near.c): */

/* The bounds of all bodies, near pairs by them, and what these need. */
mote_status mote_engine_build_near(mote_engine *e);
void mote_engine_destroy_near(mote_engine *e);
/* By e->boxes: near pairs, with their time. */
mote_status mote_engine_find_near(mote_engine *e, mote_engine_cost *cost,
                                  mote_pairs_wanted *wanted);
/* Boxes of all bodies from deformed roots, with their time. */
mote_status mote_engine_bound(mote_engine *e, mote_engine_cost *cost);

/* Makes e->now the answers of a scene. */
void mote_engine_copy_answers(mote_engine *e, const mote_scene_pair *from, size_t count);

/* Makes e->now the list of these pairs, each with its memory if it has one; states of other
   pairs are freed. */
void mote_engine_take_over(mote_engine *e, mote_pairs_wanted wanted);
/* Makes room for pairs; the old content of the list is lost where it grows. */
void mote_pair_list_make_room(mote_pair_list *list, size_t count);

#endif
