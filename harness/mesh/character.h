/* A character: a body from a user's file that moves by bones and morph targets. */
#ifndef MOTE_HARNESS_CHARACTER_H
#define MOTE_HARNESS_CHARACTER_H

#include "harness/mesh/character_data.h"

/* Reads a character from any format that assimp knows: all of its meshes, moving or not, become
   one body. Works in a child process, like mote_mesh_import, with the same errors, and
   MOTE_EINVAL also for: a weight that is negative or not finite, a matrix or key that is not
   finite, decreasing key times, a rotation of zero length, more than 65,535 bones.
   MOTE_EUNSUPPORTED: nothing in it can move (no bone, no clip, no morph target). The caller
   destroys *character. */
mote_status mote_character_import_file(const char *path, mote_character **character,
                                       mote_character_import *import);

void mote_character_destroy(mote_character *character); /* NULL is allowed */

/* The clip of a number from 1; *clip counts from 0. MOTE_EINVAL if there is none, with a list
   of the clips. */
mote_status mote_character_clip_numbered(const mote_character *character, int64_t number,
                                         uint32_t *clip);

/* Finds a clip by name; a name that no clip has may be a clip's number. Otherwise the same. */
mote_status mote_character_find_clip(const mote_character *character, const char *name,
                                     uint32_t *clip);

/* Cuts each triangle into 4^times; new vertices are midpoints with averaged weights and shifts,
   so the surface at rest does not change. MOTE_EINVAL: more than 2^31 vertices. */
mote_status mote_character_subdivide(mote_character *character, uint32_t times);

/* Multiplies each coordinate, at rest and after the bones, by a factor. */
mote_status mote_character_scale(mote_character *character, mote_vec3 factor);

/* Memory for the pose of a character. */
typedef struct mote_character_pose {
    mote_affine *globals;  /* [nodes] */
    mote_affine *matrices; /* [bones], map vertices at rest, scale included */
    double *morphs;        /* [targets] */
} mote_character_pose;

mote_character_pose mote_character_pose_create(const mote_character *character);
void mote_character_pose_free(mote_character_pose *pose);

/* Sets the pose at a time of a clip (from 0), or as stored (MOTE_RIG_NONE). */
void mote_character_pose_set(const mote_character *character, uint32_t clip, double seconds,
                             mote_character_pose *pose);

#endif
