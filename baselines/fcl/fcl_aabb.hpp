/* FCL's axis-aligned boxes, in the form that Adapter and Pair expect. */
#ifndef MOTE_BASELINES_FCL_AABB_HPP
#define MOTE_BASELINES_FCL_AABB_HPP

#include "baselines/fcl/fcl_adapter.hpp"

namespace mote_fcl
{

struct AabbVolume {
    using BV = fcl::AABB<double>;
    using DistanceNode = fcl::detail::MeshDistanceTraversalNode<BV>;
    using CollisionNode = fcl::detail::MeshCollisionTraversalNode<BV>;
    static constexpr bool oriented = false;             /* FCL applies transforms in place */
    static constexpr bool bottom_up_encloses = true;    /* bottom-up refit is correct */
    static constexpr bool public_distance = true;       /* fcl::distance supports it */
    static constexpr unsigned first_triangle_tests = 0; /* made before the traversal */
};

} // namespace mote_fcl

#endif
