/* Baselines for several bodies: a tree for each body that is in a pair, refitted to the body's
   deformed vertices once in each step, however many pairs the body is in. There are two kinds:
   FCL's AABB models, and those of aabb-tree. Models of a shape are built once and reused for
   any body of that shape; a body in no pair has none.

   Building them is timed for no step, as the trees of a pair are built before anything is
   timed: an application builds a body's tree when it makes the body. */
#ifndef MOTE_BASELINES_BODY_TREES_H
#define MOTE_BASELINES_BODY_TREES_H

#include "core/certificate/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The scene that the trees are for; everything is borrowed until destroy. */
typedef struct mote_body_trees_setup {
    const mote_body *const *shapes; /* [shape_count] */
    uint32_t shape_count;
    const uint32_t *shape_of; /* [body_count] */
    uint32_t body_count;
    double length; /* L of the scene */
    mote_ask ask;
    double tolerance; /* absolute */
    bool every;       /* every body has a tree in every step */
} mote_body_trees_setup;

/* What a pair keeps between queries. Zero-initialise. */
typedef struct mote_body_trees_memory {
    uint32_t triangle[2]; /* nearest in the last query */
    bool known;
} mote_body_trees_memory;

/* One thread at a time. A step calls begin; then, for each body in a pair, room and, once its
   vertices are written, move; then refit; then query for pairs of these bodies. */
typedef struct mote_body_trees_kind {
    const char *name;

    /* Builds the trees of all bodies if each will have one in every step. MOTE_EINVAL for
       shapes that the library does not accept, MOTE_ENOMEM. */
    mote_status (*create)(const mote_body_trees_setup *setup, void **state);
    void (*destroy)(void *state); /* NULL is allowed */

    /* Starts a step: no body has a tree. */
    void (*begin)(void *state);

    /* Gives body a tree; *vertices is where its world positions go, valid until the next call
       of room for FCL's, until begin for aabb-tree's. Builds one where more trees of the shape
       are needed than ever before; not timed. */
    mote_status (*room)(void *state, uint32_t body, mote_vec3 **vertices);

    /* Uses the positions that were written. MOTE_EINVAL where one is not finite. */
    mote_status (*move)(void *state, uint32_t body);

    /* Brings all trees up to date. */
    mote_status (*refit)(void *state);

    /* The box of a body's tree. */
    void (*box)(const void *state, uint32_t body, mote_scene_box *box);

    /* Answers for two bodies that have trees, starting from the last answer's triangles. */
    mote_status (*query)(void *state, const uint32_t body[2], mote_body_trees_memory *memory,
                         mote_answer *answer);
} mote_body_trees_kind;

extern const mote_body_trees_kind mote_fcl_body_trees, mote_aabb_body_trees;

#ifdef __cplusplus
}
#endif
#endif
