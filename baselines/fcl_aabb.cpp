/* fcl-aabb: FCL with axis-aligned boxes. Bottom-up refit is right and cheap for these. */
#include "baselines/fcl_adapter.hpp"

namespace
{

struct AabbVolume {
    using BV = fcl::AABB<double>;
    using DistanceNode = fcl::detail::MeshDistanceTraversalNode<BV>;
    using CollisionNode = fcl::detail::MeshCollisionTraversalNode<BV>;
    static constexpr bool oriented = false;             /* takes transforms in place */
    static constexpr bool bottom_up_encloses = true;    /* bottom-up refit is right */
    static constexpr bool public_distance = true;       /* fcl::distance supports it */
    static constexpr unsigned first_triangle_tests = 0; /* made before the traversal */
};

constexpr mote_parameter parameters[] = {
    mote_fcl::update_parameter("refit-bottom-up"), mote_fcl::queue_parameter,
    mote_fcl::seed_parameter, mote_fcl::call_parameter, mote_fcl::positions_parameter};

} // namespace

MOTE_METHOD(fcl_aabb) = mote_fcl::describe<AabbVolume>(
    "fcl-aabb", "FCL 0.7: axis-aligned boxes, refit bottom-up, distance by its traversal node",
    parameters);
