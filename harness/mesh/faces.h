/* A hash over the faces of meshes: a scenario's fingerprint covers its vertices alone, and the
   same vertices may carry other faces. */
#ifndef MOTE_HARNESS_FACES_H
#define MOTE_HARNESS_FACES_H

#include "core/body/mesh.h"

#include <stdint.h>

/* Carries a hash (MOTE_HASH_START at first) on over the number of a mesh's triangles and the
   vertices of each, in their order. */
uint64_t mote_faces_hash(uint64_t hash, const mote_mesh *mesh);

#endif
