/* fcl-kdop18: FCL with polytopes of 18 fixed directions, refit bottom-up. FCL has contact for
   them and no distance. */
#include "baselines/fcl/fcl_adapter.hpp"

namespace
{

struct KdopVolume {
    using BV = fcl::KDOP<double, 18>;
    using DistanceNode = void;
    using CollisionNode = fcl::detail::MeshCollisionTraversalNode<BV>;
    static constexpr bool oriented = false;
    static constexpr bool bottom_up_encloses = true;
    static constexpr bool public_distance = false;
    [[maybe_unused]] static constexpr unsigned first_triangle_tests = 0;
};

} // namespace

MOTE_METHOD(fcl_kdop18) = mote_fcl::describe<KdopVolume>(
    "fcl-kdop18", "FCL 0.7: 18-sided polytopes, refit bottom-up; contact only",
    mote_fcl::bottom_up_parameters);
