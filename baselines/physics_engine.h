/* What the physics engines (ODE, Bullet) have in common as baselines: they answer whether two
   meshes touch, not how far apart they are, and take vertices of a body in its own coordinates
   with a pose.

   Their boxes are floats, and Bullet's everything is, so they are given numbers near 1: each
   body's vertices relative to the centre of its rest box, which moves with the body, both
   bodies relative to the centre of body 0, and all scaled by the power of two that brings L
   into [1, 2). A rigid body is built once and moved by its pose. A body that deforms is
   refitted where its shape or its rotation changed (weights are in world axes); otherwise it is
   moved. */
#ifndef MOTE_BASELINES_PHYSICS_ENGINE_H
#define MOTE_BASELINES_PHYSICS_ENGINE_H

#include "core/method/method.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum mote_physics_update {
    MOTE_PHYSICS_REFIT,
    MOTE_PHYSICS_NONE, /* rigid bodies, by their poses alone */
    MOTE_PHYSICS_REBUILD
} mote_physics_update;

typedef struct mote_physics_body {
    const mote_mesh *mesh;
    mote_vec3 centre; /* of the rest box */
    bool rigid;
    bool refit;                /* this frame's vertices are not those of the last refit */
    bool fitted;               /* there was a refit */
    mote_mat3 fitted_rotation; /* at that refit */
    mote_vec3 moved_centre;    /* where the centre is in this frame; world */
    const mote_vec3 *vertices; /* at rest; from its first refit on, those of the last one */
    mote_mat3 rotation;        /* what the engine is to apply in this frame, */
    mote_vec3 translation;     /* in its unit */
} mote_physics_body;

typedef struct mote_physics {
    mote_physics_body body[2];
    double scale;
} mote_physics;

/* given: the frame's vertices come free of charge (positions=given). */
mote_traits mote_physics_traits(mote_physics_update update, bool given);

/* Checks the setup and fills the engine. MOTE_EUNSUPPORTED where the question is another one
   than contact at tolerance 0, or where update is MOTE_PHYSICS_NONE and a body deforms;
   MOTE_EINVAL as mote_input_check. name: of the engine, for messages. The meshes are borrowed.
   Cost O(v + t). */
mote_status mote_physics_begin(mote_physics *engine, const mote_setup *setup,
                               mote_physics_update update, const char *name);

/* Sets what a frame changes of body b: refit, moved_centre, vertices, rotation, translation.
   For body 0 before body 1, whose translation is relative to it. MOTE_EINVAL where the pose is
   not finite, or where a body to refit has no vertices; the next frame then refits both bodies.
   Cost O(1). */
mote_status mote_physics_follow(mote_physics *engine, const mote_frame *frame, int b);

/* Writes the vertices of body b in the engine's unit to to[3 * vertex_count]: at rest after
   mote_physics_begin, those of the frame after a mote_physics_follow that set refit. They are
   checked in the same pass: MOTE_EINVAL where one is not finite; the next frame then refits
   both bodies. Cost O(v), about 1 ns a vertex. */
mote_status mote_physics_write_doubles(mote_physics *engine, int b, double *to);
mote_status mote_physics_write_floats(mote_physics *engine, int b, float *to);

#ifdef __cplusplus
}
#endif
#endif
