/* Writes meshes as Wavefront OBJ. */
#ifndef MOTE_DATASETS_OBJ_WRITE_H
#define MOTE_DATASETS_OBJ_WRITE_H

#include "core/body/mesh.h"
#include "core/base/status.h"

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Writes the mesh's triangles at the given positions ([vertex_count]; NULL: the rest positions)
   to path, with 17 significant digits, so that reading gives the same doubles. The file is
   written as PATH.PID.partial and renamed when it is complete; an earlier file at path stays
   until then. MOTE_EINVAL: a position that is not finite. MOTE_EIO: the folder or file cannot
   be written; nothing is left behind. Cost O(v + t). */
mote_status mote_obj_write(const char *path, const mote_vec3 *positions, const mote_mesh *mesh);

/* The same to an open file, which stays open. MOTE_EINVAL before anything is written. MOTE_EIO.
 */
mote_status mote_obj_print(FILE *file, const mote_vec3 *positions, const mote_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
