/* fcl-obbrss: FCL with oriented boxes (contact) and rectangle swept spheres (distance) in one
   tree. FCL's bottom-up refit of it is wrong, so the default refits top-down. */
#include "baselines/fcl/fcl_adapter.hpp"

namespace
{

struct ObbRssVolume {
    using BV = fcl::OBBRSS<double>;
    using DistanceNode = fcl::detail::MeshDistanceTraversalNodeOBBRSS<double>;
    using CollisionNode = fcl::detail::MeshCollisionTraversalNodeOBBRSS<double>;
    static constexpr bool oriented = true;
    static constexpr bool bottom_up_encloses = false;
    static constexpr bool public_distance = true;
    static constexpr unsigned first_triangle_tests = 1;
};

} // namespace

MOTE_METHOD(fcl_obbrss) = mote_fcl::describe<ObbRssVolume>(
    "fcl-obbrss", "FCL 0.7: oriented boxes and rectangle swept spheres, refit top-down",
    mote_fcl::top_down_parameters);
