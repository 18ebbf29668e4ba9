/* fcl-kios: FCL with intersections of spheres and an oriented box. FCL's bottom-up refit leaves
   a few of them too small, so the default refits top-down. */
#include "baselines/fcl/fcl_adapter.hpp"

namespace
{

struct KiosVolume {
    using BV = fcl::kIOS<double>;
    using DistanceNode = fcl::detail::MeshDistanceTraversalNodekIOS<double>;
    using CollisionNode = fcl::detail::MeshCollisionTraversalNodekIOS<double>;
    static constexpr bool oriented = true;
    static constexpr bool bottom_up_encloses = false;
    static constexpr bool public_distance = true;
    static constexpr unsigned first_triangle_tests = 1;
};

} // namespace

MOTE_METHOD(fcl_kios) = mote_fcl::describe<KiosVolume>(
    "fcl-kios", "FCL 0.7: intersections of spheres, refit top-down",
    mote_fcl::top_down_parameters);
