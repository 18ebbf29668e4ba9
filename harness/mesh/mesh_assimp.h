/* Shared by the readers that use assimp: mesh_assimp*.c and character_assimp.c, the only
   files that include it. Call them in a child process with limits: assimp may crash, hang or
   request any amount of memory. */
#ifndef MOTE_HARNESS_MESH_ASSIMP_H
#define MOTE_HARNESS_MESH_ASSIMP_H

#include "harness/mesh/affine.h"
#include "harness/mesh/mesh_soup.h"

#include <assimp/cfileio.h>
#include <assimp/scene.h>

#define MOTE_SAID_MAX 200

/* A file may nest nodes to any depth; real ones stay below this. */
#define MOTE_ASSIMP_DEPTH_MAX 256

/* Text of assimp or of a file, made fit for one line: no control characters, no full stop at
   the end. */
const char *mote_assimp_line(const char *text, char said[MOTE_SAID_MAX]);

/* " of mesh NAME" if it has a name. */
const char *mote_assimp_of_mesh(const struct aiMesh *mesh, char text[MOTE_SAID_MAX]);

mote_affine mote_assimp_affine(const struct aiMatrix4x4 *m);

/* Reads a file as it is; moves: for what moves in it, too. MOTE_EINVAL: assimp refuses it or
   would read it wrongly (mote_gltf_check), a face has an index out of range, or it contains no
   mesh. Release *scene with aiReleaseImport. */
mote_status mote_assimp_open(const char *path, bool moves, const struct aiScene **scene);

/* How assimp opens a mesh file and those it names; path, the mesh's, has to last as long. */
struct aiFileIO mote_assimp_files(char *path);

/* Adds vertices, mapped by `place`, and faces. */
mote_status mote_assimp_add_mesh(const char *path, const struct aiMesh *mesh,
                                 const mote_affine *place, mote_soup *soup);

mote_status mote_assimp_too_deep(const char *path);

#endif
