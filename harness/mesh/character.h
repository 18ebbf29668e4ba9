/* A character: a body of a user's file that moves by bones and morph targets. */
#ifndef MOTE_HARNESS_CHARACTER_H
#define MOTE_HARNESS_CHARACTER_H

#include "harness/mesh/character_data.h"

/* Reads a character from any format that assimp knows: all meshes with a bone, with a node that
   a clip moves or with morph targets, and all others, become one body. Works in a child
   process, as mote_mesh_import does, with the same errors, and MOTE_EINVAL also for: a weight
   that is negative or not finite, a matrix or key that is not finite, key times that fall, a
   rotation of no length, more than 65,535 bones. MOTE_EUNSUPPORTED: nothing in it can move
   (no bone, no clip, no morph target). The caller destroys *character. */
mote_status mote_character_import_file(const char *path, mote_character **character,
                                       mote_character_import *import);

void mote_character_destroy(mote_character *character); /* NULL is allowed */

/* The clip of a name, or by number, from 1: *clip from 0. MOTE_EINVAL, with the clips that
   there are, for one that there is not. */
mote_status mote_character_find_clip(const mote_character *character, const char *name,
                                     uint32_t *clip);

/* Cuts each triangle into 4^times; new vertices are midpoints with mean weights and shifts, so
   that the surface at rest stays the same. MOTE_EINVAL: more than 2^31 vertices. */
mote_status mote_character_subdivide(mote_character *character, uint32_t times);

/* Multiplies each coordinate at rest, and what the bones make of it. */
mote_status mote_character_scale(mote_character *character, mote_vec3 factor);

/* Room for the pose of a character. */
typedef struct mote_character_pose {
    mote_affine *globals;  /* [nodes] */
    mote_affine *matrices; /* [bones], of vertices at rest, scale included */
    double *morphs;        /* [targets] */
} mote_character_pose;

mote_character_pose mote_character_pose_create(const mote_character *character);
void mote_character_pose_free(mote_character_pose *pose);

/* At a time of a clip (from 0), or as stored (MOTE_RIG_NONE). */
void mote_character_pose_set(const mote_character *character, uint32_t clip, double seconds,
                             mote_character_pose *pose);

#endif
