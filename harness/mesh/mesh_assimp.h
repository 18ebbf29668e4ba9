/* Shared by the readers that use assimp: mesh_assimp*.c and character_assimp.c, the only
   files that include it. Call them in a child process with limits: assimp may crash, hang or
   request any amount of memory. */
#ifndef MOTE_HARNESS_MESH_ASSIMP_H
#define MOTE_HARNESS_MESH_ASSIMP_H

#include "harness/gltf/gltf_file.h"
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

/* A file that assimp has read. */
typedef struct mote_assimp_file {
    const struct aiScene *scene;
    mote_gltf gltf; /* glTF 2, with the numbers of nodes as their names in scene; otherwise root
                       is NULL */
    char *data;     /* of gltf */
} mote_assimp_file;

/* Reads a file as it is; moves: for what moves in it, too. MOTE_EINVAL: assimp refuses it or
   would read it wrongly (mote_gltf_check), a face has an index out of range, or it contains no
   mesh. MOTE_ENOMEM: assimp has no memory left. Close *file, also after a failure. */
mote_status mote_assimp_open(const char *path, bool moves, mote_assimp_file *file);
void mote_assimp_close(mote_assimp_file *file);

/* What assimp may open: the mesh file, and files in its folder or below that it names. */
typedef struct mote_assimp_files {
    const char *path; /* of the mesh file */
    mote_gltf *gltf;  /* or NULL */
    const char *text; /* of gltf, which assimp knows as MOTE_ASSIMP_TEXT */
    size_t size;
    mote_status status; /* why a buffer of gltf could not be opened; mote_error_text has more */
} mote_assimp_files;

#define MOTE_ASSIMP_TEXT "text.gltf"

struct aiFileIO mote_assimp_file_io(mote_assimp_files *files);

/* Adds vertices, mapped by `place`, and faces. */
mote_status mote_assimp_add_mesh(const char *path, const struct aiMesh *mesh,
                                 const mote_affine *place, mote_soup *soup);

mote_status mote_assimp_too_deep(const char *path);

#endif
