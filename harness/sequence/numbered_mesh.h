/* A mesh that remembers the vertex numbers of its file, so that other files can give their
   later positions (sequence.h). mote_mesh_import may weld vertices that are at one place now
   but separate later. */
#ifndef MOTE_HARNESS_NUMBERED_MESH_H
#define MOTE_HARNESS_NUMBERED_MESH_H

#include "harness/mesh/mesh_import.h"

typedef struct mote_numbered_mesh {
    mote_mesh *mesh;
    uint32_t *file_vertex; /* [mesh->vertex_count]: number in the file, from 0 */
    uint32_t file_vertices;
    uint64_t topology; /* hash of the faces as the file has them */
    mote_import import;
} mote_numbered_mesh;

/* Reads an OBJ or a PLY file (ASCII, or binary of either byte order, single or double
   precision, kept as it is) in a child process with limits, like mote_mesh_import. Vertices
   that are in no face are left out; edges of more than two faces are cut apart, or refused
   (mote_mesh_import_strictly). MOTE_EINVAL and
   MOTE_EIO with the file and the place. Free with mote_numbered_mesh_free. */
mote_status mote_numbered_mesh_read(const char *path, mote_numbered_mesh *made);
void mote_numbered_mesh_free(mote_numbered_mesh *made);

#endif
