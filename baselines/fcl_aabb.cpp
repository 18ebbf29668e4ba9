/* fcl-aabb: FCL with axis-aligned boxes. Bottom-up refit is correct and cheap for these. */
#include "baselines/fcl_aabb.hpp"

namespace
{

constexpr mote_parameter parameters[] = {mote_fcl::update_parameter("refit-bottom-up"),
                                         mote_fcl::queue_parameter,
                                         mote_fcl::seed_parameter,
                                         mote_fcl::call_parameter,
                                         mote_fcl::positions_parameter,
                                         mote_fcl::build_parameter};

} // namespace

MOTE_METHOD(fcl_aabb) = mote_fcl::describe<mote_fcl::AabbVolume>(
    "fcl-aabb", "FCL 0.7: axis-aligned boxes, refit bottom-up, distance by its traversal node",
    parameters);
