/* fcl-obb: FCL with oriented boxes, refit top-down. FCL has contact for them and no distance.
 */
#include "baselines/fcl_adapter.hpp"

namespace
{

struct ObbVolume {
    using BV = fcl::OBB<double>;
    using DistanceNode = void;
    using CollisionNode = fcl::detail::MeshCollisionTraversalNodeOBB<double>;
    static constexpr bool oriented = true;
    static constexpr bool bottom_up_encloses = false;
    static constexpr bool public_distance = false;
    static constexpr unsigned first_triangle_tests = 0;
};

constexpr mote_parameter parameters[] = {
    mote_fcl::update_parameter("refit-top-down"), mote_fcl::queue_parameter,
    mote_fcl::seed_parameter, mote_fcl::call_parameter, mote_fcl::positions_parameter};

} // namespace

MOTE_METHOD(fcl_obb) = mote_fcl::describe<ObbVolume>(
    "fcl-obb", "FCL 0.7: oriented boxes, refit top-down; contact only", parameters);
