#include "harness/mesh/faces.h"

#include "harness/base/hash.h"

uint64_t mote_faces_hash(uint64_t hash, const mote_mesh *mesh)
{
    hash = mote_hash_word(hash, mesh->triangle_count);
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        for (int k = 0; k < 3; ++k)
            hash = mote_hash_word(hash, mesh->triangles[t][k]);
    }
    return hash;
}
