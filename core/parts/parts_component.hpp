/* A connected component of a mesh, simplified, and what it is split into. */
#ifndef MOTE_CORE_PARTS_COMPONENT_HPP
#define MOTE_CORE_PARTS_COMPONENT_HPP

#include "core/base/vec3.h"

#include <array>
#include <cstdint>
#include <vector>

namespace mote_parts_detail
{

struct Component {
    std::vector<mote_vec3> points;
    std::vector<std::array<uint32_t, 3>>
        faces;                  /* three different points each, outside in front */
    std::vector<uint32_t> part; /* of each face, below count */
    uint32_t count = 0;         /* parts; 0: not split yet */
};

} // namespace mote_parts_detail

#endif
