/* What the readers that use assimp share: mesh_assimp.c and character_assimp.c, the only files
   that include it. Call them in a child process with limits: assimp may crash, hang or ask for
   any amount of memory. */
#ifndef MOTE_HARNESS_MESH_ASSIMP_H
#define MOTE_HARNESS_MESH_ASSIMP_H

#include "harness/mesh/affine.h"
#include "harness/mesh/mesh_soup.h"

#include <assimp/scene.h>

#define MOTE_SAID_MAX 200

/* A file may nest nodes without end; real ones do not go this deep. */
#define MOTE_ASSIMP_DEPTH_MAX 256

/* What assimp or a file says, fit for one line: no control characters, no full stop at the
   end. */
const char *mote_assimp_line(const char *text, char said[MOTE_SAID_MAX]);

/* " of mesh NAME", where it has a name. */
const char *mote_assimp_of_mesh(const struct aiMesh *mesh, char text[MOTE_SAID_MAX]);

mote_affine mote_assimp_affine(const struct aiMatrix4x4 *m);

/* Reads a file as it is. MOTE_EINVAL: assimp refuses it, a face has an index out of range, or
   there is no mesh in it. Release *scene with aiReleaseImport. */
mote_status mote_assimp_open(const char *path, const struct aiScene **scene);

/* Adds vertices, moved by `place`, and faces. */
mote_status mote_assimp_add_mesh(const char *path, const struct aiMesh *mesh,
                                 const mote_affine *place, mote_soup *soup);

mote_status mote_assimp_too_deep(const char *path);

#endif
