/* The ways in which an engine asks about its bodies. Private to harness/engine.

   A pair and a scene share the engine but are asked differently. For two bodies, all vertices
   are deformed for a method that needs them, and deforming, updating and asking are timed
   separately, to a few nanoseconds. In a scene only the bodies of near pairs are deformed, each
   once however many pairs it is in, and the pairs are distributed over threads. A contract
   method sees one pair and cannot share work, so trees and the certified query have separate
   implementations for scenes. */
#ifndef MOTE_HARNESS_ENGINE_KIND_H
#define MOTE_HARNESS_ENGINE_KIND_H

#include "baselines/body_trees.h"
#include "baselines/broad_phase.h"
#include "core/base/pool.h"
#include "core/body/deform.h"
#include "core/stream/stream_scene.h"
#include "harness/engine/engine.h"

/* State kept for a pair until its next query. */
typedef struct mote_pair_memory {
    mote_body_trees_memory trees;
    void *state; /* of a contract method */
} mote_pair_memory;

typedef struct mote_engine_pair_list {
    mote_near_pair *pairs; /* [room] */
    mote_pair_memory *memories;
    size_t count, room;
} mote_engine_pair_list;

/* The pairs to ask about, ascending. */
typedef struct mote_pairs_wanted {
    const uint32_t (*pairs)[2];
    size_t count;
} mote_pairs_wanted;

/* The first failure in a thread. */
typedef struct mote_thread_failure {
    mote_status status;
    char text[256];
} mote_thread_failure;

typedef struct mote_engine_kind {
    mote_status (*create)(mote_engine *e); /* makes what is charged to no method; NULL:
                                              nothing */
    mote_status (*build)(mote_engine *e);
    void (*destroy)(mote_engine *e);
    void (*show)(mote_engine *e); /* NULL: nothing further to do */
    /* Sets e->now and the times of deforming and updating; for two bodies, all times. */
    mote_status (*ask)(mote_engine *e, mote_engine_cost *cost);
} mote_engine_kind;

extern const mote_engine_kind mote_engine_of_two;       /* any contract method */
extern const mote_engine_kind mote_engine_of_impact;    /* the same, between two moments */
extern const mote_engine_kind mote_engine_of_pairs;     /* a contract method, for each near
                                                           pair */
extern const mote_engine_kind mote_engine_of_trees;     /* FCL's and our box trees */
extern const mote_engine_kind mote_engine_of_certified; /* the certified scene */
extern const mote_engine_kind mote_engine_of_streamed;  /* the streamed scene */

struct mote_engine {
    mote_engine_setup setup;
    mote_method_choice choice;
    mote_traits traits;
    const mote_engine_kind *kind;
    const mote_body_state *states; /* of the current frame */
    mote_engine_pair_list now, before;
    mote_deform *deform[MOTE_ENGINE_SHAPES_MAX]; /* NULL: not needed, or positions are given */

    /* Two bodies: */
    mote_frame frame; /* as the method sees it; must outlive the call */
    mote_vec3 *world[2];
    void *state;
    const mote_impact_method *impact; /* NULL: impacts are not asked for */
    const mote_path *paths[2];
    mote_impact_answer found;

    /* More than two bodies: */
    uint32_t threads;
    bool refits_every;     /* every body in every frame */
    mote_scene *scene;     /* bounds from roots; NULL if every body is refitted, or none has a
                              field */
    uint32_t *scene_body;  /* [count]: number in the scene, UINT32_MAX of a body whose positions
                              are given; NULL: all are in it */
    mote_scene_box *boxes; /* [count] */
    mote_broad_phase *broad;
    const mote_body_trees_kind *trees_kind;
    void *trees;
    bool *looked_at; /* [count]: in a near pair */
    mote_stream_scene *streamed;
    mote_vec3 **worlds;        /* [count]: vertices of each body, for the streamed scene */
    mote_positions *positions; /* [count] */
    mote_pool *pool;
    mote_thread_failure *failures; /* [threads] */
};

/* For kinds of two bodies (engine_two.c): */

/* MOTE_EINVAL: keys of scenes have no effect on two bodies, so a result must not list them. */
mote_status mote_engine_refuse_scene_keys(void);
/* What the method is built for. */
mote_setup mote_engine_setup_of_method(const mote_engine *e);

/* For kinds of more than two bodies (engine_near.c): */

/* Makes and frees the bounds of all bodies and the search for near pairs. */
mote_status mote_engine_build_near(mote_engine *e);
void mote_engine_destroy_near(mote_engine *e);
/* Finds near pairs by e->boxes, timed. */
mote_status mote_engine_find_near(mote_engine *e, mote_engine_cost *cost,
                                  mote_pairs_wanted *wanted);
/* Sets the boxes of all bodies from deformed roots, or from given positions, timed. */
mote_status mote_engine_bound(mote_engine *e, mote_engine_cost *cost);

/* A failure's status, after a text that begins with "body N", which libraries count from 0, is
   made to begin with body i, counted from 1 as all that users read; with N itself where i is
   MOTE_ENGINE_SAME. */
mote_status mote_engine_blame(mote_status status, uint32_t i);
#define MOTE_ENGINE_SAME UINT32_MAX

/* Copies the answers of a scene to e->now. */
void mote_engine_copy_answers(mote_engine *e, const mote_scene_pair *from, size_t count);

/* Makes e->now the list of these pairs, each with its memory if it has one; frees the states of
   other pairs. */
void mote_engine_carry_over(mote_engine *e, mote_pairs_wanted wanted);
/* Makes room for pairs; when the list grows, its old content is lost. */
void mote_engine_pair_list_make_room(mote_engine_pair_list *list, size_t count);

#endif
