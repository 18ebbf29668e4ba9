/* Ordered one-rings from the faces of a mesh; used by mesh_create.c only. */
#ifndef MOTE_CORE_MESH_RING_H
#define MOTE_CORE_MESH_RING_H

#include "core/body/mesh.h"

/* Fills ring_start, ring, edge_count and open_edge_count of a mesh whose positions and
   triangles are set. MOTE_EINVAL, with a text that names it, for an edge of more than two faces
   or a vertex in no face. Cost O(v + t). */
mote_status mote_mesh_build_rings(mote_mesh *mesh);

#endif
