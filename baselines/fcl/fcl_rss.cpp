/* fcl-rss: FCL with rectangle swept spheres. FCL's bottom-up refit of them is wrong, so the
   default refits top-down. */
#include "baselines/fcl/fcl_adapter.hpp"

namespace
{

struct RssVolume {
    using BV = fcl::RSS<double>;
    using DistanceNode = fcl::detail::MeshDistanceTraversalNodeRSS<double>;
    using CollisionNode = fcl::detail::MeshCollisionTraversalNodeRSS<double>;
    static constexpr bool oriented = true;
    static constexpr bool bottom_up_encloses = false;
    static constexpr bool public_distance = true;
    static constexpr unsigned first_triangle_tests = 1;
};

} // namespace

MOTE_METHOD(fcl_rss) =
    mote_fcl::describe<RssVolume>("fcl-rss", "FCL 0.7: rectangle swept spheres, refit top-down",
                                  mote_fcl::top_down_parameters);
