/* Baselines for several bodies: a hierarchy for each body that is looked at, refitted to the
   body's deformed vertices once a step, however many pairs the body is in. Two kinds: FCL's
   AABB models, and aabb-tree's. Models of a shape are made once each and serve any body of it;
   a body that is not looked at has none. */
#ifndef MOTE_BASELINES_BODY_TREES_H
#define MOTE_BASELINES_BODY_TREES_H

#include "core/certificate/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the trees are made for; all borrowed until destroy. */
typedef struct mote_body_trees_setup {
    const mote_body *const *shapes; /* [shape_count] */
    uint32_t shape_count;
    const uint32_t *shape_of; /* [body_count] */
    uint32_t body_count;
    double length; /* L of the scene */
    mote_ask ask;
    double tolerance; /* absolute */
} mote_body_trees_setup;

/* What a pair keeps between queries. Zero-initialise. */
typedef struct mote_body_trees_memory {
    uint32_t triangle[2]; /* nearest in the last query */
    bool known;
} mote_body_trees_memory;

/* One thread at a time. A step is begin, then move for each body that is looked at, its
   vertices written first, then refit, then queries of pairs of these bodies. */
typedef struct mote_body_trees_kind {
    const char *name;

    /* MOTE_EINVAL for shapes that the library cannot take, MOTE_ENOMEM. */
    mote_status (*create)(const mote_body_trees_setup *setup, void **state);
    void (*destroy)(void *state); /* NULL is allowed */

    /* No body has a tree. */
    void (*begin)(void *state);

    /* Gives body a tree; *vertices is where its world positions go, valid until the next call
       of room for FCL's, until begin for aabb-tree's. Allocates where more trees of the shape
       are needed than ever before. */
    mote_status (*room)(void *state, uint32_t body, mote_vec3 **vertices);

    /* Takes over what was written. MOTE_EINVAL where a position is not finite. */
    mote_status (*move)(void *state, uint32_t body);

    /* Brings all trees up to date. */
    mote_status (*refit)(void *state);

    /* The box of a body's tree. */
    void (*box)(const void *state, uint32_t body, mote_scene_box *box);

    /* Answers for two bodies that have trees, from the last answer's triangles on. */
    mote_status (*query)(void *state, const uint32_t body[2], mote_body_trees_memory *memory,
                         mote_answer *answer);
} mote_body_trees_kind;

extern const mote_body_trees_kind mote_fcl_body_trees, mote_aabb_body_trees;

#ifdef __cplusplus
}
#endif
#endif
