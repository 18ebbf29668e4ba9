/* Reads users' mesh files. */
#ifndef MOTE_HARNESS_MESH_IMPORT_H
#define MOTE_HARNESS_MESH_IMPORT_H

#include "core/body/mesh.h"
#include "harness/mesh/mesh_split.h"

/* What happened to a file's triangles before they became a mesh. */
typedef struct mote_import {
    bool single_precision; /* coordinates went through 32-bit floats (all but OBJ, OFF, PLY) */
    size_t welded;         /* vertices welded to another one at the same place */
    size_t collapsed;      /* triangles left out: a vertex twice, or two at one place */
    size_t unused;         /* vertices left out: not in any face */
    mote_split split;      /* edges of more than two faces, cut apart */
} mote_import;

/* From now on an edge of more than two faces is an error (--strict) instead of being cut
   apart. Not thread-safe. */
void mote_mesh_import_strictly(void);

/* MOTE_EINVAL if edges of the file were cut apart; the text says where. */
mote_status mote_import_refuse_split(const char *path, const mote_import *import);

/* Reports on stderr, once per file, that some of its edges were cut apart. Not thread-safe. */
void mote_import_tell_split(const char *path, const mote_import *import);

/* Reads a mesh: OBJ, OFF and PLY with our own parsers in double precision; STL, glTF and
   others with assimp. All but OBJ and OFF get vertices at the same place merged. It works in a
   child process with limits of time and memory (4 seconds and 128 MB for a small file,
   proportionally more for large ones, with the files that a name.gltf names), so no file can
   end or block the caller. Files that it names are read only in its folder and below. An edge
   of more than two faces is cut apart (mesh_split.h): the surface stays the same bit for bit.
   MOTE_EINVAL with a text that names the file and the place: a coordinate that is not finite,
   an index out of range, a face that is not simple, no face. MOTE_EIO: the file cannot be
   read, or the child crashed or took too long. MOTE_ENOMEM: the child needed more memory.
   import may be NULL. The caller destroys *mesh. */
mote_status mote_mesh_import(const char *path, mote_mesh **mesh, mote_import *import);

#endif
