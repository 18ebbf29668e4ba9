/* A body (mesh + field), its state in a frame, and the frame, which is all that a method gets
   to see. */
#ifndef MOTE_CORE_BODY_H
#define MOTE_CORE_BODY_H

#include "core/body/field.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Zero-initialise it, so that a body without samples has a sample_count of 0. */
typedef struct mote_body {
    const mote_mesh *mesh;   /* borrowed */
    const mote_field *field; /* borrowed; never NULL: static when nothing deforms */
    /* Weights of some poses that the body is likely to take, for an identity rotation (as if in
       the body's axes); borrowed, may be NULL when sample_count is 0. A tree is split where
       triangles are far apart at rest or in one of these poses, since limbs that lie side by
       side at rest may part later. Samples change times only, never an answer. Eight are
       enough. */
    const mote_weights *samples; /* [sample_count] */
    uint32_t sample_count;
} mote_body;

/* Whether the body has no known field, only the positions of its vertices in each frame
   (mote_field_create_given). */
static inline bool mote_body_is_given(const mote_body *body)
{
    return body->field->kind->given;
}

/* Whether the body moves by its poses alone. */
static inline bool mote_body_is_rigid(const mote_body *body)
{
    return body->field->count == 0 && !body->field->kind->given;
}

/* World vertex i = rotation * x_i + translation + sum_j phi_j(x_i) w_j. Of a body whose
   positions are given it is vertices[i]. The pose then only says how the body's axes turn:
   methods may use it to tell a rotation from a deformation, but their answers are right
   whatever it is. */
typedef struct mote_body_state {
    mote_pose pose;
    mote_weights weights;      /* in world axes, field->padded long; see mote_weights */
    const mote_vec3 *vertices; /* [vertex_count] world positions, or NULL when not provided */
    bool shape_changed; /* the weights, or the positions that are given, differ from those
                           of the previous frame */
    bool pose_changed;  /* the pose does; both are true in the first frame */
} mote_body_state;

typedef struct mote_frame {
    uint64_t number; /* 1, 2, ... */
    mote_body_state body[2];
} mote_frame;

/* The position of a vertex at rest (pose 0) or in a sample pose (1 .. sample_count). */
mote_vec3 mote_body_sample(const mote_body *body, uint32_t pose, uint32_t vertex);

/* World position of one vertex, evaluated from the field; read from state->vertices only where
   the body's positions are given. Full deformation and lazy positions give these same bits.
   vertex < vertex_count. No allocation; any thread. Cost O(J) for J basis functions. */
mote_vec3 mote_body_position(const mote_body *body, const mote_body_state *state,
                             uint32_t vertex);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
